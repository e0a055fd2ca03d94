"""Predict a run from its start, and carry along how the prediction depends on everything.

The state follows xdot = rates(x, drive, p) between samples, where the drive is known. It is stepped
by CasADi's virtual machine, one function for all steps. The derivatives are those of the linearised
motion: its matrices are evaluated for all steps at once over NumPy arrays, which needs no compiler,
and then multiplied up along the run. A system that is used a lot is compiled, where there is a
compiler, and then does the same in machine code.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import casadi as ca
import numpy as np

from rr_opt.diagnose.compiled import Compiled, found, source_of
from rr_opt.diagnose.model import Array
from rr_opt.physics.arrays import over_arrays
from rr_opt.physics.cofactors import inverted

_FEW, _PAYS = 10_000, 100_000
"""Steps, with derivatives counted fourfold, that take as long as to look for what was compiled
before, and as long as to compile."""

Slope = Callable[[int, ca.SX], ca.SX]
"""d(state)/dt at the beginning (0), in the middle (1) or at the end (2) of a step."""


@dataclass(frozen=True, eq=False)
class System:
    """rates(state, drive, p) -> d(state)/dt and seen(state, drive, p) -> channels.

    stiff   how many states at the end of it settle at once, and need an implicit step
    lasts   whether it is the same for other recordings, so that compiling it may be worth it
    """

    rates: ca.Function
    seen: ca.Function
    stiff: int = 0
    lasts: bool = False


@dataclass(frozen=True)
class DrivePath:
    """The drive over all steps of a run.

    h      (steps,) s, `each` of them between two samples
    nodes  (size, 3, steps) at the beginning, in the middle and at the end of each step
    at     (size, samples) at the samples
    """

    h: Array
    nodes: Array
    at: Array
    each: int


@dataclass(frozen=True)
class DriveSlopes:
    """How the drive changes with what is asked for, by index along the last axis.

    at      (size, samples, nw) at the samples;  middle (size, steps, nw) in the middle of each step
    """

    at: Array
    middle: Array


@dataclass(frozen=True)
class Path:
    """The states (size, steps + 1) of a run and what is seen of it (samples, channels)."""

    states: Array
    seen: Array


def predict(system: System, path: DrivePath, start: Array, p: Array) -> Path:
    """Step the system along the drive from `start`."""
    steps = path.h.size
    code = _code(system, steps)
    if code:
        return Path(*code.predict(start, _rows(path), path.at, path.each, p))
    rolled = _roll(system, steps)(start, _rows(path).T, p)
    states = np.column_stack([start, np.asarray(rolled)])
    at = states[:, :: path.each]
    seen = _arrays(system, "seen")(*at, *path.at, *p)
    return Path(states, np.array(np.broadcast_arrays(*seen)).T)


@dataclass(frozen=True)
class Slopes:
    """How what is seen changes, (samples, channels, ...), with p, and with the start."""

    by_parameter: Array
    by_start: Array


def slopes(
    system: System,
    path: DrivePath,
    made: Path,
    p: Array,
    wanted: Array,
    drive_by: DriveSlopes | None,
) -> Slopes:
    """The linearised motion along a predicted path.

    wanted    (np, nw) how p changes with what is asked for
    drive_by  how the drive does; None if it does not
    """
    size, nd = made.states.shape[0], path.at.shape[0]
    code = _code(system, 4 * path.h.size)
    if code:
        moved = (drive_by.at, drive_by.middle) if drive_by else None
        return Slopes(*code.slopes(made.states, _rows(path), path.at, path.each, p, wanted, moved))
    A, B = (_frozen if path.each > 1 else _kutta)(system, path, made, p, wanted, drive_by)
    for _ in range(int(np.log2(path.each))):
        A, B = A[1::2] @ A[::2], A[1::2] @ B[::2] + B[1::2]
    samples, nw = path.at.shape[1], wanted.shape[1]
    carried = np.empty((samples, size, size + nw))
    carried[0] = np.eye(size, size + nw)
    push = np.concatenate([np.zeros((len(B), size, size)), B], axis=2)
    now = carried[0]
    for k in range(samples - 1):
        now = A[k] @ now + push[k]
        carried[k + 1] = now
    channels = made.seen.shape[1]
    at = made.states[:, :: path.each]
    sx, sd, sp = _split(
        _arrays(system, "seen_by")(*at, *path.at, *p), channels, nd, p.size, samples, size
    )
    seen = sx @ carried
    seen[:, :, size:] += sp @ wanted
    if drive_by is not None:
        seen[:, :, size:] += np.einsum("sid,dsw->siw", sd, drive_by.at)
    return Slopes(seen[:, :, size:], seen[:, :, :size])


def _rows(path: DrivePath) -> Array:
    """(steps, 1 + 3 drive): each step's length, and its drive at the beginning, middle and end."""
    nodes = path.nodes.transpose(2, 1, 0).reshape(path.h.size, -1)
    return np.column_stack([path.h, nodes])


