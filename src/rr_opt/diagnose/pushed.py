"""How the Roller Racer would move if something pushed it that the model lacks.

A push is a rolling force at a wheel, a side speed of an axle, or an error of the angle, as a small
function of time: what it does to a recording is linear in it. Any function of speed, place or
anything else is a function of time along the recorded path, so the motion answers to all of them
in one pass, the same way as it answers to the servo's drive.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING

import casadi as ca
import numpy as np
from scipy.signal import savgol_filter

from rr_opt.diagnose.model import Array, Piece
from rr_opt.diagnose.racer_quantities import values_by, values_of
from rr_opt.diagnose.racer_state import state_of, v_of_z_by
from rr_opt.diagnose.shoot import DrivePath, DriveSlopes, System, predict, slopes
from rr_opt.physics.assembly import Assembly, assembled
from rr_opt.physics.floor_motion import FloorMotion, solved
from rr_opt.physics.kane import equations
from rr_opt.physics.kinematics import Force, Frame, Mechanism

if TYPE_CHECKING:
    from rr_opt.diagnose.racer import RollerRacer

PUSHES = ("wheel1l", "wheel1r", "wheel2l", "wheel2r", "side1", "side2", "angle")
"""Rolling force at each wheel (N), side speed of each axle (m/s), error of the angle (rad)."""

_SIDES, _ANGLE = slice(4, 6), 6
_DRIVES = (*PUSHES[:6], "side1dot", "side2dot", "angle", "angledot")
"""What drives the motion beside the servo, a side speed and an angle with their rates of change."""

_FURTHER = 8
"""So many of them are none of the servo's own."""

_WINDOW = 0.5
"""What the prediction is off changes little over so long a time, s."""


@dataclass(frozen=True)
class Along:
    """What a push may depend on, along a predicted run of n samples.

    t (n,) s;  x, y (n,) m of the joint and psi (n,) rad;  phi, dphi, ddphi (n,) rad, rad/s, rad/s2
    u       rolling speed of the wheels (4, n), in the order of PUSHES, m/s
    w       yaw rate of platform 1 and 2 (2, n), rad/s
    rolled  how far the wheels rolled since the recording began (4, n), m
    places  of the wheels on the floor (4, 2, n), m
    """

    t: Array
    x: Array
    y: Array
    psi: Array
    phi: Array
    dphi: Array
    ddphi: Array
    u: Array
    w: Array
    rolled: Array
    places: Array

    @property
    def axles(self) -> Array:
        """The rolling speed of axle 1 and 2 (2, n), m/s."""
        return (self.u[::2] + self.u[1::2]) / 2


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
    model: RollerRacer,
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
    system, motion = _system(mechanical)
    given = {**model.nominal, **values}
    names = motion.parameters[:-_FURTHER]
    p = values_of(given, names)
    t = model.runs[piece.run].t[piece.span]
    path = model.drive_path(piece, given, mechanical)
    drives = _drives(pushes, t)
    pushed_path = _with_drives(path, np.tensordot(amounts, drives, 1))
    made = predict(system, pushed_path, state_of(mechanical, path, start, p), p)
    n, rows = len(wanted), len(path.at)
    by = np.hstack([values_by(given, names, wanted), np.zeros((p.size, len(pushes)))])
    at, middle = _at(drives, path.h.size)
    drive_by = DriveSlopes(
        np.zeros((rows + _FURTHER, t.size, by.shape[1])),
        np.zeros((rows + _FURTHER, path.h.size, by.shape[1])),
    )
    own = model.drive_slopes(piece, given, mechanical, wanted)
    if own is not None:
        drive_by.at[:rows, :, :n], drive_by.middle[:rows, :, :n] = own.at, own.middle
    for there, push in ((drive_by.at, at), (drive_by.middle, middle)):
        there[rows:, :, n:] = push[:_FURTHER]
        there[:2, :, n:] += push[_FURTHER:]
    out = slopes(system, pushed_path, made, p, by, drive_by)
    by_value = out.by_parameter[:, :, :n]
    if motion.slips:
        moved = v_of_z_by(path, start, p, by[:, :n], own)
        by_value = by_value + out.by_start[:, :, 3:4] * moved
    return Pushed(
        made.seen,
        by_value,
        out.by_parameter[:, :, n:],
        out.by_start[:, :, : start.size],
    )


