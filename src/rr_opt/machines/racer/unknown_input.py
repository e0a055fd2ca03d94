"""How the Roller Racer would move if something pushed it that the model lacks.

A push is a rolling force at a wheel, a side speed of an axle, or an error of the angle, as a small
function of time: what it does to a recording is linear in it. Any function of speed, place or
anything else is a function of time along the recorded path, so the motion answers to all of them
in one pass, the same way as it answers to the servo's drive.

The linearised problem of a fit with all terms that may be missing, and what some of them leave.

The terms are functions of time along the recorded path, so that their size alone is unknown. What
is nonlinear is how far they carry the robot: the problem is linearised again where the best set of
terms leads.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import casadi as ca
import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag

from rr_opt.array import Array
from rr_opt.machines.racer.parameters import values_by, values_of
from rr_opt.machines.racer.simulation import Racer, by_start_of, state_of, stiff_states, v_of_z_by
from rr_opt.mechanics.kane import equations
from rr_opt.mechanics.kinematics import Force, Frame, Mechanism
from rr_opt.motion.dynamics import Assembly, assembled
from rr_opt.motion.floor_motion import FloorMotion, solved
from rr_opt.sysid.least_squares import (
    Fit,
    Normal,
    bounded_step,
    box,
    doubt,
    normal_of,
    scaled,
    total,
    unscaled,
)
from rr_opt.sysid.model import Piece
from rr_opt.sysid.sensitivities import DriveSlopes, Hats, Linear, gram_of, linear
from rr_opt.sysid.shooting import DrivePath, System, predict

PUSHES = ("wheel1l", "wheel1r", "wheel2l", "wheel2r", "side1", "side2", "angle")
"""Rolling force at each wheel (N), side speed of each axle (m/s), error of the angle (rad)."""

DRIVES = (*PUSHES[:6], "side1dot", "side2dot", "angle", "angledot")
"""What drives the motion beside the servo, a side speed and an angle with their rates of change."""

FURTHER = 8
"""So many of them are none of the servo's own."""

_SIDES = slice(4, 6)


@lru_cache
def pushed_motion(effects: tuple[str, ...]) -> tuple[System, FloorMotion]:
    """The motion with the pushes as further drives."""
    plain = assembled(effects, for_prediction=True)
    push = ca.SX.sym("push", FURTHER)
    motion = solved(
        Assembly(
            plain.effects,
            _pushed(plain.mechanism, push),
            plain.observation,
            (*plain.parameters, *DRIVES[:FURTHER]),
            ca.vertcat(plain.p, push),
        )
    )
    rows = motion.rates.size1_in(1)
    state, p = ca.SX.sym("state", motion.size), ca.SX.sym("p", plain.p.numel())
    drive = ca.SX.sym("drive", rows + FURTHER)
    inputs = [state, drive[:rows], ca.vertcat(p, drive[rows:])]
    rates, seen = (
        ca.Function(f.name(), [state, drive, p], [f(*inputs)])
        for f in (motion.rates, motion.observed)
    )
    return System(rates, seen, stiff_states(motion)), motion


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
        path, nodes=np.concatenate([servo, nodes[:FURTHER]]), at=np.vstack([at, drives[:FURTHER]])
    )


def _finely(drives: Array, moments: Array) -> Array:
    """Drives (..., n) at moments counted in samples."""
    before = np.minimum(moments.astype(int), drives.shape[-1] - 2)
    beyond = moments - before
    return drives[..., before] * (1 - beyond) + drives[..., before + 1] * beyond


Columns = NDArray[np.int_]

_LARGEST, _ROUGHEST = 30.0, 3.0
"""The functions, and their changes from knot to knot, in usual sizes, are about no larger."""


