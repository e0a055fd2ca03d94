"""What may be missing from the equation of a pendulum: each effect a torque, or a wrong clock."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import casadi as ca

STICKING_SPEED = 0.001
"""sign(w) is smoothed to tanh(w/w0), w0 in rad/s: a pendulum spends next to no time so slow."""

STRIBECK_SPEED = 0.5
"""w_s, rad/s."""

_SHARE = 0.1
"""A torque that is left out is usually such a share of the motor's."""


@dataclass(frozen=True)
class Constant:
    """The number of an effect, which vanishes at 0.

    size  its usual size, for a usual torque of the motor (N m) and the largest speed (rad/s)
    """

    name: str
    unit: str
    low: float
    high: float
    size: Callable[[float, float], float]


@dataclass(frozen=True)
class Extra:
    """An effect with one constant.

    torque  (w, tau, constant) -> what it adds to the torque, N m
    delays  whether the constant is the time by which the torque's clock is behind the angle's
    begin   where to look for it first, in usual sizes
    smooth  whether it has a derivative by its constant where it vanishes
    """

    name: str
    family: str
    channel: str
    constant: Constant
    sentence: str
    torque: Callable[[ca.SX, ca.SX, ca.SX], ca.SX] = lambda *_: ca.SX(0)
    delays: bool = False
    begin: float = 0.0
    smooth: bool = True

    @property
    def quantity(self) -> str:
        """The constant's full name."""
        return f"{self.name}.{self.constant.name}"


def _sign(w: ca.SX) -> ca.SX:
    return ca.tanh(w / STICKING_SPEED)


def _torque(low: float) -> Constant:
    return Constant("torque", "N m", low, 100.0, lambda usual, _: _SHARE * usual)


_ALL = (
    Extra(
        "coulomb_friction",
        "bearing",
        "friction",
        _torque(0.0),
        "The bearing resists with a torque that does not depend on the speed.",
        lambda w, _, torque: -torque * _sign(w),
        begin=0.05,
    ),
    Extra(
        "stribeck_friction",
        "bearing",
        "friction",
        _torque(0.0),
        "The bearing resists more while it is slow.",
        lambda w, _, torque: -torque * _sign(w) * ca.exp(-((w / STRIBECK_SPEED) ** 2)),
        begin=0.05,
    ),
    Extra(
        "quadratic_drag",
        "air",
        "friction",
        Constant("coefficient", "N m s^2", 0.0, 100.0, lambda usual, w: _SHARE * usual / w**2),
        "The air resists with a torque that grows with the square of the speed.",
        lambda w, _, drag: -drag * w * ca.sqrt(w**2 + STICKING_SPEED**2),
        begin=0.05,
    ),
    Extra(
        "torque_offset",
        "motor",
        "actuation",
        _torque(-100.0),
        "The motor always gives more than its reading, by the same torque.",
        lambda _, __, torque: torque,
    ),
    Extra(
        "torque_limit",
        "motor",
        "actuation",
        Constant("inverse", "1/(N m)", 0.0, 100.0, lambda usual, _: _SHARE / usual),
        "The motor gives less than its reading where that is large, and never more than a limit.",
        lambda _, tau, inverse: tau / ca.sqrt(1 + (inverse * tau) ** 2) - tau,
        begin=1.0,
        smooth=False,
    ),
    Extra(
        "clock_offset",
        "measurement",
        "measurement",
        Constant("offset", "s", -0.2, 0.2, lambda _, __: 0.01),
        "The clocks of torque and angle differ, by the same in all runs.",
        delays=True,
    ),
)

EXTRAS: Mapping[str, Extra] = {extra.name: extra for extra in _ALL}
