# SPDX-License-Identifier: GPL-3.0-or-later
"""`python3 -m pfv.render`: pictures by VTK without a screen, and a sentence where there can be none."""
import os
import shutil
import subprocess
import sys
import unittest

import numpy as np
import pfv
from case import CommandCase, grains, through_flow

try:
    import pfv.render
    MISSING = "" if shutil.which("Xvfb") else "xvfb is not installed"
except ImportError as problem:
    MISSING = str(problem)

SPHERES = """<?xml version="1.0"?><VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="2" NumberOfCells="0"><Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">
0.2 0.5 0.2 0.8 0.5 {z}</DataArray></Points><Cells><DataArray type="Int64" Name="connectivity" format="ascii"/>
<DataArray type="Int64" Name="offsets" format="ascii"/><DataArray type="UInt8" Name="types" format="ascii"/></Cells><PointData>
<DataArray type="Float64" Name="radius" format="ascii">0.2 0.2</DataArray>
<DataArray type="Float64" Name="force" NumberOfComponents="3" format="ascii">0 0 0 0 3 4</DataArray>
</PointData></Piece></UnstructuredGrid></VTKFile>"""


def colours(figure):
    """The picture without its bar of colours, as reds, greens and blues."""
    return figure.axes[0].images[0].get_array().reshape(-1, 3)


@unittest.skipIf(MISSING, MISSING)
class Render(CommandCase):
    def setUp(self):
        super().setUp()
        (self.folder / "g.vtu").write_text(SPHERES.format(z=0.8))

    def pores(self):
        sample = grains()
        flow = pfv.Flow(through_flow(), viscosity=1.0)
        flow.evaluate(sample.positions, sample.radii)
        flow.write_fields(self.folder / "pores.vtu")
        return self.folder / "pores.vtu"

    def test_grains_have_the_colour_of_their_force(self):
        """viridis: the unloaded one is violet, the other yellow."""
        figure = pfv.render.figure(self.folder / "g.vtu")
        self.assertEqual(figure._repr_png_()[:4], b"\x89PNG")  # that a notebook shows
        red, green, blue = colours(figure).astype(int).T
        violet, yellow = (blue > green + 20).sum(), (red > blue + 60).sum()
        self.assertGreater(violet, 5000)
        self.assertAlmostEqual(violet / yellow, 1, delta=0.4)
        self.assertEqual(figure.axes[1].get_ylabel(), "|force|, N")

    def test_slice_falls_from_red_to_blue_and_shows_the_grains_that_it_cuts(self):
        picture = pfv.render.figure(self.pores(), cut=(1, 0.5), grains=self.folder / "g.vtu").axes[0].images[0].get_array()
        low, high = picture[-20:].reshape(-1, 3).mean(axis=0), picture[:20].reshape(-1, 3).mean(axis=0)
        self.assertGreater(low[0] - low[2], 80)
        self.assertGreater(high[2] - high[0], 80)
        grey = np.ptp(picture.astype(int), axis=2) < 3
        self.assertAlmostEqual(grey.mean(), 2 * np.pi * 0.2**2, delta=0.03)  # of the unit square

    def test_throats(self):
        figure = pfv.render.figure(self.pores(), throats=True)
        self.assertIn("flux", figure.axes[1].get_ylabel())
        self.assertGreater((np.ptp(colours(figure).astype(int), axis=1) > 60).sum(), 2000)

    def test_animation_has_a_frame_a_step_on_one_scale(self):
        from PIL import Image
        (self.folder / "h.vtu").write_text(SPHERES.format(z=0.3).replace("0 3 4", "0 0 9"))
        (self.folder / "run.pvd").write_text("<VTKFile><Collection>" + "".join(
            f'<DataSet timestep="{k}" part="1" file="{file}.vtu"/>' for k, file in enumerate("gh")) +
            "</Collection></VTKFile>")
        done = self.render("run.pvd")
        self.assertEqual((done.returncode, done.stdout), (0, "run.gif, 2 frames\n"), done.stderr)
        with Image.open(self.folder / "run.gif") as film:
            self.assertEqual(film.n_frames, 2)

    def render(self, *words, **environment):
        settings = {**os.environ, **environment}
        return subprocess.run([sys.executable, "-m", "pfv.render", *words], cwd=self.folder, text=True,
                              capture_output=True, env=settings)

    def test_without_what_it_draws_with_a_sentence(self):
        hidden = self.folder / "hidden"
        for package, debian in (("vtkmodules", "python3-vtk9"), ("matplotlib", "python3-matplotlib")):
            shutil.rmtree(hidden, ignore_errors=True)
            (hidden / package).mkdir(parents=True)
            (hidden / package / "__init__.py").write_text("raise ImportError('hidden')\n")
            done = self.render("g.vtu", PYTHONPATH=f"{hidden}:{os.environ['PYTHONPATH']}")
            self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
            self.assertIn("install " + debian, done.stderr)

    def test_without_any_screen_a_sentence(self):
        done = self.render("g.vtu", DISPLAY=":no", PATH="/nowhere")
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
        self.assertIn("install xvfb", done.stderr)
        self.assertFalse((self.folder / "g.png").exists())

    def test_refusals(self):
        pores, spheres = self.pores(), str(self.folder / "g.vtu")
        for words, part in ((["absent.vtu"], "cannot read"), ([spheres, "--color", "taste"], "radius, force"),
                            ([spheres, "--slice", "y=0.5"], "grains"), ([str(pores), "--slice", "y=7"], "outside"),
                            ([str(pores), "--slice", "w=7"], "AXIS=PLACE")):
            with self.subTest(words=words):
                with self.assertRaisesRegex(pfv.InputError, part):
                    parsed = pfv.render.parser().parse_args(words)
                    pfv.render.draw(parsed)


if __name__ == "__main__":
    unittest.main()
