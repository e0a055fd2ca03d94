"""The Roller Racer's response to inputs that the model lacks.

Such a push is a rolling force at a wheel, a side speed of an axle, or an error of the angle, as a
small function of time: its effect on a recording is linear. Any function of speed, place or
anything else is a function of time along the recorded path, so one linearised pass gives the
response to all of them, as to the servo's drive. Each channel, a place where a force or a motion
can enter, is tried with each variable, as a few functions of it along the recorded path.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import islice

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.machines.racer.model import RacerModel
from rr_opt.machines.racer.observed import Along, observed
from rr_opt.machines.racer.parameters import values_by, values_of
from rr_opt.machines.racer.simulation import stiff_states
from rr_opt.mechanics.kane import equations
from rr_opt.mechanics.kinematics import Force, Frame, Mechanism
from rr_opt.motion.dynamics import Assembly, assembled
from rr_opt.motion.floor_motion import FloorMotion, solved
from rr_opt.sysid.estimation import Fit
from rr_opt.sysid.machine import CONSTANT, Term
from rr_opt.sysid.model import Linearisation, Request, Segment
from rr_opt.sysid.paths import DrivePath, DriveSlopes
from rr_opt.sysid.sensitivities import Hats, LinearMotion, Part, linear
from rr_opt.sysid.shooting import System

PUSHES = ("wheel1l", "wheel1r", "wheel2l", "wheel2r", "side1", "side2", "angle")
"""Rolling force at each wheel (N), side speed of each axle (m/s), error of the angle (rad)."""

DRIVES = (*PUSHES[:6], "side1dot", "side2dot", "angle", "angledot", "angledotdot")
"""Drives of the motion beside the servo: side speeds and the angle with their rates of change, the
last of which only wheels that slip feel."""

FURTHER = 8
"""How many of them are not the servo's own."""

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


