"""What is fitted: pieces of runs, the quantities that they share, and what is known of those."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property

import numpy as np

from rr_opt.diagnose.model import Array, Asked, Model, Piece, Quantity
from rr_opt.diagnose.normal import Normal, normal_of

_ALIKE = 150
"""So many samples of a misfit, 1.5 s at 100 Hz, count as one."""


def scaled(quantities: Sequence[Quantity], values: Mapping[str, float]) -> Array:
    """(value - where it starts)/scale."""
    return np.array([(values[q.name] - q.value) / q.scale for q in quantities])


def unscaled(quantities: Sequence[Quantity], u: Array) -> dict[str, float]:
    """The values, held inside their bounds."""
    return {
        q.name: float(min(max(q.value + q.scale * x, q.low), q.high))
        for q, x in zip(quantities, u, strict=True)
    }


class Problem:
    """The pieces of runs and the quantities of one fit; each piece has a start of its own."""

    def __init__(
        self,
        model: Model,
        pieces: Sequence[Piece],
        effects: tuple[str, ...],
        quantities: tuple[Quantity, ...],
        fixed: Mapping[str, float] | None = None,
    ) -> None:
        self.model, self.pieces, self.effects = model, tuple(pieces), effects
        self.quantities, self.fixed = quantities, dict(fixed or {})
        self.prior = np.array([float(q.known) for q in quantities])

    def normal(self, piece: Piece, values: Mapping[str, float], start: Array) -> Normal:
        """The linearised problem of a piece."""
        return self.normals(values, {piece: start})[piece]

    def normals(
        self, values: Mapping[str, float], starts: Mapping[Piece, Array], *, stray: bool = False
    ) -> dict[Piece, Normal]:
        """The linearised problems of pieces; `stray` takes in what no model of them has exactly."""
        names = tuple(q.name for q in self.quantities)
        grams = self.model.grams(self._asked(values, starts), self.effects, names, stray=stray)
        within = self.model.start_within
        # Of how far a run strays it is known that it is 0 to within 1.
        within = np.append(within, 1.0) if stray else within
        scale = np.array([*np.ones(within.size), *(q.scale for q in self.quantities), 1.0])
        out = {}
        for (piece, start), gram in zip(starts.items(), grams, strict=True):
            begun = np.append(start, 0.0) if stray else start
            out[piece] = normal_of(gram * np.outer(scale, scale), begun / within, 1 / within)
        return out

    def costs(
        self, values: Mapping[str, float], starts: Mapping[Piece, Array]
    ) -> dict[Piece, float]:
        """Chi-square of each piece, infinite where its prediction leaves the numbers."""
        out = {}
        every = self.model.off(self._asked(values, starts), self.effects)
        for (piece, start), off in zip(starts.items(), every, strict=True):
            known = start / self.model.start_within
            cost = float(np.vdot(off, off) + known @ known)
            out[piece] = cost if np.isfinite(cost) else np.inf
        return out

    def cost(self, values: Mapping[str, float], starts: Mapping[Piece, Array]) -> tuple[float, int]:
        """Chi-square of the data, infinite where a prediction leaves the numbers; their count."""
        return sum(self.costs(values, self.own(starts)).values()), self.count

    def own(self, starts: Mapping[Piece, Array]) -> dict[Piece, Array]:
        """The starts of its pieces."""
        return {piece: starts[piece] for piece in self.pieces}

    @cached_property
    def count(self) -> int:
        """How many values were recorded."""
        return recorded(self.model, self.pieces)

    def _asked(self, values: Mapping[str, float], starts: Mapping[Piece, Array]) -> list[Asked]:
        given = {**self.fixed, **values}
        return [Asked(piece, given, start) for piece, start in starts.items()]

    def beforehand(self, values: Mapping[str, float]) -> float:
        """Chi-square of what was known."""
        return float(self.prior @ scaled(self.quantities, values) ** 2)


def recorded(model: Model, pieces: Iterable[Piece]) -> int:
    """How many values were recorded of pieces."""
    seen = (model.runs[piece.run].values[piece.span] for piece in pieces)
    return sum(int(np.isfinite(values).sum()) for values in seen)


def doubt(cost: float, count: int) -> float:
    """By how much what was known counts for more while the data are not yet explained."""
    return max(1.0, 1.0 + _ALIKE * (cost / max(count, 1) - 1.0))


def box(quantities: Sequence[Quantity]) -> tuple[Array, Array]:
    """The bounds, scaled."""
    low = scaled(quantities, {q.name: q.low for q in quantities})
    return low, scaled(quantities, {q.name: q.high for q in quantities})
