"""The style of all figures: colours that colour-blind readers can distinguish, one type size.

The plotted values are stored inside the SVG, from which a page shows the values under a pointer. A
JSON text in the SVG's `metadata` has for each axes: its place, as fractions of the picture from
the left and from the top; both scales; and the lines, bands and cells drawn on it.
"""

import io
import json
import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any
from weakref import WeakKeyDictionary
from xml.sax.saxutils import escape

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.collections import PolyCollection
from matplotlib.colors import LinearSegmentedColormap, TwoSlopeNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, MaxNLocator

from rr_opt.array import Array

INK, GREY, FAINT, PAPER = "#1f2933", "#66727f", "#d5dbe1", "#ffffff"
FORWARD, BACKWARD = "#0072b2", "#d55e00"
PLATFORM1, PLATFORM2, WHEEL = "#009e73", "#e69f00", "#2b3440"
LIMIT, OPTIMUM = "#9b2d5d", "#f0e442"
NOMINAL, FOUND = BACKWARD, FORWARD
"""The nominal model is orange, the corrected one blue."""

SIGNED = LinearSegmentedColormap.from_list(
    "signed", ["#7a2e00", "#d55e00", "#f5b98a", "#f7f5f2", "#8fc1e0", "#0072b2", "#003a5d"]
)
"""Backward is orange, forward is blue, standing still is nearly white."""

_STYLE: dict[Any, Any] = {
    "font.size": 10.5,
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "axes.titlesize": 11.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.titlepad": 10,
    "axes.labelsize": 10.5,
    "axes.labelcolor": INK,
    "axes.edgecolor": GREY,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": FAINT,
    "grid.linewidth": 0.6,
    "xtick.color": GREY,
    "ytick.color": GREY,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "text.color": INK,
    "lines.linewidth": 1.8,
    "legend.frameon": False,
    "legend.fontsize": 9.5,
    "hatch.linewidth": 0.5,
    "hatch.color": "#b4bdc6",
    "figure.facecolor": PAPER,
    "path.simplify_threshold": 0.3,
    "svg.fonttype": "path",
    "svg.hashsalt": "rr-opt",
}


@contextmanager
def styled() -> Iterator[None]:
    """New figures within this context follow the style."""
    with mpl.rc_context(_STYLE):
        yield


WIDTH = 5.2
"""Inches: of a figure on a page, whose type is then large enough on a phone."""


def figure(width: float = WIDTH, height: float = 4.4) -> Figure:
    """An empty figure, inches, with automatic layout; not registered with pyplot."""
    return Figure(figsize=(width, height), layout="constrained")


def svg(drawn: Figure) -> str:
    """The figure as SVG text, reproducible, with the values it shows."""
    text = io.StringIO()
    FigureCanvasSVG(drawn).print_svg(
        text, metadata=dict.fromkeys(("Date", "Creator", "Format", "Type"))
    )
    # A hundredth of a point is enough, and saves a fifth of the file.
    fine = re.sub(r' d="[^"]+"', lambda d: _concise(d[0]), text.getvalue())
    picture, end, rest = fine.rpartition("</svg>")
    return picture + readout(drawn) + end + rest


def _concise(path: str) -> str:
    return re.sub(r" ?\n?([A-Za-z]) ", r"\1", re.sub(r"(\.\d\d)\d+", r"\1", path))


def panel(height: float, fill: Callable[[Axes], object]) -> str:
    """A figure of one axes, inches, that `fill` draws on, as SVG text."""
    drawn = figure(height=height)
    fill(drawn.add_subplot())
    return svg(drawn)


def colour_of(speed: float) -> str:
    """The colour of a signed speed's direction."""
    return FORWARD if speed >= 0 else BACKWARD


DASHED = (0, (4, 2))
"""The line of a limit."""
STAR: dict[str, Any] = {"ls": "", "marker": "*", "mfc": OPTIMUM, "mec": INK, "clip_on": False}
"""The mark of an optimum."""
GROUND = "#eceff2"
HATCHED: dict[str, Any] = {"facecolor": GROUND, "edgecolor": "#b4bdc6", "hatch": "////", "lw": 0}
"""The look of an infeasible region, or one without an optimum."""


def hatched(ax: Axes) -> None:
    """Hatch the background of a map, visible where nothing is drawn over it."""
    ax.set_facecolor(GROUND)
    ax.fill_between([0, 1], 0, 1, transform=ax.transAxes, zorder=0, **HATCHED)


def signed(top: float) -> TwoSlopeNorm:
    """The norm of signed speeds up to `top` in both directions."""
    return TwoSlopeNorm(0.0, -top, top)


def speed_bar(ax: Axes, mapped: Any) -> Axes:
    """The colour bar of signed speeds, mm/s; its axes."""
    bar = ax.figure.colorbar(mapped, ax=ax, pad=0.02, aspect=26, ticks=MaxNLocator(7))
    bar.set_label("mean speed, mm/s  (+ forward, − backward)")
    bar.outline.set_visible(False)  # type: ignore[operator]
    return bar.ax


def lanes(ax: Axes, names: Sequence[str], pad: float = 0.0) -> None:
    """A lane for each name along y, the first on top; pad: of the names, points."""
    ax.set_yticks(range(len(names)), names)
    ax.set_ylim(len(names) - 0.4, -0.6)
    ax.grid(axis="y", visible=False)
    ax.spines["left"].set_visible(False)
    ax.tick_params(axis="y", length=0, **({"pad": pad} if pad else {}))


