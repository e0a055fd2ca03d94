"""Held set points move the servo straight from one to the next, and cost what that costs."""

import math

import numpy as np
import pytest

from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Limits
from rr_opt.motion.dynamics import dynamics_of
from rr_opt.motion.setpoints import (
    BLEND,
    Cost,
    cost,
    excess,
    interpolated,
    set_points,
    within_limits,
)
from rr_opt.motion.steady_cycle import cycle_of, steady_cycle
from rr_opt.outcome import InputError
from tests.motion.gaits import EVERY
from tests.robots import BENCHMARK, with_friction

SHAPES = pytest.mark.parametrize("gait", EVERY.values(), ids=EVERY)


@SHAPES
def test_between_the_blends_the_angle_is_on_the_line(gait):
    points = set_points(gait, 40.0)
    path, late = interpolated(points.angles, 40.0), 1 / (2 * BLEND * 40.0)
    n = len(points.angles)
    t = (np.arange(n)[:, None] + np.array([0.1, 0.5, 0.9])).ravel() / 40.0
    line = np.interp(40.0 * t, np.arange(n + 1), np.append(points.angles, points.angles[0]))
    assert path.angle(t + late) == pytest.approx(line, abs=1e-12)
    assert path.angle(path.period) == pytest.approx(path.angle0, abs=1e-12)
    corners = np.abs(path.angle(np.arange(n) / 40.0 + late) - points.angles)
    assert corners.max() <= np.abs(np.diff(points.angles)).max() / BLEND


def straight_speed(robot, angles, rate, each=24):
    """Steady speed with jumps of the servo's rate: v jumps as the equation of motion says, by the
    factor that it gives to the servo's acceleration; between the jumps by Heun's method."""
    model, p, n = dynamics_of(robot), dynamics_of(robot).values(robot), len(angles)
    rates = (np.roll(angles, -1) - angles) * rate
    h = 1 / (rate * each)

    def slope(v, phi, dphi, psi):
        vdot, w, side, _ = (float(out) for out in model.motion(v, phi, dphi, 0.0, p))
        cos, sin = math.cos(psi), math.sin(psi)
        return np.array([vdot, w, v * cos - side * sin, v * sin + side * cos])

    def period(v0):
        state, path = np.array([v0, 0.0, 0.0, 0.0]), []
        for k in range(n):
            v, phi, dphi = state[0], angles[k], rates[k]
            gain = [float(model.motion(v, phi, dphi, u, p)[0]) for u in (0.0, 1.0)]
            state = state + np.array([(gain[1] - gain[0]) * (dphi - rates[k - 1]), 0, 0, 0])
            for _ in range(each):
                path.append(state)
                one = slope(state[0], phi, dphi, state[1])
                phi += h * dphi
                there = state + h * one
                state = state + h / 2 * (one + slope(there[0], phi, dphi, there[1]))
        return np.array([*path, state]).T

    # The map of v(0) to v(T) is affine: two periods say where it stands still.
    ends = [period(v0)[0, -1] for v0 in (0.0, 0.1)]
    path = period(ends[0] / (1 - (ends[1] - ends[0]) / 0.1))
    return cycle_of(n / rate, path[2], path[3], path[1]).speed


def test_a_short_blend_tends_to_straight_lines():
    points = set_points(SineGait(0.7, 1.4, 0.2), 12.0)
    truth = straight_speed(BENCHMARK, points.angles, 12.0)
    speeds = [
        steady_cycle(BENCHMARK, interpolated(points.angles, 12.0, blend), steps=2048).speed
        for blend in (BLEND, 2 * BLEND, 4 * BLEND)
    ]
    errors = np.abs(np.array(speeds) - truth)
    assert errors[0] < 0.01 * abs(truth)
    assert errors[:-1] / errors[1:] == pytest.approx(2, abs=0.2)


@SHAPES
def test_the_steps_lead_from_the_gait_to_what_is_left(gait):
    points = set_points(gait, 33.0)
    lost = cost(BENCHMARK, points, rounded=True)
    assert lost.nominal == steady_cycle(BENCHMARK, gait).speed
    total = math.copysign(1, lost.nominal) * (lost.final - lost.nominal)
    assert sum(lost.steps.values()) == pytest.approx(total, abs=1e-15)
    assert lost.final == steady_cycle(BENCHMARK, interpolated(points.rounded, 33.0)).speed
    assert set(cost(BENCHMARK, points, rounded=False).steps) == {"period", "holding"}


