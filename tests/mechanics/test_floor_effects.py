"""On a floor with every effect the robot accelerates, and takes the torque, that multipliers say.

The other model knows no effect of the catalogue: what each does is written down here once more.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from scipy.special import expit

from rr_opt.model.robot import Robot
from tests.mechanics import multipliers
from tests.mechanics.cases import REPEATABLE, cases, numbers
from tests.mechanics.floor import MECHANICAL, on_floor
from tests.mechanics.multipliers import Beyond, Law, Wheel

G = 9.80665
CHOICES = [*((name,) for name in MECHANICAL), ("floor_tilt", "lateral_slip"), MECHANICAL]


def loads(robot: Robot) -> list[float]:
    """The weight on one wheel of each platform, from the moments about P of the straight robot."""
    one, two = robot.platform1, robot.platform2
    lever = np.array([[1.0, 1.0], [one.c, -two.c]])
    moment = one.m * one.joint_to_centre - two.m * two.joint_to_centre
    return (G / 2 * np.linalg.solve(lever, [one.m + two.m, moment])).tolist()


def rolling(robot: Robot, given: dict) -> Law:
    """The force along a wheel."""

    def law(wheel: Wheel, u: float) -> float:
        n, side, place = wheel
        k = (robot.k1, robot.k2)[n - 1]
        if values := given.get("left_right_drag"):
            k *= 1 + side * values[f"asymmetry{n}"]
        force = -k * u
        if values := given.get("coulomb_friction"):
            # In 5 ms the friction must not turn the speed round.
            mass = robot.platform1.m + robot.platform2.m
            soft = values["onset"] + 0.002 * 2 * (values["force1"] + values["force2"]) / mass
            force -= values[f"force{n}"] * math.tanh(u / soft)
        if values := given.get("floor_patch"):
            away = math.sqrt(math.dist(place, (values["x"], values["y"])) ** 2 + 0.0005**2)
            into = (math.cos(values["normal"]), math.sin(values["normal"]))
            beyond = float(np.dot(place - (values["edge_x"], values["edge_y"]), into))
            strip = min(beyond, values["width"] - beyond)
            depth = values["radius"] - away if values["radius"] > 0 else strip
            force *= 1 + (values["multiplier"] - 1) * float(expit(2 * depth / 0.005))
        if values := given.get("quadratic_drag"):
            force -= values["coefficient_total"] / 4 * u * math.sqrt(u**2 + 1e-8)
        return force

    return law


def gripping(robot: Robot, values: dict) -> Law:
    """The force across a wheel."""
    weight = loads(robot)

    def grip(wheel: Wheel, s: float) -> float:
        most = values["mu"] * weight[wheel.number - 1]
        return -s / math.hypot(values["creep_compliance"], math.hypot(s, 1e-4) / most)

    return grip


def beyond(robot: Robot) -> Beyond:
    """The robot's effects as the model with multipliers takes them."""
    given = {use.name: dict(use.values) for use in robot.physics}
    tilt = given.get("floor_tilt", {"tilt_x": 0.0, "tilt_y": 0.0})
    left = given.get("com_offset", {"d1": 0.0, "d2": 0.0})
    toe = given.get("axle_misalignment", {"toe1": 0.0, "toe2": 0.0})
    # Whether the wheels that slide also turn more slowly is for test_lateral_slip.
    slip = given.get("lateral_slip")
    return Beyond(
        law=rolling(robot, given),
        J=given.get("wheel_inertia", {"J": 0.0})["J"],
        left=(left["d1"], left["d2"]),
        toe=(toe["toe1"], toe["toe2"]),
        pull=(G * tilt["tilt_x"], G * tilt["tilt_y"]),
        grip=gripping(robot, slip) if slip else None,
        bodies=given.get("quadratic_drag", {"coefficient_bodies": 0.0})["coefficient_bodies"],
    )


def rolling_freely(robot: Robot) -> Robot:
    """The robot, of whose sliding wheels the side force alone is limited."""
    uses = [
        replace(use, values={**use.values, "mu_ratio": 0.0}) if use.name == "lateral_slip" else use
        for use in robot.physics
    ]
    return replace(robot, physics=tuple(uses))


@pytest.mark.parametrize("effects", CHOICES, ids="+".join)
def test_as_with_multipliers(effects):
    @settings(REPEATABLE, max_examples=12)
    @given(cases(effects), numbers(-1, 1), numbers(-1, 1), numbers(-7, 7), numbers(-0.1, 0.1))
    def same(case, x, y, psi, s):
        robot, state = rolling_freely(case[0]), case[1]
        other = beyond(robot)
        sides = (s, -0.6 * s) if other.grip else (0.0, 0.0)
        here = on_floor(robot, state, np.array([x, y, psi]), sides)
        q = np.array([x, y, psi, state.phi])
        qd = multipliers.rates(robot, q, state.v, state.dphi, sides, other.toe)
        qdd, (_, _, torque) = multipliers.solve(robot, q, qd, state.ddphi, other)
        speeds = multipliers.speed_rates(robot, q, qd, qdd, other)
        assert here.pose == pytest.approx(qd[:3], rel=1e-9, abs=1e-10)
        assert here.speeds == pytest.approx(speeds[: len(here.speeds)], rel=1e-5, abs=1e-5)
        assert here.torque == pytest.approx(torque, rel=1e-7, abs=1e-8)

    same()
