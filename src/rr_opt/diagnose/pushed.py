"""How the Roller Racer would move if something pushed it that the model lacks.

A push is a rolling force at a wheel, a side speed of an axle, or an error of the angle, as a small
function of time: what it does to a recording is linear in it. Any function of speed, place or
anything else is a function of time along the recorded path, so the motion answers to all of them
in one pass, the same way as it answers to the servo's drive.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rr_opt.diagnose.linear import DriveSlopes, Hats, Linear, linear
from rr_opt.diagnose.model import Array, Piece
from rr_opt.diagnose.pushed_motion import FURTHER, pushed_motion
from rr_opt.diagnose.racer_protocol import Racer
from rr_opt.diagnose.racer_quantities import values_by, values_of
from rr_opt.diagnose.racer_state import by_start_of, state_of, v_of_z_by
from rr_opt.diagnose.shoot import DrivePath, predict

_ANGLE = 6
"""The row of PUSHES that is the servo's own."""


@dataclass(frozen=True)
class Pushed:
    """A predicted run (n samples) and how it answers.

    predicted (n, 4);  by_value (n, 4, wanted);  by_push (n, 4, pushes);  by_start (n, 4, 4)
    """

    predicted: Array
    by_value: Array
    by_push: Array
    by_start: Array


def respond(
    model: Racer,
    piece: Piece,
    values: Mapping[str, float],
    effects: tuple[str, ...],
    start: Array,
    wanted: tuple[str, ...],
    pushes: Array,
    amounts: Array,
) -> Pushed:
    """Predict a piece of a run; derivatives by `wanted`, by each push, and by the start.

    pushes  (k, 7, n), rows as PUSHES;  amounts  (k,) how much of each there is
    """
    mechanical = model.simulated.every(effects)
    system, motion = pushed_motion(mechanical)
    given = {**model.nominal, **values}
    names = motion.parameters[:-FURTHER]
    p = values_of(given, names)
    t = model.runs[piece.run].t[piece.span]
    path = model.simulated.drive_path(piece, given, mechanical)
    drives = _drives(pushes, t)
    moments = _moments(path, t)
    pushed_path = _with_drives(path, np.tensordot(amounts, drives, 1), moments)
    made = predict(system, pushed_path, state_of(mechanical, path, start, p), p)
    by, own = (
        values_by(given, names, wanted),
        model.simulated.drive_slopes(piece, given, mechanical, wanted),
    )
    rows = len(path.at)
    hats = Hats(np.append(rows + np.arange(FURTHER), (0, 1)), _passed(moments, path.each))
    how = linear(system, pushed_path, made, p, by, own and _widened(own), hats)
    by_start, by_value, by_push = _carried(how, len(wanted), hats.rows, drives)
    if motion.slips:
        by_value = by_value + by_start[:, :, 3:4] * v_of_z_by(path, start, p, by, own)
    return Pushed(made.seen, by_value, by_push, by_start_of(by_start, start))


def _carried(
    how: Linear, wanted: int, rows: NDArray[np.int_], drives: Array
) -> tuple[Array, Array, Array]:
    """Derivatives of what is seen, (n, channels, ...), by the start, by what is wanted, and by
    pushes with DRIVES (k, 10, n)."""
    samples, _, size = how.by_state.shape
    at = np.ascontiguousarray(drives.transpose(2, 1, 0))
    earlier, later = np.split(how.B[:, :, wanted:], 2, axis=2)
    pushed = size + wanted
    carried = np.empty((samples, size, pushed + len(drives)))
    carried[0] = np.eye(size, pushed + len(drives))
    for k in range(samples - 1):
        now = carried[k + 1]
        np.matmul(how.A[k], carried[k], out=now)
        now[:, size:pushed] += how.B[k, :, :wanted]
        now[:, pushed:] += earlier[k] @ at[k] + later[k] @ at[k + 1]
    seen = how.by_state @ carried
    seen[:, :, size:pushed] += how.by_wanted
    seen[:, :, pushed:] += how.by_drive[:, :, rows] @ at
    return seen[:, :, :size], seen[:, :, size:pushed], seen[:, :, pushed:]


def _widened(own: DriveSlopes) -> DriveSlopes:
    """How the servo's own part of the drive changes, with the pushes' rows, which do not."""
    at, nodes = (
        np.concatenate([part, np.zeros((FURTHER, *part.shape[1:]))]) for part in (own.at, own.nodes)
    )
    return DriveSlopes(at, nodes)


def _passed(moments: Array, each: int) -> Array:
    """How much of the time between two samples has passed at each node of the steps (3, steps)."""
    steps = (moments.size - 1) // 2
    nodes = np.stack([moments[:-1:2], moments[1::2], moments[2::2]])
    return nodes - np.arange(steps) // each


def _drives(pushes: Array, t: Array) -> Array:
    """Pushes (k, 7, n) as DRIVES (k, 10, n): with the rates of change that go with them."""
    changes = np.gradient(pushes[:, 4:], t, axis=2)
    return np.concatenate(
        [pushes[:, :_ANGLE], changes[:, :2], pushes[:, _ANGLE:], changes[:, 2:]], axis=1
    )


def _moments(path: DrivePath, t: Array) -> Array:
    """Where beginning, middle and end of all steps are, counted in samples (2 steps + 1,)."""
    edges = t[0] + np.append(0.0, np.cumsum(path.h))
    both = np.empty(2 * path.h.size + 1)
    both[::2], both[1::2] = edges, (edges[1:] + edges[:-1]) / 2
    return np.interp(both, t, np.arange(t.size))


def _with_drives(path: DrivePath, drives: Array, moments: Array) -> DrivePath:
    """The servo's path with DRIVES (10, n), which are given at the samples."""
    fine = _finely(drives, moments)
    nodes = np.stack([fine[:, :-1:2], fine[:, 1::2], fine[:, 2::2]], axis=1)
    servo, at = path.nodes.copy(), path.at.copy()
    servo[:2] += nodes[FURTHER:]
    at[:2] += drives[FURTHER:]
    return replace(
        path,
        nodes=np.concatenate([servo, nodes[:FURTHER]]),
        at=np.vstack([at, drives[:FURTHER]]),
    )


def _finely(drives: Array, moments: Array) -> Array:
    """Drives (..., n) at moments counted in samples."""
    before = np.minimum(moments.astype(int), drives.shape[-1] - 2)
    beyond = moments - before
    return drives[..., before] * (1 - beyond) + drives[..., before + 1] * beyond