@pytest.mark.parametrize("sign", [1, -1], ids=["forward", "backward"])
def test_slower_is_negative_whichever_way_it_goes(sign):
    lost = Cost(sign * 0.1, sign * 0.09, sign * 0.11, sign * 0.05)
    wanted = {"period": -0.01, "holding": 0.02, "rounding": -0.06}
    assert lost.steps == pytest.approx(wanted)


def test_many_set_points_cost_nothing_but_the_period():
    gait = SineGait(0.7, 1.4, 0.2)
    coarse, fine = (cost(BENCHMARK, set_points(gait, rate), rounded=False) for rate in (50, 200))
    assert abs(coarse.steps["holding"]) > 1e-5 * abs(coarse.nominal)
    # What is left of it falls with the square of the time between two.
    ratio = coarse.steps["holding"] / fine.steps["holding"]
    assert ratio == pytest.approx(16, rel=0.05)
    changed = steady_cycle(BENCHMARK, SineGait(0.7, 1.4 + 0.3 / 50, 0.2)).speed
    odd = cost(BENCHMARK, set_points(SineGait(0.7, 1.4 + 0.3 / 50, 0.2), 50), rounded=False)
    assert odd.nominal == changed
    assert odd.resampled == pytest.approx(coarse.nominal, rel=1e-12)


@pytest.mark.parametrize(("period", "count"), [(0.3, 38), (0.296, 37), (1.2, 150), (0.1, 12)])
def test_a_period_holds_a_whole_number(period, count):
    points = set_points(SineGait(0.2, period), 125.0)
    assert len(points.angles) == count
    assert points.played.period == pytest.approx(count / 125)
    kept = set_points(SineGait(0.2, period), 125.0, keep_period=True)
    assert kept.played.period == period
    assert kept.rate == pytest.approx(count / period)
    for one in (points, kept):
        sampled = 0.2 * np.sin(2 * np.pi * np.arange(count) / count)
        assert one.angles == pytest.approx(sampled, abs=1e-14)


@pytest.mark.parametrize(
    ("degrees", "count"), [(0.0, 512), (90.0, 819), (-90.0, 205), (149.6, 1023), (-150.0, 0)]
)
def test_counts_are_those_of_the_servos_manual(degrees, count):
    points = set_points(SineGait(1e-9, 1.0, math.radians(degrees)), 10.0)
    assert set(points.counts) == {count}
    assert abs(points.rounded - points.angles).max() <= math.radians(300 / 1024) / 2


@pytest.mark.parametrize("degrees", [151.0, -151.0, 149.95])
def test_an_angle_without_a_count_is_reported(degrees):
    points = set_points(SineGait(1e-9, 1.0, math.radians(degrees)), 10.0)
    with pytest.raises(InputError, match=r"-?1\d\d.* degrees.*cover -150 to 149.7 degrees"):
        _ = points.counts


@pytest.mark.parametrize("rate", [1.0, 1e9])
def test_a_rate_that_makes_no_sense_is_reported(rate):
    with pytest.raises(InputError, match=r"--rate: .* set points a second"):
        set_points(SineGait(0.2, 1.0), rate)


def test_a_gait_that_stands_still_has_no_set_points():
    with pytest.raises(InputError, match="amplitude 0"):
        set_points(SineGait(0.0, 1.0, 0.3), 50.0)


def test_the_margin_to_the_singular_posture_is_kept():
    """By set points of a gait that keeps half of it, and every other limit."""
    limits, one, two = Limits(math.pi, math.inf, math.inf), BENCHMARK.platform1, BENCHMARK.platform2
    gait = SineGait(math.acos((limits.singularity / 2 - two.c) / one.c), 2.0)
    assert excess(BENCHMARK, limits, gait) == pytest.approx(0.5)
    played = within_limits(BENCHMARK, limits, set_points(gait, 50.0)).played
    assert one.c * math.cos(played.peak_angle) + two.c >= limits.singularity * (1 - 2e-4)
    assert played.amplitude > 0.95 * gait.amplitude


def test_without_friction_there_is_no_speed_to_lose():
    with pytest.raises(InputError, match="no friction"):
        cost(with_friction(0.0), set_points(SineGait(0.2, 1.0), 50.0), rounded=False)
