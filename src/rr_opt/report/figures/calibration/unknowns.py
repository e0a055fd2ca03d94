"""Which unknowns the nine averages pin down: what is left of each box."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rr_opt.paper.calibration.calibrate import Calibration
from rr_opt.paper.calibration.intervals import Interval, intervals
from rr_opt.paper.calibration.measured import Column
from rr_opt.paper.calibration.profile import LEVEL
from rr_opt.paper.calibration.shipped import shipped_values
from rr_opt.report.figures.style import BACKWARD, FAINT, FORWARD, GREY, INK, LIMIT, figure

COLOURS: Mapping[Column, str] = {"mean": FORWARD, "other": BACKWARD}
NAMES: Mapping[Column, str] = {"mean": "first column measured", "other": "v_exp measured"}
_BINS = 24
_TOP = 12.0
"""Deviance up to which a profile is drawn."""


def unknowns(found: Calibration) -> Figure:
    """A column of panels for each unknown: above what is left of the box, below the profiles."""
    told = intervals(found)
    names = [one.unknown.name for one in told if one.column == "mean"]
    drawn = figure(2.35 * len(names), 5.2)
    axes = drawn.subplots(2, len(names), sharex="col", height_ratios=[1, 1.15])
    for i, name in enumerate(names):
        here = [one for one in told if one.unknown.name == name]
        _left_of_box(axes[0, i], found, here, i)
        _profiles(axes[1, i], here)
        axes[1, i].set_xlabel(_axis_label(here[0]))
    for ax in axes[1, 1:]:
        ax.set_yticklabels([])
    axes[0, 0].set_ylabel("posterior, box = 1")
    axes[1, 0].set_ylabel("rise of the deviance")
    handles, labels = axes[1, 0].get_legend_handles_labels()
    drawn.legend(handles, labels, loc="outside lower center", ncols=4)
    return drawn


def _axis_label(one: Interval) -> str:
    return f"{one.unknown.symbol}, {one.unknown.shown_unit}"


def _left_of_box(ax: Axes, found: Calibration, here: Sequence[Interval], place: int) -> None:
    """Histograms over the box; the box itself is the flat grey at 1."""
    unknown = here[0].unknown
    edges, top = np.linspace(0, 1, _BINS + 1), 1.4
    at = unknown.shown(unknown.value(edges))
    ax.fill_between(at[[0, -1]], 0, 1, color=FAINT, lw=0)
    for one in here:
        points = found.posterior[one.column].points[:, place]
        height = np.histogram(points, edges, density=True)[0]
        ax.stairs(height, at, color=COLOURS[one.column], lw=1.8)
        top = max(top, height.max())
    word = here[0].word
    colour = {"pinned down": "#00704f", "narrowed": INK}.get(word, LIMIT)
    ax.set_title(f"{unknown.symbol}: {word}", color=colour, fontsize=10.5)
    ax.set_ylim(0, 1.08 * top)
    if unknown.log:
        ax.set_xscale("log")


def _profiles(ax: Axes, here: Sequence[Interval]) -> None:
    unknown = here[0].unknown
    for one in here:
        for profile, style, law in ((one.profile, "-", "Student"), (one.normal, ":", "normal")):
            ax.plot(
                unknown.shown(unknown.value(profile.grid)),
                np.minimum(profile.rise, 1.3 * _TOP),
                style,
                color=COLOURS[one.column],
                lw=1.8 if style == "-" else 1.2,
                label=f"{NAMES[one.column]}, {law}",
            )
    ax.axhline(LEVEL, color=GREY, lw=0.9, ls=(0, (4, 2)))
    values = shipped_values()
    if unknown.name in values:
        ax.plot(unknown.shown(values[unknown.name]), 0.0, "^", color=INK, ms=8, clip_on=False)
    ax.set_ylim(0, _TOP)
