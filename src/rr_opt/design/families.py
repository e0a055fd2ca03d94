"""Optima among gaits that are no sines, found family by family.

Every sine is a Fourier gait, and one of few harmonics is one of many; a free gait comes close to
them all. So the optima of each family are starts in the next, which can only be faster, and
shapes at random are other starts.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from rr_opt.design.candidate import Finds, StartResult, distinct
from rr_opt.design.decisions import SQUARE, Setting, decisions, robot_of, settings_of
from rr_opt.design.infeasible import posture_clashes
from rr_opt.design.random_shapes import scan_shapes
from rr_opt.design.search import Progress, find_sines
from rr_opt.design.sines import refine_sine, solve_sine
from rr_opt.design.solve import dense, solve
from rr_opt.design.transcription import LADDER, Mesh, at_least, intervals_for, regular
from rr_opt.model.gait import Gait
from rr_opt.model.problem import GaitBounds, Problem
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.outcome import NotConvergedError

_TRIAL = 36
"""Intervals on which a gait's own error is tried, to choose its mesh."""
_CLAIM = 3e-7
"""Largest error of a claimed speed, relative."""
_PEAK = 3e-5
"""Largest excess over a limit between nodes, relative: the solver moves peaks aside."""
_PATIENCE = 5
"""Refinements after which the intervals are halved and, after as many more, a margin is kept from
the torque's limit."""
_PER_HARMONIC = 12
"""Intervals of a period of the fastest harmonic, at least."""
_REFINEMENTS = 14
_SUBSTEPS, _FINEST = 4, 192
"""Of a free gait's interval, and intervals of a Fourier gait, at most."""


def solve_from(setting: Setting, sign: int, gait: Gait, share: float) -> StartResult:
    """Solve from a gait; of another shape than the sine on a mesh that is fine enough for its
    cycle."""
    wanted = setting.problem.gait
    if wanted.shape == "sine":
        start = np.array([gait.amplitude, gait.period, gait.offset, share])
        return solve_sine(setting, sign, start)
    if wanted.shape == "free":
        return solve(setting, sign, gait, share, regular(wanted.intervals))
    seen = dense(setting, gait, share)
    try:
        coarse = steady_cycle(robot_of(setting, share), gait, steps=_TRIAL).speed
        error = abs(coarse - seen.speed) / abs(seen.speed)
        intervals = intervals_for(_TRIAL, error, _CLAIM / 2)
    except NotConvergedError:  # dry friction too steep for so coarse a mesh
        intervals = LADDER[-1]
    # Until an optimum is chosen, limits broken between nodes are no matter.
    intervals = max(intervals, at_least(_PER_HARMONIC * wanted.harmonics))
    return solve(setting, sign, gait, share, regular(intervals))


def refine(setting: Setting, candidate: StartResult) -> StartResult:
    """Solve again until the mesh claims the true speed and no limit is broken between nodes."""
    if candidate.mesh is None:
        return refine_sine(setting, candidate)
    iterations, mesh = candidate.iterations, candidate.mesh
    for number in range(_REFINEMENTS):
        gait, share = candidate.gait, candidate.share
        seen = dense(setting, gait, share)
        error = abs(abs(candidate.speed) - abs(seen.speed)) / abs(seen.speed)
        finer = _finer(setting, mesh, error)
        if seen.used <= 1 + _PEAK and (finer is None or error <= _CLAIM):
            # With no finer mesh left, the gait is as good as found; its speed is what was seen.
            speed = candidate.speed if error <= _CLAIM else seen.speed
            candidate = replace(candidate, speed=speed)
            break
        mesh = finer or mesh
        if number == _PATIENCE and setting.problem.gait.shape == "fourier":
            mesh = replace(regular(at_least(2 * mesh.intervals)), checks=mesh.checks)
        mesh = mesh.with_torque_at(seen.peaks).with_checks_at(seen.checks)
        if number >= 2 * _PATIENCE and seen.used > 1 + _PEAK:
            mesh = replace(mesh, margin=max(mesh.margin, 1 - (1 - mesh.margin) / seen.used))
        candidate = solve(setting, candidate.sign, gait, share, mesh)
        iterations += candidate.iterations
        if not (candidate.feasible and candidate.success):
            break
    return replace(candidate, iterations=iterations)


