"""The side forces of the axles are those of Newton's and Euler's laws of the two platforms.

The second way shares no equation: it takes the places of a steady cycle alone, differentiates them
by spectral differences, and asks which forces across the axles move the two masses so.
"""

import numpy as np
import pytest

from rr_opt.model.gait import SineGait
from rr_opt.motion.steady_cycle import grip_needed, grips, reference_cycle
from tests.robots import BENCHMARK

G = 9.80665


def slope(t, x):
    """d/dt of what repeats but for a drift, sampled over a period, both ends included."""
    period, drift = t[-1], (x[-1] - x[0]) / t[-1]
    parts = np.fft.rfft((x - drift * t)[:-1])
    omega = 2j * np.pi * np.arange(len(parts)) / period
    made = np.fft.irfft(omega * parts, len(x) - 1) + drift
    return np.append(made, made[0])


@pytest.mark.parametrize("offset", [0.0, 0.3])
def test_newton_and_euler(offset):
    """The heading keeps turning where the offset is not 0, so bodies are seen from a frame that
    turns with it: the accelerations are taken of places turned back, with what that adds."""
    robot, gait = BENCHMARK, SineGait(0.6, 0.9, offset)
    steady = reference_cycle(robot, gait, samples=512)
    one, two, t = robot.platform1, robot.platform2, steady.t
    omega = (steady.psi[-1] - steady.psi[0]) / gait.period
    psi2 = steady.psi + steady.phi
    # Velocities are periodic in the turning frame.
    turn = np.exp(-1j * omega * t)
    velocity = np.exp(1j * steady.psi) * (steady.v + 1j * side_of(robot, gait, steady)) * turn

    def acceleration(reach, heading):
        rate = slope(t, heading)
        own = velocity + 1j * rate * reach * np.exp(1j * heading) * turn
        return (slope_complex(t, own) + 1j * omega * own) / turn

    A1 = acceleration(one.joint_to_centre, steady.psi)
    A2 = acceleration(-two.joint_to_centre, psi2)
    dpsi, dpsi2 = slope(t, steady.psi), slope(t, psi2)
    e1, e2 = np.exp(1j * steady.psi), np.exp(1j * psi2)
    # Rolling friction of both wheels of an axle, and the moment that their difference makes.
    V1 = velocity / turn + 1j * dpsi * one.c * e1
    V2 = velocity / turn - 1j * dpsi2 * two.c * e2
    drag1 = -2 * robot.k1 * (V1 * np.conj(e1)).real
    drag2 = -2 * robot.k2 * (V2 * np.conj(e2)).real
    assert np.abs((V1 * np.conj(1j * e1)).real).max() < 1e-6  # no side slip
    assert np.abs((V2 * np.conj(1j * e2)).real).max() < 1e-6
    forces = one.m * A1 + two.m * A2 - drag1 * e1 - drag2 * e2
    moment = one.m * cross(one.joint_to_centre * e1, A1) + one.I * slope(t, dpsi)
    moment += two.m * cross(-two.joint_to_centre * e2, A2) + two.I * slope(t, dpsi2)
    moment += 2 * (robot.k1 * one.b**2 * dpsi + robot.k2 * two.b**2 * dpsi2)
    # F1 i e1 + F2 i e2 = forces, c1 F1 - c2 F2 = moment about P: three equations for two.
    rows = np.array([
        [(1j * e1).real, (1j * e2).real],
        [(1j * e1).imag, (1j * e2).imag],
        [np.full(len(t), one.c), np.full(len(t), -two.c)],
    ]).transpose(2, 0, 1)  # fmt: skip
    given = np.stack([forces.real, forces.imag, moment], axis=1)[:, :, None]
    sides = (np.linalg.pinv(rows) @ given)[:, :, 0]
    left = np.abs(rows @ sides[:, :, None] - given)
    assert left.max() < 1e-4 * np.abs(given).max()
    length = one.c + two.c
    N1 = G * (one.m * (length - one.a) + two.m * two.a) / length
    N2 = G * (one.m + two.m) - N1
    found = np.array(grips(robot, gait, t, steady.v))
    assert found == pytest.approx(sides.T / [[N1], [N2]], abs=2e-5 * np.abs(found).max())
    assert grip_needed(steady, robot) == pytest.approx(np.abs(found).max(axis=1), rel=1e-3)


def side_of(robot, gait, steady):
    """Velocity of P to the left of platform 1, by its place."""
    velocity = slope_of_path(steady)
    return (velocity * np.conj(1j * np.exp(1j * steady.psi))).real


def slope_of_path(steady):
    """P's velocity: in a frame about the centre of the circle its path is periodic."""
    t, P = steady.t, steady.x + 1j * steady.y
    omega = (steady.psi[-1] - steady.psi[0]) / t[-1]
    turned = np.exp(1j * omega * t[-1])
    if abs(omega) < 1e-9:
        return slope(t, P.real) + 1j * slope(t, P.imag)
    centre = (P[-1] - turned * P[0]) / (1 - turned)
    own = (P - centre) * np.exp(-1j * omega * t)
    return (slope_complex(t, own) + 1j * omega * own) * np.exp(1j * omega * t)


def slope_complex(t, x):
    return slope(t, x.real) + 1j * slope(t, x.imag)


def cross(r, a):
    return (np.conj(r) * a).imag
