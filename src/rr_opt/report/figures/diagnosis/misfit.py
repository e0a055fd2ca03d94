"""Misfit of every recording: as believed, with parameters re-estimated, as found."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter

from rr_opt.diagnose.diagnosis import Misfit
from rr_opt.report.figures.diagnosis.look import FINAL, NOISE, NOMINAL, stretched
from rr_opt.report.figures.style import FAINT, GREY
from rr_opt.report.quantities import number


def misfit(
    ax: Axes, nominal: Sequence[Misfit], refitted: Sequence[Misfit], final: Sequence[Misfit]
) -> Axes:
    """A row a recording, RMS in sigma over all channels; 1 is the noise."""
    rows = range(len(final))
    ax.hlines(rows, [one.rms for one in final], [one.rms for one in nominal], color=FAINT, lw=4)
    ax.plot([one.rms for one in nominal], rows, "o", ms=7, mfc="white", mec=NOMINAL, mew=1.8,
            label="as believed")  # fmt: skip
    ax.plot([one.rms for one in refitted], rows, "|", ms=11, mew=2, color=GREY,
            label="parameters re-estimated")  # fmt: skip
    ax.plot([one.rms for one in final], rows, "o", ms=7, color=FINAL, label="as found")
    ax.axvline(1.0, color=NOISE, lw=1, ls=(0, (4, 2)))
    names = [
        f"{one.recording.removesuffix('.csv')}{', held out' if one.held_out else ''}"
        for one in final
    ]
    ax.set_yticks(rows, names)
    for label, one in zip(ax.get_yticklabels(), final, strict=True):
        label.set_fontweight("bold" if one.held_out else "normal")
    ax.set_ylim(len(final) - 0.4, -0.6)
    ax.grid(visible=False, axis="y")
    largest = max(one.rms for one in (*nominal, *final))
    ax.set_xlim(0, 1.08 * max(largest, 1.5))
    if stretched(largest):
        ax.set_xscale("log")
        ax.set_xlim(0.8, 1.3 * largest)
        ax.xaxis.set_major_formatter(FuncFormatter(lambda x, _: number(x, 2)))
        ax.xaxis.set_minor_formatter(FuncFormatter(lambda _x, _y: ""))
    ax.set_xlabel("misfit, σ; 1 is the noise")
    return ax