def _finer(setting: Setting, mesh: Mesh, error: float) -> Mesh | None:
    """The mesh with which to go on; None if no finer one is left.

    The intervals of a free gait are the user's, as its accelerations are defined on them.
    """
    if error <= _CLAIM:
        return mesh
    if setting.problem.gait.shape == "free":
        return replace(mesh, substeps=2 * mesh.substeps) if mesh.substeps < _SUBSTEPS else None
    if mesh.intervals >= _FINEST:
        return None
    finer = regular(intervals_for(mesh.intervals, error, _CLAIM / 4))
    return replace(finer, checks=mesh.checks, margin=mesh.margin)


SIGNS = {"forward": (1,), "backward": (-1,), "either": (1, -1)}
_ON_THE_WAY = {"fourier": (3, 8), "free": (3, 5)}
"""Numbers of harmonics of the families on the way to a larger one."""
_HANDED_ON = 3
"""How many optima of a family the next one starts from."""
_SCANNED, _SCANNED_LATER = 8, 2
"""How many shapes at random the first family of several harmonics starts from, and a later one."""
_WORTH = 0.8
"""Optima so much slower than the best are not handed on."""


def find_families(
    problem: Problem, progress: Progress, on_the_way: tuple[int, ...] | None = None
) -> Iterator[tuple[Problem, Finds]]:
    """Optima, or why there are none, of the sines, then of each family up to the problem's.

    on_the_way: numbers of harmonics of the families between.
    """
    sine = replace(problem, gait=replace(problem.gait, shape="sine"))
    finds = find_sines(sine, progress)
    yield sine, finds
    # What a sine cannot do another shape may; but none can do what this says.
    hopeless = posture_clashes(_loosened(sine), decisions(problem))
    clash = Finds(clash=f"{finds.clash} {_OTHERS}") if hopeless else Finds()
    lost = Finds(lost=[f"Among sines: {finds.clash}"]) if finds.clash else Finds()
    for gait in _families(problem.gait, on_the_way):
        larger = replace(problem, gait=gait)
        finds = Finds() if hopeless else _next(larger, finds, progress)
        yield larger, finds if finds.good else finds + lost + clash


_OTHERS = (
    "Shapes that need less than a sine need at least 79 % of its angle and rate, and even that is "
    "too much."
)


def _loosened(problem: Problem) -> Problem:
    """With the least amplitude of a sine that needs no more than the thriftiest shape."""
    amplitude = problem.gait.amplitude
    amplitude = replace(amplitude, low=SQUARE * amplitude.low)
    return replace(problem, gait=replace(problem.gait, amplitude=amplitude))


def _families(gait: GaitBounds, on_the_way: tuple[int, ...] | None) -> list[GaitBounds]:
    """The family that is asked for, after those on the way to it."""
    before = _ON_THE_WAY[gait.shape] if on_the_way is None else on_the_way
    if gait.shape == "fourier":
        before = tuple(n for n in before if n < gait.harmonics)
    return [*(replace(gait, shape="fourier", harmonics=n) for n in before), gait]


def _next(problem: Problem, before: Finds, progress: Progress) -> Finds:
    """Solve in this problem's family from the optima of the one before."""
    settings = settings_of(problem, decisions(problem))
    starts: list[tuple[Setting, int, Gait, float]] = []
    for old, one in distinct(before.good)[:_HANDED_ON]:
        if abs(one.speed) < _WORTH * before.fastest:
            break
        setting = next(new for new in settings if new.fixed_share == old.fixed_share)
        starts.append((setting, one.sign, one.gait, one.share))
    first = problem.gait.harmonics <= _ON_THE_WAY["fourier"][0]
    if problem.gait.shape == "fourier" or len(starts) < _HANDED_ON:
        for setting in settings[:1] if starts else settings:
            most = _SCANNED if first else _SCANNED_LATER
            seeds = scan_shapes(setting, SIGNS[problem.direction], most)
            starts += [(setting, *seed) for seed in seeds]
    name = "free gait" if problem.gait.shape == "free" else f"{problem.gait.harmonics} harmonics"
    finds = Finds()
    for number, start in enumerate(starts, 1):
        progress(f"{name}: start {number} of {len(starts)}")
        try:
            finds.pairs.append((start[0], solve_from(*start)))
        except NotConvergedError as error:
            finds.lost.append(str(error))
    return finds
