#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A wave of growing amplitude on a dense bed.

    run.py [KEY=VALUE...]      called by ./run.sh wave_dense [KEY=VALUE...]
"""
import sys
from pathlib import Path

SCENE = Path(__file__).resolve().parent
sys.path.insert(0, str(SCENE.parent / "common"))
import scene
import wave_rising

if __name__ == "__main__":
    scene.main("wave_dense", lambda words: wave_rising.work(SCENE, "dense", words))
