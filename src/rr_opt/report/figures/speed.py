"""The figures of a solved problem, as SVG text by name: among them what each limit costs."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes

from rr_opt.answers.quantities import QUANTITIES, number
from rr_opt.answers.speed import BoundRow, LimitRow, SpeedAnswer
from rr_opt.model.gait import SineGait
from rr_opt.motion.rollout import repeated
from rr_opt.report.figures.cycle import cycle
from rr_opt.report.figures.path import along_travel, cycles_to_show, path
from rr_opt.report.figures.speed_map import map_data, speed_map
from rr_opt.report.figures.style import FORWARD, GREY, INK, figure, styled, svg


def draw(answer: SpeedAnswer) -> dict[str, str]:
    """Draw all figures; none if there is no optimum to show."""
    if answer.optimum.best is None or answer.replay is None:
        return {}
    with styled():
        drawn = {"path": _path(answer), "cycle": _cycle(answer), "prices": _prices(answer)}
        # The map is one of sines.
        if answer.optimum.problem.gait.shape == "sine":
            drawn = {"speed-map": _speed_map(answer), **drawn}
        return drawn


def _speed_map(answer: SpeedAnswer) -> str:
    optimum, best = answer.optimum, answer.optimum.best
    if best is None or optimum.robot is None or not isinstance(best.gait, SineGait):
        return ""
    drawn = figure(6.3, 4.6)
    others = [
        one.gait
        for one in optimum.optima[1:]
        if isinstance(one.gait, SineGait)
        and math.isclose(one.gait.offset, best.gait.offset, abs_tol=1e-3)
        and math.isclose(one.share, best.share, abs_tol=1e-2)
    ]
    data = map_data(optimum.problem, optimum.robot, best.gait)
    speed_map(drawn.add_subplot(), data, optimum.problem, optimum.robot, best.gait, others=others)
    return svg(drawn)


def _path(answer: SpeedAnswer) -> str:
    robot, replay = answer.optimum.robot, answer.replay
    if robot is None or replay is None:
        return ""
    made = replay.steady.cycle
    motion = repeated(replay.steady, cycles_to_show(robot, made))
    straight = abs(made.dpsi) < 1e-6
    drawn = figure(6.3, 3.0 if straight else 5.0)
    ax = drawn.add_subplot()
    shown = along_travel(motion) if straight else motion
    path(ax, robot, shown, replay.steady.speed, replay.steady.gait.period)
    return svg(drawn)


def _cycle(answer: SpeedAnswer) -> str:
    if answer.replay is None:
        return ""
    drawn = figure(6.3, 6.4)
    axes = drawn.subplots(4, 1, sharex=True)
    cycle(list(axes), answer.replay.steady, answer.optimum.problem.limits)
    return svg(drawn)


def _prices(answer: SpeedAnswer) -> str:
    if answer.replay is None:
        return ""
    lines = gains(answer.limits.values(), answer.bounds.values())
    drawn = figure(6.3, 0.9 + 0.42 * len(lines))
    prices(drawn.add_subplot(), lines)
    return svg(drawn)


@dataclass(frozen=True)
class Gain:
    """One line of the figure: mm/s gained by relaxing something by 1 %, and what it is."""

    label: str
    gain: float
    remark: str


def gains(limits: Iterable[LimitRow], bounds: Iterable[BoundRow]) -> list[Gain]:
    """The lines, the largest gain first; inactive limits follow with how much of them is used."""
    active: list[Gain] = []
    idle: list[Gain] = []
    for row in limits:
        if not math.isfinite(row.limit):
            continue
        if row.active:
            way = -1 if row.name == "singularity" else 1
            gain = 10 * way * row.shadow_price * row.limit
            active.append(Gain(f"limit: {row.name}", gain, ""))
        else:
            idle.append(Gain(f"limit: {row.name}", 0.0, _use(row)))
    for row in bounds:
        if row.active in ("low", "high") and row.shadow_price is not None:
            edge = row.low if row.active == "low" else row.high
            gain = 10 * row.shadow_price * abs(edge) * (-1 if row.active == "low" else 1)
            word = "least" if row.active == "low" else "largest"
            name = QUANTITIES[row.name].words.replace("inertia ratio ", "")
            active.append(Gain(f"{word} {name}", gain, ""))
    return sorted(active, key=lambda one: -one.gain) + idle


def _use(row: LimitRow) -> str:
    kind = QUANTITIES[row.name]
    unit, factor = kind.common
    if row.name == "singularity":
        least, value = number(row.limit * factor, 3), number(row.value * factor, 3)
        return f"not active: {value} {unit} kept, {least} asked"
    return f"not active: {100 * row.value / row.limit:.0f} % used"


def prices(ax: Axes, lines: Sequence[Gain]) -> Axes:
    """A lollipop a line, the first on top."""
    places = range(len(lines))
    reach = max([one.gain for one in lines] + [1e-9])
    for place, one in zip(places, lines, strict=True):
        ax.plot([0, one.gain], [place, place], color=FORWARD, lw=3, solid_capstyle="butt")
        idle = bool(one.remark)
        colour = GREY if idle else FORWARD
        ax.plot(one.gain, place, "o", ms=6 if idle else 9, color=colour, clip_on=False, zorder=4)
        text = one.remark or f"{one.gain:+.3g} mm/s"
        at = max(one.gain, 0.0) + 0.035 * reach
        ax.text(at, place, text, va="center", color=GREY if idle else INK, fontsize=9.5)
    ax.set_yticks(list(places), [one.label for one in lines])
    ax.set_ylim(len(lines) - 0.4, -0.6)
    ax.set_xlim(min(0.0, *(one.gain for one in lines)), 1.35 * reach)
    ax.grid(axis="y", visible=False)
    ax.spines["left"].set_visible(False)
    ax.tick_params(axis="y", length=0, pad=9)
    ax.set_xlabel("speed gained by relaxing it by 1 %, mm/s")
    return ax
