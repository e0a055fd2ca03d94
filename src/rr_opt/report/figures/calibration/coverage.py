"""How often 95 % intervals hold the truth, on data made by robots that are known."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from rr_opt.paper.calibration.coverage import Coverage
from rr_opt.paper.calibration.models import MODELS
from rr_opt.paper.calibration.unknowns import UNKNOWNS
from rr_opt.report.figures.style import BACKWARD, FAINT, FORWARD, GREY, LIMIT


def coverage(ax: Axes, found: Coverage) -> Axes:
    """A dot for each unknown and kind of interval; the band is what chance does to 95 %."""
    names = MODELS["viscous"].unknowns
    kinds = (
        ("posterior, Student", found.posterior, "o", FORWARD),
        ("profile, Student", found.profile["student"], "s", LIMIT),
        ("profile, normal", found.profile["normal"], "D", BACKWARD),
    )
    spread = 196 * np.sqrt(0.95 * 0.05 / found.sets)
    ax.axhspan(95 - spread, min(95 + spread, 100), color=FAINT, lw=0)
    ax.axhline(95, color=GREY, lw=0.9)
    for i, (label, share, mark, colour) in enumerate(kinds):
        place = np.arange(len(names)) + 0.18 * (i - 1)
        ax.plot(place, 100 * share, mark, color=colour, ms=8, ls="", label=label, clip_on=False)
    ax.set_xticks(range(len(names)), [UNKNOWNS[name].symbol for name in names])
    ax.set_ylim(50, 101)
    ax.set_ylabel("intervals that hold the truth, %")
    ax.grid(axis="x", visible=False)
    ax.legend(loc="lower left")
    return ax