def observed(
    model: RollerRacer,
    piece: Piece,
    values: Mapping[str, float],
    effects: tuple[str, ...],
    start: Array,
) -> Along:
    """The motion that was recorded: the prediction, and the smooth part of what it is off."""
    mechanical = model.every(effects)
    system, motion = _system(mechanical)
    given = {**model.nominal, **values}
    p = values_of(given, motion.parameters[:-_FURTHER])
    data = model.runs[piece.run]
    t = data.t[piece.span]
    path = model.drive_path(piece, given, mechanical)
    still = _with_drives(path, np.zeros((len(_DRIVES), t.size)))
    made = predict(system, still, state_of(mechanical, path, start, p), p)
    pose, rate = _smooth(t, made.seen[:, :3], data.values[piece.span, :3])
    states = made.states[:, :: path.each]
    _, s1, s2, w = np.array(
        motion.speeds.map(t.size)(states, path.at, np.append(p, np.zeros(_FURTHER)))
    )
    phi, dphi = path.at[:2]
    v = rate[0] * np.cos(pose[2]) + rate[1] * np.sin(pose[2])
    u = np.array(_rolling(mechanical).map(t.size)(np.array([v, s1, s2, dphi]), phi, p))
    places = np.array(_places(mechanical).map(t.size)(pose, phi, p)).reshape(4, 2, t.size)
    steps = np.diff(t) * (u[:, 1:] + u[:, :-1]) / 2
    return Along(
        t=t,
        x=pose[0],
        y=pose[1],
        psi=pose[2],
        phi=phi,
        dphi=dphi,
        ddphi=np.gradient(dphi, t),
        u=u,
        w=np.array([w, w + dphi]),
        rolled=np.concatenate([np.zeros((4, 1)), np.cumsum(steps, axis=1)], axis=1),
        places=places,
    )


def _smooth(t: Array, predicted: Array, seen: Array) -> tuple[Array, Array]:
    """What was seen (n, k), without its noise, and its rate of change, both (k, n)."""
    step = float(np.median(np.diff(t)))
    window = max(2 * round(_WINDOW / step / 2) + 1, 5)
    off = seen - predicted
    for column in off.T:
        good = np.isfinite(column)
        column[~good] = np.interp(t[~good], t[good], column[good])
    about = {"window_length": window, "polyorder": 2, "axis": 0, "delta": step}
    rate = np.gradient(predicted, t, axis=0) + np.asarray(savgol_filter(off, deriv=1, **about))
    return (predicted + np.asarray(savgol_filter(off, **about))).T, rate.T


def _drives(pushes: Array, t: Array) -> Array:
    """Pushes (k, 7, n) as _DRIVES (k, 10, n): with the rates of change that go with them."""
    changes = np.gradient(pushes[:, 4:], t, axis=2)
    return np.concatenate(
        [pushes[:, :_ANGLE], changes[:, :2], pushes[:, _ANGLE:], changes[:, 2:]], axis=1
    )


def _with_drives(path: DrivePath, drives: Array) -> DrivePath:
    """The servo's path with _DRIVES (10, n), which are given at the samples."""
    fine = _finely(drives, path.h.size)
    nodes = np.stack([fine[:, :-1:2], fine[:, 1::2], fine[:, 2::2]], axis=1)
    servo, at = path.nodes.copy(), path.at.copy()
    servo[:2] += nodes[_FURTHER:]
    at[:2] += drives[_FURTHER:]
    return replace(
        path,
        nodes=np.concatenate([servo, nodes[:_FURTHER]]),
        at=np.vstack([at, drives[:_FURTHER]]),
    )


