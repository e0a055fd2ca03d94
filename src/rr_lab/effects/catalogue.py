"""What each effect does to the rig; `effects.toml` names the functions, without the underscore."""

import math
from typing import Any

import numpy as np

from rr_lab.effects.hidden_effect import Setting, Values
from rr_lab.rig import (
    Circle,
    Drift,
    Edge,
    Falling,
    Motor,
    Patch,
    Rig,
    RollingResistance,
    Rub,
    Tether,
    swing_inertia,
    wheel_loads,
)
from rr_opt.array import Array
from rr_opt.model.robot import Robot


def _coulomb(rig: Rig, values: Values) -> None:
    """A force F at the rim is a torque F h."""
    one, two = (values.get(name, 0.0) * rig.robot.h for name in ("force1", "force2"))
    rig.dry = [dry + more for dry, more in zip(rig.dry, (one, one, two, two), strict=True)]
    rig.onset = values.get("onset", rig.onset)


def _equal(rig: Rig, values: Values) -> None:
    _coulomb(rig, {"force1": values["force"], "force2": values["force"]})


def _equal_forces(_: Robot, values: Values) -> dict[str, float]:
    return {"force1": values["force"], "force2": values["force"]}


def _by_load(rig: Rig, values: Values) -> None:
    rig.laws.append(RollingResistance(values["mu"], rig.robot.h))


def _forces_of_loads(robot: Robot, values: Values) -> dict[str, float]:
    """With the loads of a robot that stands."""
    one, _, two, _ = values["mu"] * wheel_loads(Rig(robot))
    return {"force1": float(one), "force2": float(two)}


def _quadratic(rig: Rig, values: Values) -> None:
    """(c/4) v^2 at the rim is (c/4) h^3 omega^2."""
    each = values["coefficient_total"] / 4 * rig.robot.h**3
    rig.quadratic = [coefficient + each for coefficient in rig.quadratic]


def _left_right(rig: Rig, values: Values) -> None:
    for platform, name in enumerate(("asymmetry1", "asymmetry2")):
        lean = values.get(name, 0.0)
        rig.kappa[2 * platform] *= 1 + lean
        rig.kappa[2 * platform + 1] *= 1 - lean


def _wheel_inertia(rig: Rig, values: Values) -> None:
    rig.J = [J + values["J"] for J in rig.J]


def _slip(rig: Rig, values: Values) -> None:
    """`mu`: the grip that lets go; `creep_compliance`: side speed per side force."""
    rig.mu = values.get("mu", rig.mu)
    rig.creep += values.get("creep_compliance", 0.0)


def _patch(rig: Rig, values: Values) -> None:
    """The drag of each wheel times `multiplier` within a circle, or beyond an edge."""
    within: Circle | Edge
    if "radius" in values:
        within = Circle(values["x"], values["y"], values["radius"])
    else:
        within = Edge(values["edge_x"], values["edge_y"], values["normal"])
    rig.laws.append(Patch(values["multiplier"], within))


def _any_direction(setting: Setting, _: Values) -> Values:
    slope, way = 1.4e-3, setting.rng.uniform(-math.pi, math.pi)
    return {"tilt_x": slope * math.cos(way), "tilt_y": slope * math.sin(way)}


def _round_a_path(setting: Setting, values: Values) -> Values:
    """A circle round a place that a run passes."""
    x, y = setting.passed()
    radius = float(setting.rng.uniform(0.15, 0.55))
    return {"multiplier": 1 + values["multiplier"] / 2, "x": x, "y": y, "radius": radius}


def _across_a_path(setting: Setting, values: Values) -> Values:
    """An edge through a place that a run passes."""
    x, y = setting.passed()
    normal = float(setting.rng.uniform(-math.pi, math.pi))
    return {"multiplier": 1 + values["multiplier"] / 2, "normal": normal, "edge_x": x, "edge_y": y}


def _lag(rig: Rig, values: Values) -> None:
    """A follower of first order, tau dy/dt = u - y, or with beta of second.

    Exact for a command that is straight in a step.
    """
    tau, beta = values["tau"], values.get("beta", 0.0)

    def follow(t: Array, angle: Array) -> Array:
        from scipy.signal import cont2discrete, lfilter  # takes a second

        system = [1.0], [beta, tau, 1.0] if beta else [tau, 1.0]
        discrete: Any = cont2discrete(system, t[1] - t[0], method="foh")
        above, below = discrete[:2]
        return np.asarray(lfilter(above[0], below, angle - angle[0])) + angle[0]

    rig.shapers.append(follow)


