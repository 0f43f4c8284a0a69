# SPDX-License-Identifier: GPL-3.0-or-later
"""A screen for VTK, which ends the whole process where it finds none."""
import atexit
import ctypes
import ctypes.util
import os
import shutil
import signal
import subprocess

_SENTENCE = ("there is no screen, and VTK as Debian builds it draws on none: install xvfb, or set DISPLAY to a "
             "screen that can be reached")


def _reachable():
    """Whether the screen of DISPLAY answers."""
    name = ctypes.util.find_library("X11")
    if not os.environ.get("DISPLAY") or not name:
        return False
    x11 = ctypes.CDLL(name)
    x11.XOpenDisplay.restype = ctypes.c_void_p
    x11.XCloseDisplay.argtypes = [ctypes.c_void_p]
    screen = x11.XOpenDisplay(None)
    if not screen:
        return False
    x11.XCloseDisplay(screen)
    return True


def _end_with_parent():
    """Also where that is killed."""
    set_signal_of_parents_death = 1
    ctypes.CDLL(None).prctl(set_signal_of_parents_death, signal.SIGTERM)


def _begin_virtual_screen(program):
    """Xvfb picks a free number and says it once it answers; it ends with this process."""
    reading, writing = os.pipe()
    # -noreset: it would begin anew whenever a window has gone, and refuse the next one meanwhile
    server = subprocess.Popen([program, "-displayfd", str(writing), "-screen", "0", "1600x1200x24", "-nolisten", "tcp",
                               "-noreset"], pass_fds=[writing], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                              preexec_fn=_end_with_parent)
    os.close(writing)
    with os.fdopen(reading) as said:
        number = said.readline().strip()
    if not number:
        server.wait()
        raise RuntimeError("Xvfb ended without a screen: try `Xvfb :99` by hand, which says why")
    os.environ["DISPLAY"] = ":" + number

    def end():
        server.terminate()
        server.wait()

    atexit.register(end)


def ensure_screen():
    """The screen of DISPLAY, or a virtual one for this process. Raises RuntimeError where there is neither."""
    if _reachable():
        return
    program = shutil.which("Xvfb")
    if not program:
        raise RuntimeError(_SENTENCE)
    _begin_virtual_screen(program)
