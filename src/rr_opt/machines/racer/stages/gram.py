"""Least squares of many blocks of columns at once, and the chi-square that each block is worth.

The data residuals are white noise where nothing is wrong, so what a block lowers the sum of squares
by, with the rest fitted along, is chi-square with as many degrees of freedom as it adds to the rank
(a Lagrange multiplier test). That the path's own errors are correlated in time does not matter: it
is the data, not the path, that are noisy.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import chi2

from rr_opt.array import Array
from rr_opt.machines.racer.stages.reference import linearised
from rr_opt.sysid.least_squares import doubt
from rr_opt.sysid.model import Quantity

_RANK = 1e-9
"""Of a scaled block's largest eigenvalue: less is no direction of its own."""


@dataclass(frozen=True)
class Worth:
    """Chi-square that a block lowers the cost by, and its degrees of freedom."""

    chi2: float
    dof: int

    @property
    def p(self) -> float:
        """Of no fault."""
        return float(chi2.sf(self.chi2, self.dof)) if self.dof else 1.0

    @property
    def beyond(self) -> float:
        """Chi-square beyond what noise gives."""
        return max(self.chi2 - self.dof, 0.0)


@dataclass(frozen=True)
class Gram:
    """Products of all columns, the last of which is the residual.

    blocks  columns by name;  always  the blocks that are fitted along in every test
    count   of data
    """

    S: Array
    blocks: Mapping[str, slice]
    always: tuple[str, ...]
    count: int

    def worth(self, block: str, beside: Sequence[str] = ()) -> Worth:
        """Of a block, with the blocks `beside` it fitted along with and without it."""
        less, rank0 = self._cost((*self.always, *beside))
        more, rank1 = self._cost((*self.always, *beside, block))
        return Worth(max(less - more, 0.0), rank1 - rank0)

    def together(self, blocks: Sequence[str]) -> Worth:
        """Of several blocks at once."""
        less, rank0 = self._cost(self.always)
        more, rank1 = self._cost((*self.always, *blocks))
        return Worth(max(less - more, 0.0), rank1 - rank0)

    def fitted(self, blocks: Sequence[str], beside: Sequence[str] = ()) -> tuple[Array, Array]:
        """The coefficients (m,) of blocks, and their covariance (m, m)."""
        k, half = self._half(tuple(dict.fromkeys((*self.always, *beside, *blocks))))
        inverse = half @ half.T
        own = [self.blocks[name] for name in blocks]
        place = [k.index(i) for part in own for i in range(part.start, part.stop)]
        return (inverse @ self.S[k, -1])[place], inverse[np.ix_(place, place)]

    def _cost(self, names: Sequence[str]) -> tuple[float, int]:
        k, half = self._half(names)
        return float(self.S[-1, -1] - np.sum((half.T @ self.S[k, -1]) ** 2)), half.shape[1]

    def _half(self, names: Sequence[str]) -> tuple[list[int], Array]:
        """Which columns, and a root (m, rank) of their products' inverse."""
        k = [i for name in names for i in range(self.blocks[name].start, self.blocks[name].stop)]
        if not k:
            return k, np.zeros((0, 0))
        H = self.S[np.ix_(k, k)]
        size = np.sqrt(np.maximum(np.diag(H), 1e-300))
        values, vectors = np.linalg.eigh(H / np.outer(size, size))
        kept = values > _RANK * values.max()
        return k, vectors[:, kept] / np.sqrt(values[kept]) / size[:, None]


def products(L: Array, C: Array) -> Array:
    """Products of the columns C (n, m), with their share of the columns L (n, l) taken out."""
    both = np.concatenate([L, C], axis=1)
    return eliminated(both.T @ both, L.shape[1])


def eliminated(S: Array, first: int) -> Array:
    """Products of columns with the first ones of them fitted along."""
    if not first:
        return S
    A, B = S[:first, :first], S[:first, first:]
    size = np.sqrt(np.maximum(np.diag(A), 1e-300))
    values, vectors = np.linalg.eigh(A / np.outer(size, size))
    kept = values > 1e-12 * values.max()
    half = (vectors[:, kept] / np.sqrt(values[kept])).T @ (B / size[:, None])
    return S[first:, first:] - half.T @ half


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
