# SPDX-License-Identifier: GPL-3.0-or-later
"""Error against run time of each scene of inputs/ in small: the part `scenes` of doc/error_vs_time.py.

A row is a scene with one setting of fix pfv. What was measured is kept, row by row, in a file beside the user's other caches
($XDG_CACHE_HOME/pfv), so that a command that was interrupted goes on; rows of other sources are not taken.
"""
import hashlib
import inspect
import json
import math
import os
import pathlib
import re
import tempfile

import numpy as np

import scene_forms
from scene_forms import FORMS, ROOT, scene

FINEST, DEFAULT, SCATTER = "finest", "default", "viscosity x 1.0001"
FINE = "couple_every 1 retriangulate mean 0.001"
USUAL = "couple_every auto retriangulate mean 0.01 coupling explicit conductance open_throat solver auto"  # of fix pfv
STEPS = {f"couple_every {n}": f"couple_every {n}" for n in ("1", "10", "auto", "auto error 1")}
STRAINS = {f"retriangulate {e}": f"retriangulate {e}" for e in ("mean 0.002", "mean 0.01", "mean 0.05", "0.01")}
OF_ALL = {"conductance hydraulic_radius": "conductance hydraulic_radius", "solver amg": "solver amg"}
CACHE = pathlib.Path(os.environ.get("XDG_CACHE_HOME", pathlib.Path.home() / ".cache")) / "pfv" / "error_vs_time"
LIMIT = 0.01  # of what settings are taken for
# what the figures follow from; not how files are read, and no other front end
ROOMS = ("problem", "geometry", "network", "physics", "sparse", "solve", "step", "darcy_grid")


def sources_of(patterns):
    return sorted(path for pattern in patterns for path in ROOT.glob(pattern) if path.is_file())


def digest(*more, text=""):
    """Of the sources that the figures follow from, without their comments and empty lines."""
    code = [f"pfvlib/src/{room}/**/*.?pp" for room in ROOMS]
    code += ["pfvlib/include/pfv/*.hpp", "liggghts_fix/*.cpp", "liggghts_fix/*.h"]
    total = hashlib.sha256(text.encode())
    for path in sources_of([*code, *more]):
        text = path.read_text(errors="replace")
        if path.suffix in (".cpp", ".hpp", ".h"):
            text = re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.S)
        total.update((path.name + "\n" + "\n".join(line.strip() for line in text.split("\n") if line.strip())).encode())
    return total.hexdigest()[:16]


def recipe(form):
    """What a form does, as text."""
    functions = (form.run, form.prepare)
    held = [[cell.cell_contents for cell in function.__closure__ or ()] for function in functions]
    return repr((form.words, held, [inspect.getsource(function) for function in functions]))


def hash_of_part(part):
    """Of all that the figures of a part of the page follow from."""
    if part == "scenes":
        folders, own = {form.scene for form in FORMS}, ["doc/scene_errors.py", "doc/scene_forms.py"]
    else:
        folders, own = {"oedometer"}, ["doc/error_vs_time.py"]
    scripts = [f"inputs/{folder}/{name}" for folder in sorted(folders | {"common"}) for name in ("*.py", "in.*")]
    return digest(*scripts, *own)


# ------------------------------------------------------------------------------ measuring

class Kept:
    """The rows that were measured with these sources, and the folder in which runs write."""

    def __init__(self, form, cache=CACHE):
        folder = f"inputs/{form.scene}"
        self.form, self.key = form, digest(f"{folder}/*.py", f"{folder}/in.*", "inputs/common/*", text=recipe(form))
        self.folder = cache / f"{self.key}_{re.sub(r'[^a-z_]+', '_', form.name())}"
        self.folder.mkdir(parents=True, exist_ok=True)
        self.file, self.shared = self.folder / "rows.jsonl", {}
        lines = self.file.read_text().splitlines() if self.file.exists() else []
        self.rows = {row["setting"]: row for row in map(json.loads, lines)}

    def row(self, setting, words="", factor=1.0, grains=None):
        if setting not in self.rows:
            found = {"setting": setting, "words": words, "grains": grains, **self.measured(words, factor, grains)}
            self.rows[setting] = found
            with open(self.file, "a", encoding="utf-8") as file:
                file.write(json.dumps(found) + "\n")
        return self.rows[setting]

    def measured(self, words, factor, grains):
        form, module = self.form, scene_forms.module_of(self.form.scene)
        out = str(self.folder / f"run_{grains or 'as_it_is'}")
        try:
            if grains not in self.shared:
                self.shared[grains] = form.prepare(module, scene_forms.settings_of(form, module, out, "", grains))
            settings = scene_forms.settings_of(form, module, out, words, grains)
            found = form.run(module, settings, self.shared[grains], factor)
        except scene.Failure as failure:
            log = re.search(r" \(see (.*)\.txt\)", str(failure))
            return {"failed": str(failure).replace(log[0] if log else "", ""),
                    "warned": scene_forms.warnings(log[1]) if log else ""}
        cost = scene_forms.costs(found.log) if found.log else {}
        sizes = {name: size(np.asarray(y)) if callable(size) else size for name, (_, y, size) in found.curves.items()}
        return {"cpu": found.cpu, **cost, "theory": found.theory, "sizes": sizes, "curves": {
            name: [np.asarray(x).tolist(), np.asarray(y).tolist()] for name, (x, y, _) in found.curves.items()}}


