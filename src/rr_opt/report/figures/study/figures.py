"""The figures of a study, as SVG text by name."""

from __future__ import annotations

from rr_opt.report.figures.study.axis import shown
from rr_opt.report.figures.study.grid import grid_of
from rr_opt.report.figures.study.held import areas, lanes
from rr_opt.report.figures.study.map import study_map
from rr_opt.report.figures.study.pareto import pareto
from rr_opt.report.figures.study.speed import speed
from rr_opt.report.figures.style import figure, styled, svg
from rr_opt.report.study.result import Studied

_COSTS = (("peak_torque", "largest servo torque, N m"), ("energy_per_metre", "energy, J/m"))


def draw(result: Studied) -> dict[str, str]:
    """Draw all figures that the study has something to show in; none without an optimum."""
    if result.fastest is None:
        return {}
    with styled():
        drawn = {"speed": _speed(result), "held": _held(result), "pareto": _pareto(result)}
        if grid_of(result) is not None:
            drawn["map"] = _map(result)
    return drawn


def _speed(result: Studied) -> str:
    axes = [at for at, n in enumerate(result.study.shape) if n > 1] or [0]
    ordered = [at for at in axes if shown(result.study.axes[at]).ordered] or axes[:1]
    drawn = figure(6.3, 3.9 * len(ordered))
    for place, along in enumerate(ordered):
        speed(drawn.add_subplot(len(ordered), 1, place + 1), result, along)
    return svg(drawn)


def _map(result: Studied) -> str:
    grid = grid_of(result)
    drawn = figure(6.3, 4.6)
    if grid:
        study_map(drawn.add_subplot(), result, grid)
    return svg(drawn)


def _held(result: Studied) -> str:
    grid = grid_of(result)
    if grid is None:
        lanes_count = len({n for row in result.rows if row.optimum for n in row.optimum.held})
        drawn = figure(6.3, 1.1 + 0.42 * lanes_count)
        lanes(drawn.add_subplot(), result)
    else:
        drawn = figure(6.3, 5.6)
        areas(drawn.add_subplot(), result, grid)
    return svg(drawn)


def _pareto(result: Studied) -> str:
    drawn = figure(6.3, 6.6)
    for place, (name, label) in enumerate(_COSTS, 1):
        pareto(drawn.add_subplot(2, 1, place), result, name, label)
    return svg(drawn)