def note(ax: Axes, text: str, x: float = 0.985, y: float = 0.96, **style: object) -> None:
    """A remark inside the axes, at a position in axes fractions, on a faint background."""
    options = {"ha": "right", "va": "top", "fontsize": 9.0, "color": GREY, **style}
    box = {"facecolor": PAPER, "edgecolor": "none", "alpha": 0.8, "pad": 1.5}
    ax.text(x, y, text, transform=ax.transAxes, bbox=box, **options)  # type: ignore[arg-type]


def grid(drawn: Figure, count: int, columns: int) -> list[Axes]:
    """`count` axes in rows of `columns`; the last row may be shorter."""
    axes = np.atleast_1d(drawn.subplots(-(-count // columns), columns)).ravel()
    for ax in axes[count:]:
        ax.remove()
    return list(axes[:count])


def legend_below(drawn: Figure, ax: Axes) -> None:
    """The legend of the axes, below all axes."""
    drawn.legend(*ax.get_legend_handles_labels(), loc="outside lower center", ncols=3)


_STEPS = 32
"""Steps of a scale, which is taken as linear in between."""
_MOST, _FINEST = 600, 100
"""Most points of a line, and most cells along an axis."""

_CELLS: WeakKeyDictionary[Axes, dict[str, Any]] = WeakKeyDictionary()


def cells(ax: Axes, x: Array, y: Array, values: Array, label: str) -> None:
    """Show the values (len(y), len(x)) of a map under a pointer; label: `speed, mm/s`."""
    across, up = (max(1, -(-len(one) // _FINEST)) for one in (x, y))
    rows = [_numbers(row) for row in values[::up, ::across]]
    _CELLS[ax] = {"label": label, "x": _numbers(x[::across]), "y": _numbers(y[::up]), "z": rows}


def readout(drawn: Figure) -> str:
    """The metadata of a figure after layout; empty if it has no values."""
    shown = [found for ax in drawn.axes if (found := _of_axes(ax))]
    if not shown:
        return ""
    text = json.dumps(shown, separators=(",", ":"), ensure_ascii=False)
    return f'<metadata id="readout">{escape(text)}</metadata>'


def _of_axes(ax: Axes) -> dict[str, Any] | None:
    lines = [found for line in ax.get_lines() if (found := _of_line(ax, line))]
    bands = [
        {"label": name, "points": [_numbers(point) for point in np.asarray(path.vertices)[:_MOST]]}
        for one in ax.collections
        if isinstance(one, PolyCollection) and (name := _name(one.get_label()))
        for path in one.get_paths()
    ]
    if not (lines or bands or ax in _CELLS):
        return None
    place = ax.get_position()
    return {
        "box": _numbers([place.x0, 1 - place.y1, place.x1, 1 - place.y0]),
        "x": _scale(ax.xaxis, ax.get_xlim(), _shared(ax)),
        "y": _scale(ax.yaxis, ax.get_ylim(), ax.get_ylabel()),
        "lines": lines,
        "bands": bands,
        "cells": _CELLS.get(ax),
    }


def _of_line(ax: Axes, line: Line2D) -> dict[str, Any] | None:
    """A line or marks in the axes' own coordinates; None for a rule or an arrow."""
    x, y = np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float)
    if line.get_transform() != ax.transData or (len(x) < 3 and line.get_marker() in ("None", "")):
        return None
    every = max(1, -(-len(x) // _MOST))
    known = np.isfinite(x) & np.isfinite(y)
    x, y = x[known][::every], y[known][::every]
    if not len(x):
        return None
    return {"label": _name(line.get_label()), "x": _numbers(x), "y": _numbers(y)}


def _shared(ax: Axes) -> str:
    """The x label, which stacked axes leave to the lowest."""
    siblings = ax.get_shared_x_axes().get_siblings(ax)
    return ax.get_xlabel() or next((one.get_xlabel() for one in siblings if one.get_xlabel()), "")


def _scale(axis: Axis, ends: tuple[float, float], label: str) -> dict[str, Any]:
    """Label, and the values at equal steps along the axis; tick labels if these are names."""
    transform = axis.get_transform()
    first, last = transform.transform(np.asarray(ends))
    at = transform.inverted().transform(np.linspace(first, last, _STEPS + 1))
    straight = np.allclose(at, np.linspace(*ends, _STEPS + 1))
    found: dict[str, Any] = {"label": label, "at": _numbers(ends if straight else at)}
    if isinstance(axis.get_major_locator(), FixedLocator) and not label:
        words = [tick.get_text() for tick in axis.get_ticklabels()]
        found["words"] = [_numbers(axis.get_ticklocs()), words]
    return found


def _name(label: object) -> str:
    """The label without the underscore that hides it from legends; empty if matplotlib set it."""
    text = str(label)
    return "" if text.startswith("_child") else text.lstrip("_")


def _numbers(values: Sequence[float] | Array) -> list[float | None]:
    """To five digits; None for what is not finite."""
    return [float(f"{v:.5g}") if np.isfinite(v) else None for v in np.asarray(values).tolist()]
