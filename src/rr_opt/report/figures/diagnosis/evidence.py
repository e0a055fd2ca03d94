"""The residual of a stage, or a force without a name, against what it depends on."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from rr_opt.diagnose.diagnosis import Curve, Residue
from rr_opt.report.figures.diagnosis.look import NOISE, NOMINAL
from rr_opt.report.figures.style import GREY

_Z = 1.96
_NAMES = {
    "phase": "phase of the cycle",
    "rate": "commanded rate",
    "along": "place along x",
    "across": "place along y",
    "time": "time since the start",
}


def curve(ax: Axes, one: Curve | Residue, label: str) -> Axes:
    """The mean in bins with its 95 % band; at zero there is no fault."""
    low, high = one.mean - _Z * one.error, one.mean + _Z * one.error
    ax.axhline(0, color=NOISE, lw=1)
    ax.fill_between(one.at, low, high, color=NOMINAL, alpha=0.22, lw=0)
    ax.plot(one.at, one.mean, "o-", color=NOMINAL, ms=3.5, lw=1.4)
    name = _NAMES.get(one.variable, one.variable.replace("_", " "))
    ax.set_xlabel(f"{name}, {one.unit}" if one.unit else name)
    ax.set_ylabel(label)
    seen = np.concatenate([low, high])
    if not np.isfinite(seen).any():
        ax.text(0.5, 0.5, "no data", transform=ax.transAxes, ha="center", color=GREY)
    return ax
