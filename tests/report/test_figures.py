"""Every figure draws what its data say, on the axes it is given."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from rr_opt.motion.rollout import repeated
from rr_opt.results.figures import style
from rr_opt.results.figures.fastest import allowed, draw, gains, prices, speed_map
from rr_opt.results.figures.motion import along_travel, cycle, instants, path
from rr_opt.verify.sweep import SpeedMap


@pytest.fixture
def data():
    period, amplitude = np.linspace(0.8, 1.6, 30), np.linspace(0.1, 1.2, 40)
    shape = (40, 30)
    speed = -0.1 * amplitude[:, None] ** 2 / period**2
    return SpeedMap(period, amplitude, speed, np.full(shape, 0.05))


def axes():
    return Figure().add_subplot()


def test_speed_map_marks_the_optimum(answer, data):
    best = answer.optimum.best.gait
    ax = axes()
    speed_map(ax, data, answer.optimum.problem, answer.optimum.robot, best)
    stars = [line for line in ax.lines if line.get_marker() == "*"]
    assert [(float(s.get_xdata()[0]), float(s.get_ydata()[0])) for s in stars] == [
        (best.period, best.amplitude)
    ]


def test_speed_map_allows_what_the_rate_allows(answer, data):
    problem, robot = answer.optimum.problem, answer.optimum.robot
    inside = allowed(data, problem, robot, 0.0)
    rate = 2 * np.pi * data.amplitude[:, None] / data.period
    assert np.array_equal(inside, rate <= problem.limits.rate)


def test_path_ends_with_the_robot_and_keeps_poses_apart(answer):
    motion = along_travel(repeated(answer.replay.steady, 3))
    assert motion.y[-1] == pytest.approx(0.0, abs=1e-12)
    best = answer.optimum.best.gait
    assert instants(motion, 0.2)[-1] == len(motion.x) - 1
    ax = axes()
    path(ax, answer.optimum.robot, motion, answer.replay.speed, best.period)
    assert len(ax.patches) >= 9


def test_a_long_way_has_few_robots_on_it(answer):
    motion = along_travel(repeated(answer.replay.steady, 1000))
    assert 15 <= len(instants(motion, 0.2)) <= 25


def test_cycle_shows_the_limit_that_is_near(answer):
    rows = list(Figure().subplots(4, 1))
    cycle(rows, answer.replay.steady, answer.optimum.problem.limits)
    limit = answer.optimum.problem.limits.rate
    levels = {float(line.get_ydata()[0]) for line in rows[1].lines}
    assert {limit, -limit} <= levels


def test_prices_put_the_dearest_first_and_idle_limits_last(answer):
    lines = gains(answer.limits.values(), answer.bounds.values())
    assert lines[0].gain == max(line.gain for line in lines)
    assert lines[-1].remark.startswith("not active")
    ax = axes()
    prices(ax, lines)
    assert [text.get_text() for text in ax.get_yticklabels()] == [line.label for line in lines]


def test_drawing_twice_gives_the_same_files(answer, monkeypatch):
    monkeypatch.setattr("rr_opt.verify.sweep._SIDE", {True: 16, False: 16})
    with style.styled():
        first, second = draw(answer), draw(answer)
    assert first.keys() == {"speed-map", "path", "cycle", "prices"}
    assert first == second
