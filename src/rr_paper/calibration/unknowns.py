"""The unknowns of the calibration, each with its box and the reason for it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from rr_opt.array import Array
from rr_opt.formatting import number


@dataclass(frozen=True)
class Unknown:
    """A quantity to be estimated; its prior is flat inside its box, in its logarithm if `log`.

    low, high  the box, in `unit`
    scale      factor from `unit` to `shown_unit`
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
        """The value in `shown_unit`."""
        return self.scale * np.asarray(value, float)

    def span(self, ends: tuple[float, float], digits: int = 2) -> str:
        """`-28 to 5 mm`; ends in SI."""
        low, high = (number(float(self.shown(end)), digits) for end in ends)
        return f"{low} to {high} {self.shown_unit}"

    @property
    def box(self) -> str:
        """The box as text."""
        return self.span((self.low, self.high))


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
        "Not in the paper. The servo alone is some 40 mm wide, so the track cannot be narrower; "
        "160 mm would be as wide as the robot is long.",
        scale=1e3, shown_unit="mm",
    ),
    Unknown(
        "k", "k", "viscous friction of each wheel", "N s/m", 0.005, 2.0,
        "The printed 0.25 has no unit. The box spans from a robot that coasts for a minute to one "
        "that stops within a quarter of a second; flat in the logarithm, as its magnitude is "
        "unknown.",
        log=True, shown_unit="N s/m",
    ),
    Unknown(
        "amplitude", "α2", "amplitude of Table 2's gait", "rad", 0.2, 1.4,
        "Table 2 does not give it. The text varies the amplitude up to 1.4 rad; below 0.2 rad "
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
