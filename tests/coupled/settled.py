# SPDX-License-Identifier: GPL-3.0-or-later
"""The sample of the coupled tests of time steps beyond the explicit limit: 125 grains under gravity
between six walls, their contacts at rest in the data file. In the tests gravity grows by a third and
water leaves through bottom and top. R is the time step over the explicit limit that the fix reports.
"""
from coupled import EDGE, FACES, CoupledTest, dump, faces, packing, read_thermo, restarted_head
from coupled import write_data

WALLS = "".join(
    f"fix w{face} all wall/gran model hooke/stiffness tangential history primitive type 1 "
    f"{face[0]}plane {EDGE if face.endswith('hi') else 0.0}\n" for face in FACES)
GRAVITY = "fix g all gravity {0} vector 0 0 -1\n"
# the tests' figures are those of the papers' law
OPEN = (faces(zlo="pressure 0", zhi="pressure 0") +
        " density 0 conductance hydraulic_radius")
STEP = 1e-4  # s; contacts are stable to about 6e-4 s
THERMO = ("compute height all reduce ave z\n"
          "thermo_style custom step ke c_height f_flow f_flow[5] f_flow[6] f_flow[7] f_flow[9]\n"
          "thermo_modify norm no format float %.15g\n")
SETTLE = ("include in.packing\n" + WALLS + GRAVITY.format(30) + "fix v all viscous 1.0\n"
          f"timestep {STEP}\nrun 3000\n"
          "dump e all custom 1 rest.dump id x y z radius\n"
          "dump_modify e sort id format \"%d" + " %.17g" * 4 + "\"\nrun 0\n")


class SettledTest(CoupledTest):
    rest = None  # the settled grains, made once
    limit = None  # s, of the explicit coupling at a viscosity of 1 Pa s

    def setUp(self):
        super().setUp()
        if not SettledTest.rest:
            write_data(self.folder, [(n, x, y, z, 1.35 * r) for n, x, y, z, r in packing(5)])
            self.liggghts(SETTLE)
            rows = (self.folder / "rest.dump").read_text().splitlines()[9:]
            SettledTest.rest = [(int(row.split()[0]), *map(float, row.split()[1:])) for row in rows]
            write_data(self.folder, SettledTest.rest)
            SettledTest.limit = self.thermo(self.script(self.fix(1.0), "run 0\n"))[0]["flow[6]"]
        write_data(self.folder, SettledTest.rest)

    def fix(self, viscosity, words=""):
        every = "" if "coupl" in words else " couple_every 1"
        return f"fix flow all pfv viscosity {viscosity!r} {OPEN}{every} {words}\n"

    def at_ratio(self, ratio, words="coupling staged"):
        """The fix with the viscosity at which STEP is `ratio` times the explicit limit."""
        return self.fix(ratio * SettledTest.limit / STEP, words)

    def script(self, fix, run, step=STEP, before=""):
        return ("include in.packing\n" + WALLS + GRAVITY.format(40) + before + fix +
                f"timestep {step!r}\n" + THERMO + run)

    def thermo(self, script, **options):
        self.liggghts(script, **options)
        return read_thermo((self.folder / "log.liggghts").read_text())

    def restarts_with_the_same_bytes(self, fix):
        """A run that goes on and one from its restart file: the same thermo rows and dumps."""
        self.liggghts(self.script(fix, "run 50\nwrite_restart file.restart\n" +
                                  dump("a.dump") + "run 50\n"))
        continued = read_thermo((self.folder / "log.liggghts").read_text())
        self.liggghts(restarted_head() + WALLS + GRAVITY.format(40) + fix +
                      f"timestep {STEP}\n" + THERMO + dump("b.dump") + "run 50\n")
        restarted = read_thermo((self.folder / "log.liggghts").read_text())
        self.assertEqual(restarted, continued[-len(restarted):])
        self.assertEqual((self.folder / "a.dump").read_bytes(),
                         (self.folder / "b.dump").read_bytes())
