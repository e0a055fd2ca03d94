"""Effects that machines share: friction of a joint, and faults of its drive.

A law sees the states and inputs of its machine by name and, for a joint, `w` (rad/s), the torques
`drive` of the motor and `load` of gravity (N m), and `gravity`, the latter as a function of the
angle q; a signal sees times and inputs.
"""

from typing import Any

import casadi as ca
import numpy as np

from rr_opt.array import Array
from rr_opt.model.machine import Channel, Constant, MachineEffect, Names, Signals

G = 9.81
"""m/s2."""

STICKING = 0.005
"""sign(w) is smoothed to tanh(w/w0), w0 in rad/s: a joint spends hardly any time below it."""

STRIBECK = 0.5
"""rad/s, at which the additional friction of a slow joint has fallen to 1/e."""

_SHARE = 0.1
"""Usual size of a missing torque, as a share of the motor's."""

FRICTION_FORM_ERROR = 0.15
"""Of friction laws. The best of six for geared servos is reported to halve the error of viscous and
Coulomb friction (Duclusaud et al., ICRA 2025): as much remains as it explains. Chosen with the
public recordings of a servo in view."""


def sign(w: Any) -> Any:
    """Smoothed sign of a speed."""
    return ca.tanh(w / STICKING)


def size(x: Any, small: float = 1e-3) -> Any:
    """Smoothed |x|."""
    return ca.sqrt(x**2 + small**2)


JOINT: dict[str, Any] = {
    "states": ("q", "w"),
    "outputs": (Channel("q", "rad", "the angle", angle=True),),
    "seen": lambda v, _: {"q": v.q},
    "rate_of": {"w": "q"},
    "start": lambda seen: {"q": seen["q"], "w": seen["q_rate"]},
    "ports": {"friction": ("torque", "N m", "a torque")},
}
"""Common to machines with one joint: its angle q is measured, its speed is w."""


def _torque(name: str = "torque", low: float = 0.0) -> Constant:
    return Constant(name, "N m", lambda s: _SHARE * s["torque"], low, 1e3)


def _joint(name: str, words: str, sentence: str, constant: Constant, law: Any, **more: Any):
    return MachineEffect(name, "bearing", "friction", "torque", words, sentence, (constant,), law,
                         form_error=FRICTION_FORM_ERROR, **more)  # fmt: skip


COULOMB = _joint(
    "coulomb_friction",
    "Coulomb friction",
    "The bearing resists with a torque that does not depend on the speed.",
    _torque(),
    lambda v, c: -c.torque * sign(v.w),
)
STRIBECK_FRICTION = _joint(
    "stribeck_friction",
    "friction that rises at low speed (Stribeck)",
    "The bearing resists more at low speed.",
    _torque(),
    lambda v, c: -c.torque * sign(v.w) * ca.exp(-((v.w / STRIBECK) ** 2)),
)
QUADRATIC_DRAG = _joint(
    "quadratic_drag",
    "quadratic drag",
    "The air resists with a torque that grows with the square of the speed.",
    Constant("coefficient", "N m s^2", lambda s: _SHARE * s["torque"] / s["speed"] ** 2),
    lambda v, c: -c.coefficient * v.w * size(v.w),
)
LOAD_FRICTION = _joint(
    "load_friction",
    "friction that grows with the load on the gears",
    "The more torque the gears transmit, the more they resist.",
    Constant("share", "dimensionless", lambda _: _SHARE, high=1.0),
    lambda v, c: -c.share * size(v.drive + v.load) * sign(v.w),
)
DIRECTION_FRICTION = _joint(
    "direction_friction",
    "Coulomb friction that differs between the directions",
    "The bearing resists more in one direction than in the other.",
    _torque("difference", -1e3),
    lambda v, c: -c.difference / 2 * sign(v.w) ** 2,
)
SUPPLY_SAG = MachineEffect(
    "supply_sag",
    "motor",
    "actuation",
    "torque",
    "a supply that sags between the measuring point and the motor",
    "The more current the motor draws, the less of the measured voltage reaches it.",
    (Constant("resistance", "ohm", lambda _: 1.0),),
    lambda v, c: -c.resistance / v.R * v.duty**2 * v.drive,
)
TORQUE_OFFSET = MachineEffect(
    "torque_offset",
    "motor",
    "actuation",
    "torque",
    "a torque offset",
    "The motor's torque differs from its reading by a constant.",
    (_torque(low=-1e3),),
    lambda _, c: c.torque,
)
ANGLE_OFFSET = MachineEffect(
    "angle_offset",
    "measurement",
    "measurement",
    "torque",
    "an angle offset",
    "The angle is not zero when the machine hangs at rest.",
    (Constant("angle", "rad", lambda _: 0.03, -1.0, 1.0),),
    lambda v, c: v.gravity(v.q) - v.gravity(v.q + c.angle),
)


def delayed(t: Array, u: Array, late: float) -> Array:
    """A signal delayed by `late`, s."""
    return np.interp(t - late, t, u)


def lagged(t: Array, u: Array, tau: float) -> Array:
    """A signal through a first-order lag, exact for a signal that is linear between samples."""
    if tau <= 0:
        return u
    h = np.diff(t)
    decay = np.exp(-h / tau)
    slope = np.diff(u) / h
    out = np.empty_like(u)
    out[0] = now = u[0]
    for k in range(h.size):
        ahead = u[k] - slope[k] * tau
        now = (now - ahead) * decay[k] + ahead + slope[k] * h[k]
        out[k + 1] = now
    return out


def late(
    name: str, words: str, *signals: str, low: float = -0.3, constant: str = "delay"
) -> MachineEffect:
    """Some inputs are late, or early."""

    def law(t: Array, u: Signals, c: Names) -> Signals:
        return {one: delayed(t, u[one], getattr(c, constant)) for one in signals}

    sentence = f"{words[0].upper()}{words[1:]} acts later than recorded."
    return MachineEffect(name, "signal", "actuation", "signal", f"a delay of {words}", sentence,
                         (Constant(constant, "s", lambda _: 0.01, low, 0.3),), law)  # fmt: skip


def lagging(name: str, words: str, signal: str, tau: float) -> MachineEffect:
    """An input is followed with a first-order lag of about tau, s."""

    def law(t: Array, u: Signals, c: Names) -> Signals:
        return {signal: lagged(t, u[signal], c.tau)}

    sentence = f"{words[0].upper()}{words[1:]} follows its command with a lag."
    return MachineEffect(name, "signal", "actuation", "signal", f"a lag of {words}", sentence,
                         (Constant("tau", "s", lambda _: tau, 0.0, 2.0),), law)  # fmt: skip