def settings_of(form):
    """{setting: words of fix pfv} beside finest, default and scatter; none that the scene has anyway."""
    own, explicit = in_effect(form.own), "coupling" not in form.own
    of_time = (STEPS if explicit else {"coupling explicit": "coupling explicit"}) | STRAINS
    tried = {**(of_time if form.moves else {}), **OF_ALL, **form.rows}
    return {name: words for name, words in tried.items() if in_effect(form.own, words) != own}


def in_effect(own, words=""):
    """{keyword: its values} of a run with these settings."""
    merged = scene.fix_words(scene.fix_words(USUAL, own), words)
    found, keyword = {}, None
    for word in merged.split():
        keyword = word if word in scene.fix_keywords() else keyword
        found.setdefault(keyword, []).append(word)
    return found


def difference(row, finest):
    """Root mean square of what a row's curves differ by from the finest run's, over their sizes: of that which differs most."""
    worst = 0.0
    for name, (x, y) in finest["curves"].items():
        (x, y), (other_x, other_y) = (map(np.array, pair) for pair in ((x, y), row["curves"][name]))
        if other_y.ndim > 1:
            other = np.column_stack([np.interp(x, other_x, column) for column in other_y.T])
        else:
            other = np.interp(x, other_x, other_y)
        worst = max(worst, float(np.sqrt(np.mean((other - y)**2))) / finest["sizes"][name])
    return worst


def measure_form(form):
    kept = Kept(form)
    print(f"  {form.name()}", flush=True)
    finest = kept.row(FINEST, FINE if form.moves else "")
    rows = [finest, kept.row(DEFAULT)] + ([kept.row(SCATTER, "", 1.0001)] if form.moves else [])
    rows += [kept.row(setting, words) for setting, words in settings_of(form).items()]
    rows += [kept.row(f"{grains} grains", "", 1.0, grains) for grains in form.sizes]
    found = []
    for row in rows:
        one = {key: row.get(key) for key in ("setting", "words", "cpu", "flow", "networks", "steps", "theory", "failed",
                                           "warned")}
        if "curves" in row and "curves" in finest and (form.moves or not row["grains"]):
            one["error"] = difference(row, finest)
        if row["setting"] == SCATTER and "curves" in row:
            one["scatter"] = difference(row, kept.row(DEFAULT))
        found.append(one)
    return {"scene": form.scene, "title": form.name(), "words": form.words, "what": form.what, "against": form.theory,
            "rows": found}


def measure_scenes(names=()):
    return [measure_form(form) for form in FORMS if not names or form.name() in names]


CHEAP = ("permeameter", "settling, one bead", "wave_still")
AGREES = 1e-3  # of a distance from theory


def again(results):
    """Measures the default of three scenes once more; exit status."""
    wrong = 0
    for form in (form for form in FORMS if form.name() in CHEAP):
        with tempfile.TemporaryDirectory() as folder:
            found = Kept(form, pathlib.Path(folder)).measured("", 1.0, None)
        page = next(one for one in results if one["title"] == form.name())
        wanted = next(row for row in page["rows"] if row["setting"] == DEFAULT)["theory"]
        held = "failed" not in found and abs(found["theory"] - wanted) <= AGREES * wanted
        print(f"{form.name()}: {100 * found.get('theory', math.nan):.4f} % from theory, {100 * wanted:.4f} % on the page"
              + ("" if held else f": not the same; {found.get('failed', 'make the page again')}"))
        wrong += not held
    return 1 if wrong else 0
