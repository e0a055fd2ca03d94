"""The state that a prediction begins in, from what a run's start is fitted as."""

from __future__ import annotations

from functools import lru_cache

import casadi as ca
import numpy as np

from rr_opt.diagnose.model import Array
from rr_opt.diagnose.shoot import DrivePath, DriveSlopes
from rr_opt.physics.floor_motion import floor_motion
from rr_opt.physics.kinematics import ROBOT_PARAMETERS


def state_of(effects: tuple[str, ...], path: DrivePath, start: Array, p: Array) -> Array:
    """The state that belongs to x, y, psi and z = v - g dphi, which is 0 of a robot at rest.

    Where the axles may slip it holds v, and they begin without: what they slip at first is over in
    milliseconds.
    """
    if not floor_motion(effects).slips:
        return start
    speeds = floor_motion().speeds
    v = float(speeds(start, path.at[:2, 0], p[: len(ROBOT_PARAMETERS)])[0])
    return np.array([*start[:3], v, 0.0, 0.0])


def v_of_z_by(
    path: DrivePath, start: Array, p: Array, by: Array, drive_by: DriveSlopes | None
) -> Array:
    """How the v that belongs to a start's z changes with what is asked for, (nw,)."""
    v_by = _v_by()
    known = len(ROBOT_PARAMETERS)
    slope = np.asarray(v_by(start, path.at[:2, 0], p[:known]))[0]
    own = slope[2:] @ by[:known]
    return own if drive_by is None else own + slope[:2] @ drive_by.at[:2, 0]


@lru_cache
def _v_by() -> ca.Function:
    """(state, drive, p) -> the derivatives of v by the drive and by p, (1, 2 + np)."""
    speeds = floor_motion().speeds
    state, drive, p = speeds.sx_in()
    by = ca.densify(ca.jacobian(speeds(state, drive, p)[0], ca.vertcat(drive, p)))
    return ca.Function("v_by", [state, drive, p], [by])
