"""The robot's parameters as columns that every stage fits along, held by what is known of them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rr_opt.diagnose.model import Array, Quantity
from rr_opt.diagnose.problem import doubt
from rr_opt.diagnose.stages.ports import linearised


def values_of(given: Mapping[str, float]) -> Array:
    """The numbers behind the linearised motion's parameters; kappa and h make k."""
    friction = {f"k{i}": given[f"kappa{i}"] / given["h"] ** 2 for i in (1, 2)}
    return np.array([(friction | dict(given))[name] for name in linearised()[0].parameters])


@dataclass(frozen=True)
class Known:
    """The parameters, at the values about which everything is linear.

    held  by how much what was known of them counts for more than one standard deviation
    """

    quantities: tuple[Quantity, ...]
    given: Mapping[str, float]
    held: float = 1.0

    def only(self, names: Sequence[str]) -> Known:
        """Some of them."""
        return replace(self, quantities=tuple(q for q in self.quantities if q.name in names))

    def moved(self, d: Array) -> Known:
        """At values changed by d (nq,) of the quantities' scales, inside their bounds."""
        moved = {
            q.name: min(max(self.given[q.name] + q.scale * float(x), q.low), q.high)
            for q, x in zip(self.quantities, d, strict=True)
        }
        return replace(self, given={**self.given, **moved})

    def changes(self) -> Array:
        """How the motion's numbers change with the quantities in their own scales (np, nq)."""
        out = []
        for q in self.quantities:
            step = 1e-4 * q.scale
            here = self.given[q.name]
            more, less = (values_of({**self.given, q.name: here + s * step}) for s in (1, -1))
            out.append((more - less) / 2e-4)
        return np.array(out).reshape(len(self.quantities), -1).T

    def prior(self, size: int) -> Array:
        """Products (size, size) of the rows that hold the quantities, the first of the columns."""
        rows = np.zeros((len(self.quantities), size))
        for k, q in enumerate(self.quantities):
            weight = float(q.known) * self.held**0.5
            rows[k, k] = weight
            rows[k, -1] = -weight * (self.given[q.name] - q.value) / q.scale
        return rows.T @ rows


def held(cost: float, count: int) -> float:
    """As `fit.doubt`, but 1 for all that noise alone may leave."""
    return doubt(cost - 3 * math.sqrt(2 * count), count)
