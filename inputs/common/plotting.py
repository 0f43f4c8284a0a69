# SPDX-License-Identifier: GPL-3.0-or-later
"""matplotlib without a screen."""
import matplotlib
from PIL import Image

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.text import Text
from matplotlib.transforms import Bbox


def save_figure(figure, path, dpi=90):
    figure.tight_layout()
    figure.savefig(path, dpi=dpi)
    plt.close(figure)


def name_points(axes, points, names):
    """Writes each name beside its point, (x, y) in data, where it lies on no other name or point; once the axes have
    their scales and limits."""
    axes.figure.canvas.draw()
    renderer = axes.figure.canvas.get_renderer()
    room, half = axes.get_window_extent(), 4  # half of a marker's size
    taken = [Bbox.from_extents(x - half, y - half, x + half, y + half) for x, y in map(axes.transData.transform, points)]
    places = [(7, 0), (-7, 0), (0, 10), (0, -10), (9, 10), (9, -10), (-9, 10), (-9, -10), (14, 21), (14, -21), (-14, 21),
              (-14, -21), (20, 32), (20, -32), (-20, 32), (-20, -32)]
    for point, name in zip(points, names):
        for across, up in places:
            line = {"arrowstyle": "-", "lw": 0.4, "shrinkA": 0, "shrinkB": 2} if across and up else None
            text = axes.annotate(name, point, xytext=(across, up), textcoords="offset points", va="center", fontsize="small",
                                 ha="left" if across > 0 else "right" if across < 0 else "center", arrowprops=line)
            text.update_positions(renderer)
            box = Text.get_window_extent(text, renderer)  # without its line
            if room.x0 < box.x0 and box.x1 < room.x1 and not any(map(box.overlaps, taken)):
                break
            text.remove()
        else:
            raise ValueError(f"there is no free place for the name {name}: make the figure larger")
        taken.append(box)


def contact_sheet(pictures, path, width=1800, gap=10, most=2.4):
    """The pictures in rows of the same width, in one file; a row's shapes, width over height, add up to `most` or more."""
    rows = [[]]
    for picture in pictures:
        with Image.open(picture) as image:
            rows[-1].append(image.convert("RGB"))
        if sum(image.width / image.height for image in rows[-1]) >= most:
            rows.append([])
    shelves = []
    for row in filter(None, rows):
        height = round((width - gap * (len(row) - 1)) / max(most, sum(image.width / image.height for image in row)))
        shelves.append([image.resize((round(image.width * height / image.height), height)) for image in row])
    sheet = Image.new("RGB", (width, sum(row[0].height + gap for row in shelves)), "white")
    down = 0
    for row in shelves:
        across = 0
        for image in row:
            sheet.paste(image, (across, down))
            across += image.width + gap
        down += row[0].height + gap
    sheet.save(path)
