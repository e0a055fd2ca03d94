"""Figures of a machine's diagnosis: what predictions leave over time, and the unknown input."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from rr_opt.results.figures import style
from rr_opt.results.machine_diagnosis import ExplainedMachine

_MOST = 12
"""Parts of recordings, the held-out ones if there are any."""


def draw(one: ExplainedMachine) -> dict[str, str]:
    """SVG text by name."""
    with style.styled():
        made = {"errors": _errors(one), "unknown": _unknown(one)}
        return {name: style.svg(each) for name, each in made.items() if each}


def _errors(one: ExplainedMachine) -> Figure:
    outputs = one.experiment.machine.outputs
    found = one.found
    rows = [k for k, m in enumerate(found.final) if m.held_out] or list(range(len(found.final)))
    made = style.figure(height=0.8 + 1.7 * len(outputs))
    axes = np.atleast_1d(made.subplots(len(outputs), 1, sharex=True))
    for k, (ax, channel) in enumerate(zip(axes, outputs, strict=True)):
        for level, colour, label in (
            (found.refitted, style.NOMINAL, "values fitted, no effect"),
            (found.final, style.FOUND, "as found"),
        ):
            start = 0.0
            for row in rows[:_MOST]:
                m = level[row]
                t = m.t - m.t[0] + start
                off = (m.predicted - m.recorded)[:, k]
                ax.plot(t, off, color=colour, lw=1.2, label=label if start == 0 else None)
                start = float(t[-1])
        ax.axhline(0, color=style.GREY, lw=0.8)
        ax.set(ylabel=f"{channel.name} off, {channel.unit}")
    axes[-1].set_xlabel("time, one recording after the other, s")
    style.legend_below(made, axes[0])
    return made


def _unknown(one: ExplainedMachine) -> Figure | None:
    curves = [c for stage in one.found.stages for c in stage.curves if c.at.size > 1]
    if not curves:
        return None
    made = style.figure(height=2.6)
    axes = style.grid(made, len(curves), min(len(curves), 2))
    ports = list(one.experiment.machine.ports.values())
    for ax, c in zip(axes, curves, strict=True):
        ax.fill_between(c.at, c.mean - 2 * c.error, c.mean + 2 * c.error, color=style.NOMINAL,
                        alpha=0.22, lw=0)  # fmt: skip
        ax.plot(c.at, c.mean, "o-", color=style.NOMINAL, ms=3.5)
        ax.axhline(0, color=style.GREY, lw=0.8)
        ax.set(xlabel=f"{c.variable}, {c.unit}".rstrip(", "), ylabel=f"unknown, {ports[0][1]}")
    return made
