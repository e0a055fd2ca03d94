"""So many of so many, with the interval of the chance behind it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from scipy.stats import binomtest


@dataclass(frozen=True)
class Rate:
    """count of total cases."""

    count: int
    total: int

    @property
    def fraction(self) -> float | None:
        """None where there is no case."""
        return self.count / self.total if self.total else None

    @property
    def interval(self) -> tuple[float, float]:
        """95 % interval of the chance, Clopper and Pearson's, which covers at least that often."""
        if not self.total:
            return 0.0, 1.0
        found = binomtest(self.count, self.total).proportion_ci(0.95, method="exact")
        return float(found.low), float(found.high)

    @property
    def record(self) -> dict[str, Any]:
        """As plain data."""
        told = {"count": self.count, "total": self.total}
        return {**told, "fraction": self.fraction, "ci95": list(self.interval)}


def rate(flags: Iterable[bool]) -> Rate:
    """How many of the flags are set."""
    every = list(flags)
    return Rate(sum(every), len(every))
