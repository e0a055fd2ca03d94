"""Predict runs from their initial states.

The state follows xdot = rates(x, drive, p) with a known drive. It is stepped by CasADi's virtual
machine, one function for all steps. A system that is used a lot is compiled, where there is a
compiler, and then several runs are stepped at once. For derivatives see `sensitivities`.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from functools import cached_property, lru_cache, partial

import casadi as ca
import numpy as np

from rr_opt import interrupt
from rr_opt.array import Array
from rr_opt.mechanics.code_generation import ArrayFunction, over_arrays, source_file
from rr_opt.sysid.compiled import Compiled, found, source_of
from rr_opt.threads import in_background

_FEW, _PAYS = 10_000, 100_000
"""Steps, with derivatives counted fourfold, that take as long as a look into the compile cache,
and as long as compiling."""

_REST = 1e-12
"""A stiff state this near to 0 is at rest."""

Slope = Callable[[int, ca.SX], ca.SX]
"""d(state)/dt at the beginning (0), in the middle (1) or at the end (2) of a step."""


@dataclass(frozen=True, eq=False)
class System:
    """rates(state, drive, p) -> d(state)/dt and seen(state, drive, p) -> channels.

    stiff   how many of the last states are stiff, and need an implicit step
    lasts   whether it serves other recordings too, so that compiling it may pay
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
    fine   how many steps derivatives take as one
    """

    h: Array
    nodes: Array
    at: Array
    each: int
    fine: int = 1

    @cached_property
    def inputs(self) -> Array:
        """(steps, 1 + 3 size): each step's length, and its drive at all three places."""
        nodes = self.nodes.transpose(2, 1, 0).reshape(self.h.size, -1)
        return np.column_stack([self.h, nodes])

    def part(self, first: int, last: int) -> DrivePath:
        """From sample `first` to sample `last`."""
        during = slice(first * self.each, last * self.each)
        h, nodes, at = self.h[during], self.nodes[:, :, during], self.at[:, first : last + 1]
        return DrivePath(h, nodes, at, self.each, self.fine)

    @cached_property
    def coarse(self) -> DrivePath:
        """In the steps of derivatives."""
        return self.coarser(self.fine)

    def coarser(self, count: int) -> DrivePath:
        """In steps of so many each; their middle is the mean."""
        split = self.nodes.reshape(*self.nodes.shape[:2], -1, count)
        nodes = split[:, 0, :, 0], split[:, 1].mean(axis=2), split[:, 2, :, -1]
        h = self.h.reshape(-1, count).sum(axis=1)
        return DrivePath(h, np.stack(nodes, axis=1), self.at, self.each // count)


@dataclass(frozen=True)
class Path:
    """The states (size, steps + 1) of a run and its outputs (samples, channels)."""

    states: Array
    seen: Array

    def coarser(self, count: int) -> Path:
        """In steps of so many each."""
        return Path(self.states[:, ::count], self.seen)


def predict(system: System, path: DrivePath, start: Array, p: Array) -> Path:
    """Step the system along the drive from `start`."""
    return predict_all(system, [(path, start, p)])[0]


def predict_all(system: System, asked: Sequence[tuple[DrivePath, Array, Array]]) -> Sequence[Path]:
    """Step the system along each drive from its start, with its p."""
    code = code_of(system, sum(path.h.size for path, _, _ in asked))
    if code:
        every = [(start, path.inputs, path.at, path.each, p) for path, start, p in asked]
        return [Path(*made) for made in code.predict(every)]
    return [_predicted(system, path, start, p) for path, start, p in asked]


def _predicted(system: System, path: DrivePath, start: Array, p: Array) -> Path:
    rolled = _roll(system, path.h.size)(start, path.inputs.T, p)
    states = np.column_stack([start, np.asarray(rolled)])
    at = states[:, :: path.each]
    seen = arrays_of(system, "seen")(*at, *path.at, *p)
    return Path(states, np.array(np.broadcast_arrays(*seen)).T)


_used: dict[System, int] = {}


def code_of(system: System, steps: int) -> Compiled | None:
    """The compiled system, if cached or if, with these steps, it is used enough to pay."""
    if not system.lasts:
        return None
    used = _used[system] = _used.get(system, 0) + steps
    if ahead := _begun.get((os.getpid(), system)):
        return ahead.result()
    return _compiled(system, make=used > _PAYS) if used > _FEW else None


_begun: dict[tuple[int, System], Future[Compiled | None]] = {}
"""By process: a child that was forked would wait for its parent's thread."""


def prepare(systems: Iterable[System], like: System) -> None:
    """Begin to compile, in the background, systems that will be used about as much as another one
    was, if that paid."""
    if _used.get(like, 0) <= _PAYS:
        return
    for one in systems:
        own = os.getpid(), one
        if one.lasts and own not in _begun and _compiled(one, make=False) is None:
            try:
                # Written here, as CasADi is not safe in threads.
                source = _source(one)
            except NotImplementedError:
                continue
            _begun[own] = in_background(partial(_made, source, *_sizes(one), _key(one)))


def _made(source: str, size: int, channels: int, key: str) -> Compiled | None:
    # Nobody waits for it after an interrupt.
    interrupt.check()
    return found(source, size, channels, make=True, key=key)


@lru_cache(maxsize=64)
def _compiled(system: System, *, make: bool) -> Compiled | None:
    try:
        return found(partial(_source, system), *_sizes(system), make=make, key=_key(system))
    except NotImplementedError:
        return None


def _source(system: System) -> str:
    return source_of(_step(system), system.rates, system.seen, stiff=bool(system.stiff))


def _sizes(system: System) -> tuple[int, int]:
    return system.rates.numel_in(0), system.seen.numel_out(0)


def _key(system: System) -> str:
    """What the source is written from."""
    stiff = str(bool(system.stiff))
    return "\n".join((system.rates.serialize(), system.seen.serialize(), stiff, _writer()))


@lru_cache(maxsize=1)
def _writer() -> str:
    """All that writes a system's source."""
    files = [("mechanics", "code_generation.py"), ("mechanics", "lanes.c")]
    files += [("sysid", name) for name in ("compiled.py", "diagnose_lanes.c", "shooting.py")]
    texts = [source_file(f"rr_opt.{package}", name) for package, name in files]
    return "\n".join((ca.CasadiMeta.version(), *texts))


@lru_cache(maxsize=256)
def arrays_of(system: System, which: str) -> ArrayFunction:
    """`seen`, its derivatives `seen_by`, or those of the rates, `rates_by`, over arrays."""
    function = system.rates if which == "rates_by" else system.seen
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

    So the matrix need only contain the stiff states. Its columns are their chords to rest, not
    tangents: a wheel that slides is hardly held by more slip, and a tangent lets it go past rest
    and back, step by step, so that the result depends on the last digit of the start.
    """
    gamma = 1 - 1 / math.sqrt(2)
    here, columns = f(0, x), []
    for k in range(x.numel() - n, x.numel()):
        there = ca.SX(x)
        there[k] = 0
        away = ca.if_else(ca.fabs(x[k]) > _REST, x[k], _REST)
        columns.append((here - f(0, there))[-n:] / away)
    inverse = ca.inv_minor(ca.SX.eye(n) - gamma * h * ca.horzcat(*columns))

    def solve(b: ca.SX) -> ca.SX:
        return ca.vertcat(b[:-n], inverse @ b[-n:])

    k1 = solve(here)
    k2 = solve(f(2, x + h * k1) - 2 * k1)
    return x + h * (1.5 * k1 + 0.5 * k2)
