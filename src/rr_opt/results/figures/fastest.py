"""The figures of a fastest gait, as SVG text by name: among them what each limit costs."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.axes import Axes

from rr_opt.formatting import QUANTITIES, number
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import LEAST
from rr_opt.motion.rollout import repeated
from rr_opt.results.fastest import FastestGait
from rr_opt.results.figures import style
from rr_opt.results.figures.motion import along_travel, cycle, cycles_to_show, path
from rr_opt.results.figures.speed_map import map_data, speed_map
from rr_opt.results.limits import BoundRow, LimitRow
from rr_opt.results.robust import Robust
from rr_opt.results.shapes import FastestShapes, family
from rr_opt.verify.replay import Replay


def draw(result: FastestGait) -> dict[str, str]:
    """Draw all figures; none if there is no optimum to show."""
    replay, gait = result.replay, result.replay and result.replay.steady.gait
    if replay is None or gait is None:
        return {}
    lines = gains(result.limits.values(), result.bounds.values())
    drawn = {
        "path": _path(result, replay),
        "cycle": _cycle(result, replay),
        "prices": style.panel(0.9 + 0.42 * len(lines), lambda ax: prices(ax, lines, result.cost)),
    }
    if result.robust and result.problem.robust:
        robust = result.robust
        drawn["robust"] = style.panel(3.4, lambda ax: certainty(ax, robust))
    # The map is one of sines.
    return {"speed-map": _speed_map(result, gait), **drawn} if isinstance(gait, SineGait) else drawn


def certainty(ax: Axes, robust: Robust) -> Axes:
    """What 95 % of the robots reach, mm/s, over the size of all spreads, with both gaits."""
    for curve, colour, label in zip(
        robust.curves, (style.FORWARD, style.GREY), ("robust gait", "nominal gait"), strict=True
    ):
        ax.plot(robust.scales, 1e3 * np.abs(curve), color=colour, label=label)
    ax.plot(1.0, 1e3 * abs(robust.speed), "o", color=style.FORWARD, zorder=4)
    ax.set(xlabel="spreads, in those of the file", ylabel="95 % reach, mm/s")
    ax.set(xlim=(robust.scales[0], robust.scales[-1]))
    ax.set_ylim(bottom=0)
    style.note(ax, f"nominal gait: {100 * robust.kept:.0f} % keep the limit on torque")
    ax.legend(loc="upper right")
    return ax


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


def _cycle(result: FastestGait, replay: Replay) -> str:
    with style.styled():
        drawn = style.figure(style.WIDTH, 6.2)
        cycle(list(drawn.subplots(4, 1, sharex=True)), replay.steady, result.problem.limits)
        return style.svg(drawn)


@dataclass(frozen=True)
class Gain:
    """One line of the figure: mm/s gained by relaxing something by 1 %, and what it is."""

    label: str
    gain: float
    remark: str = ""


def gains(limits: Iterable[LimitRow], bounds: Iterable[BoundRow]) -> list[Gain]:
    """The lines, the largest gain first; inactive limits follow with how much of them is used."""
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
        return f"not active: {value} {unit} kept, {least} asked"
    return f"not active: {100 * row.value / row.limit:.0f} % used"


def prices(ax: Axes, lines: Sequence[Gain], cost: float | None = None) -> Axes:
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
    return ax


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
    with style.styled():
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
            size, gain = 1e3 * abs(speed), compared.gain(one) or 0.0
            text = f"{size:.0f} mm/s" + ("" if first else f"  {100 * gain:+.0f} %")
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