_used: dict[System, int] = {}


def _code(system: System, steps: int) -> Compiled | None:
    """The system compiled: if it was before, or was used so much now that it pays."""
    if not system.lasts:
        return None
    used = _used[system] = _used.get(system, 0) + steps
    return _compiled(system, make=used > _PAYS) if used > _FEW else None


@lru_cache(maxsize=64)
def _compiled(system: System, *, make: bool) -> Compiled | None:
    return found(*_source(system), make=make)


@lru_cache(maxsize=64)
def _source(system: System) -> tuple[str, tuple[int, int, int, int]]:
    inputs = system.rates.sx_in()
    both = []
    for name, function in (("rr_rates", system.rates), ("rr_seen", system.seen)):
        by = ca.densify(ca.jacobian(function(*inputs), ca.vertcat(*inputs)))
        outputs = ca.cse([ca.densify(function(*inputs)), by])
        both.append(ca.Function(name, inputs, outputs))
    state, drive, given = (one.numel() for one in inputs)
    sizes = (state, drive, given, system.seen.numel_out(0))
    return source_of((_step(system), *both), sizes), sizes


def _kutta(system, path, made, p, wanted, drive_by) -> tuple[Array, Array]:
    """Transition matrices of smooth steps: the classical Runge-Kutta method on d/dt M = fx M + f_w.

    The state in the middle of a step is that of the cubic through both ends and their slopes.
    """
    ends, h = made.states, path.h
    drive = np.concatenate([path.nodes[:, 0], path.nodes[:, 2, -1:]], axis=1)
    slope = np.array(np.broadcast_arrays(*_arrays(system, "rates")(*ends, *drive, *p)))
    middle = (ends[:, 1:] + ends[:, :-1]) / 2 + h / 8 * (slope[:, :-1] - slope[:, 1:])
    at = np.concatenate([ends, middle], axis=1)
    with_drive = np.concatenate([drive, path.nodes[:, 1]], axis=1)
    fx, fd, fp = _split(
        _arrays(system, "rates_by")(*at, *with_drive, *p),
        len(ends),
        len(drive),
        p.size,
        at.shape[1],
    )
    force = fp @ wanted
    if drive_by is not None:
        moved = np.concatenate([drive_by.at, drive_by.middle], axis=1)
        force = force + np.einsum("sid,dsw->siw", fd, moved)
    n, size = h.size, len(ends)
    both = np.concatenate([fx, force], axis=2)
    first, last, mid = both[:n], both[1 : n + 1], both[n + 1 :]
    h = h[:, None, None]
    eye = np.eye(size, both.shape[2])

    def slope_of(f: Array, M: Array) -> Array:
        out = f[:, :, :size] @ M
        out[:, :, size:] += f[:, :, size:]
        return out

    k1 = first
    k2 = slope_of(mid, eye + h / 2 * k1)
    k3 = slope_of(mid, eye + h / 2 * k2)
    k4 = slope_of(last, eye + h * k3)
    out = eye + h / 6 * (k1 + 2 * (k2 + k3) + k4)
    return out[:, :, :size], out[:, :, size:]


