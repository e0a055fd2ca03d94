"""The models that are held against the nine rows, the robots of the rows, and the unknowns.

The nine measured averages of Tables 2 and 3, and what their intervals mean.

An interval is mean +- t s/sqrt(n) with n = 3 runs and t the 97.5 % point of Student's
distribution with 2 degrees of freedom. So the standard error is half_width/4.303, and it is
itself estimated from three runs: (mean - true)/standard error follows Student's distribution
with 2 degrees of freedom, not the normal one.

The tables head the column with the interval as the mean and the other as `v_exp`. Both readings
of which column was measured are followed; the intervals are the same, there being one set.

The robots of the nine rows: Table 1 with the unknowns filled in and the row's J20/J10.

The paper does not say how its ratios are taken. A `Reading` is one way to take them.

How far nine predicted speeds are from nine measured ones: minus twice the log-likelihood.

With standard errors from n = 3 runs each row is Student's with 2 degrees of freedom,
3 log(1 + z^2/2) in z = (predicted - measured)/standard error; with standard errors taken as
known it is z^2. Both are 0 for a perfect fit.

The models that are held against the nine rows: each gives nine mean speeds to any point.

All have a1, a2, b, k and Table 2's amplitude unknown, but where said otherwise. The tables do
not say which platform leads, but as the text speaks of gaits that drive the opposite way and no
printed speed has a minus sign, all nine are taken to drive one way, whichever: see `one_way`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.stats import t as student

from rr_opt.array import Array
from rr_opt.model.ballast import About, By, Loads, hang
from rr_opt.model.robot import Platform, Robot
from rr_paper.calibration import steady as coefficients
from rr_paper.calibration import steady as servo
from rr_paper.calibration.steady import dry_speed, viscous_speed
from rr_paper.equation3 import PRINTED, equation3
from rr_paper.publication import RUNS, TABLE_1, TABLE_2, TABLE_3


@dataclass(frozen=True)
class Unknown:
    """A quantity to be estimated; flat inside its box, or flat in its logarithm if `log`.

    low, high  the box, in `unit`
    scale      by which a value is multiplied when it is shown in `shown_unit`
    """

    name: str
    symbol: str
    words: str
    unit: str
    low: float
    high: float
    why: str
    log: bool = False
    scale: float = 1.0
    shown_unit: str = ""

    def value(self, share: ArrayLike) -> Array:
        """The value at a share (0 to 1) of the box."""
        share = np.asarray(share, float)
        if self.log:
            return self.low * (self.high / self.low) ** share
        return self.low + (self.high - self.low) * share

    def share(self, value: ArrayLike) -> Array:
        """The share of the box at a value."""
        value = np.asarray(value, float)
        if self.log:
            return np.log(value / self.low) / np.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)

    def shown(self, value: ArrayLike) -> Array:
        """The value in the unit in which it is told."""
        return self.scale * np.asarray(value, float)


_ALL = (
    Unknown(
        "a1", "a1", "centre of mass of platform 1 ahead of its axle", "m", -0.03, 0.03,
        "Table 1 gives c1 - a1 alone. The photograph shows the wheels under the platform's load; "
        "30 mm is a sixth of c1 - a1 to either side.",
        scale=1e3, shown_unit="mm",
    ),
    Unknown(
        "a2", "a2", "centre of mass of platform 2 ahead of its axle", "m", -0.03, 0.03,
        "Table 1 gives c2 - a2 alone. 30 mm keeps c2 above 14 mm, so that the axle stays on its "
        "own side of the joint.",
        scale=1e3, shown_unit="mm",
    ),
    Unknown(
        "b", "b", "half track of both platforms", "m", 0.02, 0.08,
        "Not in the paper. Narrower than the servo's own width of some 40 mm cannot be built, and "
        "160 mm would be as wide as the robot is long.",
        scale=1e3, shown_unit="mm",
    ),
    Unknown(
        "k", "k", "viscous friction of each wheel", "N s/m", 0.005, 2.0,
        "The printed 0.25 has no unit. The box spans from a robot that coasts for a minute to one "
        "that stops within a quarter of a second; flat in the logarithm, as its size is unknown.",
        log=True, shown_unit="N s/m",
    ),
    Unknown(
        "amplitude", "α2", "amplitude of Table 2's gait", "rad", 0.2, 1.4,
        "Table 2 does not give it. Its text varies the amplitude up to 1.4 rad; below 0.2 rad "
        "Table 3 has speeds of millimetres per second, not decimetres.",
        shown_unit="rad",
    ),
    Unknown(
        "force", "F", "dry friction of each wheel", "N", 0.0, 0.05,
        "Not in the paper. With a wheel load of 2 to 4 N, 0.05 N is a rolling resistance of 0.012 "
        "to 0.025, that of a soft tyre.",
        scale=1e3, shown_unit="mN",
    ),
    Unknown(
        "lag", "τ", "time constant of the servo", "s", 0.0, 0.3,
        "Not in the paper. A servo of this size follows within some tens of milliseconds; 0.3 s "
        "would halve the angle at T = 1 s.",
        scale=1e3, shown_unit="ms",
    ),
)  # fmt: skip

UNKNOWNS: Mapping[str, Unknown] = MappingProxyType({one.name: one for one in _ALL})


def values(names: Sequence[str], shares: Array) -> dict[str, Array]:
    """name -> values (K,) of points given as shares of their boxes (K, len(names))."""
    return {name: UNKNOWNS[name].value(shares[:, i]) for i, name in enumerate(names)}


def shares(names: Sequence[str], points: Mapping[str, ArrayLike]) -> Array:
    """The inverse of `values`: (K, len(names))."""
    return np.column_stack([UNKNOWNS[name].share(points[name]) for name in names])


Column = Literal["mean", "other"]
COLUMNS: tuple[Column, ...] = ("mean", "other")

FREEDOM = RUNS - 1
"""Degrees of freedom of each standard error."""

T_POINT = float(student.ppf(0.975, FREEDOM))
"""t of the printed intervals: 4.303."""

ROWS = (*TABLE_2, *TABLE_3)
"""The nine rows, Table 2 first."""

RATIO = np.array([row.ratio for row in ROWS])
PERIOD = np.array([row.period for row in ROWS])
AMPLITUDE = np.array([np.nan if row.amplitude is None else row.amplitude for row in ROWS])
"""rad; NaN where the paper does not give it: there the unknown `amplitude` stands."""

LABELS = tuple(
    f"Table 2, ratio {row.ratio:g}"
    if row.amplitude is None
    else f"Table 3, T = {row.period:g} s, α = {row.amplitude:g}"
    for row in ROWS
)


@dataclass(frozen=True)
class Measured:
    """Nine speeds, m/s, and their standard errors, m/s; both (9,)."""

    speed: Array
    error: Array


def measured(column: Column) -> Measured:
    """What was measured, if `column` is the measured one."""
    speed = np.array([getattr(row, column) for row in ROWS])
    return Measured(speed, np.array([row.half_width for row in ROWS]) / T_POINT)


_M1, _M2 = TABLE_1["m1"].value, TABLE_1["m2"].value
_I1, _I2 = TABLE_1["I10"].value, TABLE_1["I20"].value
REACH1, REACH2 = TABLE_1["c1 - a1"].value, TABLE_1["c2 - a2"].value
"""From P to the centres of mass, m."""

WHEEL_RADIUS = 0.02
"""m; does not matter, as k is given and not kappa."""


@dataclass(frozen=True)
class Reading:
    """How J20/J10 is taken: about which point, and by what it was changed.

    spread  of the loads to either side of platform 2's axis, m
    """

    about: About = "joint"
    by: By = "loads"
    spread: float = Loads.spread

    @property
    def words(self) -> str:
        """The reading as a person says it."""
        point = "the joint P" if self.about == "joint" else "each centre of mass"
        if self.by == "inertia":
            return f"about {point}, I20 alone changed"
        return f"about {point}, by loads {1e3 * self.spread:.0f} mm off the axis"


READINGS = (
    Reading(),
    Reading(spread=0.1),
    Reading(by="inertia"),
    Reading(about="centre", by="inertia"),
)
"""The first is the default. About the centres of mass loads cannot do it: the bare robot has
I20/I10 = 0.453, above every ratio printed, and loads only add to it."""


def parameters(unknowns: Mapping[str, Array], reading: Reading) -> Array:
    """The 13 values of `rr_opt.mechanics.kinematics.ROBOT_PARAMETERS` for K points and 9 rows.

    unknowns: a1, a2, b (m) and k (N s/m), (K,) each. Returns (13, 9 K), rows of a point together.
    """
    count = len(unknowns["a1"])
    a1, a2, b, k = (unknowns[name][:, None] for name in ("a1", "a2", "b", "k"))
    m2, I2, reach2 = platform2(reading)
    c2 = REACH2 + a2
    columns = (*(_M1, _I1, REACH1 + a1, a1, b, k), *(m2, I2, c2, c2 - reach2, b, k), WHEEL_RADIUS)
    return np.array([np.broadcast_to(column, (count, len(RATIO))).ravel() for column in columns])


def platform2(reading: Reading) -> tuple[Array, Array, Array]:
    """m (kg), I (kg m2) and distance from P to the centre of mass (m) in each row, (9,)."""
    ones = np.ones_like(RATIO)
    if reading.by == "inertia":
        if reading.about == "centre":
            return _M2 * ones, RATIO * _I1, REACH2 * ones
        return _M2 * ones, RATIO * (_I1 + _M1 * REACH1**2) - _M2 * REACH2**2, REACH2 * ones
    each = Loads(mass=TABLE_1["mass of one load"].value, distance=REACH2, spread=reading.spread)
    return hang(_M2, _I2, REACH2, each.each, load_counts(reading))


def load_counts(reading: Reading) -> Array:
    """How many loads, real numbers (9,), bring the joint inertia to each row's ratio."""
    mass = TABLE_1["mass of one load"].value
    wanted = RATIO * (_I1 + _M1 * REACH1**2)
    return (wanted - _I2 - _M2 * REACH2**2) / (mass * (REACH2**2 + reading.spread**2))


Law = Literal["student", "normal"]


def row_deviance(z: Array, law: Law) -> Array:
    """The part of each row, in the shape of z; infinite where z is not a number."""
    square = np.where(np.isnan(z), np.inf, z) ** 2
    return square if law == "normal" else (FREEDOM + 1) * np.log1p(square / FREEDOM)


def weight(z: Array, law: Law) -> Array:
    """What a row counts in a least-squares step: the slope of its deviance in z^2."""
    return np.ones_like(z) if law == "normal" else (FREEDOM + 1) / (FREEDOM + z**2)


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

_MODELS_ALL = (
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

MODELS: Mapping[str, Model] = MappingProxyType({one.name: one for one in _MODELS_ALL})
"""The paper's own law first; `cost` is that of a point, relative to its."""
