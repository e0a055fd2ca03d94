"""Sensitivities of a predicted run: the motion linearised along it.

The matrices are evaluated for all steps at once over NumPy arrays, which needs no compiler, and
then multiplied up along the run.

A least-squares step needs J'J. J has the derivatives of the outputs, in sigmas, at every sample and
channel with data: by the initial state, by the wanted quantities, any further columns, and last the
residual.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.sysid.paths import DrivePath, DriveSlopes, Path, Sought
from rr_opt.sysid.shooting import System, arrays_of, code_of

Jacobian = tuple[Array, Array, Array]

_STEPS_AT_ONCE = 4000
"""Steps per array evaluation: fewer cost more calls, more cost memory."""


@dataclass(frozen=True)
class Slopes:
    """Derivatives of the outputs, (samples, channels, ...), by wanted quantities and by the initial
    state; and of the last state, (size, size + nw), by initial state and wanted quantities."""

    by_parameter: Array
    by_start: Array
    end: Array


@dataclass(frozen=True)
class Hats:
    """Rows of the drive that are moved by hat functions: 1 at one sample, 0 at its neighbours.

    passed  (steps,) fraction of the time between two samples that has passed in the middle of each
            step
    """

    rows: NDArray[np.int_]
    passed: Array


@dataclass(frozen=True)
class LinearMotion:
    """The linearised motion from sample to sample, and the linearised outputs.

    A (samples - 1, size, size);  B (samples - 1, size, nw) of the wanted quantities, followed by
    hats: all at the earlier sample, then all at the later
    by_state (samples, channels, size);  by_drive (samples, channels, drive);  by_wanted (.., nw)
    """

    A: Array
    B: Array
    by_state: Array
    by_drive: Array
    by_wanted: Array


@dataclass(frozen=True)
class Part:
    """A predicted path to linearise along, the drive's derivatives by the wanted quantities (None
    if it does not depend on them), and hats that move the drive."""

    path: DrivePath
    made: Path
    drive_by: DriveSlopes | None
    hats: Hats | None = None


def linear(
    system: System, parts: Sequence[Part], p: Array, wanted: Array
) -> Iterator[LinearMotion]:
    """The motion linearised along predicted paths. The drive depends on the same wanted quantities
    along all of them or along none; likewise with hats.

    wanted  (np, nw) derivatives of p by the wanted quantities
    """
    for some in _at_once(parts):
        yield from _linear(system, some, p, wanted)


def _at_once(parts: Iterable[Part]) -> Iterator[Sequence[Part]]:
    """Batches that are large enough to be worth a call and small enough for memory."""
    some, steps = [], 0
    for one in parts:
        some.append(one)
        steps += one.path.h.size
        if steps > _STEPS_AT_ONCE:
            yield some
            some, steps = [], 0
    if some:
        yield some


def _linear(
    system: System, parts: Sequence[Part], p: Array, wanted: Array
) -> Iterator[LinearMotion]:
    size, nd = parts[0].made.states.shape[0], parts[0].path.at.shape[0]
    A, B = _transitions(system, parts, p, wanted)
    at = np.hstack([one.made.states[:, :: one.path.each] for one in parts])
    drive = np.hstack([one.path.at for one in parts])
    channels = parts[0].made.seen.shape[1]
    by_state, by_drive, by_p = _split(
        arrays_of(system, "seen_by")(*at, *drive, *p), channels, nd, p.size, at.shape[1], size
    )
    by_wanted = by_p @ wanted
    if parts[0].drive_by is not None:
        moved = _joined([one.drive_by.at for one in parts if one.drive_by], 1)
        by_wanted[:, :, parts[0].drive_by.columns] += np.einsum("sid,dsw->siw", by_drive, moved)
    step = sample = 0
    for one in parts:
        steps, samples = one.path.h.size, one.path.at.shape[1]
        during, seen = slice(step, step + steps), slice(sample, sample + samples)
        a, b = A[during], B[during]
        for _ in range(int(np.log2(one.path.each))):
            a, b = a[1::2] @ a[::2], a[1::2] @ b[::2] + b[1::2]
        yield LinearMotion(a, b, by_state[seen], by_drive[seen], by_wanted[seen])
        step, sample = step + steps, sample + samples


def _joined(arrays: Sequence[Array], axis: int) -> Array:
    return arrays[0] if len(arrays) == 1 else np.concatenate(arrays, axis)


def slopes(
    system: System,
    path: DrivePath,
    made: Path,
    p: Array,
    wanted: Array,
    drive_by: DriveSlopes | None,
) -> Slopes:
    """Derivatives of the outputs along a predicted path; see `linear`."""
    (by,) = linear(system, [Part(path, made, drive_by)], p, wanted)
    (samples, _, size), nw = by.by_state.shape, wanted.shape[1]
    carried = np.empty((samples, size, size + nw))
    carried[0] = np.eye(size, size + nw)
    for k in range(samples - 1):
        np.matmul(by.A[k], carried[k], out=carried[k + 1])
        carried[k + 1, :, size:] += by.B[k]
    seen = by.by_state @ carried
    seen[:, :, size:] += by.by_wanted
    return Slopes(seen[:, :, size:], seen[:, :, :size], carried[-1])


def _transitions(
    system: System, parts: Sequence[Part], p: Array, wanted: Array
) -> tuple[Array, Array]:
    """The midpoint rule along the steps' chords, one path after the other: A (steps, size, size),
    B (steps, size, nw).

    With stiff states exp(z), z = h fx, is replaced by its Pade approximant
    (1 + z/3)/(1 - 2z/3 + z^2/6), which damps them.
    """
    h = np.concatenate([one.path.h for one in parts])[:, None, None]
    fx, force = _forces(system, parts, p, wanted)
    eye, z, push = np.eye(fx.shape[1]), h * fx, h * force
    if not system.stiff:
        return eye + z + z @ z / 2, push + z @ push / 2
    left = eye - 2 / 3 * z + z @ z / 6
    right = np.concatenate([eye + z / 3, push - z @ push / 6], axis=2)
    both = np.linalg.solve(left, right).astype(float)
    return both[:, :, : len(eye)], both[:, :, len(eye) :]


def _forces(system: System, parts: Sequence[Part], p: Array, wanted: Array) -> tuple[Array, Array]:
    """The rates' derivatives by the state (steps, size, size), and by the wanted quantities and
    the hats (steps, size, nw), in the middle of all steps."""
    states = [one.made.states for one in parts]
    middle = np.hstack([(x[:, :-1] + x[:, 1:]) / 2 for x in states])
    drive = _joined([one.path.nodes[:, 1] for one in parts], 1)
    by = arrays_of(system, "rates_by")(*middle, *drive, *p)
    fx, fd, fp = _split(by, len(middle), len(drive), p.size, middle.shape[1])
    force = fp @ wanted
    moved = [one.drive_by for one in parts if one.drive_by]
    if moved:
        by_drive = _joined([one.middle for one in moved], 1)
        force[:, :, moved[0].columns] += np.einsum("sid,dsw->siw", fd, by_drive)
    hats = [one.hats for one in parts if one.hats]
    if not hats:
        return fx, force
    hat = fd[:, :, hats[0].rows]
    later = hat * np.hstack([one.passed for one in hats])[:, None, None]
    return fx, np.concatenate([force, hat - later, later], axis=2)


def _split(parts, rows: int, nd: int, np_: int, count: int, nx: int | None = None) -> Jacobian:
    """The dense Jacobians (count, rows, ...) by state, drive and p from their entries."""
    nx = rows if nx is None else nx
    columns = nx + nd + np_
    dense = np.empty((count, rows, columns))
    for k, part in enumerate(parts):
        dense[:, k % rows, k // rows] = part
    return dense[:, :, :nx], dense[:, :, nx : nx + nd], dense[:, :, nx + nd :]


def grams(system: System, asked: Sequence[Sought]) -> list[tuple[Array, Array]]:
    """J'J (n, n) of each run, without samples where the prediction is not finite; and derivatives
    of its last state (size, size + nw) by initial state and wanted quantities."""
    if not asked:
        return []
    asked = [one.coarse for one in asked]
    code = code_of(system, 4 * sum(one.path.h.size for one in asked))
    return code.grams(asked) if code else [_gram(system, a) for a in asked]


def _gram(system: System, one: Sought) -> tuple[Array, Array]:
    by = slopes(system, one.path, one.made, one.p, one.wanted, one.drive_by)
    off = one.made.seen - one.recorded.values
    weight = np.where(np.isfinite(off), one.recorded.weight, 0.0)
    more = [] if one.more is None else [one.more]
    J = np.concatenate([by.by_start, by.by_parameter, *more, off[..., None]], axis=2)
    # Weights of 0 do not remove what is not finite.
    J = np.where(weight[..., None] > 0, J, 0.0) * weight[..., None]
    J = J.reshape(-1, J.shape[2])
    return J.T @ J, by.end