def _frozen(system, path, made, p, wanted, drive_by) -> tuple[Array, Array]:
    """Transition matrices of fine steps, where the drive jumps or some states settle at once.

    The matrix z = h fx of the middle of the step is taken for all of it; exp(z) as its Pade
    approximant (1 + z/3)/(1 - 2z/3 + z^2/6), which damps what settles at once.
    """
    middle, h = (made.states[:, 1:] + made.states[:, :-1]) / 2, path.h
    nd, size = path.at.shape[0], len(middle)
    fx, fd, fp = _split(
        _arrays(system, "rates_by")(*middle, *path.nodes[:, 1], *p), size, nd, p.size, h.size
    )
    force = fp @ wanted
    if drive_by is not None:
        force = force + np.einsum("sid,dsw->siw", fd, drive_by.middle)
    eye, z = np.eye(size), fx * h[:, None, None]
    push = (eye - z / 6) @ (force * h[:, None, None])
    left = eye - 2 / 3 * z + z @ z / 6
    out = np.linalg.solve(left, np.concatenate([eye + z / 3, push], axis=2))
    return out[:, :, :size], out[:, :, size:]


def _split(parts, rows: int, nd: int, np_: int, count: int, nx: int | None = None):
    """The dense Jacobians (count, rows, ...) by state, drive and p from their entries."""
    nx = rows if nx is None else nx
    columns = nx + nd + np_
    dense = np.empty((count, rows, columns))
    for k, part in enumerate(parts):
        dense[:, k % rows, k // rows] = part
    return dense[:, :, :nx], dense[:, :, nx : nx + nd], dense[:, :, nx + nd :]


@lru_cache(maxsize=256)
def _arrays(system: System, which: str):
    function = system.rates if which.startswith("rates") else system.seen
    if which.endswith("_by"):
        inputs = function.sx_in()
        by = ca.densify(ca.jacobian(function(*inputs), ca.vertcat(*inputs)))
        function = ca.Function(which, inputs, [ca.cse(by)])
    return over_arrays(function)


@lru_cache(maxsize=512)
def _roll(system: System, steps: int) -> ca.Function:
    return _step(system).mapaccum(steps)


@lru_cache(maxsize=64)
def _step(system: System) -> ca.Function:
    x, drive, p = system.rates.sx_in()
    h, nodes = ca.SX.sym("h"), ca.SX.sym("nodes", 3 * drive.numel())
    parts = ca.vertsplit(nodes, drive.numel())
    make = _rosenbrock if system.stiff else _rk4
    end = make(lambda k, y: system.rates(y, parts[k], p), x, h, system.stiff)
    return ca.Function("rr_step", [x, ca.vertcat(h, nodes), p], [ca.cse(end)])


def _rk4(f: Slope, x: ca.SX, h: ca.SX, _: int) -> ca.SX:
    k1 = f(0, x)
    k2 = f(1, x + h / 2 * k1)
    k3 = f(1, x + h / 2 * k2)
    k4 = f(2, x + h * k3)
    return x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


def _rosenbrock(f: Slope, x: ca.SX, h: ca.SX, n: int) -> ca.SX:
    """ROS2 of Verwer, Spee, Blom and Hundsdorfer (1999): L-stable, and of order 2 with any matrix.

    So the matrix holds the stiff states alone.
    """
    gamma = 1 - 1 / np.sqrt(2)
    y = ca.SX.sym("y", x.numel())
    by = ca.jacobian(f(0, y)[-n:], y)[:, -n:]
    inverse = inverted(ca.SX.eye(n) - gamma * h * ca.substitute(by, y, x))

    def solve(b: ca.SX) -> ca.SX:
        return ca.vertcat(b[:-n], inverse @ b[-n:])

    k1 = solve(f(0, x))
    k2 = solve(f(2, x + h * k1) - 2 * k1)
    return x + h * (1.5 * k1 + 0.5 * k2)
