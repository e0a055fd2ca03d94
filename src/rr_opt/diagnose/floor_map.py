"""What a patch of other floor would gain, wherever it lies, without a fit.

Every piece of a recording is cut into moments. The drag of one wheel in one moment is a push of its
own, and one linearised pass says what each changes of the motion. A patch brakes some wheels in
some moments, so what it would gain, parameters and starts fitted with it, is a matter of adding up.

Places and speeds are those recorded: with them a drag is right however strong it is, where
predicted ones would have the robot drive on.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.diagnose.fit import Fit
from rr_opt.diagnose.model import Array
from rr_opt.diagnose.normal import Normal, total
from rr_opt.diagnose.observed import Along, observed
from rr_opt.diagnose.pushed_motion import PUSHES
from rr_opt.diagnose.racer_protocol import Racer
from rr_opt.diagnose.residue_problem import Linearised, Point, linearised
from rr_opt.physics.effects.floor_patch import BORDER

_MOMENTS = 50
"""In each piece, at most."""

_SAMPLES = 5
"""In each moment, at least."""

_LEAST, _MOST = 0.02, 100.0
"""Multipliers that a patch may have."""

_AT_ONCE = 64
"""Patches, lest memory run out."""

Depth = Callable[[Array, Array], Array]
"""How deep inside a patch the places x, y are, m."""


@dataclass(frozen=True)
class FloorMap:
    """The pushes of all wheels in all moments, a moment's four wheels side by side, and their cost.

    places   of the wheels (2, 4, n), m;  begins  the sample in which each moment begins (moments,)
    slope    (4 moments,), by shares of drag, everything else fitted
    bends    second derivatives of each piece, to be weakened by `onto` (nq, 4 moments) as the
             parameters are fitted again: weakened = onto' inverse onto
    """

    places: Array
    begins: NDArray[np.int_]
    slope: Array
    bends: Sequence[Array]
    onto: Array
    inverse: Array

    def at(self, depth: Depth) -> Array:
        """How much of each moment each wheel is on a patch (4 moments,)."""
        inside = _inside(depth(*self.places))
        whole = np.add.reduceat(inside, self.begins, axis=1)
        lengths = np.diff(np.append(self.begins, inside.shape[1]))
        return (whole / lengths).T.ravel()

    def roughly(self, depth: Depth) -> Array:
        """The same, from where the wheels are in the middle of the moments."""
        ends = np.append(self.begins[1:], self.places.shape[2])
        return _inside(depth(*self.places[:, :, (self.begins + ends) // 2])).T.ravel()

    def gains(self, shares: Array) -> tuple[Array, Array]:
        """What patches gain in chi-square, each at its best multiplier, and that; (patches,).

        shares  of the moments on each patch (patches, 4 moments)
        """
        parts = [
            self._gains(shares[k : k + _AT_ONCE]) for k in range(0, max(len(shares), 1), _AT_ONCE)
        ]
        gain, multiplier = np.hstack(parts)
        return gain, multiplier

    def _gains(self, shares: Array) -> Array:
        bend, at = np.zeros(len(shares)), 0
        for H in self.bends:
            own = shares[:, at : at + len(H)]
            bend += np.einsum("ij,ij->i", own @ H, own)
            at += len(H)
        onto = shares @ self.onto.T
        bend -= np.einsum("ij,jk,ik->i", onto, self.inverse, onto)
        slope = shares @ self.slope
        more = np.where(bend > 0, -slope / np.where(bend > 0, bend, 1.0), 0.0)
        more = np.clip(more, _LEAST - 1.0, _MOST - 1.0) * (bend > 0)
        return np.array([-more * (2 * slope + bend * more), 1.0 + more])


def floor_map(model: Racer, fit: Fit) -> FloorMap:
    """The map beside a fit, over the pieces it was fitted over."""
    along = {
        piece: observed(model, piece, fit.values, fit.effects, start)
        for piece, start in fit.starts.items()
    }
    given = {**model.nominal, **fit.values}
    k = np.repeat([given["kappa1"], given["kappa2"]], 2) / given["h"] ** 2
    shortest = min(one.t.size for one in along.values())
    count = max(min(shortest // _SAMPLES, _MOMENTS), 1)
    pushes = {piece: _pushes(one, k, count) for piece, one in along.items()}
    none = np.zeros((4 * count, 4 * count))
    problem = linearised(
        model, fit, Point(fit.values, fit.starts, np.zeros(4 * count)), pushes, [none]
    )
    sizes = [one.t.size for one in along.values()]
    places = np.concatenate([one.places.transpose(1, 0, 2) for one in along.values()], axis=2)
    firsts = np.cumsum([0, *sizes[:-1]])
    begins = [first + _edges(n, count)[:-1] for first, n in zip(firsts, sizes, strict=True)]
    return _reduced(problem, list(problem.normals.values()), places, np.concatenate(begins))


def _reduced(
    problem: Linearised, parts: Sequence[Normal], places: Array, begins: NDArray[np.int_]
) -> FloorMap:
    """The pushes are each piece's own; the parameters, which all pieces share, are fitted."""
    n = problem.fitted
    shared = total(parts, problem.prior, problem.u)
    inverse = np.zeros((n, n))
    if n:
        inverse[:] = np.linalg.pinv(shared.H[:n, :n], hermitian=True)
    onto = np.hstack([one.H[:n, n:] for one in parts])
    slope = np.concatenate([one.g[n:] for one in parts])
    return FloorMap(
        places,
        begins,
        slope - onto.T @ (inverse @ shared.g[:n]),
        [one.H[n:, n:] for one in parts],
        onto,
        inverse,
    )


def _pushes(along: Along, k: Array, count: int) -> Array:
    """(4 count, 7, n): each wheel's drag, N, in each moment, as much as all the floor has."""
    edges = _edges(along.t.size, count)
    out = np.zeros((count, 4, len(PUSHES), along.t.size))
    for moment in range(count):
        during = slice(edges[moment], edges[moment + 1])
        for wheel in range(4):
            out[moment, wheel, wheel, during] = -k[wheel] * along.u[wheel, during]
    return out.reshape(4 * count, len(PUSHES), along.t.size)


def _edges(samples: int, count: int) -> NDArray[np.int_]:
    return np.linspace(0, samples, count + 1).astype(int)


def _inside(depth: Array) -> Array:
    return (1 + np.tanh(depth / BORDER)) / 2
