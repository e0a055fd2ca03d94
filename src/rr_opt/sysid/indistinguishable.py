"""Which names these recordings cannot tell apart.

The signature of an accepted effect is what it does to the recordings beside everything else that
was fitted. Other effects, one or two, may do the same: the fraction of the signature that is left
after the best fit by them, with parameters and starts re-fitted, is 0 where both are one thing to
these recordings. In chi-square it is what telling them apart rests on. No machine is exactly its
model, so a difference that so much misfit as is none (`FLOOR`) could make is no difference.

For a parameter that is not what it was believed to be the others are the parameters that would do
as well, if what is known of them were wrong.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import lsq_linear

from rr_opt.array import Array
from rr_opt.sysid.candidate import FLOOR, Chosen, Explanation, explain, joined
from rr_opt.sysid.least_squares import Fit, Problem, box, doubt, scaled, total
from rr_opt.sysid.model import Model, Quantity
from rr_opt.sysid.score_test import every, linear
from rr_opt.sysid.selection import Search
from rr_opt.sysid.values import wrong

CERTAIN = 20.0
"""So many units of chi-square, in terms of model error, tell two explanations apart."""


_FITS = 3
"""So many fits, at most, to confirm what is only linearised."""

_UNSEEN = 1e-9
"""Of what is seen best, each quantity in its own size: less than that is rounding."""


@dataclass(frozen=True)
class Alike:
    """Something that may be in the place of something accepted.

    accepted    the effect or parameter
    other       the effects, or the parameter, that would take its place
    left        fraction of the signature that they leave, linearised; NaN where only fits can tell
    separation  by how much worse they explain the recordings, chi-square
    fitted      whether that is from a fit, and not linearised
    """

    accepted: str
    other: tuple[str, ...]
    left: float
    separation: float
    fitted: bool = False


def groups(search: Search, best: Explanation) -> tuple[tuple[str, ...], ...]:
    """Groups of names that these recordings cannot tell apart, what was accepted first.

    Two effects that only together take the place of one are written `one + other`. What a
    linearised pass alone says is alike is fitted, as two effects may part where they are not small.
    """
    limit, fits = margin(best.whole), _FITS
    together: dict[str, list[str]] = {}
    met: dict[str, list[set[str]]] = {}
    for one in alike(search, best):
        names, before = together.setdefault(one.accepted, []), met.setdefault(one.accepted, [])
        # A pair with an effect that was judged alone adds nothing but the other.
        if one.separation >= limit or any(other <= set(one.other) for other in before):
            continue
        before.append(set(one.other))
        if best.chosen and not one.fitted and fits:
            fits -= 1
            if _refitted(search, best, one) >= limit:
                continue
        names.append(" + ".join(one.other))
    return tuple((accepted, *others) for accepted, others in together.items() if others)


def _refitted(search: Search, best: Explanation, one: Alike) -> float:
    """By how much worse the score is with something in the place of an accepted effect."""
    model = search.model
    rest = [chosen for chosen in best.chosen if chosen.name != one.accepted]
    forms = [[c for c in every(model) if c.name == name] for name in one.other]
    scores = []
    for other in itertools.product(*forms):
        fit = explain(model, (*rest, *other), search.nominal, best.windows)
        scores.append(Explanation((*rest, *other), fit, joined(model, fit)).score)
    return min(scores) - best.score


def margin(fit: Fit) -> float:
    """The chi-square below which two explanations are the same, for all that is known."""
    floor = FLOOR**2 * fit.count
    return CERTAIN * max(doubt(fit.cost, fit.count), doubt(fit.count + floor, fit.count))


def alike(search: Search, best: Explanation) -> tuple[Alike, ...]:
    """What could be in the place of what was accepted, the likest first."""
    if best.chosen:
        found = [one for name in best.names for one in _effects(search, best, name)]
    else:
        found = [one for q in wrong(best.whole) for one in _parameters(best.whole, q)]
    return tuple(sorted(found, key=lambda one: (len(one.other), one.separation)))


def _effects(search: Search, best: Explanation, name: str) -> list[Alike]:
    linearised = {one.other: one for one in _in_place(search.model, best, name)}
    rest = set(best.names) - {name}
    for tried in search.tried:
        if not rest <= set(tried.names) or name in tried.names:
            continue
        other = tuple(sorted(set(tried.names) - rest))
        if other:
            # What was fitted counts for more than what was only linearised.
            worse = max(tried.score - best.score, 0.0)
            left = linearised[other].left if other in linearised else math.nan
            known = linearised.get(other)
            if known is None or not known.fitted or worse < known.separation:
                linearised[other] = Alike(name, other, left, worse, fitted=True)
    return list(linearised.values())


def _in_place(model: Model, best: Explanation, name: str) -> list[Alike]:
    """Effects, one or two, in the place of an accepted one: one linearised pass over all."""
    fit, have = best.whole, set(best.names)
    new = [one for one in every(model) if one.name not in have and linear(model, one)]
    added = {one: one.of(model).quantities for one in new}
    own = tuple({q.name: q for qs in ((), *added.values()) for q in qs}.values())
    names = tuple(dict.fromkeys(one.name for one in new))
    pass_ = _Pass.of(model, fit, (*fit.effects, *names), own)
    its = [k for k, q in enumerate(pass_.quantities) if q.name.startswith(f"{name}.")]
    base = [k for k in range(len(fit.quantities)) if k not in its]
    place = {q.name: k for k, q in enumerate(pass_.quantities)}
    whole = pass_.left(base, its)
    out = []
    for count in (1, 2):
        for some in itertools.combinations(new, count):
            if len({one.name for one in some}) < count:
                continue
            others = [place[q.name] for one in some for q in added[one]]
            left = pass_.left([*base, *others], its)
            price = (len(others) - len(its)) * math.log(fit.count)
            fraction = math.sqrt(left / whole) if whole > 0 else math.nan
            out.append(Alike(name, _names(some), fraction, max(left + price, 0.0)))
    return _likest(out)


def _names(some: Sequence[Chosen]) -> tuple[str, ...]:
    return tuple(sorted({one.name for one in some}))


def _likest(found: Sequence[Alike]) -> list[Alike]:
    """Of an effect's forms, that which is most like."""
    ranked = sorted(found, key=lambda one: one.separation, reverse=True)
    return list({one.other: one for one in ranked}.values())