def _second_order(rig: Rig, values: Values) -> None:
    """The damping ratio zeta stays as the lag tau = 2 zeta/omega grows."""
    tau = values["tau"]
    _lag(rig, {"tau": tau, "beta": (tau / (2 * values["zeta"])) ** 2})


def _p_loop(rig: Rig, values: Values) -> None:
    """A motor as soft as its lag says, which the load's torque deflects too."""
    tau, zeta = values["tau"], values["zeta"]
    stiffness = swing_inertia(rig.robot) * (2 * zeta / tau) ** 2
    rig.motor = Motor(stiffness, stiffness * tau, feedforward=0.0)


def _damped(setting: Setting, values: Values) -> Values:
    """A servo that hardly overshoots: damping ratio 0.5 to 1.2."""
    return {**values, "zeta": float(setting.rng.uniform(0.5, 1.2))}


def _delay(rig: Rig, values: Values) -> None:
    late = values["delay"]
    rig.shapers.append(lambda t, angle: np.interp(t - late, t, angle))


def _rate_limit(rig: Rig, values: Values) -> None:
    limit = values["rate_limit"]

    def follow(t: Array, angle: Array) -> Array:
        most = limit * (t[1] - t[0])
        made, out = float(angle[0]), np.empty_like(angle)
        for k, asked in enumerate(angle.tolist()):
            made += min(max(asked - made, -most), most)
            out[k] = made
        return out

    rig.shapers.append(follow)


def _below_the_fastest(setting: Setting, _: Values) -> Values:
    """Just below the fastest rate of the commands."""
    fastest = max(gait.peak_rate for gait in setting.gaits)
    return {"rate_limit": float(fastest * setting.rng.uniform(0.8, 0.95))}


def _backlash(rig: Rig, values: Values) -> None:
    rig.play += values["width"]
    rig.hinge_dry += values.get("joint_friction", 0.0)
    if "gear_stiffness" in values:
        rig.gear = values["gear_stiffness"]


def _frictional(setting: Setting, values: Values) -> Values:
    """Friction from about the torque of the load's own inertia, where it begins to hold the load in
    the play, to well above."""
    largest = max(gait.amplitude * gait.angular_frequency**2 for gait in setting.gaits)
    inertial = swing_inertia(setting.robot) * largest
    friction = inertial * math.exp(setting.rng.uniform(math.log(0.5), math.log(4.0)))
    return {**values, "joint_friction": float(friction)}


def _compliant(setting: Setting, values: Values) -> Values:
    """A gear that the joint's friction twists by 2 to 15 mrad."""
    drawn = _frictional(setting, values)
    twist = math.exp(setting.rng.uniform(math.log(2e-3), math.log(15e-3)))
    return {**drawn, "gear_stiffness": float(drawn["joint_friction"] / twist)}


def _tether(rig: Rig, values: Values) -> None:
    rig.tether = Tether(values["x"], values["y"], values["slack"], values["stiffness"])


def _beside_a_path(setting: Setting, values: Values) -> Values:
    """Tied to a place somewhat off a run, and taut for a part of it."""
    x, y = setting.passed()
    dx, dy = setting.rng.uniform(-0.3, 0.3, 2)
    return {**values, "x": float(x + dx), "y": float(y + dy)}


def _stribeck(rig: Rig, values: Values) -> None:
    """Dry friction that falls from `force` to `force/3` as the rim's speed grows past `speed`."""
    h = rig.robot.h
    rig.laws.append(Falling(values["force"] * h, values["speed"] / h))


def _drift(rig: Rig, values: Values) -> None:
    rig.laws.append(Drift(values["change"], values["time"]))


def _sprung(rig: Rig, values: Values) -> None:
    """`give` is 1/stiffness."""
    rig.spring = 1 / values["give"]


def _fault(rig: Rig, values: Values) -> None:
    rig.laws.append(Rub(values["force"] * rig.robot.h))


def _pin(rig: Rig, values: Values) -> None:
    """The platforms can shift against each other by the clearance, up to hard stops."""
    rig.pin = values["clearance"]


def _cable(rig: Rig, values: Values) -> None:
    rig.cable = values["force"]


def _load(rig: Rig, values: Values) -> None:
    rig.load = (values["mass"], values["stiffness"])
