"""The unknowns of the calibration, each with its box and the reason for it."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from rr_opt.array import Array
from rr_opt.formatting import number
from rr_opt.model.ballast import About, By, Loads, hang
from rr_opt.model.robot import Platform, Robot
from rr_paper.calibration.cycles import coefficients, dry_speed, lagging, limited, viscous_speed
from rr_paper.publication import ROWS, TABLE_1, read_data
from rr_paper.signs import PRINTED, Angle, equation3, sine


@dataclass(frozen=True)
class Unknown:
    """A quantity to be estimated; its prior is flat inside its box, in its logarithm if `log`.

    box    low and high, in `unit`; why: the reason for it
    scale  factor from `unit` to `shown_unit`
    """

    name: str
    symbol: str
    words: str
    unit: str
    box: tuple[float, float]
    why: str
    log: bool = False
    scale: float = 1.0
    shown_unit: str = ""

    def value(self, share: ArrayLike) -> Array:
        """The value at a share (0 to 1) of the box."""
        share, (low, high) = np.asarray(share, float), self.box
        return low * (high / low) ** share if self.log else low + (high - low) * share

    def share(self, value: ArrayLike) -> Array:
        """The share of the box at a value."""
        value, (low, high) = np.asarray(value, float), self.box
        if self.log:
            return np.log(value / low) / np.log(high / low)
        return (value - low) / (high - low)

    def shown(self, value: ArrayLike) -> Array:
        """The value in `shown_unit`."""
        return self.scale * np.asarray(value, float)

    def span(self, ends: tuple[float, float], digits: int = 2) -> str:
        """`-28 to 5 mm`; ends in SI."""
        low, high = (number(float(self.shown(end)), digits) for end in ends)
        return f"{low} to {high} {self.shown_unit}"

    @property
    def box_text(self) -> str:
        """The box as `-30 to 30 mm`."""
        return self.span(self.box)


UNKNOWNS: Mapping[str, Unknown] = MappingProxyType(
    {name: Unknown(name, **one) for name, one in read_data("unknowns.toml").items()}
)


def values(names: Sequence[str], shares: Array) -> dict[str, Array]:
    """name -> values (K,) of points given as shares of their boxes (K, len(names))."""
    return {name: UNKNOWNS[name].value(shares[:, i]) for i, name in enumerate(names)}


def shares(names: Sequence[str], points: Mapping[str, ArrayLike]) -> Array:
    """The inverse of `values`: (K, len(names))."""
    return np.column_stack([UNKNOWNS[name].share(points[name]) for name in names])


PERIOD = np.array([row.period for row in ROWS])
AMPLITUDE = np.array([np.nan if row.amplitude is None else row.amplitude for row in ROWS])
"""rad; NaN where the paper does not give it and the unknown `amplitude` is used."""

_SMOOTH, _CORNERS, _DRY = 16, 64, 48
"""Samples per half period: where v is smooth, where the angle has corners, with dry friction."""


@dataclass(frozen=True)
class Reading:
    """How J20/J10 is defined, and how it was changed.

    spread  of the loads on both sides of platform 2's axis, m
    """

    about: About = "joint"
    by: By = "loads"
    spread: float = Loads.spread

    @property
    def words(self) -> str:
        """In words."""
        point = "the joint P" if self.about == "joint" else "each centre of mass"
        if self.by == "inertia":
            return f"about {point}, changing I20 only"
        return f"about {point}, by loads {1e3 * self.spread:.0f} mm off the axis"


READINGS = (
    Reading(),
    Reading(spread=0.1),
    Reading(by="inertia"),
    Reading(about="centre", by="inertia"),
)
"""The first is the default. Loads cannot realise the ratios about the centres of mass: the bare
robot has I20/I10 = 0.453, above every printed ratio, and loads only add to it."""


_M1, _M2, _I1, _I2, _REACH1, _REACH2, _LOAD = (
    TABLE_1[name].value
    for name in ("m1", "m2", "I10", "I20", "c1 - a1", "c2 - a2", "mass of one load")
)
_h = 0.02
"""Wheel radius, m: arbitrary, as k is given and not kappa."""


def parameters(x: Mapping[str, Array], reading: Reading) -> Array:
    """The values of `ROBOT_PARAMETERS` for the nine rows of K points, (13, 9 K).

    x: a1, a2, b (m) and k (N s/m), (K,) each.
    """
    a1, a2, b, k = (x[name][:, None] for name in ("a1", "a2", "b", "k"))
    m2, I2, reach2 = _platform2(reading)
    c2 = _REACH2 + a2
    rows = (_M1, _I1, _REACH1 + a1, a1, b, k, m2, I2, c2, c2 - reach2, b, k, _h)
    return np.array([np.broadcast_to(row, (len(a1), len(ROWS))).ravel() for row in rows])


def _platform2(reading: Reading) -> tuple[Array, Array, Array]:
    """m (kg), I (kg m2) and distance from P to the centre of mass (m) in each row, (9,)."""
    ratio = np.array([row.ratio for row in ROWS])
    ones = np.ones_like(ratio)
    if reading.about == "centre":
        return _M2 * ones, ratio * _I1, _REACH2 * ones
    wanted = ratio * (_I1 + _M1 * _REACH1**2)
    if reading.by == "inertia":
        return _M2 * ones, wanted - _M2 * _REACH2**2, _REACH2 * ones
    excess = wanted - _I2 - _M2 * _REACH2**2
    count = excess / (_LOAD * (_REACH2**2 + reading.spread**2))
    return hang(_M2, _I2, _REACH2, (_LOAD, _REACH2, reading.spread), count)


def _robot(p: Array) -> Robot:
    """The robots as a single one with arrays of values."""
    m1, I1, c1, a1, b1, k1, m2, I2, c2, a2, b2, k2, h = p
    one: tuple[Any, ...] = (m1, I1, c1, a1, b1, k1 * h**2)
    two: tuple[Any, ...] = (m2, I2, c2, a2, b2, k2 * h**2)
    return Robot(Platform(*one), Platform(*two), _h)


@dataclass(frozen=True)
class Model:
    """A model and its unknowns.

    speeds    (values by name, each (K,); reading) -> signed mean speeds (9 K,), m/s; NaN where a
              robot has none
    cost      of a point, approximate, relative to the viscous model
    block     points evaluated at once: few enough for the processor's cache, enough for NumPy
    nested    it contains the viscous model, with its last unknown at the low end of its box
    profiled  the unknowns of which profiles are computed
    """

    name: str
    words: str
    unknowns: tuple[str, ...]
    speeds: Callable[[Mapping[str, Array], Reading], Array]
    cost: float = 1.0
    block: int = 64
    nested: bool = False
    profiled: tuple[str, ...] = ()

    def __call__(self, shares: Array, reading: Reading) -> Array:
        """Signed speeds (K, 9) at points given as shares of their boxes (K, unknowns)."""
        blocks = [shares[i : i + self.block] for i in range(0, len(shares), self.block)]
        parts = [self.speeds(values(self.unknowns, block), reading) for block in blocks]
        return np.concatenate([np.empty(0), *parts]).reshape(-1, len(ROWS))


def _gaits(x: Mapping[str, Array]) -> tuple[Array, Array]:
    """Commanded amplitudes (rad) and periods (s) of the nine rows of each point, (9 K,)."""
    amplitude = np.where(np.isnan(AMPLITUDE), x["amplitude"][:, None], AMPLITUDE)
    return amplitude.ravel(), np.tile(PERIOD, len(amplitude))


_Speeds = Callable[[Mapping[str, Array], Reading], Array]


def _viscous(servo: Callable[[Array, Array, Mapping[str, Array]], Angle]) -> _Speeds:
    def speeds(x: Mapping[str, Array], reading: Reading) -> Array:
        amplitude, period = _gaits(x)
        angle = servo(amplitude, period, x)
        return viscous_speed(coefficients(angle, parameters(x, reading)), period)

    return speeds


def _with_dry(x: Mapping[str, Array], reading: Reading) -> Array:
    amplitude, period = _gaits(x)
    force = np.repeat(x["force"], len(ROWS))
    return dry_speed(sine(amplitude, period, _DRY), period, parameters(x, reading), force)


def _printed(x: Mapping[str, Array], reading: Reading) -> Array:
    amplitude, period = _gaits(x)
    angle, p = sine(amplitude, period, _SMOOTH), parameters(x, reading)
    slope, drive = equation3(_robot(p), *angle, PRINTED)
    return viscous_speed(coefficients(angle, p)._replace(slope=slope, drive=drive), period)


_BASIC = ("a1", "a2", "b", "k", "amplitude")

_ALL = (
    Model("viscous", "viscous friction, as in the paper", _BASIC,
          _viscous(lambda alpha, T, _: sine(alpha, T, _SMOOTH)), profiled=_BASIC),
    Model("viscous+dry", "viscous and dry friction", (*_BASIC, "force"), _with_dry,
          cost=30, block=512, nested=True, profiled=("k", "force")),
    Model("rate limit", "viscous, servo limited to 30 rpm", _BASIC,
          _viscous(lambda alpha, T, _: limited(alpha, T, _CORNERS)), cost=5, block=16),
    Model("lag", "viscous, servo with a lag", (*_BASIC, "lag"),
          _viscous(lambda alpha, T, x: lagging(alpha, T, np.repeat(x["lag"], len(ROWS)), _SMOOTH)),
          nested=True, profiled=("lag",)),
    Model("printed", "viscous, equation (3) as printed", _BASIC, _printed),
)  # fmt: skip

MODELS: Mapping[str, Model] = MappingProxyType({one.name: one for one in _ALL})
"""The paper's own model first."""
VISCOUS, DRY = "viscous", "viscous+dry"
