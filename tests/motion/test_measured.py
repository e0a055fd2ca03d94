"""A driven motion is told its largest torque and last speeds, as a model with multipliers has them,
however far apart its samples lie."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rr_opt.model.gait import SineGait
from rr_opt.motion.rollout import measured, rollout
from rr_opt.motion.steady_cycle import steady_cycle
from tests.mechanics import multipliers
from tests.motion.gaits import EVERY, SINE, free_gait
from tests.robots import BENCHMARK, with_friction

PARTS, EACH = 16, 50
PERIOD = SINE.period

# Turned round in time, what was just after a jump comes just before it.
GAITS = EVERY | {"turned": free_gait(PERIOD, -0.2, EVERY["free"].accelerations[::-1])}
SHAPES = pytest.mark.parametrize("gait", GAITS.values(), ids=GAITS)


def driven(gait, v0, parts):
    """v, psi, x + iy at steps of T/(PARTS EACH), and the largest torque, over so many parts."""
    phi, dphi = float(gait.angle(0.0)), float(gait.rate(0.0))
    q = np.array([0.0, 0.0, 0.0, phi])
    state = np.concatenate([q, multipliers.rates(BENCHMARK, q, v0, dphi)])
    length, peak, path = gait.period / PARTS, 0.0, []
    for k in range(parts):
        t = np.linspace(k, k + 1, EACH + 1) * length

        def ddphi(t, k=k):
            return gait.accelerations[k % PARTS] if gait.pieces == PARTS else gait.acceleration(t)

        def slope(t, s, ddphi=ddphi):
            return np.append(s[4:], multipliers.solve(BENCHMARK, s[:4], s[4:], ddphi(t))[0])

        states = solve_ivp(slope, t[[0, -1]], state, "RK45", t, rtol=1e-8, atol=1e-9).y
        forces = (
            multipliers.solve(BENCHMARK, s[:4], s[4:], ddphi(at))[1]
            for at, s in zip(t, states.T, strict=True)
        )
        peak = max(peak, *(abs(force[2]) for force in forces))
        path.append(states[:, :-1])
        state = states[:, -1]
    x, y, psi, _, dx, dy, *_ = np.column_stack([*path, state])
    return dx * np.cos(psi) + dy * np.sin(psi), psi, x + 1j * y, peak


def along_circle(psi, z):
    """Speed of the mean point of P's path about the centre to which a period moves P, m/s."""
    turn = psi[-1] - psi[0]
    centre = (z[-1] - np.exp(1j * turn) * z[0]) / (1 - np.exp(1j * turn))
    back = np.exp(-1j * turn * np.arange(len(z) - 1) / (len(z) - 1))
    return abs(np.mean(back * (z[:-1] - centre)) * turn) / PERIOD


@SHAPES
@pytest.mark.parametrize("start", ["rest", "steady"])
@pytest.mark.parametrize("parts", [37, 32, 5], ids=["between", "whole", "short"])
def test_as_the_model_with_multipliers(gait, start, parts):
    seconds = parts * gait.period / PARTS
    # Samples this far apart miss the peak and make a bad mean.
    motion = rollout(BENCHMARK, gait, seconds, start, 5 / seconds)
    found = measured(BENCHMARK, gait, motion)
    v, psi, z, peak = driven(gait, float(motion.v[0]), parts)
    last = slice(-PARTS * EACH - 1, None)
    assert found.peak_torque == pytest.approx(peak, rel=1e-4)
    assert found.mean_v == pytest.approx(
        np.trapezoid(v[last]) / (len(v[last]) - 1), rel=1e-4, abs=1e-6
    )
    if parts < PARTS:
        assert found.speed is None
    else:
        assert abs(found.speed or 0.0) == pytest.approx(along_circle(psi[last], z[last]), rel=2e-4)


@SHAPES
def test_the_speed_settles_to_that_of_the_steady_cycle(gait):
    for start in ("rest", "steady"):
        motion = rollout(BENCHMARK, gait, 100.3 * gait.period, start, 2.0)
        found = measured(BENCHMARK, gait, motion)
        # The period ends up to a 2048th of itself from the end, and the cut moves nothing else.
        assert found.speed == pytest.approx(steady_cycle(BENCHMARK, gait).speed, rel=1e-6)


def test_a_robot_without_friction_that_never_settles():
    gait = SineGait(0.5, 1.0)
    motion = rollout(with_friction(0.0), gait, 5.5, "rest", 10.0)
    assert measured(with_friction(0.0), gait, motion).peak_torque > 0


def test_a_gait_that_stands_still():
    still = SineGait(0.0, 1.0, 0.2)
    found = measured(BENCHMARK, still, rollout(BENCHMARK, still, 2.5, "rest", 10.0))
    assert (found.peak_torque, found.mean_v, found.speed) == (0.0, 0.0, 0.0)
