# SPDX-License-Identifier: GPL-3.0-or-later
"""`python3 -m pfv.plot`: what a file holds becomes a figure, whose texts do not lie on each other."""
import itertools
import pathlib
import subprocess
import sys
import unittest

import numpy as np
import pfv
import pfv.plot
from case import DATA, UNIT, CommandCase, grains, through_flow
from matplotlib.text import Text
from PIL import Image

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "inputs/common"))
import plotting

HISTORY = ("step,time,strain,networks,steps,solves,inflow,outflow,volume_rate_sum,storage_rate,mass_error,"
           "force_balance_error,fluid_balance_error,mean_pressure,porosity,permeability,hidden,stages,force_x,force_y,"
           "force_z,zlo_position,zlo_flux,zlo_force_x,zlo_force_y,zlo_force_z,zhi_position,zhi_flux,zhi_force_x,"
           "zhi_force_y,zhi_force_z,patch 1 on face zhi flux,patch 1 on face zhi pressure\n")


def history(rows=30):
    text = HISTORY
    for k in range(rows):
        text += (f"{10 * k},{1e-3 * k},{1e-4 * k},{k // 9},{10 * k},{k},1e-6,{1e-6 * k},{-1e-7 * k},0,1e-15,2e-16,1e-17,"
                 f"{500 - k},0.4,,0,1,0,1e-9,{-0.1 * k},0,1e-6,0,0,{-9 + 0.1 * k},{1 - 1e-3 * k},-1e-6,0,0,9,-2e-7,5\n")
    return text


def overlapping_texts(figure):
    """Pairs of texts that are drawn on each other."""
    figure.canvas.draw()
    drawn = figure.canvas.get_renderer()
    beyond = set()  # labels of ticks that matplotlib makes beyond the limits of an axis and does not draw
    for axis in (axis for axes in figure.axes for axis in (axes.xaxis, axes.yaxis)):
        low, high = sorted(axis.get_view_interval())
        beyond.update(label for tick in axis.get_major_ticks() + axis.get_minor_ticks()
                      if not low <= tick.get_loc() <= high for label in (tick.label1, tick.label2))
    seen = [(text.get_text(), Text.get_window_extent(text, drawn)) for text in figure.findobj(Text)  # without lines of names
            if text.get_text().strip() and text.get_visible() and text not in beyond]
    return [(a, b) for (a, one), (b, other) in itertools.combinations(seen, 2)
            if min(one.x1, other.x1) - max(one.x0, other.x0) > 1 and min(one.y1, other.y1) - max(one.y0, other.y0) > 1]


