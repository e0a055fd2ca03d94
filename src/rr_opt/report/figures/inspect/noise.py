"""The noise of each channel against what is stated."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes

from rr_opt.recordings.noise import NoiseEstimate
from rr_opt.report.figures.style import BACKWARD, FORWARD, GREY, INK


def noise(ax: Axes, found: Mapping[str, NoiseEstimate], stated: Mapping[str, float]) -> Axes:
    """The estimate over the stated value, with its 95 % interval; 1 where nothing was stated.

    Beside it the noise at half the frequency, which is the same if the noise is white.
    """
    names = [name for name, one in found.items() if one.sigma > 0]
    for row, name in enumerate(names):
        one = found[name]
        said = stated[name] if stated[name] > 0 else one.sigma
        ax.errorbar(one.sigma / said, row, xerr=1.96 * one.error / said, fmt="o", color=FORWARD,
                    capsize=3, label="" if row else "highest frequencies")  # fmt: skip
        ax.plot(one.slower / said, row + 0.22, "D", ms=5, color=BACKWARD,
                label="" if row else "half of them")  # fmt: skip
    ax.axvline(1.0, color=INK, lw=1)
    ax.set_yticks(range(len(names)), names)
    ax.set_ylim(len(names) - 0.4, -0.6)
    ax.grid(visible=False, axis="y")
    low, high = ax.get_xlim()
    if np.isfinite(high) and high > 20:
        ax.set_xscale("log")
    else:
        ax.set_xlim(min(low, 0.0), max(high, 1.5))
    ax.set_xlabel("noise, in units of the stated one")
    if names:
        ax.legend(loc="lower left", facecolor="white", labelcolor=GREY)
    return ax