def _at(drives: Array, steps: int) -> tuple[Array, Array]:
    """Drives (k, 10, n), last index first: at the samples, and in the middle of the steps."""
    fine = np.array([_finely(one, steps)[:, 1::2] for one in drives])
    middle = fine.reshape(len(drives), len(_DRIVES), steps)
    return drives.transpose(1, 2, 0), middle.transpose(1, 2, 0)


def _finely(drives: Array, steps: int) -> Array:
    """Drives (10, n) at the beginning, middle and end of all steps (10, 2 steps + 1)."""
    samples = np.arange(drives.shape[1])
    inner = np.linspace(0, samples[-1], 2 * steps + 1)
    return np.array([np.interp(inner, samples, row) for row in drives])


@lru_cache
def _rolling(effects: tuple[str, ...]) -> ca.Function:
    """(speeds, phi, p) -> the rolling speeds of the wheels (4,), m/s."""
    assembly = assembled(effects, sharp=True)
    robot = assembly.mechanism
    rolling = ca.vertcat(*(robot.rolling_speed(wheel) for wheel in robot.wheels))
    return ca.Function("rolling", [robot.speeds, robot.phi, assembly.p], [rolling])


@lru_cache
def _places(effects: tuple[str, ...]) -> ca.Function:
    """(pose, phi, p) -> x, y of the wheels on the floor, one wheel after the other (8,), m."""
    assembly = assembled(effects, sharp=True)
    robot = assembly.mechanism
    places = ca.vertcat(*(robot.on_floor(wheel.platform, wheel.point) for wheel in robot.wheels))
    return ca.Function("places", [robot.pose, robot.phi, assembly.p], [places])


@lru_cache
def _system(effects: tuple[str, ...]) -> tuple[System, FloorMotion]:
    """The motion with the pushes as further drives."""
    plain = assembled(effects, sharp=True)
    push = ca.SX.sym("push", _FURTHER)
    motion = solved(
        Assembly(
            plain.effects,
            _pushed(plain.mechanism, push),
            plain.seen,
            (*plain.parameters, *_DRIVES[:_FURTHER]),
            ca.vertcat(plain.p, push),
        )
    )
    rows = motion.rates.size1_in(1)
    state, p = ca.SX.sym("state", motion.size), ca.SX.sym("p", plain.p.numel())
    drive = ca.SX.sym("drive", rows + _FURTHER)
    inputs = [state, drive[:rows], ca.vertcat(p, drive[rows:])]
    rates, seen = (
        ca.Function(f.name(), [state, drive, p], [f(*inputs)]) for f in (motion.rates, motion.seen)
    )
    return System(rates, seen, len(motion.free) if motion.slips else 0), motion


def _pushed(robot: Mechanism, push: ca.SX) -> Mechanism:
    pushes = [
        Force(wheel.platform, wheel.point, push[k] * wheel.direction)
        for k, wheel in enumerate(robot.wheels)
    ]
    sides = robot.speeds[1:3]
    moved = sides + push[_SIDES]

    def slid(part: ca.SX) -> ca.SX:
        return ca.substitute(part, sides, moved)

    # What it takes to speed up sideways is felt along axle 1, which v moves at one to one.
    kane = equations(robot)
    felt = ca.jacobian(kane.needed[0], kane.udot[1:3]) @ push[6:8]
    first = robot.wheels[0]
    pushes.append(Force(1, ca.SX.zeros(2), -felt * first.direction))
    return replace(
        robot,
        frames={i: Frame(slid(f.origin), slid(f.rate)) for i, f in robot.frames.items()},
        rotors=tuple(replace(rotor, rate=slid(rotor.rate)) for rotor in robot.rotors),
        forces=(*(replace(f, vector=slid(f.vector)) for f in robot.forces), *pushes),
    )