class Plot(CommandCase):
    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def assert_readable(self, figure):
        self.assertEqual(overlapping_texts(figure), [])
        return figure

    def test_texts_that_overlap_are_found(self):
        figure = pfv.plot.history_figure(self.write("h.csv", history()))
        figure.axes[0].set_title("a title that reaches into the axes", y=0.5)
        figure.axes[0].text(0.5, 0.5, "another", transform=figure.axes[0].transAxes, ha="center")
        self.assertNotEqual(overlapping_texts(figure), [])

    def test_history_has_a_panel_for_each_kind_of_quantity_that_the_run_has(self):
        figure = self.assert_readable(pfv.plot.figure(self.write("h.csv", history())))
        self.assertEqual(figure._repr_png_()[:4], b"\x89PNG")  # that a notebook shows
        labels = [axes.get_ylabel() for axes in figure.axes]
        self.assertEqual(labels, ["pressure, Pa", "flux into the box, m³/s", "force of the fluid, N", "displacement, m",
                                  "pore strain", "porosity", "balance errors", "count"])
        saved = figure.axes[-1].lines[1].get_ydata()
        np.testing.assert_array_equal(saved, 9 * np.arange(30))
        moved = [line for line in figure.axes[3].lines]
        self.assertEqual([line.get_label() for line in moved], ["zhi moved"])
        self.assertAlmostEqual(moved[0].get_ydata()[-1], -0.029)

    def test_profiles_and_sensors(self):
        profile = self.write("p.csv", "time,0.25,0.75\n" + "".join(f"{0.1 * k},{9 - k},{3}\n" for k in range(20)))
        figure = self.assert_readable(pfv.plot.figure(profile))
        self.assertEqual(len(figure.axes[0].lines), 9)
        np.testing.assert_array_equal(figure.axes[0].lines[-1].get_xdata(), [-10, 3])
        sensors = self.write("s.csv", "time,0.1 0.2 0.3,0.1 0.2 0.9\n0,1,2\n1,3,4\n")
        figure = self.assert_readable(pfv.plot.figure(sensors))
        np.testing.assert_array_equal(figure.axes[0].lines[1].get_ydata(), [2, 4])

    def test_forces_with_and_without_their_packing(self):
        self.solve(DATA / "packing_100.csv", "--face", "zlo:pressure=1", "--face", "zhi:pressure=0")
        forces = self.folder / "forces.csv"
        self.assert_readable(pfv.plot.figure(forces))
        figure = self.assert_readable(pfv.plot.figure(forces, DATA / "packing_100.csv"))
        self.assertEqual(len(figure.axes[0].lines[0].get_xdata()), 100)
        with self.assertRaisesRegex(pfv.InputError, "no sphere"):
            pfv.plot.figure(forces, DATA / "bed_25.csv")

    def test_slices_of_pores(self):
        flow = pfv.Flow(through_flow(), viscosity=1.0)
        sample = grains()
        flow.evaluate(sample.positions, sample.radii)
        flow.write_fields(self.folder / "pores.vtu")
        figure = self.assert_readable(pfv.plot.figure(self.folder / "pores.vtu"))
        self.assertEqual(len(figure.axes), 4)

    def test_names_of_points_that_lie_close(self):
        figure, axes = plotting.plt.subplots()
        points = [(1, 1), (1.01, 1.01), (1.02, 1), (1.03, 1.015), (2, 2)]
        axes.plot(*zip(*points), "ko")
        plotting.name_points(axes, points, [f"point number {k}" for k in range(5)])
        self.assert_readable(figure)
        plotting.plt.close(figure)

    def test_sheet_has_each_picture_once(self):
        for name, size, colour in (("a.png", (300, 100), "red"), ("b.png", (100, 100), "blue"), ("c.png", (100, 90), "green")):
            Image.new("RGB", size, colour).save(self.folder / name)
        plotting.contact_sheet(sorted(self.folder.glob("?.png")), self.folder / "sheet.png", width=600)
        with Image.open(self.folder / "sheet.png") as sheet:
            self.assertEqual(sheet.width, 600)
            counted = {colour: number for number, colour in sheet.getcolors()}
        self.assertEqual(counted[255, 0, 0], 600 * 200)  # a row of its own
        self.assertEqual(set(counted), {(255, 0, 0), (0, 0, 255), (0, 128, 0), (255, 255, 255)})

    def test_command_writes_a_picture_or_says_what_is_wrong(self):
        self.write("s.csv", "time,0.1 0.2 0.3\n0,1\n1,3\n")
        self.write("no.csv", "a,b\n1,2\n")
        self.write("short.csv", "time,0.5\n1\n")
        run = lambda *words: subprocess.run([sys.executable, "-m", "pfv.plot", *words], cwd=self.folder, text=True,
                                            capture_output=True)
        self.assertEqual(run("s.csv").stdout, "s.png\n")
        self.assertEqual((self.folder / "s.png").read_bytes()[:4], b"\x89PNG")
        done = run("no.csv", "short.csv")
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1))
        self.assertIn("no history", done.stderr)
        self.assertEqual(sorted(file.name for file in self.folder.glob("*.png")), ["s.png"])
        for file, part in (("short.csv", ":2: has 1 fields"), ("absent.csv", "cannot read")):
            with self.assertRaisesRegex(pfv.InputError, part):
                pfv.plot.figure(self.folder / file)


if __name__ == "__main__":
    unittest.main()
