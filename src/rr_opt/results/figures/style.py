"""How every figure looks: colours that colour-blind readers can distinguish, one type size."""

import io
import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import LinearSegmentedColormap, TwoSlopeNorm
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from rr_opt.results.figures.readout import readout

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
    """Within it every new figure follows the style."""
    with mpl.rc_context(_STYLE):
        yield


WIDTH = 5.2
"""Inches: of a figure on a page, whose type is then large enough on a phone."""


def figure(width: float = WIDTH, height: float = 4.4) -> Figure:
    """An empty figure, inches, that lays itself out; not known to pyplot."""
    made = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(made)
    return made


def svg(drawn: Figure) -> str:
    """The figure as SVG text, the same for the same data, with the values it shows."""
    text = io.StringIO()
    drawn.savefig(text, format="svg", metadata=dict.fromkeys(("Date", "Creator", "Format", "Type")))
    # A hundredth of a point is enough, and saves a fifth of the file.
    fine = re.sub(r' d="[^"]+"', lambda d: _concise(d[0]), text.getvalue())
    picture, end, rest = fine.rpartition("</svg>")
    return picture + readout(drawn) + end + rest


def _concise(path: str) -> str:
    return re.sub(r" ?\n?([A-Za-z]) ", r"\1", re.sub(r"(\.\d\d)\d+", r"\1", path))


def panel(height: float, fill: Callable[[Axes], object]) -> str:
    """A figure of one axes, inches, that `fill` draws on, as SVG text."""
    with styled():
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
"""How what is not allowed, or has no optimum, looks."""


def hatched(ax: Axes) -> None:
    """Hatch the ground of a map, to be seen where nothing is drawn over it."""
    ax.set_facecolor(GROUND)
    ax.fill_between([0, 1], 0, 1, transform=ax.transAxes, zorder=0, **HATCHED)


def signed(top: float) -> TwoSlopeNorm:
    """The norm of signed speeds up to `top` either way."""
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
    """A remark inside the axes, at a place in fractions of them, on a faint ground."""
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
    """What the axes label, below all axes."""
    drawn.legend(*ax.get_legend_handles_labels(), loc="outside lower center", ncols=3)
