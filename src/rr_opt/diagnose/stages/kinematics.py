"""Does the motion obey the axles? The side speed of each, from the measured motion alone.

v may be any smooth function of time here, so no force and no mass counts. What is left of x, y and
psi are two relations, one for each axle, which the lengths c1, c2 and the place of the tracked
point share. Each run is cut into windows with starts of their own.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from rr_opt.diagnose.model import Array
from rr_opt.diagnose.stages.depends import Variable
from rr_opt.diagnose.stages.gram import Gram, eliminated, products
from rr_opt.diagnose.stages.known import Known
from rr_opt.diagnose.stages.reference import Reference
from rr_opt.diagnose.stages.respond import missed, path_of, start_of, wiggled
from rr_opt.diagnose.stages.splines import columns, hats

WINDOW = 5.0
"""s."""

KNOTS_IN_PERIOD = 10
"""Of v in a period of the command."""

TOE, SLIP, POINT = 0.01, 1e-3, 1e-3
"""Units of the columns: rad, m/s, m."""

_LOADS = np.array([0.0, 0.3, 0.6, 0.8, 1.0])
"""Nodes of the side speed as a function of the side force, in its largest."""


def kinematic_gram(
    refs: Sequence[Reference],
    known: Known,
    variables: Sequence[Variable],
) -> Gram:
    """Blocks `lengths` (the known), `point` (dx, dy), `axle1`, `axle2`, axles by each variable."""
    most = side_forces(refs)
    sizes = {
        "lengths": len(known.quantities),
        "point": 2,
        "axle1": _LOADS.size,
        "axle2": _LOADS.size,
    }
    sizes |= {f"axle{i} by {x.name}": x.nodes.size for i in (1, 2) for x in variables}
    ends = np.cumsum([0, *sizes.values()])
    blocks = {name: slice(a, b) for name, a, b in zip(sizes, ends[:-1], ends[1:], strict=True)}
    total = known.prior(int(ends[-1]) + 1)
    count = 0
    by = known.changes()
    for ref in refs:
        own, seen = _of_run(ref, by, most, variables)
        total += own
        count += seen
    return Gram(total, blocks, ("lengths",), count)


def shift_gram(refs: Sequence[Reference], most: Sequence[float]) -> Array:
    """Products of how far `point`, `axle1` and `axle2` shift whole runs, v unchanged."""
    total: Array = np.zeros((2 + 2 * _LOADS.size, 2 + 2 * _LOADS.size))
    for ref in refs:
        span = slice(0, ref.t.size)
        sides = np.concatenate([_side(ref, i, axle(ref, i, most[i - 1])) for i in (1, 2)], axis=2)
        moved = path_of(ref, sides, span, held=True)[:, :3]
        C = np.concatenate([_point(ref), moved], axis=2) / ref.sigma[:, :3, None]
        L = start_of(ref, span, held=True)[:, :3] / ref.sigma[:, :3, None]
        seen = np.isfinite(ref.data[:, :3])
        total += products(L[seen], C[seen])
    return total


def side_forces(refs: Sequence[Reference]) -> list[float]:
    """The largest side force on each axle, N, but for a hundredth of the time."""
    return [
        float(np.percentile(np.abs(np.concatenate([ref.ports[f"side{i}"] for ref in refs])), 99))
        for i in (1, 2)
    ]


def _of_run(
    ref: Reference, by: Array, most: Sequence[float], variables: Sequence[Variable]
) -> tuple[Array, int]:
    wiggles = wiggled(ref)
    nb = wiggles.shape[2]
    pushes = [wiggles, np.einsum("nip,pq->niq", ref.by_p, by)]
    sides = [_side(ref, i, axle(ref, i, most[i - 1])) for i in (1, 2)]
    curves = [_side(ref, i, SLIP * x.columns(ref)) for i in (1, 2) for x in variables]
    pushes = np.concatenate([*pushes, *sides, *curves], axis=2)
    pushes[:, 3] = 0.0
    point = _point(ref)
    at = nb + by.shape[1]
    phi = np.column_stack([ref.free, np.zeros((ref.t.size, pushes.shape[2] - nb + 2)),
                           ref.data[:, 3] - ref.drive[0]]) / ref.sigma[:, 3, None]  # fmt: skip
    phi = phi[np.isfinite(phi).all(axis=1)]
    S, count = phi.T @ phi, len(phi)
    for span in _windows(ref.t):
        moved = path_of(ref, pushes[span], span, held=True)
        moved = np.concatenate([moved[:, :3, :at], point[span], moved[:, :3, at:]], axis=2)
        left = ref.data[span, :3] - ref.pose[span] - missed(ref, span, held=True)[:, :3]
        C = np.concatenate([moved, left[:, :, None]], axis=2) / ref.sigma[span, :3, None]
        L = _free(ref, span) / ref.sigma[span, :3, None]
        seen = np.isfinite(left)
        if seen.sum() > 2 * L.shape[2]:
            S += products(L[seen], C[seen])
            count += int(seen.sum())
    return eliminated(S, nb), count


def axle(ref: Reference, i: int, most: float) -> Array:
    """Side speeds (n, m) that a turned or slipping axle may have, m/s."""
    load = ref.ports[f"side{i}"] / most
    law = np.sign(load)[:, None] * hats(np.abs(load), _LOADS)[:, 1:]
    roll = ref.ports["v" if i == 1 else "u2"]
    return np.column_stack([TOE * roll, SLIP * law])


def _side(ref: Reference, i: int, speeds: Array) -> Array:
    out = np.zeros((ref.t.size, 4, speeds.shape[1]))
    for k, name in enumerate(("x", "y", "psi")):
        out[:, k] = ref.ports[f"{name}_by_s{i}"][:, None] * speeds
    return out


def _point(ref: Reference) -> Array:
    c, s = np.cos(ref.pose[:, 2]), np.sin(ref.pose[:, 2])
    zero = np.zeros_like(c)
    return POINT * np.array([[c, -s], [s, c], [zero, zero]]).transpose(2, 0, 1)


def _free(ref: Reference, span: slice) -> Array:
    t = ref.t[span]
    B = columns(t, max(ref.period / KNOTS_IN_PERIOD, 4 * float(np.median(np.diff(t)))))[0]
    pushes = np.zeros((t.size, 4, B.shape[1]))
    pushes[:, 3] = B
    moved = path_of(ref, pushes, span, held=True)
    return np.concatenate([start_of(ref, span, held=True), moved], axis=2)[:, :3]


def _windows(t: Array) -> list[slice]:
    count = max(round((t[-1] - t[0]) / WINDOW), 1)
    return [
        slice(a, b) for a, b in itertools.pairwise(np.linspace(0, t.size, count + 1).astype(int))
    ]