@dataclass(frozen=True)
class _Pass:
    """The linearised problem at a fit, by its quantities and those of effects that vanish there.

    moved  (n,) the quantities, scaled, from where they vanish
    """

    quantities: tuple[Quantity, ...]
    H: Array
    moved: Array
    low: Array
    high: Array

    @classmethod
    def of(
        cls, model: Model, fit: Fit, effects: tuple[str, ...], added: tuple[Quantity, ...]
    ) -> _Pass:
        """One pass over the runs."""
        quantities = (*fit.quantities, *added)
        values = {q.name: q.neutral for q in added} | dict(fit.values)
        problem = Problem(model, tuple(fit.starts), effects, quantities)
        normals = problem.normals(values, fit.starts).values()
        moved = np.array([(values[q.name] - q.neutral) / q.scale for q in quantities])
        low, high = box(quantities)
        u = scaled(quantities, values)
        H = total(normals, doubt(fit.cost, fit.count) * problem.prior, u).H
        return cls(quantities, H, moved, low - u, high - u)

    def left(self, free: Sequence[int], signature: Sequence[int]) -> float:
        """|signature|^2 that the best change of the free quantities leaves.

        The signature is the change of the prediction as the quantities of an effect go to where
        it vanishes; what is free makes up for it within its bounds.
        """
        gone, own = -self.moved[list(signature)], list(free)
        g = self.H[np.ix_(own, list(signature))] @ gone
        H = self.H[np.ix_(own, own)]
        whole = float(gone @ self.H[np.ix_(list(signature), list(signature))] @ gone)
        if not own:
            return whole
        # As least squares, |R d + R'^-1 g|^2 with R'R = H, inside the bounds; d = 0 is always
        # allowed. By eigenvalues, as what the runs hardly see may be below zero by rounding.
        size = np.sqrt(1e-9 + np.maximum(np.diag(H), 0.0))
        seen, V = np.linalg.eigh(H / np.outer(size, size))
        seen = np.sqrt(np.maximum(seen, _UNSEEN))[:, None]
        bounds = np.minimum(self.low[own], -1e-12), np.maximum(self.high[own], 1e-12)
        R, rest = seen * V.T * size, (V.T @ (g / size)) / seen[:, 0]
        d = lsq_linear(R, -rest, bounds, method="bvls").x
        return max(whole + 2 * float(g @ d) + float(d @ H @ d), 0.0)


def _parameters(fit: Fit, moved: Quantity) -> list[Alike]:
    """Parameters in the place of one, each without what is known of it."""
    own = [q.name for q in fit.quantities].index(moved.name)
    known, together = fit.prior, fit.total().H
    low, high = box(fit.quantities)
    u, out = fit.scaled, []
    off = np.where(np.arange(u.size) == own, u, 0.0)
    rest = [k for k in range(u.size) if k != own]
    whole = _Pass(fit.quantities, together, off, low - u, high - u).left(rest, [own])
    for k in rest:
        H = together - np.diag(np.where(np.arange(u.size) == k, known, 0.0))
        left = _Pass(fit.quantities, H, off, low - u, high - u).left(rest, [own])
        fraction = math.sqrt(left / whole) if whole > 0 else math.nan
        out.append(Alike(moved.name, (fit.quantities[k].name,), fraction, left))
    return out
