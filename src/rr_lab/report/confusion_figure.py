"""Diagnosis against truth: right is blue and on the diagonal, wrong is orange."""

from functools import partial

from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from rr_lab.report import Proof
from rr_lab.trial.statistics import Confusion, confusion
from rr_opt.formatting import words_of
from rr_opt.results.figures import style

_CELL = 0.42
"""Inches."""


def draw(proof: Proof) -> dict[str, str]:
    """The figure as SVG text by its name."""
    counted = confusion(proof.opened.cases)
    drawn = style.figure(3.2 + _CELL * len(counted.columns), 2.6 + _CELL * len(counted.rows))
    matrix(drawn.subplots(), counted)
    return {"confusion": style.svg(drawn)}


def matrix(ax: Axes, counted: Confusion) -> None:
    """A square for each count; correct ones are shaded by their share of the row."""
    totals = {
        row: sum(counted.counts.get((row, col), 0) for col in counted.columns)
        for row in counted.rows
    }
    for y, row in enumerate(counted.rows):
        for x, column in enumerate(counted.columns):
            _cell(ax, x, y, counted.counts.get((row, column), 0), totals[row], right=row == column)
    right = sum(counted.counts.get((row, row), 0) for row in counted.rows)
    ax.set_title(f"{right} of {sum(totals.values())} right", pad=14)
    ax.set_xlim(0, max(1, len(counted.columns)))
    ax.set_ylim(max(1, len(counted.rows)), 0)
    ax.set_aspect("equal")
    ax.grid(visible=False)
    ax.tick_params(length=0)
    ax.spines[:].set_visible(False)
    ax.set_xticks([x + 0.5 for x in range(len(counted.columns))], map(words_of, counted.columns))
    ax.tick_params(axis="x", labelrotation=55)
    for label in ax.get_xticklabels():
        label.set(ha="right", rotation_mode="anchor")
    ax.set_yticks([y + 0.5 for y in range(len(counted.rows))], map(words_of, counted.rows))
    ax.set(xlabel="diagnosis", ylabel="hidden")


def _cell(ax: Axes, x: int, y: int, count: int, total: int, *, right: bool) -> None:
    share = count / total if total else 0.0
    colour = style.FORWARD if right else style.BACKWARD
    square = partial(Rectangle, (x + 0.04, y + 0.04), 0.92, 0.92)
    ax.add_patch(square(facecolor=style.PAPER, edgecolor=style.FAINT, lw=0.6))
    if count:
        # A miss stands out, however rare.
        shade = 0.25 + 0.75 * share if right else 1.0
        ax.add_patch(square(facecolor=colour, alpha=shade, lw=0))
        ink = style.PAPER if shade > 0.6 else style.INK
        ax.text(x + 0.5, y + 0.52, str(count), ha="center", va="center", color=ink, weight="bold")
    elif right:
        ax.text(x + 0.5, y + 0.5, "0", ha="center", va="center", color=style.GREY)
