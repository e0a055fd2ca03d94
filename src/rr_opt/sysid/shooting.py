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
from functools import lru_cache, partial

import casadi as ca
import numpy as np

from rr_opt import interrupt
from rr_opt.array import Array
from rr_opt.mechanics.code_generation import ArrayFunction, over_arrays, source_file
from rr_opt.sysid.compiled import Compiled, found, source_of
from rr_opt.sysid.paths import DrivePath, Path
from rr_opt.threads import in_background

_FEW, _PAYS = 10_000, 100_000
"""Steps, with derivatives counted fourfold, that take as long as a look into the compile cache,
and as long as compiling."""

_ITERATIONS = 3
"""Of Newton's method, per stage of an implicit step."""

Slope = Callable[[float, ca.SX], ca.SX]
"""d(state)/dt after a fraction of a step, 0 to 1."""


@dataclass(frozen=True, eq=False)
class System:
    """rates(state, drive, p) -> d(state)/dt and seen(state, drive, p) -> channels.

    stiff   how many of the last states are stiff, and need an implicit step
    jumps   whether the drive's rate may jump. Linearised steps would then chatter where friction
            brings a stiff state to rest, so that the result depends on the last digit of the start
    lasts   whether it serves other recordings too, so that compiling it may pay
    """

    rates: ca.Function
    seen: ca.Function
    stiff: int = 0
    jumps: bool = False
    lasts: bool = False


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
    parts = system.rates.serialize(), system.seen.serialize(), _method(system).__name__, _writer()
    return "\n".join(parts)


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

    def rates(when: float, y: ca.SX) -> ca.SX:
        # The drive is a parabola through its nodes.
        weights = 2 * (when - 0.5) * (when - 1), 4 * when * (1 - when), 2 * when * (when - 0.5)
        return system.rates(y, sum(w * part for w, part in zip(weights, parts, strict=True)), p)

    end = _method(system)(rates, x, h, system.stiff)
    return ca.Function("rr_step", [x, ca.vertcat(h, nodes), p], [ca.cse(end)])


def _method(system: System) -> Callable[[Slope, ca.SX, ca.SX, int], ca.SX]:
    if not system.stiff:
        return _rk4
    return _implicit if system.jumps else _rosenbrock


def _rk4(f: Slope, x: ca.SX, h: ca.SX, _: int) -> ca.SX:
    k1 = f(0.0, x)
    k2 = f(0.5, x + h / 2 * k1)
    k3 = f(0.5, x + h / 2 * k2)
    k4 = f(1.0, x + h * k3)
    return x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


def _rosenbrock(f: Slope, x: ca.SX, h: ca.SX, n: int) -> ca.SX:
    """ROS2 of Verwer, Spee, Blom and Hundsdorfer (1999): L-stable, and of order 2 with any matrix.

    So the matrix need only contain the stiff states.
    """
    gamma = 1 - 1 / math.sqrt(2)
    y = ca.SX.sym("y", x.numel())
    by = ca.jacobian(f(0.0, y)[-n:], y)[:, -n:]
    inverse = ca.inv_minor(ca.SX.eye(n) - gamma * h * ca.substitute(by, y, x))

    def solve(b: ca.SX) -> ca.SX:
        return ca.vertcat(b[:-n], inverse @ b[-n:])

    k1 = solve(f(0.0, x))
    k2 = solve(f(1.0, x + h * k1) - 2 * k1)
    return x + h * (1.5 * k1 + 0.5 * k2)


def _implicit(f: Slope, x: ca.SX, h: ca.SX, n: int) -> ca.SX:
    """ARS(2,2,2) of Ascher, Ruuth and Spiteri (1997): of order 2, and implicit and L-stable in the
    stiff states."""
    gamma = 1 - 1 / math.sqrt(2)
    delta = 1 - 1 / (2 * gamma)
    u, s = x[:-n], x[-n:]

    def settled(when: float, u: ca.SX, known: ca.SX) -> ca.SX:
        """The s that equals known + gamma h f(u, s). Friction is steepest at 0, so that Newton's
        method does not overshoot from there."""
        y = ca.SX.sym("y", n)
        rate = f(when, ca.vertcat(u, y))[-n:]
        both, s = [rate, ca.jacobian(rate, y)], ca.SX.zeros(n)
        for _ in range(_ITERATIONS):
            here, by = ca.substitute(both, [y], [s])
            s -= ca.inv_minor(ca.SX.eye(n) - gamma * h * by) @ (s - known - gamma * h * here)
        return s

    k1 = f(0.0, x)[:-n]
    u1 = u + gamma * h * k1
    s1 = settled(gamma, u1, s)
    k2 = f(gamma, ca.vertcat(u1, s1))[:-n]
    u2 = u + h * (delta * k1 + (1 - delta) * k2)
    return ca.vertcat(u2, settled(1.0, u2, s + (1 - gamma) / gamma * (s1 - s)))
