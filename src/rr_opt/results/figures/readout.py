"""What a figure shows, as numbers inside its SVG, from which a page tells the values at a pointer.

A JSON text in the SVG's `metadata`: for each axes its place, in shares of the picture from the left
and from the top; both scales; and the lines, bands and cells drawn on it.
"""

import json
from collections.abc import Sequence
from typing import Any
from weakref import WeakKeyDictionary
from xml.sax.saxutils import escape

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator

from rr_opt.array import Array

_STEPS = 32
"""Of a scale: between them it is taken for linear, whether it is or not."""
_MOST, _FINEST = 600, 100
"""Points of a line, and cells along an axis."""

_CELLS: WeakKeyDictionary[Axes, dict[str, Any]] = WeakKeyDictionary()


def cells(ax: Axes, x: Array, y: Array, values: Array, label: str) -> None:
    """Have the values (len(y), len(x)) of a map shown at a pointer; label: `speed, mm/s`."""
    across, up = (max(1, -(-len(one) // _FINEST)) for one in (x, y))
    rows = [_numbers(row) for row in values[::up, ::across]]
    _CELLS[ax] = {"label": label, "x": _numbers(x[::across]), "y": _numbers(y[::up]), "z": rows}


def readout(drawn: Figure) -> str:
    """The metadata of a figure that has been laid out; empty if it has nothing to tell."""
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
    """A line or marks in the axes' own coordinates; None of a rule or an arrow."""
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
    """The label of x, which axes above others leave to the lowest."""
    siblings = ax.get_shared_x_axes().get_siblings(ax)
    return ax.get_xlabel() or next((one.get_xlabel() for one in siblings if one.get_xlabel()), "")


def _scale(axis: Axis, ends: tuple[float, float], label: str) -> dict[str, Any]:
    """Label, and the values at equal steps along the axis; its words where ticks have names."""
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
    """The label, which an underscore keeps from legends; empty of one that matplotlib gave."""
    text = str(label)
    return "" if text.startswith("_child") else text.lstrip("_")


def _numbers(values: Sequence[float] | Array) -> list[float | None]:
    """To five digits; None for what is not finite."""
    return [float(f"{v:.5g}") if np.isfinite(v) else None for v in np.asarray(values).tolist()]
