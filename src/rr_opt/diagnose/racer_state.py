"""The state that a prediction begins in, from what a run's start is fitted as."""

from __future__ import annotations

from functools import lru_cache

import casadi as ca
import numpy as np

from rr_opt.diagnose.linear import DriveSlopes
from rr_opt.diagnose.model import Array
from rr_opt.diagnose.shoot import DrivePath
from rr_opt.physics.floor_motion import floor_motion
from rr_opt.physics.kinematics import ROBOT_PARAMETERS
from rr_opt.robot.gait import Gait
from rr_opt.robot.parameters import Robot

HELD = 4
"""So many numbers of a start belong to a robot whose axles are held."""


def state_of(effects: tuple[str, ...], path: DrivePath, start: Array, p: Array) -> Array:
    """The state that belongs to a start: to x, y, psi, z = v - g dphi, and both axles' side speeds.

    z is 0 of a robot at rest. Where the axles may slip the state holds v instead, and where they
    may not there are no side speeds.
    """
    if not floor_motion(effects).slips:
        return start[:HELD]
    speeds = floor_motion().speeds
    v = float(speeds(start[:HELD], path.at[:2, 0], p[: len(ROBOT_PARAMETERS)])[0])
    return np.array([*start[: HELD - 1], v, *start[HELD:]])


def v_of_z_by(
    path: DrivePath, start: Array, p: Array, by: Array, drive_by: DriveSlopes | None
) -> Array:
    """How the v that belongs to a start's z changes with what is asked for, (nw,)."""
    v_by = _v_by()
    known = len(ROBOT_PARAMETERS)
    slope = np.asarray(v_by(start[:HELD], path.at[:2, 0], p[:known]))[0]
    own = slope[2:] @ by[:known]
    return own if drive_by is None else own + slope[:2] @ drive_by.at[:2, 0]


_MOMENT = 0.25
"""s, in which a parabola tells the speeds with which a piece begins."""


def side_speeds(robot: Robot, gait: Gait, t: Array, values: Array) -> Array:
    """Side speeds (2,) of both axles, m/s, at the first of the samples (n, channels) of a piece."""
    good = (t - t[0] <= _MOMENT) & np.isfinite(values[:, :3]).all(axis=1)
    if good.sum() < 2 * 3:
        return np.zeros(2)
    powers = np.vander(t[good] - t[0], 3, increasing=True)
    (_, _, psi), (vx, vy, w), _ = np.linalg.lstsq(powers, values[good, :3], rcond=None)[0]
    phi, dphi = float(gait.angle(t[0])), float(gait.rate(t[0]))
    ahead = psi, psi + phi
    to_left = [vy * np.cos(way) - vx * np.sin(way) for way in ahead]
    return np.array(
        [to_left[0] + robot.platform1.c * w, to_left[1] - robot.platform2.c * (w + dphi)]
    )


def by_start_of(by_state: Array, start: Array) -> Array:
    """Derivatives (n, channels, start) from those by the state that belongs to it."""
    held = start.size - by_state.shape[2]
    return np.pad(by_state, ((0, 0), (0, 0), (0, held)))


@lru_cache
def _v_by() -> ca.Function:
    """(state, drive, p) -> the derivatives of v by the drive and by p, (1, 2 + np)."""
    speeds = floor_motion().speeds
    state, drive, p = speeds.sx_in()
    by = ca.densify(ca.jacobian(speeds(state, drive, p)[0], ca.vertcat(drive, p)))
    return ca.Function("v_by", [state, drive, p], [by])
