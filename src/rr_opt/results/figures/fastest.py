"""The figures of a fastest gait and a turn, as SVG text by name, with the price of each limit."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.formatting import QUANTITIES, number, with_unit
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import LEAST, GaitBounds, Interval, Limits, Problem
from rr_opt.model.robot import Robot
from rr_opt.motion.rollout import repeated
from rr_opt.motion.steady_cycle import SteadyCycle
from rr_opt.results.fastest import FastestGait
from rr_opt.results.figures import style
from rr_opt.results.figures.motion import along_travel, cycle, cycles_to_show, path
from rr_opt.results.limits import BoundRow, LimitRow
from rr_opt.results.robust import Robust
from rr_opt.results.shapes import FastestShapes, family
from rr_opt.results.sweep import Sweep
from rr_opt.verify.replay import Replay
from rr_opt.verify.sweep import SpeedMap
from rr_opt.verify.sweep import speed_map as evaluated_map

if TYPE_CHECKING:
    from rr_opt.results.turn import FastestTurn, TurnChart
    from rr_opt.verify.turn_chart import TurnMap


def draw(result: FastestGait) -> dict[str, str]:
    """Draw all figures; none if there is no optimum to show."""
    replay, gait = result.replay, result.replay and result.replay.steady.gait
    if replay is None or gait is None:
        return {}
    lines = gains(result.limits.values(), result.bounds.values())
    rows = style.figure(style.WIDTH, 6.2)
    cycle(list(rows.subplots(4, 1, sharex=True)), replay.steady, result.problem.limits)
    drawn = {
        "path": _path(result, replay),
        "cycle": style.svg(rows),
        "prices": style.panel(0.9 + 0.42 * len(lines), lambda ax: prices(ax, lines, result.cost)),
    }
    if result.robust and result.problem.robust:
        robust = result.robust
        drawn["robust"] = style.panel(3.4, lambda ax: certainty(ax, robust))
    # The map is for sines only.
    return {"speed-map": _speed_map(result, gait), **drawn} if isinstance(gait, SineGait) else drawn


def certainty(ax: Axes, robust: Robust) -> None:
    """Speed reached by 95 % of the robots, mm/s, over a factor on all spreads, for both gaits."""
    for curve, colour, label in zip(
        robust.curves, (style.FORWARD, style.GREY), ("robust gait", "nominal gait"), strict=True
    ):
        ax.plot(robust.scales, 1e3 * np.abs(curve), color=colour, label=label)
    ax.plot(1.0, 1e3 * abs(robust.speed), "o", color=style.FORWARD, zorder=4)
    ax.set(xlabel="spreads, relative to those in the file", ylabel="95 % reach, mm/s")
    ax.set(xlim=(robust.scales[0], robust.scales[-1]))
    ax.set_ylim(bottom=0)
    style.note(ax, f"nominal gait: {100 * robust.kept:.0f} % keep the torque limit")
    ax.legend(loc="upper right")


def _speed_map(result: FastestGait, gait: SineGait) -> str:
    best, *rest = result.optimum.optima
    others = [
        one.gait
        for one in rest
        if isinstance(one.gait, SineGait)
        and math.isclose(one.gait.offset, gait.offset, abs_tol=1e-3)
        and math.isclose(one.share, best.share, abs_tol=1e-2)
    ]
    problem, robot = result.problem, result.robot
    data = map_data(problem, robot, gait)
    return style.panel(4.2, lambda ax: speed_map(ax, data, problem, robot, gait, others=others))


def _path(result: FastestGait, replay: Replay) -> str:
    robot, steady = result.robot, replay.steady
    motion = repeated(steady, cycles_to_show(robot, steady.cycle))
    straight = abs(steady.cycle.dpsi) < 1e-6
    shown, height = (along_travel(motion), 3.0) if straight else (motion, 5.0)
    return style.panel(height, lambda ax: path(ax, robot, shown, steady.speed, steady.gait.period))


@dataclass(frozen=True)
class Gain:
    """One line of the figure: mm/s gained by relaxing something by 1 %, and what it is."""

    label: str
    gain: float
    remark: str = ""


def gains(limits: Iterable[LimitRow], bounds: Iterable[BoundRow]) -> list[Gain]:
    """The lines, the largest gain first; inactive limits follow with their utilisation."""
    active, idle = [], []
    for row in limits:
        if row.active:
            way = -1 if row.name in LEAST else 1
            active.append(Gain(f"limit: {row.name}", 10 * way * row.shadow_price * row.limit))
        elif row.limit and math.isfinite(row.limit):
            idle.append(Gain(f"limit: {row.name}", 0.0, _use(row)))
    for row in bounds:
        if row.active in ("low", "high") and row.shadow_price is not None:
            low = row.active == "low"
            gain = 10 * row.shadow_price * abs(row.low if low else row.high) * (-1 if low else 1)
            name = QUANTITIES[row.name].words.replace("inertia ratio ", "")
            active.append(Gain(f"{'least' if low else 'largest'} {name}", gain))
    return sorted(active, key=lambda one: -one.gain) + idle


def _use(row: LimitRow) -> str:
    unit, factor = QUANTITIES[row.name].common
    if row.name in LEAST:
        least, value = number(row.limit * factor, 3), number(row.value * factor, 3)
        return f"not active: {value} {unit}, {least} required"
    return f"not active: {100 * row.value / row.limit:.0f} % used"


def prices(ax: Axes, lines: Sequence[Gain], cost: float | None = None) -> None:
    """A lollipop for each line, the first on top; with a cost of transport in per cent of it."""
    what, unit = "speed gained by relaxing it by 1 %, mm/s", "mm/s"
    if cost:
        lines = [replace(one, gain=0.1 * one.gain / cost) for one in lines]
        what, unit = "cost of transport saved by relaxing it by 1 %, %", "%"
    reach = max([one.gain for one in lines] + [1e-9])
    for place, one in enumerate(lines):
        ax.plot([0, one.gain], [place, place], color=style.FORWARD, lw=3, solid_capstyle="butt")
        idle = bool(one.remark)
        colour = style.GREY if idle else style.FORWARD
        ax.plot(one.gain, place, "o", ms=6 if idle else 9, color=colour, clip_on=False, zorder=4)
        text = one.remark or f"{one.gain:+.3g} {unit}"
        at = max(one.gain, 0.0) + 0.035 * reach
        ax.text(at, place, text, va="center", color=style.GREY if idle else style.INK, fontsize=9.5)
    style.lanes(ax, [one.label for one in lines], pad=9)
    ax.set(xlim=(min(0.0, *(one.gain for one in lines)), 1.35 * reach), xlabel=what)


_SAMPLES = 1500
_SHADES = (0.35, 0.55, 0.75, 1.0)


def draw_shapes(compared: FastestShapes) -> dict[str, str]:
    """The figure as SVG text by its name; nothing if no family has an optimum.

    phi (rad) and its rate (rad/s) over the phase, and a bar for each speed (mm/s).
    """
    solved = [(one, one.gait, one.speed) for one in compared.solved]
    lines = [(one, gait, speed) for one, gait, speed in solved if gait and speed is not None]
    if not lines:
        return {}
    drawn = style.figure(style.WIDTH, 6.4)
    axes = drawn.subplot_mosaic([["angle"], ["rate"], ["speed"]])
    angle, rate, bars = (axes[name] for name in ("angle", "rate", "speed"))
    phase, top = np.linspace(0, 1, _SAMPLES), max(1e3 * abs(speed) for *_, speed in lines)
    for place, (one, gait, speed) in enumerate(lines):
        first = place == 0
        colour = style.GREY if first else style.colour_of(speed)
        alpha = 1.0 if first else _SHADES[place - len(lines)]
        line = {"color": colour, "alpha": alpha, "ls": (0, (5, 2)) if first else "-"}
        angle.plot(phase, gait.angle(phase * gait.period), **line)
        rate.plot(phase, gait.rate(phase * gait.period), **line)
        size, gain = 1e3 * abs(speed), compared.gain(one)
        text = f"{size:.0f} mm/s" + (f"  {100 * gain:+.0f} %" if gain else "")
        bars.barh(place, size, height=0.62, color=colour, alpha=alpha)
        bars.text(size + 0.02 * top, place, text, va="center", color=style.INK)
    limit = compared.answers[0].problem.limits.rate
    for value in (limit, -limit) if np.isfinite(limit) else ():
        rate.axhline(value, color=style.LIMIT, lw=1.2, ls=style.DASHED)
    angle.set_ylabel("φ, rad")
    rate.set(ylabel="dφ/dt, rad/s", xlabel="share of the period")
    for ax in (angle, rate):
        ax.set_xlim(0, 1)
    style.lanes(bars, [family(one) for one, *_ in lines])
    bars.set(xlim=(0, 1.5 * top), xlabel="speed of the best gait, mm/s")
    return {"shapes": style.svg(drawn)}


def map_data(problem: Problem, robot: Robot, best: SineGait) -> SpeedMap:
    """Speed and peak torque around the optimum, over the problem's bounds.

    A quantity that the problem fixes is shown from half to one and a half times its value.
    """

    def opened(box: Interval) -> Interval:
        return Interval(0.5 * box.low, 1.5 * box.high) if box.fixed else box

    gait = problem.gait
    bounds = GaitBounds(opened(gait.amplitude), opened(gait.period), gait.offset)
    return evaluated_map(replace(problem, gait=bounds), robot, best.offset)


def uses(data: SpeedMap, problem: Problem, robot: Robot, offset: float) -> dict[str, Array]:
    """Utilisation of each limit by every gait of the map, (A, T): more than 1 exceeds it."""
    one, two, limits = robot.platform1, robot.platform2, problem.limits
    cosine = (limits.singularity - two.c) / one.c
    posture = math.acos(min(max(cosine, -1.0), 1.0)) if cosine > -1 else math.inf
    amplitude, period = np.meshgrid(data.amplitude, data.period, indexing="ij")
    angle = amplitude + abs(offset)
    return {
        "rate": 2 * math.pi * amplitude / (limits.rate * period),
        # Past the singular posture there is no torque, and no gait.
        "torque": np.nan_to_num(data.torque / limits.torque, nan=2.0),
        "singularity": angle / posture,
        "angle": angle / limits.angle,
    }


def allowed(data: SpeedMap, problem: Problem, robot: Robot, offset: float) -> NDArray[np.bool_]:
    """Which gaits of the map respect every limit, (A, T)."""
    return np.max(list(uses(data, problem, robot, offset).values()), axis=0) <= 1


def speed_map(
    ax: Axes,
    data: SpeedMap,
    problem: Problem,
    robot: Robot,
    best: SineGait,
    *,
    others: Sequence[SineGait] = (),
) -> None:
    """Filled contours of the speed where all limits are satisfied; hatched elsewhere.

    best is marked with a star, others with rings.
    """
    inside = allowed(data, problem, robot, best.offset)
    kept = 1e3 * data.speed[inside]
    low, high = (min(kept.min(), 0.0), max(kept.max(), 0.0)) if kept.size else (-1.0, 1.0)
    top = max(-low, high, 1e-9)
    levels = np.linspace(low if low < 0 else -1e-3 * top, high if high > 0 else 1e-3 * top, 31)
    style.hatched(ax)
    # Colours beyond a limit are covered below, so the speed is only clipped there: a contour that
    # ended at the limit would end in steps.
    shown = np.clip(1e3 * data.speed, low, high)
    fill = ax.contourf(data.period, data.amplitude, shown, levels=levels, cmap=style.SIGNED,
                       norm=style.signed(top), zorder=1)  # fmt: skip
    # Each band has an edge in its own colour, to avoid thin white seams between them.
    fill.set(edgecolor="face", linewidth=0.5)
    shares = uses(data, problem, robot, best.offset)
    worst = np.clip(np.max(list(shares.values()), axis=0), 0.0, 2.0)
    ax.contourf(data.period, data.amplitude, worst, levels=[1.0, 2.0], colors=[style.GROUND],
                hatches=["////"], zorder=2)  # fmt: skip
    style.speed_bar(ax, fill)
    style.cells(ax, data.period, data.amplitude, 1e3 * data.speed, "mean speed, mm/s")
    _edges(ax, data, shares, problem.limits)
    for one in others:
        ax.plot(one.period, one.amplitude, "o", ms=9, mfc="none", mec=style.INK, mew=1.4, zorder=6)
    ax.plot(best.period, best.amplitude, ms=19, mew=1.2, zorder=7, label="optimum", **style.STAR)
    ax.set(xlim=(data.period[0], data.period[-1]), ylim=(data.amplitude[0], data.amplitude[-1]))
    ax.set(**_LABELS)
    ax.grid(visible=False)


_LABELS = {"xlabel": "period T, s", "ylabel": "amplitude α, rad"}


def _edges(ax: Axes, data: SpeedMap, shares: dict[str, Array], limits: Limits) -> None:
    """The boundaries of the feasible region, with their names."""
    texts = {
        "rate": f"rate {number(limits.rate * 30 / math.pi, 3)} rpm",
        "torque": f"torque {number(limits.torque, 3)} N m",
        "singularity": f"S1 = {number(1e3 * limits.singularity, 3)} mm: nearly singular",
        "angle": f"|φ| = {number(limits.angle, 3)} rad",
    }
    halo = [withStroke(linewidth=3, foreground=style.PAPER, alpha=0.85)]
    regular = np.maximum(shares["singularity"], shares["angle"]) <= 1
    for name, share in shares.items():
        # The torque is known only among gaits short of the limits on the angle.
        known = np.where(regular, share, np.nan) if name == "torque" else share
        if not np.nanmin(known, initial=2.0) < 1 < np.nanmax(known, initial=0.0):
            continue
        edge = ax.contour(
            data.period, data.amplitude, known, levels=[1.0], colors=[style.LIMIT], zorder=3,
            linewidths=1.4, linestyles=[style.DASHED if name == "torque" else "-"],
        )  # fmt: skip
        pieces = edge.get_paths()[0].to_polygons(closed_only=False)
        line = max(map(np.asarray, pieces), key=len)
        line = line[line[:, 0].argsort()]
        # Near the right end of a long line, beside the middle of a short one; at the left of a flat
        # one, which a rising one may meet at its right.
        if np.ptp(line[:, 1]) < 0.02 * np.ptp(data.amplitude):
            at, side = 0.03, "left"
        elif np.ptp(line[:, 0]) > 0.5 * np.ptp(data.period):
            at, side = 0.85, "right"
        else:
            at, side = 0.5, "left"
        x = float(np.quantile(line[[0, -1], 0], at))
        y = float(np.interp(x, *line.T))
        ax.text(x, y, f" {texts[name]} ", color=style.LIMIT, fontsize=9, zorder=5, va="bottom",
                ha=side, path_effects=halo)  # fmt: skip


_MANY = 2000


def draw_sweep(result: Sweep) -> dict[str, str]:
    """A dot for each feasible gait, the fastest on top; a faint cross for any other. Many dots are
    rasterised inside the SVG, to keep it small.

    Gaits of several offsets and inertia ratios coincide: the fastest is visible.
    """
    found, best = result.found.found, result.best
    amplitude, period = found.decisions[:2]
    speed, kept = 1e3 * found.speed, found.feasible
    order = np.flatnonzero(kept)
    order = order[np.argsort(np.abs(speed[order]))]
    top = float(np.abs(speed[order[-1]])) if len(order) else 1.0
    drawn = style.figure(style.WIDTH, 4.4)
    drawn.set_dpi(160)
    ax = drawn.add_subplot()
    ax.plot(period[~kept], amplitude[~kept], "x", color=style.GREY, ms=2.5, mew=0.5, alpha=0.3)
    dots = ax.scatter(
        period[order], amplitude[order], c=speed[order], cmap=style.SIGNED,
        norm=style.signed(top), s=26, edgecolors=style.GREY, linewidths=0.25, zorder=3,
    )  # fmt: skip
    for part in (*ax.collections, *ax.lines):
        part.set_rasterized(len(speed) > _MANY)
    ends = speed[order].min(initial=0.0), speed[order].max(initial=0.0)
    style.speed_bar(ax, dots).set_ylim(min(ends[0], -1e-9), max(ends[1], 1e-9))
    if best:
        ax.plot(best.gait.period, best.gait.amplitude, ms=19, mew=1.2, zorder=5, **style.STAR)
    ax.set_title(f"{len(speed)} gaits: dots keep every limit, crosses do not", weight="normal")
    ax.set(**_LABELS)
    return {"sweep": style.svg(drawn)}


def draw_turn(turn: FastestTurn) -> dict[str, str]:
    """Draw all figures; none if there is no turn to show."""
    drawn = draw(turn)
    if drawn and turn.arc is not None and math.isfinite(turn.radius or math.inf):
        drawn["path"] = style.panel(4.8, lambda ax: arc(ax, turn))
    return drawn


def arc(ax: Axes, turn: FastestTurn) -> None:
    """The circle, dashed; the arc of the turn as a band with its ends marked; the path of P, m."""
    way, replay, radius = turn.arc, turn.replay, turn.radius
    if way is None or replay is None or radius is None:
        return
    steady = replay.steady
    cycles = max(1, math.ceil(way.periods - 1e-9))
    motion = repeated(steady, cycles, every=math.ceil(cycles * len(steady.t) / _TURN_SAMPLES))
    centre = _centre(steady)
    start = np.angle(complex(motion.x[0], motion.y[0]) - centre)
    round_ = centre + radius * np.exp(1j * np.linspace(0, 2 * math.pi, 361))
    along = centre + radius * np.exp(1j * (start + np.linspace(0, way.heading, 181)))
    ax.plot(round_.real, round_.imag, color=style.GREY, lw=1.1, ls=style.DASHED, label="circle")
    ax.plot(along.real, along.imag, color=style.FAINT, lw=9, solid_capstyle="butt", label="turn")
    for end in (along[0], along[-1]):
        spoke = np.array([centre, end])
        ax.plot(np.real(spoke), np.imag(spoke), color=style.GREY, lw=0.8)
    ax.plot(centre.real, centre.imag, "+", color=style.GREY, ms=8)
    path(ax, turn.robot, motion, steady.speed, steady.gait.period)
    style.note(ax, f"radius {radius:.4g} m, {abs(math.degrees(way.heading)):.4g}°")
    ax.legend(loc="lower right")


def _centre(steady: SteadyCycle) -> complex:
    """The point about which a period rotates the robot."""
    first, last = (complex(steady.x[i], steady.y[i]) for i in (0, -1))
    turned = np.exp(1j * (steady.psi[-1] - steady.psi[0]))
    return complex((last - turned * first) / (1 - turned))


_TURN_SAMPLES = 200_000
"""Samples of a turn that is drawn."""
_WIDEST = 20.0
"""m; wider circles are not drawn."""


def draw_chart(chart: TurnChart) -> dict[str, str]:
    """The chart as SVG text by its name; offsets below 0 are the mirror image and not drawn."""
    seen, tight = chart.seen, chart.tight
    count = len(seen.period)
    columns = min(count, 2)
    drawn = style.figure(style.WIDTH, 1.0 + 2.3 * -(-count // columns))
    axes = drawn.subplots(-(-count // columns), columns, sharex=True, sharey=True, squeeze=False)
    for j, ax in enumerate(axes.flat):
        if j >= count:
            ax.set_visible(False)
            continue
        _panel(ax, seen, j)
        if tight:
            ax.axhline(tight.radius, color=style.LIMIT, lw=1.0)
    style.note(axes[0, 0], "solid: to the left, dashed: to the right")
    if tight:
        style.note(
            axes[0, 0], f"tightest: {with_unit(tight.radius, 'm')}", y=0.1, color=style.LIMIT
        )
    for ax in axes[-1]:
        ax.set_xlabel("offset φ0, rad")
    for ax in axes[:, 0]:
        ax.set_ylabel("radius, m")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    drawn.legend(handles, labels, loc="outside lower center", ncols=4, title="amplitude α")
    return {"turn-chart": style.svg(drawn)}


def _panel(ax: Axes, seen: TurnMap, j: int) -> None:
    """Solid lines turn left, dashed ones right; blank where a limit is exceeded."""
    colours = mpl.colormaps["viridis"](np.linspace(0.0, 0.85, len(seen.amplitude)))
    curvature = seen.curvature[:, j]
    kept = seen.keeps[:, j] & (np.abs(curvature) > 1 / _WIDEST)
    for i, alpha in enumerate(seen.amplitude):
        label = with_unit(float(alpha), "rad", 3)
        ax.plot([], [], color=colours[i], label=label)
        for side, line in ((1, "-"), (-1, "--")):
            there = kept[i] & (side * curvature[i] > 0)
            radius = np.full(len(seen.offset), np.nan)
            radius[there] = 1 / np.abs(curvature[i][there])
            ax.plot(seen.offset, radius, line, color=colours[i], lw=1.5)
    ax.set(yscale="log", title=f"T = {with_unit(float(seen.period[j]), 's', 3)}")
