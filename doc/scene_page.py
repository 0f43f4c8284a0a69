# SPDX-License-Identifier: GPL-3.0-or-later
"""What doc/error_vs_time.md shows of the part `scenes`: tables, the settings for 1 %, the picture of all scenes."""
import re

import plotting
from plotting import plt
from scene_errors import DEFAULT, FINEST, LIMIT, SCATTER
from scene_forms import ROOT

PAGE = ROOT / "doc" / "couple_every.md"  # has five scenes' rows of the interval
LEAST, MOST = 1e-6, 3.0  # of an error in the picture
ALIKE = 0.8  # a run that takes more of the default's time than this is no cheaper


def percent(part):
    return "" if part is None else f"{100 * part:.2g} %"


def row_of(found, setting):
    return next((row for row in found["rows"] if row["setting"] == setting), None)


def scatter_of(found):
    """What a change of the viscosity by 1e-4 does to the default run."""
    row = row_of(found, SCATTER)
    return row.get("scatter", 0.0) if row else 0.0


def tried(found):
    """Rows of settings that can be taken, cheapest first; not the finest, and no other sample."""
    rows = [row for row in found["rows"] if "error" in row and row["setting"] not in (FINEST, SCATTER)
            and not row["setting"].endswith("grains")]
    return sorted(rows, key=lambda row: row["cpu"])


def said(message):
    """The first words of an error message."""
    text = re.sub(r"^.*ERROR: |Fix pfv \(id flow\): | \(\S*\)$", "", message).replace("`", "'").replace("|", "/")
    return text if len(text) <= 90 else text[:90].rsplit(" ", 1)[0] + " ..."


def all_rows(results):
    lines = ["| scene | setting | CPU of the run, s | of the flow, s | networks | flow steps | from the finest run | "
             "from theory |", "|--|--|--|--|--|--|--|--|"]
    for found in results:
        small = f" `{found['words']}`" if found["words"] else ""
        lines.append(f"| **{found['title']}**{small}: {found['what']}"
                     + (f"; theory: {found['against']}" if found["against"] else "")
                     + f" | scatter | | | | | {percent(scatter_of(found))} | |")
        for row in found["rows"]:
            name = row["setting"] + (f" (warned: {row['warned']})" if row["warned"] else "")
            if row["failed"]:
                lines.append(f"| | {name} | no run: {said(row['failed'])} | | | | | |")
            elif row["setting"] != SCATTER:
                numbers = [f"{row['flow']:.2f}" if row["flow"] is not None else "", row["networks"], row["steps"]]
                cells = ["" if number is None else str(number) for number in numbers]
                lines.append(f"| | {name} | {row['cpu']:.2f} | {' | '.join(cells)} | "
                             f"{percent(row.get('error'))} | {percent(row['theory'])} |")
    return "\n".join(lines)


def folder_of(found):
    """A scene's second form may have a folder of its own (oedometer_large)."""
    return found["title"] if (ROOT / "inputs" / found["title"]).is_dir() else found["scene"]


def for_one_percent(results):
    """Of each scene: its default, and the cheapest setting whose error is below 1 % or what runs scatter by."""
    lines = ["| scene | own observable | scatter | default: error, from theory, CPU | for 1 % take | error | "
             "CPU / default |", "|--|--|--|--|--|--|--|"]
    for found in results:
        default, scatter = row_of(found, DEFAULT), scatter_of(found)
        enough = max(LIMIT, scatter)
        good = [row for row in tried(found) if row["error"] <= enough]
        take = good[0] if good else None
        if take and default in good and take["cpu"] > ALIKE * default["cpu"]:
            take = default
        known = "error" in default
        lines.append(
            f"| [{found['title']}](../inputs/{folder_of(found)}) | {found['what']} | {percent(scatter)} | "
            + (f"{percent(default.get('error'))}, {percent(default['theory']) or 'none'}, {default['cpu']:.2f} s" if known else "")
            + (f" | {take['setting']} | {percent(take['error'])} | {take['cpu'] / default['cpu']:.2f} |" if take else
               " | none of these | | |"))
    return "\n".join(lines)


def table_of_page(name):
    """Rows of cells of the tables of doc/couple_every.md, the first under a name."""
    text = PAGE.read_text(encoding="utf-8").split(f"<!-- table {name} -->\n")[1].split("\n\n")[0].split("<!--")[0]
    return [[cell.strip() for cell in line.split("|")[1:-1]] for line in text.splitlines()[2:]]


def of_interval():
    """The interval in the five scenes of doc/couple_every.md: cheapest row within 1 % or what runs scatter by."""
    scatter = {row[0]: float(row[3].removesuffix(" %")) for row in table_of_page("scatter")}
    rows = [row for row in table_of_page("intervals") if row[4]]
    lines = ["| scene | scatter | every step: error, CPU | `auto` (default): error, CPU | for 1 % take | error | CPU, s |",
             "|--|--|--|--|--|--|--|"]
    for name in dict.fromkeys(row[0] for row in rows):
        own = [row for row in rows if row[0] == name]
        each, auto = (next(row for row in own if row[1] == word) for word in ("1", "auto error 0.1"))
        good = [row for row in own if float(row[4].removesuffix(" %")) <= max(100 * LIMIT, scatter[name])]
        take = min(good, key=lambda row: float(row[7]))
        lines.append(f"| {name} | {scatter[name]:g} % | {each[4]}, {each[7]} s | {auto[4]}, {auto[7]} s | "
                     f"couple_every {take[1]} | {take[4]} | {take[7]} |")
    return "\n".join(lines)


# ------------------------------------------------------------------------------ the picture

def panel(axes, results, value, colors):
    """All settings as dots, those beyond MOST as triangles at the top, the defaults large; the defaults' points and names."""
    points, names = [], []
    for found in results:
        color = colors[found["title"]]
        rows = [row for row in found["rows"] if value(row, found) is not None and row["setting"] not in (FINEST, SCATTER)]
        for row in rows:
            at = (row["cpu"], min(value(row, found), MOST))
            if row["setting"] == DEFAULT:
                points.append(at)
                names.append(found["title"])
                axes.plot(*at, "o", ms=8, color=color, mec="black")
            else:
                axes.plot(*at, "." if at[1] < MOST else "^", ms=4, color=color)
    axes.set(xscale="log", yscale="log", xlabel="CPU s of the run")
    axes.margins(x=0.12, y=0.08)
    axes.grid(alpha=0.3)
    axes.axhline(LIMIT, color="black", lw=0.8, ls="--")
    return points, names


def from_finest(row, found):
    return None if row.get("error") is None else max(row["error"], scatter_of(found), LEAST)


def from_theory(row, found):
    return None if row.get("theory") is None else max(row["theory"], LEAST)


def draw(results, path):
    colors = {found["title"]: plt.get_cmap("tab20")(k % 20) for k, found in enumerate(results)}
    moving = [found for found in results if row_of(found, SCATTER)]
    theory = [found for found in results if found["against"]]
    figure, axes = plt.subplots(1, 2, figsize=(20, 12))
    labels = [panel(axes[0], moving, from_finest, colors), panel(axes[1], theory, from_theory, colors)]
    axes[0].set(ylabel="error (rms; as parts of the curve's size)",
                title="from the finest run; not below what runs scatter by")
    axes[1].set(title="from theory, where there is one")
    figure.tight_layout()
    for place, (points, names) in zip(axes, labels):
        plotting.name_points(place, points, names)
    figure.savefig(path, dpi=70)
    plt.close(figure)
