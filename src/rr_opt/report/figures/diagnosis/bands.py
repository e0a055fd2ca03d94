"""What the simulation leaves of each channel over time, against the noise."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator
from numpy.typing import NDArray

from rr_opt.diagnose.diagnosis import Misfit
from rr_opt.report.figures.diagnosis.look import CHANNELS, FINAL, NOISE, NOMINAL, stretched
from rr_opt.report.figures.style import GREY

Array = NDArray[np.float64]

_ENDS = (2.5, 97.5)
_Z = 1.96
_LINEAR = 4.0
"""Where the axis is stretched it is linear up to so many sigma."""
_MARKS = (0, *(sign * 10**power for power in range(1, 7) for sign in (-1, 1)))


def bands(
    axes: Sequence[Axes],
    nominal: Sequence[Misfit],
    final: Sequence[Misfit],
    names: Sequence[str],
) -> None:
    """One axes a channel, the recordings one after the other: 95 % of the residuals, in sigma."""
    starts = np.concatenate([[0.0], np.cumsum([one.t[-1] - one.t[0] for one in final])])
    for k, (ax, name) in enumerate(zip(axes, names, strict=True)):
        largest = 0.0
        for level, colour in ((nominal, NOMINAL), (final, FINAL)):
            for start, one in zip(starts, level, strict=False):
                at, low, high = _band(one.t, one.residuals[:, k])
                here = at - one.t[0] + start
                ax.fill_between(here, low, high, color=colour, alpha=0.45, lw=0.8, step="mid")
                largest = max([largest, *np.abs([*low, *high])[np.isfinite([*low, *high])]])
        for end in (-_Z, _Z):
            ax.axhline(end, color=NOISE, lw=1, ls=(0, (4, 2)))
        for edge in starts[1:-1]:
            ax.axvline(edge, color=GREY, lw=0.8)
        if stretched(largest):
            ax.set_yscale("symlog", linthresh=_LINEAR, linscale=1)
            ax.yaxis.set_major_locator(FixedLocator(_MARKS))
            ax.yaxis.set_minor_locator(NullLocator())
            ax.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{y:g}"))
        ax.set_ylabel(f"{CHANNELS.get(name, name)}, σ")
        ax.set_xlim(0, starts[-1])
    for (first, last), one in zip(itertools.pairwise(starts), final, strict=True):
        axes[0].text((first + last) / 2, 1.03, one.recording.removesuffix(".csv"), ha="center",
                     va="bottom", fontsize=9, color=GREY,
                     transform=axes[0].get_xaxis_transform())  # fmt: skip
    axes[-1].set_xlabel("time, one recording after the other, s")


def _band(t: Array, residuals: Array) -> tuple[Array, Array, Array]:
    """Times of the bins, and the ends of 95 % of a bin's residuals; NaN without data."""
    pieces = np.array_split(np.arange(len(t)), max(round(t[-1] - t[0]), 1))
    rows = []
    for piece in pieces:
        inside = residuals[piece][np.isfinite(residuals[piece])]
        ends = np.percentile(inside, _ENDS) if len(inside) > 3 else (np.nan, np.nan)
        rows.append((t[piece].mean(), *ends))
    at, low, high = np.array(rows).T
    return at, low, high
