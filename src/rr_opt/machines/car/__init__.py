"""A car with two axles, as one wheel each; the speed along it is measured.

A wheel's side force is its slip angle over its compliance; without an effect it hardly slips.
"""

from collections.abc import Mapping
from typing import Any

import casadi as ca

from rr_opt.machines import laws
from rr_opt.model.machine import (
    Add,
    Channel,
    Constant,
    Machine,
    MachineEffect,
    MachineParameter,
    Names,
)
from rr_opt.model.parameters import Spread

RIGID = 2e-3
"""rad/N: compliance of wheels that are taken not to slip; an effect adds to it."""

SLOW = 0.3
"""m/s: lower limit of the rolling speed in a slip angle."""


def _rates(v: Names, add: Add) -> Mapping[str, Any]:
    delta = v.gain * v.steering + v.zero + add("steering")
    lf = v.L * v.mr / (v.mf + v.mr)
    lr = v.L - lf
    mass = v.mf + v.mr
    # In a bend front wheels are faster than rear ones: here, as if none slipped.
    vx = v.vx * (1 + add("speed")) / (1 + v.front_share * (1 / ca.cos(delta) - 1))
    roll = ca.sqrt(vx**2 + SLOW**2)
    front = ((v.vy + lf * v.r) * ca.cos(delta) - vx * ca.sin(delta)) / roll
    rear = (v.vy - lr * v.r) / roll
    Ff = -front / (RIGID + add("slip", slip=front, axle="front"))
    Fr = -rear / (RIGID + add("slip", slip=rear, axle="rear"))
    inertia = mass * (v.L**2 + 0.08**2) / 12
    c, s = ca.cos(v.psi), ca.sin(v.psi)
    # The recorded point is ahead of the rear axle and to the left.
    ahead = v.ahead - lr
    sx, sy = vx - v.left * v.r, v.vy + ahead * v.r
    return {
        "x": sx * c - sy * s,
        "y": sx * s + sy * c,
        "psi": v.r,
        "vy": (Ff * ca.cos(delta) + Fr) / mass - vx * v.r + add("side"),
        "r": (lf * Ff * ca.cos(delta) - lr * Fr) / inertia + add("yaw"),
    }


def _slip(v: Names, c: Names) -> ca.SX:
    front, rear = (c.front, c.front_grip), (c.rear, c.rear_grip)
    compliance, grip = front if v.axle == "front" else rear
    return compliance + grip * laws.size(v.slip)


def _constants(name: str, unit: str, size: float, high: float) -> tuple[Constant, ...]:
    """A constant for each axle."""
    return tuple(Constant(f"{axle}{name}", unit, lambda _: size, 0.0, high)
                 for axle in ("front", "rear"))  # fmt: skip


LATERAL_SLIP = MachineEffect(
    "lateral_slip", "contact", "tyres", "slip", "lateral slip of the wheels",
    "The wheels slip sideways: in proportion to their side force, which approaches a limit.",
    (*_constants("", "rad/N", 0.02, 1.0), *_constants("_grip", "1/N", 0.1, 10.0)),
    _slip,
    forms=(("front", "rear"), ("front", "rear", "front_grip", "rear_grip")),
)  # fmt: skip


CAR = Machine(
    name="car",
    words="a car",
    equation="wheels that do not slip sideways",
    states=("x", "y", "psi", "vy", "r"),
    parameters=(
        MachineParameter("L", "m", "wheelbase", "0.1735", Spread(2e-3), 1e-3),
        MachineParameter("mf", "kg", "mass on the front axle", "0.847",
                         Spread(relative=0.01), 1e-3),
        MachineParameter("mr", "kg", "mass on the rear axle", "0.733", Spread(relative=0.01), 1e-3),
        MachineParameter("gain", "rad", "steering angle per unit of command", "0.35",
                         Spread(factor=5.0), 1e-3),
        MachineParameter("zero", "rad", "steering angle at zero command", "0", Spread(0.05), -1.0),
        MachineParameter("ahead", "m", "recorded point ahead of the rear axle", "0.115",
                         Spread(5e-3), -1.0),
        MachineParameter("left", "m", "recorded point to the left", "-0.01", Spread(5e-3), -1.0),
        MachineParameter("front_share", "dimensionless", "weight of the front wheels in the "
                         "measured speed: 0 for a rear-axle encoder, 0.5 for a motor on both axles",
                         "0", Spread(0.5), 0.0, 1.0, 0.0),
        MachineParameter("speed_late", "s", "delay until the speed acts, negative if it is "
                         "recorded late", "0", Spread(0.05), -0.3, 0.3, 0.0),
        MachineParameter("steering_late", "s", "delay until the steering command acts", "0",
                         Spread(0.05), -0.3, 0.3, 0.0),
    ),
    inputs=(
        Channel("vx", "m/s", "the speed along the car", steady=True),
        Channel("steering", "", "the steering command"),
    ),
    outputs=(
        Channel("x", "m", "x"),
        Channel("y", "m", "y"),
        Channel("psi", "rad", "the heading", angle=True),
    ),
    effects=(
        LATERAL_SLIP,
        MachineEffect("steering_curve", "steering", "steering", "steering",
                      "a nonlinear steering map",
                      "The steering angle is not proportional to its command.",
                      (Constant("cubic", "rad", lambda _: 0.05, -1.0, 1.0),),
                      lambda v, c: c.cubic * v.steering**3),
        MachineEffect("speed_gain", "measurement", "measurement", "speed",
                      "a wrong speed gain", "The encoder's speed is off by a constant factor.",
                      (Constant("error", "dimensionless", lambda _: 0.05, -0.5, 1.0),),
                      lambda _, c: c.error),
        laws.lagging("steering_lag", "the steering", "steering", 0.1),
    ),
    signals=(
        laws.late("", "the speed", "vx", constant="speed_late"),
        laws.late("", "the steering", "steering", constant="steering_late"),
    ),
    rates=_rates,
    seen=lambda v, _: {"x": v.x, "y": v.y, "psi": v.psi},
    rate_of={"vy": "y", "r": "psi"},
    start=lambda s: {"x": s["x"], "y": s["y"], "psi": s["psi"], "vy": 0.0, "r": s["psi_rate"]},
    scales=lambda s: {"speed": max(s["vx"], 1e-3)},
    ports={"yaw": ("yaw", "rad/s^2", "a yaw acceleration"),
           "tyres": ("side", "m/s^2", "a lateral acceleration")},
    variables={"vx": ("speed", "m/s"), "steering": ("steering command", "")},
    step=2.5e-3,
    stiff=2,
)  # fmt: skip
