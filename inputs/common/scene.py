# SPDX-License-Identifier: GPL-3.0-or-later
"""What the run.py of the scenes share: KEY=VALUE words, running LIGGGHTS and pfv with progress,
the table of results beside their references."""
import functools
import json
import pathlib
import resource
import subprocess
import sys
import time

import plotting
from programs import BIN, liggghts_words, solve_words

# settings that many scenes have: (type, default, what it is)
SEED = (int, 1, "sample number, 1, 2, ...")
TOP = (str, "plane", "plane or extent: where the flow box ends")
SHAKE = (float, 0.0, "force that keeps each grain moving, over its weight in the fluid")
LAW = (str, "open_throat", "conductance law; hydraulic_radius is that of the papers and the thesis")
FIX = (str, "", "settings of fix pfv, in quotes; they win over those of the scene")
OUT = (str, "post/sample", "where results go, without ending")


class Failure(Exception):
    """What went wrong and what to do, in one line."""


class BadSetting(Failure):
    """A word of the command that means nothing here."""


def parse(words, keys):
    """Settings from KEY=VALUE words; keys: {KEY: (type, default, what it is)}."""
    settings = {key: default for key, (_, default, _) in keys.items()}
    for word in words:
        key, equals, value = word.partition("=")
        if not equals or key not in keys:
            known = ", ".join(f"{k} ({what})" for k, (_, _, what) in keys.items())
            raise BadSetting(f"'{word}' is not KEY=VALUE with a known key: {known}")
        try:
            settings[key] = keys[key][0](value)
        except ValueError:
            raise BadSetting(f"{key} needs a number, not '{value}'") from None
    return settings


def numbers(settings, key, kind=float, zero=False):
    """The comma-separated numbers of a setting, above 0 (or 0, where that is meant), sorted."""
    try:
        values = sorted(kind(word) for word in settings[key].split(","))
    except ValueError:
        raise BadSetting(f"{key} is a number, or several with commas between them") from None
    if values[0] < 0 or (values[0] == 0 and not zero):
        raise BadSetting(f"{key} must be above 0" if not zero else f"{key} must be 0 or above")
    return values


@functools.cache
def fix_keywords():
    """Of the settings of fix pfv."""
    listed = subprocess.run([str(BIN / "pfv"), "settings", "--fix"], capture_output=True, text=True, check=True).stdout
    return {line.split()[0] for line in listed.splitlines() if line[:1].strip()}


OF_PORES = {"conductance", "retriangulate", "shear_viscous", "coupling"}  # a coarse grid has none of them


def fix_words(own, given):
    """Settings of fix pfv: the scene's own, but for those that are given as well, then the given ones. With the model
    darcy_grid those of pores fall as well."""
    keywords, kept, keyword = fix_keywords(), [], None
    taken = keywords & set(given.split())
    if "darcy_grid" in given.split():
        taken |= OF_PORES
    for word in own.split():
        keyword = word if word in keywords else keyword
        kept += [word] if keyword not in taken else []
    return " ".join([*kept, *given.split()])


def primes(seed, count=5):
    """Distinct primes above 10000, as LIGGGHTS wants them, others for each seed."""
    found, candidate = [], 10000 + 1000 * seed
    while len(found) < count:
        candidate += 1
        if all(candidate % d for d in range(2, int(candidate**0.5) + 1)):
            found.append(candidate)
    return found


class Progress:
    """One line about every five seconds: percent, simulated time, estimated time left."""

    def __init__(self, stage, first, last, step_time):
        self.stage, self.first, self.last, self.step_time = stage, first, last, step_time
        self.start = self.shown = time.monotonic()

    def at(self, step):
        now = time.monotonic()
        if now - self.shown < 5.0 or step <= self.first:
            return
        self.shown = now
        done = (step - self.first) / (self.last - self.first)
        left = (now - self.start) * (1.0 - done) / done
        simulated = (step - self.first) * self.step_time
        print(f"  {self.stage:<14s} {100 * done:3.0f} %   "
              + (f"simulated {simulated:.4g} s   " if simulated else "")
              + f"about {left:.0f} s left", flush=True)


def child_seconds():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def liggghts(folder, script, variables, log, progress=None):
    """Runs a script in the scene's folder; returns what it printed behind the scene's name, by
    first word, and the CPU seconds."""
    program = BIN / "liggghts-pfv"
    if not program.exists():
        raise Failure(f"{program.name} is not built; run ./run.sh, which builds it")
    command = ["stdbuf", "-oL", *liggghts_words(script, variables, log + ".log")]
    before = child_seconds()
    said, tail = {}, []
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True, errors="replace")
    with open(folder / (log + ".txt"), "w") as copy:
        for line in process.stdout:
            copy.write(line)
            tail = (tail + [line.strip()])[-40:]
            words = line.split()
            if words[:1] == [folder.name]:
                said[words[1]] = words[2:]
            elif progress and words and words[0].isdigit():
                progress.at(int(words[0]))
    if process.wait() != 0:
        errors = [line for line in tail if "ERROR" in line] or tail[-1:]
        raise Failure(f"{script} stopped: {errors[0] if errors else 'no message'} "
                      f"(see {log}.txt)")
    return said, child_seconds() - before


def pfv_solve(folder, packing, room, viscosity, report, *words):
    """Report of `pfv solve` on a packing; room: the six numbers of a box, or the name of a container's file."""
    done = subprocess.run(solve_words(packing, room, viscosity, "--report", report, *words), cwd=folder,
                          capture_output=True, text=True)
    if done.returncode != 0:
        raise Failure(f"pfv solve on {packing}: {done.stderr.strip()}")
    return json.loads((folder / report).read_text())


def print_checks(rows):
    """rows: (what, measured, wanted, held); returns whether all held."""
    print()
    for what, measured, wanted, held in rows:
        print(f"  {'ok    ' if held else 'FAILED'} {what:<58s} {measured:9.4g}   {wanted}")
    return all(held for *_, held in rows)


def summary(folder, base, figures, rows):
    """Prints the checks and writes figures and checks to BASE_summary.json."""
    passed = print_checks(rows)
    checks = [{"what": what, "measured": measured, "wanted": wanted, "held": bool(held)}
              for what, measured, wanted, held in rows]
    (folder / (base + "_summary.json")).write_text(
        json.dumps({**figures, "passed": bool(passed), "checks": checks}, indent=1) + "\n")
    return passed


def sheet_of_figures(name, out, begin):
    """The pictures that the scene has drawn as OUT_*.png since `begin`, on one sheet beside them."""
    stem = pathlib.Path(__file__).resolve().parents[1] / name / out
    sheet = stem.with_name(stem.name + "_all_figures.png")
    drawn = sorted(file for file in stem.parent.glob(stem.name + "*.png")
                   if file != sheet and file.stat().st_mtime >= begin)
    if len(drawn) > 1:
        plotting.contact_sheet(drawn, sheet)
        print(f"all figures on one sheet: {sheet}")


def main(name, work):
    """work(words) -> whether the promises held; exit status 0, 1 (not held, failed) or 2 (bad
    words). Ends with a sheet of the scene's figures."""
    begin = time.time() - 1  # a file system may keep whole seconds
    try:
        passed = work(sys.argv[1:])
        out = next((word.partition("=")[2] for word in sys.argv[1:] if word.startswith("OUT=")), OUT[1])
        sheet_of_figures(name, out, begin)
    except Failure as failure:
        print(f"{name}: {failure}", file=sys.stderr)
        sys.exit(2 if isinstance(failure, BadSetting) else 1)
    sys.exit(0 if passed else 1)
