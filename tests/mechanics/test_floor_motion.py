"""Where place and heading do not count, the motion on the floor is the one of the steady cycle.

Its state holds z = v - g dphi instead of v. At a point, and along two periods of a gait, it makes
the v, the path and the torque of the equation of motion in v itself.
"""

from dataclasses import replace
from math import cos, sin

import numpy as np
import pytest
from hypothesis import given, settings
from scipy.integrate import solve_ivp

from rr_opt.motion.dynamics import dynamics_of, steady_effects, values_of
from rr_opt.motion.floor_motion import floor_motion
from tests.mechanics.cases import REPEATABLE, State, cases, motion, numbers
from tests.mechanics.floor import on_floor
from tests.mechanics.test_multiplier_path import ACCURATE, reduced_path, runs

CHOICES = [(), *((name,) for name in sorted(steady_effects())), tuple(sorted(steady_effects()))]


@pytest.mark.parametrize("effects", CHOICES, ids="+".join)
def test_same_rates(effects):
    @settings(REPEATABLE, max_examples=10)
    @given(cases(effects), numbers(-7.0, 7.0))
    def same(case, psi):
        robot, state = case
        # On the floor v counts along the wheels, in the steady cycle along the platform.
        toe = next((use.values["toe1"] for use in robot.physics if "toe1" in use.values), 0.0)
        along = State(state.v * cos(toe), *state[1:])
        there, here = (
            motion(robot, along),
            on_floor(robot, state, np.array([1.0, -2.0, psi]), for_prediction=False),
        )
        pose = [
            along.v * cos(psi) - there.side * sin(psi),
            along.v * sin(psi) + there.side * cos(psi),
            there.w,
        ]
        assert here.pose == pytest.approx(pose, rel=1e-9, abs=1e-11)
        assert here.speeds[0] * cos(toe) == pytest.approx(there.vdot, rel=1e-6, abs=1e-6)
        assert here.torque == pytest.approx(there.torque, rel=1e-9, abs=1e-11)

    same()


@settings(REPEATABLE, max_examples=5)
@given(runs())
def test_same_path(run):
    robot, gait, v0 = run
    model = floor_motion()
    p = values_of(robot, model.parameters)
    times = np.linspace(0.0, 2 * gait.T, 21)

    def v_of(state: np.ndarray, t: float) -> float:
        return float(model.speeds(state, gait(t)[:2], p)[0])

    def slope(t: float, state: np.ndarray) -> np.ndarray:
        return model.rates(state, gait(t)[:2], p).full().ravel()

    start = np.array([0.0, 0.0, 0.0, v0 - v_of(np.zeros(4), 0.0)])
    found = solve_ivp(slope, times[[0, -1]], start, t_eval=times, **ACCURATE).y
    v = [v_of(state, t) for state, t in zip(found.T, times, strict=True)]
    direct = reduced_path(robot, gait, v0, times)
    np.testing.assert_allclose(np.vstack([found[:3], v]), direct, rtol=1e-6, atol=1e-7)


def test_what_has_no_place_in_a_steady_cycle_is_passed_over():
    @settings(REPEATABLE, max_examples=5)
    @given(cases(("floor_tilt", "wheel_inertia", "lateral_slip", "servo_lag")))
    def left_out(case):
        robot, state = case
        (kept,) = (use for use in robot.physics if use.name == "wheel_inertia")
        assert dynamics_of(robot).effects == ("wheel_inertia",)
        assert motion(robot, state) == motion(replace(robot, physics=(kept,)), state)

    left_out()
