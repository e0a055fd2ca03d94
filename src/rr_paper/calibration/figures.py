"""Figures of `rr-opt calibrate`."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rr_opt.results.figures import style
from rr_paper.calibration.comparison import Coverage
from rr_paper.calibration.fit import measured
from rr_paper.calibration.intervals import LEVEL
from rr_paper.calibration.models import MODELS, UNKNOWNS, VISCOUS
from rr_paper.calibration.report import Calibration, Interval, shipped_values
from rr_paper.publication import COLUMNS, ROWS, T_POINT, Column

_MARKS = {
    VISCOUS: ("o", style.FORWARD),
    "viscous+dry": ("D", style.PLATFORM1),
    "rate limit": ("v", style.BACKWARD),
    "lag": ("P", style.GREY),
    "printed": ("x", style.LIMIT),
}
_COLOURS: dict[Column, str] = {"mean": style.FORWARD, "other": style.BACKWARD}
_NAMES: dict[Column, str] = {"mean": "first column measured", "other": "v_exp measured"}
_TITLES: dict[Column, str] = {
    "mean": "If the first column was measured",
    "other": "If the column headed v_exp was measured",
}
_WORD_COLOURS = {"pinned down": "#00704f", "narrowed": style.INK}
_EDGE = 2.4
"""Half widths beyond which a mark is drawn as an arrow at the edge."""
_BINS = 24
_TOP = 12.0
"""Deviance up to which a profile is drawn."""


def draw(found: Calibration) -> dict[str, str]:
    """All figures as SVG texts by name."""
    drawn = {
        "unknowns": unknowns_figure(found),
        "predictions": predictions_figure(found),
        "coverage": coverage_figure(found.coverage),
    }
    return {name: style.svg(one) for name, one in drawn.items()}


def unknowns_figure(found: Calibration) -> Figure:
    """A column of panels for each unknown: above, the rest of the box; below, the profiles."""
    intervals = found.intervals()
    names = MODELS[VISCOUS].unknowns
    drawn = style.figure(2.35 * len(names), 5.2)
    axes = drawn.subplots(2, len(names), sharex="col", height_ratios=[1, 1.15])
    for i, name in enumerate(names):
        here = [one for one in intervals if one.unknown.name == name]
        unknown = here[0].unknown
        _posterior_panel(axes[0, i], found, here)
        _profile_panel(axes[1, i], here)
        axes[1, i].set_xlabel(f"{unknown.symbol}, {unknown.shown_unit}")
    for ax in axes[1, 1:]:
        ax.set_yticklabels([])
    axes[0, 0].set_ylabel("posterior, box = 1")
    axes[1, 0].set_ylabel("rise in deviance")
    handles, labels = axes[1, 0].get_legend_handles_labels()
    drawn.legend(handles, labels, loc="outside lower center", ncols=4)
    return drawn


def _posterior_panel(ax: Axes, found: Calibration, here: Sequence[Interval]) -> None:
    """Histograms over the box; the box itself is uniform grey at 1."""
    unknown = here[0].unknown
    edges, top = np.linspace(0, 1, _BINS + 1), 1.4
    at = unknown.shown(unknown.value(edges))
    ax.fill_between(at[[0, -1]], 0, 1, color=style.FAINT, lw=0)
    for one in here:
        height = np.histogram(found.draws(one.column, unknown.name), edges, density=True)[0]
        ax.stairs(height, at, color=_COLOURS[one.column], lw=1.8)
        top = max(top, height.max())
    word = here[0].verdict
    ax.set_title(
        f"{unknown.symbol}: {word}", color=_WORD_COLOURS.get(word, style.LIMIT), fontsize=10.5
    )
    ax.set_ylim(0, 1.08 * top)
    if unknown.log:
        ax.set_xscale("log")


def _profile_panel(ax: Axes, here: Sequence[Interval]) -> None:
    unknown = here[0].unknown
    for one in here:
        for profile, line, name in ((one.profile, "-", "Student"), (one.normal, ":", "normal")):
            ax.plot(
                unknown.shown(unknown.value(profile.grid)), np.minimum(profile.rise, 1.3 * _TOP),
                line, color=_COLOURS[one.column], lw=1.8 if line == "-" else 1.2,
                label=f"{_NAMES[one.column]}, {name}",
            )  # fmt: skip
    ax.axhline(LEVEL, color=style.GREY, lw=0.9, ls=(0, (4, 2)))
    values = shipped_values()
    if unknown.name in values:
        ax.plot(unknown.shown(values[unknown.name]), 0.0, "^", color=style.INK, ms=8, clip_on=False)
    ax.set_ylim(0, _TOP)


def predictions_figure(found: Calibration) -> Figure:
    """A panel for each column; a mark for each model and row, in half widths of the interval."""
    drawn = style.figure(10.2, 6.4)
    axes = drawn.subplots(2, 1, sharex=True)
    for ax, column in zip(axes, COLUMNS, strict=True):
        _prediction_panel(ax, found, column)
    labels = [
        f"ratio {row.ratio:g}\nα = ?" if row.amplitude is None
        else f"T = {row.period:g} s\nα = {row.amplitude:g}"
        for row in ROWS
    ]  # fmt: skip
    axes[-1].set_xticks(range(len(ROWS)), labels)
    handles, names = axes[0].get_legend_handles_labels()
    drawn.legend(handles, names, loc="outside lower center", ncols=6)
    drawn.supylabel("(predicted − measured) / half width", fontsize=10.5)
    return drawn


def _prediction_panel(ax: Axes, found: Calibration, column: Column) -> None:
    data = measured(column)
    ax.axhspan(-1, 1, color=style.FAINT, lw=0)
    ax.axhline(0, color=style.GREY, lw=0.8)
    ax.axvline(2.5, color=style.GREY, lw=0.8, ls=":")
    for i, (name, (mark, colour)) in enumerate(_MARKS.items()):
        off = found.assessments[name, column].student.z(data) / T_POINT
        place = np.arange(len(off)) + 0.12 * (i - (len(_MARKS) - 1) / 2)
        inside = np.abs(off) <= _EDGE
        ax.plot(place[inside], off[inside], mark, label=name, color=colour, ls="", ms=6.5)
        for x, y in zip(place[~inside], off[~inside], strict=True):
            ax.plot(x, np.copysign(_EDGE, y), "^" if y > 0 else "v", color=colour, ms=6.5)
            ax.annotate(f"{y:+.0f}", (x, np.copysign(_EDGE, y)), fontsize=7.5, color=style.INK,
                        ha="center", va="bottom" if y > 0 else "top",
                        xytext=(0, 4 if y > 0 else -4), textcoords="offset points")  # fmt: skip
    ax.set_ylim(-1.2 * _EDGE, 1.2 * _EDGE)
    ax.grid(axis="x", visible=False)
    ax.set_title(f"{_TITLES[column]} (grey band: the 95 % interval)")


def coverage_figure(covered: Coverage) -> Figure:
    """A dot for each unknown and kind of interval; the band is the sampling error of 95 %."""
    drawn = style.figure(6.6, 3.8)
    ax = drawn.subplots()
    names = MODELS[VISCOUS].unknowns
    kinds = (
        ("posterior, Student", covered.posterior, "o", style.FORWARD),
        ("profile, Student", covered.profile_student, "s", style.LIMIT),
        ("profile, normal", covered.profile_normal, "D", style.BACKWARD),
    )
    spread = 196 * np.sqrt(0.95 * 0.05 / covered.sets)
    ax.axhspan(95 - spread, min(95 + spread, 100), color=style.FAINT, lw=0)
    ax.axhline(95, color=style.GREY, lw=0.9)
    for i, (label, share, mark, colour) in enumerate(kinds):
        place = np.arange(len(names)) + 0.18 * (i - 1)
        ax.plot(place, 100 * share, mark, color=colour, ms=8, ls="", label=label, clip_on=False)
    ax.set_xticks(range(len(names)), [UNKNOWNS[name].symbol for name in names])
    ax.set(ylim=(50, 101), ylabel="intervals that contain the truth, %")
    ax.grid(axis="x", visible=False)
    ax.legend(loc="lower left")
    return drawn
