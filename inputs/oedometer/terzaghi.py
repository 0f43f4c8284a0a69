# SPDX-License-Identifier: GPL-3.0-or-later
"""Terzaghi's consolidation of a layer drained on both faces; T_v = C_v t/L^2, L = H/2."""
import numpy as np

TERMS = np.pi * (2 * np.arange(400) + 1) / 2


def pressure(height, T_v):
    """p/load at the relative heights z/H (array) and the times T_v (array): one row a time."""
    T = np.maximum(np.atleast_1d(T_v), 1e-6)[:, None, None]
    z = 2.0 * np.atleast_1d(height)[None, :, None]
    return np.sum(2 / TERMS * np.sin(TERMS * z) * np.exp(-TERMS**2 * T), axis=2)


def settlement(T_v):
    """U, settlement divided by its final value."""
    T = np.maximum(np.atleast_1d(T_v), 0.0)[:, None]
    return 1 - np.sum(2 / TERMS**2 * np.exp(-TERMS**2 * T), axis=1)
