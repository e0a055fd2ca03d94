"""A servo that lifts a mass on an arm: its motor, and the P controller of its firmware.

(m l^2 + armature) q'' = kt V/R - kt^2 w/R - m g l sin q - friction,
V = volts clip(kp (goal - q) 4096/(2 pi)/(256 885), -1, 1)
"""

import math
from collections.abc import Mapping

import casadi as ca

from rr_opt.machines import laws
from rr_opt.model.machine import Add, Channel, Machine, MachineParameter, Names
from rr_opt.model.parameters import Spread

PER_COUNT = 4096 / (2 * math.pi) / (256 * 885)
"""Duty per gain and rad: 4096 steps a turn, gains in 1/256, 885 counts of PWM at full voltage."""


def _rates(v: Names, add: Add) -> Mapping[str, ca.SX]:
    def gravity(q: ca.SX) -> ca.SX:
        return v.m * laws.G * v.l * ca.sin(q)

    duty = ca.fmax(ca.fmin(v.kp * (v.goal - v.q) * PER_COUNT, 1), -1)
    drive = v.on * v.kt / v.R * (v.volts * duty - v.kt * v.w)
    known = drive - v.b * v.w - v.fc * laws.sign(v.w) - gravity(v.q)
    torque = known + add("torque", drive=drive, load=gravity(v.q), gravity=gravity, duty=duty)
    return {"q": v.w, "w": torque / (v.m * v.l**2 + v.armature)}


SERVO = Machine(
    name="servo",
    words="a servo that lifts a mass on an arm",
    equation="(m l^2 + armature) q'' = kt V/R - kt^2 w/R - b w - fc sign w - m g l sin q",
    **laws.JOINT,
    parameters=(
        MachineParameter("kt", "N m/A", "torque constant at the arm", "0.4",
                         Spread(relative=0.2), 1e-6),
        MachineParameter("R", "ohm", "resistance of the winding", "4", Spread(relative=0.2), 1e-6),
        MachineParameter("armature", "kg m^2", "inertia of motor and gears at the arm", "0.002",
                         Spread(factor=5.0), 1e-9),
        MachineParameter("b", "N m s", "viscous friction", "0.004", Spread(factor=5.0)),
        MachineParameter("fc", "N m", "Coulomb friction", "0.013", Spread(factor=5.0)),
    ),
    inputs=(
        Channel("goal", "rad", "the set point"),
        Channel("volts", "V", "the supply", 7.4),
        Channel("on", "", "whether the motor is on", 1.0),
        Channel("kp", "", "the gain of the P controller, as the firmware counts it"),
        Channel("m", "kg", "the mass"),
        Channel("l", "m", "the arm's length"),
    ),
    effects=(
        laws.STRIBECK_FRICTION,
        laws.LOAD_FRICTION,
        laws.DIRECTION_FRICTION,
        laws.QUADRATIC_DRAG,
        laws.SUPPLY_SAG,
        laws.TORQUE_OFFSET,
        laws.ANGLE_OFFSET,
        laws.late("command_delay", "the set point", "goal"),
    ),
    rates=_rates,
    scales=lambda s: {"torque": s["m"] * laws.G * s["l"], "speed": max(s["q_rate"], 1e-3)},
    variables={"w": ("speed", "rad/s"), "q": ("angle", "rad"), "goal": ("set point", "rad")},
    # A servo that lifts a mass turns back so fast that with twice this, derivatives by friction and
    # inertia are off by up to a factor of two.
    step=5e-4,
)  # fmt: skip
