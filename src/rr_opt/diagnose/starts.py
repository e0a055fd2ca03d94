"""Fit the starts of pieces, each by itself and all side by side; the values stay as they are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from rr_opt.diagnose.fit import DONE, TRIES, UPHILL, Fit
from rr_opt.diagnose.model import Array, Piece
from rr_opt.diagnose.problem import Problem

_PARTS = (1.0, 0.6, 0.3, 0.1, 0.03, 0.01)
"""A step that leads uphill goes such a part of the way."""


@dataclass
class _Way:
    """A piece's start on the way to its best: where it is, the best so far, and their costs."""

    at: Array
    best: Array
    cost: float
    tries: int = 0
    part: int = 0
    ended: bool = False
    converged: bool = False

    def arrived(self, trial: Array, cost: float, done: float) -> None:
        """Take a step, or think better of it. Like a fit's, it may lead uphill for a few tries."""
        if cost < self.cost:
            self.ended = self.converged = self.cost - cost < max(done, 1e-6 * self.cost)
            self.at = self.best = trial
            self.cost, self.tries, self.part = cost, 0, max(self.part - 1, 0)
        elif self.tries < TRIES and cost < UPHILL * self.cost:
            self.at, self.tries = trial, self.tries + 1
        elif self.part + 1 < len(_PARTS):
            self.at, self.tries, self.part = self.best, 0, self.part + 1
        else:
            self.ended = self.converged = True


def fit_starts(
    problem: Problem, starts: Mapping[Piece, Array], *, steps: int = 16, done: float = DONE
) -> Fit:
    """The starts that fit each piece best, with the problem's fixed values and nothing else free.

    done  a step that would lower a piece's chi-square by less is its last
    """
    if problem.quantities:
        raise ValueError(f"Read {len(problem.quantities)} free quantities. Expected none.")
    own = problem.own(starts)
    ways = {p: _Way(own[p], own[p], cost) for p, cost in problem.costs({}, own).items()}
    normals = {}
    for _ in range(steps):
        open_ways = {piece: way for piece, way in ways.items() if not way.ended}
        if not open_ways:
            break
        fresh = {
            p: w.at for p, w in open_ways.items() if p not in normals or normals[p][0] is not w.at
        }
        for piece, normal in problem.normals({}, fresh).items():
            normals[piece] = fresh[piece], normal
        trials = {p: w.at + _PARTS[w.part] * normals[p][1].shift for p, w in open_ways.items()}
        for piece, cost in problem.costs({}, trials).items():
            ways[piece].arrived(trials[piece], cost, done)
    found = {piece: way.best for piece, way in ways.items()}
    fresh = {
        p: start for p, start in found.items() if p not in normals or normals[p][0] is not start
    }
    last = {piece: one for piece, (_, one) in normals.items()} | problem.normals({}, fresh)
    return Fit(
        problem.effects,
        (),
        problem.fixed,
        found,
        {piece: last[piece] for piece in found},
        sum(way.cost for way in ways.values()),
        problem.count,
        all(way.converged for way in ways.values()),
    )
