"""How every figure looks: colours that colour-blind readers can tell apart, one size of type."""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

INK, GREY, FAINT, PAPER = "#1f2933", "#66727f", "#d5dbe1", "#ffffff"
FORWARD, BACKWARD = "#0072b2", "#d55e00"
PLATFORM1, PLATFORM2, WHEEL = "#009e73", "#e69f00", "#2b3440"
LIMIT, OPTIMUM = "#9b2d5d", "#f0e442"

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
    "svg.fonttype": "path",
    "svg.hashsalt": "rr-opt",
}


@contextmanager
def styled() -> Iterator[None]:
    """Within it every new figure follows the style."""
    with mpl.rc_context(_STYLE):
        yield


def figure(width: float = 6.6, height: float = 4.4) -> Figure:
    """An empty figure, inches, that lays itself out; not known to pyplot."""
    made = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(made)
    return made


def svg(drawn: Figure) -> str:
    """The figure as SVG text, the same for the same data."""
    text = io.StringIO()
    drawn.savefig(text, format="svg", metadata={"Date": None, "Creator": "rr-opt"})
    return text.getvalue()


def colour_of(speed: float) -> str:
    """The colour of a signed speed's direction."""
    return FORWARD if speed >= 0 else BACKWARD


def note(ax: Axes, text: str, x: float = 0.985, y: float = 0.96, **style: object) -> None:
    """A remark inside the axes, at a place in fractions of them, on a faint ground."""
    options = {"ha": "right", "va": "top", "fontsize": 9.0, "color": GREY, **style}
    box = {"facecolor": PAPER, "edgecolor": "none", "alpha": 0.8, "pad": 1.5}
    ax.text(x, y, text, transform=ax.transAxes, bbox=box, **options)  # type: ignore[arg-type]
