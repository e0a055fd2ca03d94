"""The unknowns of the calibration, each with its box and the reason for it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from rr_opt.array import Array
from rr_opt.formatting import number
from rr_paper.publication import read_data


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
