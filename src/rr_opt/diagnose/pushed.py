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

from rr_opt.diagnose.model import Array, Piece
from rr_opt.diagnose.pushed_motion import FURTHER, pushed_motion
from rr_opt.diagnose.racer_protocol import Racer
from rr_opt.diagnose.racer_quantities import values_by, values_of
from rr_opt.diagnose.racer_state import by_start_of, state_of, v_of_z_by
from rr_opt.diagnose.shoot import DrivePath, DriveSlopes, predict, slopes

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
    mechanical = model.every(effects)
    system, motion = pushed_motion(mechanical)
    given = {**model.nominal, **values}
    names = motion.parameters[:-FURTHER]
    p = values_of(given, names)
    t = model.runs[piece.run].t[piece.span]
    path = model.drive_path(piece, given, mechanical)
    drives = _drives(pushes, t)
    moments = _moments(path, t)
    pushed_path = _with_drives(path, np.tensordot(amounts, drives, 1), moments)
    made = predict(system, pushed_path, state_of(mechanical, path, start, p), p)
    n, rows = len(wanted), len(path.at)
    by = np.hstack([values_by(given, names, wanted), np.zeros((p.size, len(pushes)))])
    at, middle = _at(drives, moments)
    drive_by = DriveSlopes(
        np.zeros((rows + FURTHER, t.size, by.shape[1])),
        np.zeros((rows + FURTHER, path.h.size, by.shape[1])),
    )
    own = model.drive_slopes(piece, given, mechanical, wanted)
    if own is not None:
        drive_by.at[:rows, :, :n], drive_by.middle[:rows, :, :n] = own.at, own.middle
    for there, push in ((drive_by.at, at), (drive_by.middle, middle)):
        there[rows:, :, n:] = push[:FURTHER]
        there[:2, :, n:] += push[FURTHER:]
    out = slopes(system, pushed_path, made, p, by, drive_by)
    by_value = out.by_parameter[:, :, :n]
    if motion.slips:
        moved = v_of_z_by(path, start, p, by[:, :n], own)
        by_value = by_value + out.by_start[:, :, 3:4] * moved
    return Pushed(
        made.seen,
        by_value,
        out.by_parameter[:, :, n:],
        by_start_of(out.by_start, start),
    )


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


def _at(drives: Array, moments: Array) -> tuple[Array, Array]:
    """Drives (k, 10, n), last index first: at the samples, and in the middle of the steps."""
    return drives.transpose(1, 2, 0), _finely(drives, moments[1::2]).transpose(1, 2, 0)


def _finely(drives: Array, moments: Array) -> Array:
    """Drives (..., n) at moments counted in samples."""
    before = np.minimum(moments.astype(int), drives.shape[-1] - 2)
    beyond = moments - before
    return drives[..., before] * (1 - beyond) + drives[..., before + 1] * beyond
