# SPDX-License-Identifier: GPL-3.0-or-later
"""matplotlib without a screen."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def save_figure(figure, path, dpi=90):
    figure.tight_layout()
    figure.savefig(path, dpi=dpi)
    plt.close(figure)
