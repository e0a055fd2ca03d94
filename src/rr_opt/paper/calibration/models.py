"""The models that are held against the nine rows: each gives nine mean speeds to any point.

All have a1, a2, b, k and Table 2's amplitude unknown, but where said otherwise. The tables do
not say which platform leads, but as the text speaks of gaits that drive the opposite way and no
printed speed has a minus sign, all nine are taken to drive one way, whichever: see `one_way`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rr_opt.paper.calibration import coefficients, servo
from rr_opt.paper.calibration.measured import AMPLITUDE, PERIOD
from rr_opt.paper.calibration.robots import WHEEL_RADIUS, Reading, parameters
from rr_opt.paper.calibration.steady import dry_speed, viscous_speed
from rr_opt.paper.calibration.unknowns import values
from rr_opt.paper.equation3 import PRINTED, equation3
from rr_opt.robot.parameters import Platform, Robot

Array = NDArray[np.float64]

_SMOOTH, _CORNERED, _DRY = 16, 64, 48
"""Samples of half a period: where v is smooth; where the angle has corners; with dry friction."""


@dataclass(frozen=True)
class Model:
    """A model and what is unknown in it.

    speeds  (values by name, each (K,); reading) -> signed mean speeds (K, 9), m/s; NaN where a
            robot has none
    cost    of a point, about, relative to the viscous model's
    block   points in one go: few enough for the processor's cache, enough to keep NumPy busy
    nested  the viscous model is this one with its last unknown at the low end of its box
    told    the unknowns whose profiles are told
    """

    name: str
    words: str
    unknowns: tuple[str, ...]
    speeds: Callable[[Mapping[str, Array], Reading], Array]
    cost: float = 1.0
    block: int = 64
    nested: bool = False
    told: tuple[str, ...] = ()

    def __call__(self, shares: Array, reading: Reading) -> Array:
        """Signed speeds (K, 9) at points given as shares of their boxes (K, unknowns)."""
        blocks = [shares[i : i + self.block] for i in range(0, len(shares), self.block)]
        found = [self.speeds(values(self.unknowns, block), reading) for block in blocks]
        return np.concatenate(found) if found else np.empty((0, len(PERIOD)))


def one_way(speeds: Array) -> Array:
    """Signed speeds (N, 9) counted positive the way the nine drive on the whole: a row that
    drives the other way comes out negative, and far from what is printed."""
    return speeds * np.sign(speeds.sum(axis=1, keepdims=True))


_Angles = Callable[[Array, Array, Mapping[str, Array]], servo.Angle]


def _gaits(x: Mapping[str, Array]) -> tuple[Array, Array]:
    """Commanded amplitudes (rad) and periods (s) of the nine rows of each point, (9 K,)."""
    amplitude = np.where(np.isnan(AMPLITUDE), x["amplitude"][:, None], AMPLITUDE)
    return amplitude.ravel(), np.tile(PERIOD, len(amplitude))


def _rows(of: Array, count: int) -> Array:
    """A value of each point, (K,), for its nine rows, (9 K,)."""
    return np.repeat(of, count)


def _sine(amplitude: Array, period: Array, _: Mapping[str, Array]) -> servo.Angle:
    return servo.sine(amplitude, period, _SMOOTH)


def _limited(amplitude: Array, period: Array, _: Mapping[str, Array]) -> servo.Angle:
    return servo.limited(amplitude, period, _CORNERED)


def _lagging(amplitude: Array, period: Array, x: Mapping[str, Array]) -> servo.Angle:
    return servo.lagging(amplitude, period, _rows(x["lag"], len(PERIOD)), _SMOOTH)


def _viscous(angles: _Angles) -> Callable[[Mapping[str, Array], Reading], Array]:
    def speeds(x: Mapping[str, Array], reading: Reading) -> Array:
        amplitude, period = _gaits(x)
        phi, q, r = angles(amplitude, period, x)
        p = parameters(x, reading)
        known = coefficients.linear(phi, q, r, p)
        return viscous_speed(known, q, period).reshape(-1, len(PERIOD))

    return speeds


def _with_dry(x: Mapping[str, Array], reading: Reading) -> Array:
    amplitude, period = _gaits(x)
    phi, q, r = servo.sine(amplitude, period, _DRY)
    p = parameters(x, reading)
    known, rolling = coefficients.linear(phi, q, r, p), coefficients.wheels(phi, q, p)
    force = _rows(x["force"], len(PERIOD))
    return dry_speed(known, rolling, force, q, period).reshape(-1, len(PERIOD))


def _printed(x: Mapping[str, Array], reading: Reading) -> Array:
    amplitude, period = _gaits(x)
    phi, q, r = servo.sine(amplitude, period, _SMOOTH)
    p = parameters(x, reading)
    slope, drive = equation3(_robot_of_arrays(p), phi, q, r, PRINTED)
    _, _, turn_v, turn_q = coefficients.linear(phi, q, r, p)
    known = coefficients.Linear(slope, drive, turn_v, turn_q)
    return viscous_speed(known, q, period).reshape(-1, len(PERIOD))


def _robot_of_arrays(p: Array) -> Robot:
    """A robot whose numbers are arrays, for formulas that broadcast."""
    m1, I1, c1, a1, b1, k1, m2, I2, c2, a2, b2, k2, _ = p
    one: tuple[Any, ...] = (m1, I1, c1, a1, b1, k1 * WHEEL_RADIUS**2)
    two: tuple[Any, ...] = (m2, I2, c2, a2, b2, k2 * WHEEL_RADIUS**2)
    return Robot(Platform(*one), Platform(*two), WHEEL_RADIUS)


_GEOMETRY = ("a1", "a2", "b")
_PAPERS = (*_GEOMETRY, "k", "amplitude")

_ALL = (
    Model("viscous", "viscous friction, as in the paper", _PAPERS, _viscous(_sine), told=_PAPERS),
    Model(
        "viscous+dry", "viscous and dry friction", (*_PAPERS, "force"), _with_dry,
        cost=30, block=512, nested=True, told=("k", "force"),
    ),
    Model(
        "rate limit", "viscous, the servo held to 30 rpm", _PAPERS, _viscous(_limited),
        cost=5, block=16,
    ),
    Model(
        "lag", "viscous, the servo with a lag", (*_PAPERS, "lag"), _viscous(_lagging),
        nested=True, told=("lag",),
    ),
    Model("printed", "viscous, equation (3) as printed", _PAPERS, _printed),
)  # fmt: skip

MODELS: Mapping[str, Model] = MappingProxyType({one.name: one for one in _ALL})
"""The paper's own law first; `cost` is that of a point, relative to its."""
