"""A recorded pendulum, two simulations of it, and fitted values against published ones."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from rr_opt.diagnose.diagnosis import Misfit
from rr_opt.diagnose.model import Array, Data
from rr_opt.report.figures.style import BACKWARD, FORWARD, GREY, INK, figure, styled, svg
from rr_opt.report.pendulum.told import WORDS, Told


def drawn(
    runs: Sequence[Data],
    begins: Array,
    told: Told,
) -> str:
    """SVG text: angle and misfit over time (parts begin at `begins`, s), and the values."""
    published, fitted = told.published, told.cuts[0].found.final
    with styled():
        page = figure(8.2, 8.6)
        angle, misfit, values = page.subplots(3, 1, height_ratios=(3, 2, 2.4))
        _angles(angle, runs, begins, published, fitted)
        for parts, colour in ((published, BACKWARD), (fitted, FORWARD)):
            for run, begin, part in zip(runs, begins, parts, strict=True):
                off = (part.predicted - run.values)[:, 0]
                misfit.plot(run.t + begin, 1e3 * off, color=colour, linewidth=1)
        misfit.set(xlabel="time, s", ylabel="simulated less\nrecorded, mrad")
        _values(values, told)
        return svg(page)


def _angles(
    ax: Axes,
    runs: Sequence[Data],
    begins: Array,
    published: Sequence[Misfit],
    fitted: Sequence[Misfit],
) -> None:
    for k, (run, begin) in enumerate(zip(runs, begins, strict=True)):
        if run.held_out:
            ax.axvspan(begin, begin + run.t[-1], color=GREY, alpha=0.12, label="held out")
        curves = (
            (run.values, INK, 4.0, "recorded"),
            (published[k].predicted, BACKWARD, 1.4, "published values, simulated"),
            (fitted[k].predicted, FORWARD, 1.4, "fitted by simulation error"),
        )
        for values, colour, width, label in curves:
            faint = 0.35 if width > 2 else 1.0
            name = label if k == 0 else None
            ax.plot(run.t + begin, values[:, 0], colour, lw=width, alpha=faint, label=name)
    ax.set(ylabel="angle, rad", title="Each part starts anew where it fits best")
    ax.legend(loc="upper left")


def _values(ax: Axes, told: Told) -> None:
    """Each value as a multiple of the published one."""
    for row, (name, published) in enumerate(told.values.items()):
        one = told.cuts[0].terms[name]
        at, low, high = (value / published for value in (one.value, one.low, one.high))
        ax.plot([low, high], [row, row], color=FORWARD, lw=4, alpha=0.4)
        ax.plot(at, row, "o", color=FORWARD)
    ax.axvline(1, color=BACKWARD)
    labels = [f"{WORDS[name]}: {published:.3g}" for name, published in told.values.items()]
    ax.set_yticks(np.arange(len(labels)), labels)
    ax.set_ylim(len(labels) - 0.5, -0.5)
    ax.set(xlabel="fitted, with 95 % interval, as a multiple of the published value")