@dataclass(frozen=True)
class Linearised:
    """The problem by the fit's quantities and, after them, all terms' columns, at u, scaled.

    normals  by piece;  prior  weights of what is known, (n, n);  fitted  how many quantities;
    count    values in the recordings
    """

    normals: Mapping[Piece, Normal]
    u: Array
    prior: Array
    low: Array
    high: Array
    fitted: int
    count: int

    def left(self, columns: Columns) -> float:
        """Misfit of the runs, each predicted from the others: mean square in sigma, less 1."""
        every = list(self.normals.values())
        left = 0.0
        for n in every:
            others = [other for other in every if other is not n] or every
            left += n.at(self.step(others, columns))
        return left / max(self.count - 4 * len(every), 1) - 1.0

    def step(self, normals: Sequence[Normal], columns: Columns) -> Array:
        """The best change (n,) with some columns free and the others at zero."""
        own = self._own(columns)
        d = np.zeros(self.u.size)
        d[self.fitted :] = -self.u[self.fitted :]
        d[own] = 0.0
        whole = total(normals, self.prior, self.u)
        g = whole.g + whole.H @ d
        d[own] = bounded_step(
            whole.H[np.ix_(own, own)], g[own], 1e-9, self.u[own], self.low[own], self.high[own]
        )
        return d

    def cost(self, columns: Columns) -> float:
        """Chi-square of all runs at the best change."""
        d = self.step(list(self.normals.values()), columns)
        return sum(n.at(d) for n in self.normals.values())

    def curve(self, columns: Columns) -> tuple[Array, Array]:
        """The columns' values and their covariance, from all runs."""
        own, every = self._own(columns), list(self.normals.values())
        d = self.step(every, columns)
        wider = doubt(self.cost(columns), self.count)
        H = total(every, self.prior, self.u).H[np.ix_(own, own)]
        spread = np.asarray(wider * np.linalg.inv(H), float)
        return (self.u + d)[columns], spread[self.fitted :, self.fitted :]

    def _own(self, columns: Columns) -> Columns:
        return np.concatenate([np.arange(self.fitted), columns])


@dataclass(frozen=True)
class Point:
    """Where a problem is linearised: values, starts, and how much of each column there is."""

    values: Mapping[str, float]
    starts: Mapping[Piece, Array]
    amounts: Array


def linearised(
    model: Racer,
    fit: Fit,
    point: Point,
    pushes: Mapping[Piece, Array],
    weights: Sequence[Array],
    each: Callable[..., Iterable] = map,
) -> Linearised:
    """The problem at a point; the columns push (columns, 7, n) in each piece.

    weights  of each term's columns, against being rough
    """
    tasks = [_OfPiece(model, fit, point, piece, pushes[piece]) for piece in point.starts]
    done = list(each(_linearised, tasks))
    normals = {task.piece: normal for task, (normal, _, _) in zip(tasks, done, strict=True)}
    cost, count = sum(one[1] for one in done), sum(one[2] for one in done)
    added = point.amounts.size
    low, high = box(fit.quantities)
    known = np.array([float(q.known) for q in fit.quantities])
    return Linearised(
        normals,
        np.append(scaled(fit.quantities, point.values), point.amounts),
        doubt(cost, count)
        * np.asarray(block_diag(np.diag(known), *(_known(one) for one in weights))),
        np.append(low, np.full(added, -np.inf)),
        np.append(high, np.full(added, np.inf)),
        len(fit.quantities),
        count,
    )


@dataclass(frozen=True)
class _OfPiece:
    model: Racer
    fit: Fit
    point: Point
    piece: Piece
    pushes: Array


def _linearised(one: _OfPiece) -> tuple[Normal, float, int]:
    """A piece's problem, its chi-square and how many values it has."""
    model, piece, quantities = one.model, one.piece, one.fit.quantities
    names = tuple(q.name for q in quantities)
    scale = np.array([q.scale for q in quantities])
    within, start = model.start_within, one.point.starts[piece]
    values, amounts = one.point.values, one.point.amounts
    out = respond(model, piece, values, one.fit.effects, start, names, one.pushes, amounts)
    data = model.runs[piece.run]
    sigma = data.sigma[piece.span]
    r = (out.predicted - data.values[piece.span]) / sigma
    good = np.isfinite(r)
    by_value, by_push, by_start = (
        (part / sigma[:, :, None])[good] for part in (out.by_value, out.by_push, out.by_start)
    )
    gram = gram_of(by_start, by_value * scale, by_push, r[good])
    normal = normal_of(gram, start / within, 1 / within)
    return normal, float(r[good] @ r[good]), int(good.sum())


def _known(weights: Array) -> Array:
    """Weights of a term's columns, which are neither huge nor rough."""
    return np.eye(len(weights)) / _LARGEST**2 + weights / _ROUGHEST**2


def moved(fit: Fit, point: Point, problem: Linearised, columns: Columns) -> Point:
    """Where the best set of columns leads."""
    d = problem.step(list(problem.normals.values()), columns)
    u = problem.u + d
    starts = {
        piece: point.starts[piece] + n.shift + n.follow @ d for piece, n in problem.normals.items()
    }
    values = dict(point.values) | unscaled(fit.quantities, u[: problem.fitted])
    return Point(values, starts, u[problem.fitted :])
