"""The derived equation of motion is the paper's closed form with corrected signs.

The signs that equation (3) is printed with do not hold, nor do they for a robot whose v is
counted the other way round: one sign inside B2 is wrong by itself.
"""

from math import cos, sin

import numpy as np
import pytest
from hypothesis import find, given

from rr_opt.model.robot import Robot
from tests.mechanics.cases import FIRST_FOUND, REPEATABLE, State, cases, motion

CORRECT = (-1, -1, +1, +1)
"""Signs of B1, B2, of epsilon in B2, and of D as it enters (3), before the printed terms."""
PRINTED = (+1, +1, -1, -1)


def terms(robot: Robot, state: State, signs: tuple[int, ...]) -> np.ndarray:
    """The terms of equation (3), whose sum is vdot; symbols as in the paper."""
    one, two = robot.platform1, robot.platform2
    m1, I1, c1, a1, b1, k1 = one.m, one.I, one.c, one.a, one.b, one.kappa / robot.h**2
    m2, I2, c2, a2, b2, k2 = two.m, two.I, two.c, two.a, two.b, two.kappa / robot.h**2
    v, phi, dphi, ddphi = state
    M = m1 + m2
    delta = c1 * a2 * m2 + c2 * a1 * m1
    epsilon = m1 * a1 + c1 * m2
    J1 = I1 + I2 + m1 * a1**2 + m2 * (a2**2 + c1**2 - c2**2)
    J2 = I2 - m2 * (c2**2 - a2**2)
    S1, S2 = c1 * cos(phi) + c2, c1 + c2 * cos(phi)
    Dn = J1 * sin(phi) ** 2 + M * S1**2
    B1_sign, B2_sign, epsilon_sign, D_sign = signs

    A = -dphi * sin(phi) * (J1 * S2 + delta * S1) / (S1 * Dn)
    C = 2 * ((b1**2 * k1 + b2**2 * k2) * sin(phi) ** 2 + k1 * S1**2 + k2 * S2**2) / Dn
    B1 = ddphi * sin(phi) * (J1 * c2 - J2 * S1) / Dn
    arms = c1 * delta * cos(phi) - epsilon_sign * epsilon * c2 * S1
    B2 = dphi**2 * (J1 * c1 * c2 * sin(phi) ** 2 - S1 * arms) / (S1 * Dn)
    loss = c1 * k2 * (b2**2 - c2**2) * cos(phi) - c2 * (b1**2 * k1 + c1**2 * k2)
    D = 2 * dphi * sin(phi) * loss / Dn
    return np.array([A * v, -C * v, B1_sign * B1, B2_sign * B2, D_sign * D])


def disagreement(robot: Robot, state: State, signs: tuple[int, ...]) -> float:
    """|closed form - derived| over the size of the closed form's terms, dimensionless."""
    parts = terms(robot, state, signs)
    return abs(parts.sum() - motion(robot, state).vdot) / (np.abs(parts).sum() + 1e-9)


@REPEATABLE
@given(cases())
def test_corrected_form_is_the_derived_one(case):
    assert disagreement(*case, CORRECT) < 1e-9


@pytest.mark.parametrize(
    "signs",
    [PRINTED, (-1, -1, -1, +1), (+1, -1, +1, +1), (-1, +1, +1, +1), (-1, -1, +1, -1)],
    ids=["as printed", "as printed with v reversed", "B1", "B2", "D"],
)
def test_other_signs_are_told_apart(signs):
    find(cases(), lambda case: disagreement(*case, signs) > 1e-2, settings=FIRST_FOUND)
