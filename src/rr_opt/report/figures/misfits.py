"""How well the model as believed and the model as found predict the recordings, in sigma."""

from __future__ import annotations

import itertools

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from rr_opt.array import Array
from rr_opt.formatting import number
from rr_opt.model.experiment import CHANNELS
from rr_opt.report.figures import style
from rr_opt.results.diagnosis import ExplainedExperiment

_SYMBOLS = {"psi": "ψ", "phi": "φ"}
_MOST = 4
"""Recordings in the bands."""
_WIDE = 8.0
"""With more sigma than this a linear axis would hide the noise."""
_LINEAR = 4.0
"""Up to this many sigma a stretched axis is linear."""
_MARKS = (0, *(sign * 10**power for power in range(1, 7) for sign in (-1, 1)))
_Z, _ENDS = 1.96, (2.5, 97.5)


def bands(one: ExplainedExperiment) -> tuple[Figure, str]:
    """95 % of the residuals over time, an axes for each channel, one recording after the other."""
    shown = one.proof[:_MOST]
    nominal, final = ([level[k] for k in shown] for level in (one.found.nominal, one.found.final))
    starts = np.concatenate([[0.0], np.cumsum([each.t[-1] - each.t[0] for each in final])])
    made = style.figure(height=0.7 + 1.35 * len(CHANNELS))
    axes = list(made.subplots(len(CHANNELS), 1, sharex=True))
    for k, (ax, name) in enumerate(zip(axes, CHANNELS, strict=True)):
        largest = 0.0
        for level, colour in ((nominal, style.NOMINAL), (final, style.FOUND)):
            for start, each in zip(starts, level, strict=False):
                at, low, high = _band(each.t, each.residuals[:, k])
                here = at - each.t[0] + start
                ax.fill_between(here, low, high, color=colour, alpha=0.45, lw=0.8, step="mid")
                largest = max([largest, *np.abs([*low, *high])[np.isfinite([*low, *high])]])
        for end in (-_Z, _Z):
            ax.axhline(end, color=style.GREY, lw=1, ls=style.DASHED)
        for edge in starts[1:-1]:
            ax.axvline(edge, color=style.GREY, lw=0.8)
        if largest > _WIDE:
            ax.set_yscale("symlog", linthresh=_LINEAR, linscale=1)
            ax.yaxis.set_major_locator(FixedLocator(_MARKS))
            ax.yaxis.set_minor_locator(NullLocator())
            ax.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{y:g}"))
        ax.set(ylabel=f"{_SYMBOLS.get(name, name)}, σ", xlim=(0, starts[-1]))
    for (first, last), each in zip(itertools.pairwise(starts), final, strict=True):
        axes[0].text((first + last) / 2, 1.03, each.recording.removesuffix(".csv"), ha="center",
                     va="bottom", fontsize=9, color=style.GREY,
                     transform=axes[0].get_xaxis_transform())  # fmt: skip
    axes[-1].set_xlabel("time, one recording after the other, s")
    made.align_ylabels()
    for words, colour in (("as believed", style.NOMINAL), ("as found", style.FOUND)):
        axes[0].fill_between([], [], [], color=colour, alpha=0.45, label=words)
    axes[0].plot([], [], color=style.GREY, ls=style.DASHED, lw=1, label="the noise")
    style.legend_below(made, axes[0])
    return made, (
        "Bands contain 95 % of each channel's residuals within a second and are dark where they "
        "overlap. Where blue just fills the space between the dashed lines, only noise is left."
    )


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


def misfits(one: ExplainedExperiment) -> tuple[Figure, str]:
    """A lane for each recording: RMS in sigma over all channels."""
    final = one.found.final
    levels = (one.found.nominal, one.found.refitted, final)
    nominal, refitted, found = ([each.rms for each in level] for level in levels)
    lanes, largest = range(len(final)), max(*nominal, *found)
    made = style.figure(height=1.3 + 0.3 * len(final))
    ax = made.subplots()
    ax.hlines(lanes, found, nominal, color=style.FAINT, lw=4)
    ax.plot(nominal, lanes, "o", ms=7, mfc="white", mec=style.NOMINAL, mew=1.8, label="as believed")
    ax.plot(refitted, lanes, "|", ms=11, mew=2, color=style.GREY, label="parameters re-estimated")
    ax.plot(found, lanes, "o", ms=7, color=style.FOUND, label="as found")
    ax.axvline(1.0, color=style.GREY, lw=1, ls=style.DASHED)
    names = [each.recording.removesuffix(".csv") for each in final]
    held = [", held out" if each.held_out else "" for each in final]
    style.lanes(ax, list(map("".join, zip(names, held, strict=True))))
    for label, apart in zip(ax.get_yticklabels(), held, strict=True):
        label.set_fontweight("bold" if apart else "normal")
    ax.set(xlabel="misfit, in units of the noise σ", xlim=(0, 1.08 * max(largest, 1.5)))
    if largest > _WIDE:
        ax.set(xscale="log", xlim=(0.8, 1.3 * largest))
        ax.xaxis.set_major_formatter(FuncFormatter(lambda x, _: number(x, 2)))
        ax.xaxis.set_minor_formatter(FuncFormatter(lambda _x, _y: ""))
    style.legend_below(made, ax)
    proof = "Held-out recordings took no part in the fit." if one.marked else (
        "All of them were fitted: mark one with `use: holdout` to see it predicted."
    )  # fmt: skip
    return made, f"RMS difference between simulation and recording, in σ of the noise. {proof}"
