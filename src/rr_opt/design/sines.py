"""The best sines: climbs from all over the box, each finished by sequential quadratic programming.

A sine has four decisions, and its steady cycle is a known function of them, so a program in the
decisions alone suffices. Shapes with dozens of coefficients are left to multiple shooting.
"""

import math
from dataclasses import replace

import numpy as np

from rr_opt.array import Array
from rr_opt.design.candidate import StartResult
from rr_opt.design.decisions import Setting, decisions, robot_of
from rr_opt.design.terrain import Terrain
from rr_opt.model.gait import SineGait
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.outcome import NotConvergedError
from rr_opt.sqp import DEAREST, FEASIBLE, Ascent, ascend

WAYS = {"forward": 1, "backward": -1, "either": 0}

FEWEST, _MOST = 96, 3072
"""Phases per cycle, at least and at most."""
_ORDER = 4
_ERROR = {True: 1e-9, False: 1e-7}
"""Relative tolerance of speed and peak torque, by whether friction is viscous."""
_SENTENCES = {
    (True, True): "A local optimum within the solver's tolerance.",
    (True, False): "The solver stopped short of an optimum.",
    (False, True): "No gait near this start respects all limits.",
    (False, False): "The solver stopped short of gaits that keep the limits.",
}
"""The outcome in words, by (feasible, converged)."""


def climbed(terrain: Terrain, start: Array, nodes: int = FEWEST) -> tuple[Ascent, Array]:
    """The local optimum from a gait (4,): amplitude, period, offset, share; and its gait."""
    program, x = terrain.program(start, nodes)
    ascent = ascend(program, x)
    return ascent, terrain.gait_at(start, ascent.x)


def solve_sine(setting: Setting, sign: int, start: Array) -> StartResult:
    """Maximise the speed in direction `sign`, 0 for either, from amplitude, period, offset and the
    ballast's share (4,), with the fewest phases."""
    return _candidate(Terrain(setting, decisions(setting.problem), sign), start, FEWEST)


def solve_from_kept(setting: Setting, sign: int, start: Array, nodes: int) -> StartResult:
    """The same from a gait that is feasible at this many phases; at fewer it may not be."""
    terrain = Terrain(setting, decisions(setting.problem), sign)
    candidate = _candidate(terrain, start, FEWEST)
    if candidate.feasible and candidate.success:
        return candidate
    return _candidate(terrain, start, nodes)


def refine_sine(setting: Setting, candidate: StartResult) -> StartResult:
    """The same with more and more phases, until the result converges."""
    terrain = Terrain(setting, decisions(setting.problem), candidate.sign)
    wanted, nodes = _ERROR[setting.landscape.linear], candidate.intervals
    iterations = candidate.iterations
    while True:
        gait = candidate.gait
        end = np.array([gait.amplitude, gait.period, gait.offset, candidate.share])
        (seen, _), (finer, sizes) = (terrain.measured(end, n) for n in (nodes, 2 * nodes))
        error = float((np.abs(seen - finer) / sizes).max())
        if not error > wanted or nodes >= _MOST:
            return _settled(setting, replace(candidate, iterations=iterations))
        nodes = min(nodes * 2 ** max(1, math.ceil(math.log2(error / wanted) / _ORDER)), _MOST)
        candidate = _candidate(terrain, end, nodes)
        iterations += candidate.iterations


def _settled(setting: Setting, candidate: StartResult) -> StartResult:
    """For friction that is not viscous, where the linearised cycle may fail to converge."""
    if setting.landscape.linear:
        return candidate
    try:
        speed = steady_cycle(robot_of(setting, candidate.share), candidate.gait, steps=_MOST).speed
    except NotConvergedError as error:
        return replace(candidate, success=False, sentence=str(error))
    return replace(candidate, speed=speed)


def _candidate(terrain: Terrain, start: Array, nodes: int) -> StartResult:
    ascent, end = climbed(terrain, start, nodes)
    kept = ascent.violation <= FEASIBLE
    if not (kept and ascent.converged):
        # Near-degenerate rows bend away from a step that may violate them a little; and where
        # violating them gains a lot, the climb has left the feasible gaits for good.
        near = end if kept else start
        program, x = terrain.program(near, nodes)
        ascent = ascend(program, x, DEAREST)
        end = terrain.gait_at(near, ascent.x)
    cycles, sign = terrain.setting.landscape.cycles(end[:, None], nodes), terrain.way
    speed = float(cycles.speed[0])
    prices, bound_prices = terrain.prices(end, speed, float(cycles.turn[0]), ascent)
    feasible = ascent.violation <= FEASIBLE
    return StartResult(
        sign=sign or int(math.copysign(1, speed)),
        gait=SineGait(*end[:3].tolist()),
        share=float(end[3]),
        speed=speed,
        feasible=feasible,
        success=ascent.converged,
        sentence=_SENTENCES[feasible, ascent.converged],
        iterations=ascent.iterations,
        prices=prices,
        bound_prices=bound_prices,
        violation=ascent.violation,
        intervals=nodes,
        cost=None if terrain.setting.problem.objective == "speed" else terrain.cost(end, nodes),
    )
