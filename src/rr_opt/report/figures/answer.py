"""The figures of a solved problem, as SVG text by name."""

from __future__ import annotations

import math

from rr_opt.answers.speed import SpeedAnswer
from rr_opt.model.gait import SineGait
from rr_opt.motion.rollout import repeated
from rr_opt.report.figures.cycle import cycle
from rr_opt.report.figures.path import along_travel, cycles_to_show, path
from rr_opt.report.figures.prices import gains, prices
from rr_opt.report.figures.speed_map import map_data, speed_map
from rr_opt.report.figures.style import figure, styled, svg


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
