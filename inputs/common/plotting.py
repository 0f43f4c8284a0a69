# SPDX-License-Identifier: GPL-3.0-or-later
"""matplotlib without a screen."""
import matplotlib
from PIL import Image

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def save_figure(figure, path, dpi=90):
    figure.tight_layout()
    figure.savefig(path, dpi=dpi)
    plt.close(figure)


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
