#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Oedometer test: sample, dry test, permeability, coupled run, comparison with Terzaghi.

    run.py [KEY=VALUE...]      called by ./run.sh oedometer [KEY=VALUE...]
    run.py dry [KEY=VALUE...]  stress over strain of the dry sample, loaded and unloaded
    run.py parts [KEY=VALUE...]  what the time of a coupled run goes into
    run.py study               the tables of doc/oedometer.md: sizes, seeds, thresholds, times
"""
import sys
import time

import dry_curve
import oedometer
import parts
import scene
import study


def main(words):
    try:
        if words == ["study"]:
            study.study()
            return 0
        if words[:1] in (["dry"], ["parts"]):
            return 0 if {"dry": dry_curve, "parts": parts}[words[0]].run(words[1:]) else 1
        begin, settings = time.time() - 1, oedometer.parse(words)
        summary = oedometer.run(settings)
        scene.sheet_of_figures("oedometer", settings["OUT"], begin)
    except oedometer.Failure as failure:
        print(f"oedometer: {failure}", file=sys.stderr)
        return 2 if isinstance(failure, oedometer.BadSetting) else 1
    return 0 if summary["passed"] else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
