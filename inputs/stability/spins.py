# SPDX-License-Identifier: GPL-3.0-or-later
"""What spins do that the fluid turns (`torques yes`): settlements at the same t / viscosity."""
from consolidations import GRAVITY, OFTEN, consolidation
from regions import limits_of
from samples import sample
from tables import Table

PART = 1 / 6  # of the contacts' limit
CASES = ((4, 28, (10, 100, 1000)), (8, 112, (10, 100)))  # cells along each edge; steps over R; R
ALL_RATIOS = CASES[0][2]
TORQUES = ("yes", "no")
EXPLICIT_R = 0.7  # of the papers' E


def table():
    rows = Table("grains", "friction", "torques", "volume rates",
                 *(f"settlement, μm, R = {ratio}" for ratio in ALL_RATIOS))
    for cells, length, ratios in CASES:
        data = sample("dense", cells)
        coupling, contact = limits_of(data)
        step = PART * contact

        def settled(ratio, words, parts=1, **variables):
            run = consolidation(data, ratio * coupling / step, step / parts, words + OFTEN, ratio * length * step,
                                4, gravity=GRAVITY, **variables)
            return f"{1e6 * (run.heights[0] - run.heights[-1]):.1f}"

        for friction in (0.0, 0.5):
            for torques in TORQUES:
                cells_of_row = [settled(ratio, f"coupling implicit torques {torques}", friction=friction)
                                for ratio in ratios]
                rows.row(cells**3, friction, torques, "Sᵀ", *cells_of_row,
                         *[""] * (len(ALL_RATIOS) - len(ratios)))
            rows.row(cells**3, friction, "", "E", settled(
                ratios[0], "time_step_check no volume_rates geometric",
                round(ratios[0] / EXPLICIT_R), friction=friction), *[""] * (len(ALL_RATIOS) - 1))
    return rows