def linearised_inputs(
    racer: RacerModel,
    requests: Sequence[Request],
    effects: tuple[str, ...],
    wanted: tuple[str, ...],
    inputs: Sequence[Array],
    pieces: int = 1,
) -> Iterator[Linearisation]:
    """Segments, all with the same values, linearised about zero inputs: in the initial state, the
    wanted quantities and the inputs.

    inputs  (k, 7, n) of each segment, rows as PUSHES
    pieces  into which a segment is cut: inputs act in one of them each, a piece's k side by side;
            their rates of change are those of the inputs before the cut

    The response to a push takes one step from sample to sample, which is fine enough but where the
    wheels slide.
    """
    simulator = racer.simulator
    mechanical = simulator.every(effects)
    system, motion = pushed_motion(mechanical)
    given = simulator.given(requests[0].values)
    names = motion.parameters[:-FURTHER]
    p, by = values_of(given, names), values_by(given, names, wanted)
    every, parts = [], []
    simulated = simulator.paths(requests, effects)
    for request, pushes, (fine, predicted, *_) in zip(requests, inputs, simulated, strict=True):
        segment, each = request.segment, fine.each
        path, made = fine.coarser(each), predicted.coarser(each)
        t = racer.runs[segment.run].t[segment.span]
        moments = _moments(path, t)
        plain = _widened_path(path)
        own = simulator.drive_slopes(segment, given, mechanical, wanted)
        rows = np.roll(np.arange(len(plain.at)), FURTHER)
        every.append((pushes, t))
        own = own and _widened(own.coarser(each))
        parts.append(Part(plain, made, own, Hats(rows, _passed(moments))))
    motions = zip(requests, parts, every, linear(system, parts, p, by), strict=True)
    columns = len(wanted) + pieces * len(inputs[0])
    while some := [*islice(motions, max(_COLUMNS_AT_ONCE // max(columns, 1), 1))]:
        pushed = [_with_inputs(how, _drives(*drives), pieces) for *_, drives, how in some]
        made = []
        for (request, part, *_), (how, _), own in zip(some, pushed, _carried(pushed), strict=True):
            recorded = simulator.recorded(request.segment)
            made.append(_linearised(how, own, recorded.weight, recorded.off(part.made.seen)))
        grams, ends = map(np.array, zip(*made, strict=True))
        yield from map(Linearisation, *_whole(grams, ends, len(wanted)))


_COLUMNS_AT_ONCE = 1000
"""Columns of segments side by side, to bound the memory."""


def cut(samples: int, pieces: int) -> NDArray[np.int_]:
    """The samples with which equal pieces of a segment begin, and its end (pieces + 1,)."""
    return np.linspace(0, samples, pieces + 1).astype(int)


def _with_inputs(how: LinearMotion, drives: Array, pieces: int) -> tuple[LinearMotion, Array]:
    """The motion with inputs as DRIVES (k, 11, n) among the wanted quantities; and what those of a
    piece have done by its first sample (pieces, size, k)."""
    wanted = how.by_wanted.shape[2]
    rows = how.by_drive.shape[2]
    at = np.ascontiguousarray(drives[:, :rows].transpose(2, 1, 0))
    earlier, later = np.split(how.B[:, :, wanted:], 2, axis=2)
    late = later @ at[1:]
    before = cut(len(at), pieces)[1:-1] - 1
    begun = np.concatenate([np.zeros((1, *late.shape[1:])), late[before]])
    late[before] = 0.0
    B = np.concatenate([how.B[:, :, :wanted], earlier @ at[:-1] + late], axis=2)
    direct = np.roll(how.by_drive, FURTHER, axis=2) @ at
    by_wanted = np.concatenate([how.by_wanted, direct], axis=2)
    return replace(how, B=B, by_wanted=by_wanted), begun


def _carried(pushed: Sequence[tuple[LinearMotion, Array]]) -> Array:
    """Derivatives of the state from the first sample of a piece to that of the next (segments,
    pieces, samples + 1, size, ...), by its state at the first, wanted quantities, its inputs, and
    the residual. All pieces, side by side, are padded to the same length."""
    pieces, size, k = pushed[0][1].shape
    most = max(int(np.diff(cut(len(how.by_state), pieces)).max()) for how, _ in pushed)
    columns = size + pushed[0][0].B.shape[2] + 1
    A = np.empty((len(pushed), pieces, most, size, size))
    out = np.zeros((len(pushed), pieces, most + 1, size, columns))
    out[:, :, 0] = np.eye(size, columns)
    for (how, begun), a, own in zip(pushed, A, out, strict=True):
        at = np.minimum(_samples(len(how.by_state), pieces, most), len(how.A) - 1)
        a[:] = how.A[at]
        own[:, 0, :, -1 - k : -1] = begun
        own[:, 1:, :, size:-1] = how.B[at]
    for step in range(most):
        out[:, :, step + 1] += A[:, :, step] @ out[:, :, step]
    return out


def _samples(samples: int, pieces: int, most: int) -> NDArray[np.int_]:
    """The samples of each piece (pieces, most), and further ones if it has fewer."""
    return np.minimum(cut(samples, pieces)[:-1, None] + np.arange(most), samples - 1)


def _linearised(
    how: LinearMotion, carried: Array, weight: Array, off: Array
) -> tuple[Array, Array]:
    """J'J of a segment's pieces (pieces, ...), and derivatives of the state after each (pieces,
    size, ...), by the state at its first sample, wanted quantities, its inputs, the residual."""
    pieces, most, size, columns = carried.shape
    lengths = np.diff(cut(len(weight), pieces))
    at = _samples(len(weight), pieces, most - 1)
    J = (how.by_state * weight[:, :, None])[at] @ carried[:, :-1]
    J[..., size:-1] += (how.by_wanted * weight[:, :, None])[at]
    J[..., -1] = off[at]
    beyond = np.arange(most - 1) >= lengths[:, None]
    J[(weight[at] == 0) | beyond[:, :, None]] = 0.0
    J = J.reshape(pieces, -1, columns)
    lengths[-1] -= 1  # Nothing follows the last sample.
    return J.transpose(0, 2, 1) @ J, carried[range(pieces), lengths]


def _whole(grams: Array, ends: Array, wanted: int) -> tuple[Array, Array]:
    """J'J (segments, ...) and derivatives of the last states (segments, size, ...), by initial
    states, wanted quantities and the inputs of all pieces, from those of the pieces."""
    count, pieces, size, columns = ends.shape
    own = columns - size - wanted - 1
    width = size + wanted + pieces * own + 1
    out = np.zeros((count, width, width))
    state = np.zeros((count, pieces + 1, size, width))
    state[:, 0] = np.eye(size, width)
    # Of what is quadratic in the states at the beginnings, half: it comes back as the transpose.
    half = np.zeros((count, pieces, size, width))
    grams[:, :, :size, :size] /= 2
    for k in range(pieces):
        first = size + wanted + k * own
        at = np.r_[size : size + wanted, first : first + own, width - 1]
        for made, by in (state[:, k + 1], ends[:, k]), (half[:, k], grams[:, k, :size]):
            made[:] = by[:, :, :size] @ state[:, k]
            made[:, :, at] += by[:, :, size:]
        out[:, at[:, None], at] += grams[:, k, size:, size:]
    before = state[:, :-1].reshape(count, -1, width)
    cross = before.transpose(0, 2, 1) @ half.reshape(count, -1, width)
    out += cross
    out += cross.transpose(0, 2, 1)
    return out, state[:, -1, :, :-1]


def _widened(own: DriveSlopes) -> DriveSlopes:
    """Derivatives of the servo's part of the drive, with zero rows for the pushes."""
    return DriveSlopes(_padded(own.at), _padded(own.middle), own.columns)


def _widened_path(path: DrivePath) -> DrivePath:
    """The servo's path, with zero rows for the pushes."""
    return replace(path, nodes=_padded(path.nodes), at=_padded(path.at))


def _padded(servo: Array) -> Array:
    """The servo's rows, then zero rows for the pushes."""
    return np.concatenate([servo, np.zeros((FURTHER, *servo.shape[1:]))])


def _passed(moments: Array) -> Array:
    """Fraction of the time between two samples that has passed in the middle of each step."""
    return moments[1::2] - np.arange((moments.size - 1) // 2)


def _drives(pushes: Array, t: Array) -> Array:
    """Pushes (k, 7, n) as DRIVES (k, 11, n): with the rates of change that go with them."""
    moved = pushes[:, 4:]
    changes = np.gradient(moved, t, axis=2) if moved.any() else moved
    again = np.gradient(changes[:, 2:], t, axis=2) if moved.any() else moved[:, 2:]
    return np.concatenate(
        [pushes[:, :_ANGLE], changes[:, :2], pushes[:, _ANGLE:], changes[:, 2:], again], axis=1
    )


def _moments(path: DrivePath, t: Array) -> Array:
    """Beginning, middle and end of all steps, counted in samples (2 steps + 1,)."""
    edges = t[0] + np.append(0.0, np.cumsum(path.h))
    both = np.empty(2 * path.h.size + 1)
    both[::2], both[1::2] = edges, (edges[1:] + edges[:-1]) / 2
    return np.interp(both, t, np.arange(t.size))


CHANNELS: Mapping[str, tuple[float, ...]] = {
    "rolling": (1, 1, 1, 1, 0, 0, 0),
    "yaw": (-1, 1, -1, 1, 0, 0, 0),
    "constraint_axle1": (0, 0, 0, 0, 1, 0, 0),
    "constraint_axle2": (0, 0, 0, 0, 0, 1, 0),
    "actuation": (0, 0, 0, 0, 0, 0, 1),
}
"""Which of PUSHES each channel moves; rolling forces along the wheels' directions."""

_SIDE_SIZE, _ANGLE_SIZE = 0.02, 0.02
"""Usual sizes: of a side speed, as a share of the robot's; of an error of the angle, rad."""


@dataclass(frozen=True)
class _Variable:
    """A variable (n,) along a path, and functions (n,) of it that are of about unit size.

    grid  where they are plotted; empty if they are not functions of it alone
    """

    unit: str
    of: Callable[[_Moving], Array]
    functions: tuple[Callable[[Array, _Moving], Array], ...]
    grid: Array


@dataclass(frozen=True)
class _Moving:
    """A recorded path, the phase of its gait (n,), and the usual speed, m/s.

    whole  of its run (3, m): t, s, and x, y, m
    """

    along: Along
    phase: Array
    usual: float
    whole: Array

    @property
    def speed(self) -> Array:
        """Speed of the axles, relative to the usual one."""
        return self.along.axles.mean(axis=0) / self.usual


_ROUND = np.linspace(0, 2 * math.pi, 37)
_ACROSS = np.linspace(-2.0, 2.0, 41)
_NONE = np.zeros(0)


def _centred(x: Array, whole: Array) -> Array:
    """x relative to the range of its whole run: the same place, or time, is the same in each of the
    run's segments."""
    low, high = float(np.nanmin(whole)), float(np.nanmax(whole))
    return (x - (low + high) / 2) / max(high - low, 1e-3)


_VARIABLES: Mapping[str, _Variable] = {
    "phase of the cycle": _Variable(
        "rad",
        lambda m: m.phase,
        tuple(lambda x, _, k=k, f=f: f(k * x) for k in (1, 2) for f in (np.sin, np.cos)),
        _ROUND,
    ),
    "speed": _Variable(
        "of the usual",
        lambda m: m.speed,
        (lambda x, _: x, lambda x, _: x * np.abs(x), lambda x, _: np.tanh(5 * x)),
        _ACROSS,
    ),
    "heading": _Variable(
        "rad", lambda m: m.along.psi, (lambda x, _: np.sin(x), lambda x, _: np.cos(x)), _ROUND
    ),
    "place": _Variable(
        "m",
        lambda m: m.along.x,
        (
            lambda _, m: m.speed * _centred(m.along.x, m.whole[1]),
            lambda _, m: m.speed * _centred(m.along.y, m.whole[2]),
        ),
        _NONE,
    ),
    "time": _Variable(
        "s", lambda m: m.along.t, (lambda x, m: m.speed * (_centred(x, m.whole[0]) + 0.5),), _NONE
    ),
    CONSTANT: _Variable("", lambda m: m.along.t, (lambda x, _: np.ones_like(x),), _NONE),
}


def unknown_terms(
    racer: RacerModel, fit: Fit
) -> tuple[Sequence[Term], Mapping[Segment, Linearisation]]:
    """The terms, and the fit's segments linearised in the quantities and in the terms."""
    given = racer.simulator.given(fit.values)
    drag = (given["kappa1"] + given["kappa2"]) / 2 / given["h"] ** 2 * racer.setting.speed
    sizes = np.array([drag] * 4 + [_SIDE_SIZE * racer.setting.speed] * 2 + [_ANGLE_SIZE])
    usual = max(racer.setting.speed, 1e-6)
    requests, every, terms = fit.problem.requests(fit.values, fit.states), [], []
    for request, along in zip(requests, observed(racer, requests, fit.effects), strict=True):
        gait = racer.experiment.runs[request.segment.run].gait
        data = racer.runs[request.segment.run]
        whole = np.vstack([data.t, data.values[:, :2].T])
        moving = _Moving(along, 2 * math.pi * along.t / gait.period, usual, whole)
        terms, columns = _terms(moving, sizes)
        every.append(columns)
    parts = linearised_inputs(racer, requests, fit.effects, fit.problem.names, every)
    return terms, {one.segment: part for one, part in zip(requests, parts, strict=True)}


def _terms(moving: _Moving, sizes: Array) -> tuple[list[Term], Array]:
    """Of every channel and variable, and their inputs along a path (columns, 7, n)."""
    terms: list[Term] = []
    columns: list[Array] = []
    along = {
        name: [f(variable.of(moving), moving) for f in variable.functions]
        for name, variable in _VARIABLES.items()
    }
    for channel, pushes in CHANNELS.items():
        shape = sizes * np.array(pushes)
        size = float(np.abs(shape).max())
        for name, variable in _VARIABLES.items():
            own = tuple(range(len(columns), len(columns) + len(along[name])))
            columns += [shape[:, None] * each for each in along[name]]
            # A plotted curve depends on the variable alone, so the path does not matter.
            alone = np.zeros((0, len(own)))
            if variable.grid.size:
                shown = [size * f(variable.grid, moving) for f in variable.functions]
                alone = np.array(shown).T
            terms.append(Term(channel, name, own, variable.unit, variable.grid, alone))
    return terms, np.array(columns)
