# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of some pages of the site, by chromium without a screen."""
import pathlib
import subprocess
import tempfile

from PIL import Image

WIDTH, HEIGHT = 1280, 1000
PAGES = {  # and the section with which the picture begins
    "front": ("index.html", None), "search": ("search.html?q=permeability", None),
    "equations": ("doc/method.html", "one-dissipation-function"), "figure": ("doc/waves.html", "permeability")}


def beginning_with(page, section):
    """A copy of the page without what stands above the section: chromium takes pictures of the top alone."""
    copy = page.with_name("picture.html")
    hidden = f"<style>article section > *:has(~ #{section}) {{ display: none; }}</style></head>"
    copy.write_text(page.read_text(encoding="utf-8").replace("</head>", hidden, 1), encoding="utf-8")
    return copy


def screenshot(address, picture, profile):
    done = subprocess.run(
        ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--mute-audio",
         f"--user-data-dir={profile}", f"--window-size={WIDTH},{HEIGHT}", "--virtual-time-budget=8000",
         f"--screenshot={picture}", f"file://{address}"], capture_output=True, text=True)
    if not picture.exists():
        raise SystemExit(f"website: chromium took no picture of {address}: {done.stderr.strip()[-500:]}")


def take(site, folder):
    for name, (page, section) in PAGES.items():
        with tempfile.TemporaryDirectory() as scratch:
            picture = pathlib.Path(scratch, "page.png")
            if section:
                copy = beginning_with(site / page, section)
                screenshot(copy, picture, f"{scratch}/profile")
                copy.unlink()
            else:
                screenshot(site / page, picture, f"{scratch}/profile")
            # few colours: a third of the bytes
            made = folder / f"site_{name}.png"
            Image.open(picture).convert("RGB").quantize(48, dither=Image.Dither.NONE).save(made, optimize=True)
        print(f"website: {made.name}, {made.stat().st_size // 1000} kB")
