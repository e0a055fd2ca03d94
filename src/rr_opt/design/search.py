"""All optima of a problem, family by family: starts, solves, refinement, and which are one.

Optima among gaits that are no sines, found family by family.

Every sine is a Fourier gait, and one of few harmonics is one of many; a free gait comes close to
them all. So the optima of each family are starts in the next, which can only be faster, and
shapes at random are other starts.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from rr_opt.array import Array
from rr_opt.design.decisions import (
    SQUARE,
    Decisions,
    Setting,
    decisions,
    robot_of,
    scanned,
    settings_of,
)
from rr_opt.design.infeasible import direction_clash, posture_clashes, torque_clash
from rr_opt.design.landscape import Cycles, Landscape
from rr_opt.design.scan import FINER_NODES, Seed, scan_shapes
from rr_opt.design.seeds import find_seeds
from rr_opt.design.solve import Candidate, Dense, dense, solve
from rr_opt.design.transcription import LADDER, Mesh, at_least, intervals_for, regular
from rr_opt.model.gait import Gait, SineGait
from rr_opt.model.problem import GaitBounds, Problem
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.outcome import NotConvergedError

_STEPS = 24
_FALL = 1e-4
"""A fall on the way, relative to the optimum, that is the landscape's roughness."""
_CORRECTIONS = 4
_PENALTY = 3.0
"""For an excess of 1 over the torque limit, in speeds of the optimum."""


def leads_to(
    landscape: Landscape, box: Decisions, torque_limit: float, seed: Seed, known: Candidate
) -> bool:
    """The way from a start to an optimum rises all along.

    It is the straight line in the unit box; where that would need too much torque the amplitude is
    lowered. A top between them, or the start on a slope of its own, would make it fall somewhere.
    Turns are not looked at.
    """
    if seed.sign != known.sign or not (known.feasible and known.success):
        return False
    end = box.unit(known.gait.amplitude, known.gait.period, known.gait.offset, known.share)
    start = seed.point.copy()
    if box.mirrored:
        for point in (start, end):
            point[1] = max(point[1], 1 - point[1])
    way = start + np.linspace(0.0, 1.0, _STEPS)[:, None] * (end - start)
    for _ in range(_CORRECTIONS):
        way[:, 2] /= 1 + _excess(landscape.cycles(box.physical(way), FINER_NODES), torque_limit)
    cycles = landscape.cycles(box.physical(way), FINER_NODES)
    height = seed.sign * cycles.speed / abs(known.speed) - _PENALTY * _excess(cycles, torque_limit)
    height[-1] = 1.0
    # A comparison with nan, where nothing settles, is false.
    return bool(np.all(np.diff(height) >= -_FALL))


def _excess(cycles: Cycles, torque_limit: float) -> Array:
    return np.maximum(cycles.peak_torque / torque_limit - 1, 0.0)


@dataclass(frozen=True)
class Finds:
    """Candidates with their settings, in any order; why other starts led nowhere; and, where it
    is known, why no gait can keep all limits."""

    pairs: list[tuple[Setting, Candidate]] = field(default_factory=list)
    lost: list[str] = field(default_factory=list)
    clash: str = ""

    @property
    def good(self) -> list[tuple[Setting, Candidate]]:
        """Optima, best first."""
        optima = [pair for pair in self.pairs if pair[1].feasible and pair[1].success]
        return sorted(optima, key=lambda pair: pair[1].rank)

    @property
    def fastest(self) -> float:
        """Speed of the best optimum, m/s; 0 if there is none."""
        return max((abs(one.speed) for _, one in self.good), default=0.0)

    def __add__(self, other: Finds) -> Finds:
        return Finds(self.pairs + other.pairs, self.lost + other.lost, self.clash or other.clash)


def distinct(ranked: list[tuple[Setting, Candidate]]) -> list[tuple[Setting, Candidate]]:
    """One of each optimum; a gait and its mirror image (phi0 and -phi0) are one if alike."""
    kept: list[tuple[Setting, Candidate]] = []
    for setting, one in ranked:
        if not any(
            setting is other and _same(one, twin, setting.dynamics.mirrored) for other, twin in kept
        ):
            kept.append((setting, one))
    return kept


def _same(one: Candidate, other: Candidate, mirrored: bool) -> bool:
    """Before their meshes are refined, two finds of one optimum differ a little."""
    a, b = one.gait, other.gait
    offsets = (abs(a.offset), abs(b.offset)) if mirrored else (a.offset, b.offset)
    return (
        one.sign == other.sign
        and math.isclose(one.speed, other.speed, rel_tol=1e-3)
        and math.isclose(a.amplitude, b.amplitude, rel_tol=1e-2)
        and math.isclose(a.period, b.period, rel_tol=1e-2)
        and math.isclose(*offsets, abs_tol=1e-2)
        and math.isclose(one.share, other.share, abs_tol=1e-2)
    )


_TRIAL = 36
"""Intervals on which a gait's own error is tried, to choose its mesh."""
_CLAIM = 3e-7
"""Largest error of a claimed speed, relative."""
_PEAK = 1e-6
"""Largest excess over a limit between nodes, relative."""
_SHAPED_PEAK = 3e-5
"""The same where the solver moves peaks aside."""
_PATIENCE = 5
"""Refinements after which the intervals are halved and, after as many more, a margin is kept from
the torque's limit."""
_PER_HARMONIC = 12
"""Intervals of a period of the fastest harmonic, at least."""
_REFINEMENTS = 14
_SUBSTEPS, _FINEST = 4, 192
"""Of a free gait's interval, and intervals of a Fourier gait, at most."""


def solve_from(setting: Setting, sign: int, gait: Gait, share: float) -> Candidate:
    """Solve from a gait on a mesh that is fine enough for its cycle."""
    wanted = setting.problem.gait
    if wanted.shape == "free":
        return solve(setting, sign, gait, share, regular(wanted.intervals))
    seen = dense(setting, gait, share)
    try:
        coarse = steady_cycle(robot_of(setting, share), gait, steps=_TRIAL).speed
        error = abs(coarse - seen.speed) / abs(seen.speed)
        intervals = intervals_for(_TRIAL, error, _CLAIM / 2)
    except NotConvergedError:  # dry friction too steep for so coarse a mesh
        intervals = LADDER[-1]
    if wanted.shape == "sine":
        return solve(setting, sign, gait, share, regular(intervals).with_nodes_at(seen.peaks))
    # Until an optimum is chosen, limits broken between nodes are no matter.
    intervals = max(intervals, at_least(_PER_HARMONIC * wanted.harmonics))
    return solve(setting, sign, gait, share, regular(intervals))


def refine(setting: Setting, candidate: Candidate) -> Candidate:
    """Solve again until the mesh claims the true speed and no limit is broken between nodes."""
    iterations = candidate.iterations
    peak = _PEAK if setting.problem.gait.shape == "sine" else _SHAPED_PEAK
    for number in range(_REFINEMENTS):
        gait, share = candidate.gait, candidate.share
        seen = dense(setting, gait, share)
        error = abs(abs(candidate.speed) - abs(seen.speed)) / abs(seen.speed)
        finer = _finer(setting, candidate.mesh, error)
        if seen.used <= 1 + peak and (finer is None or error <= _CLAIM):
            # With no finer mesh left, the gait is as good as found; its speed is what was seen.
            speed = candidate.speed if error <= _CLAIM else seen.speed
            candidate = replace(candidate, speed=speed)
            break
        mesh = finer or candidate.mesh
        if number == _PATIENCE and setting.problem.gait.shape == "fourier":
            mesh = replace(regular(at_least(2 * mesh.intervals)), checks=mesh.checks)
        mesh = _held(setting, mesh, seen)
        if number >= 2 * _PATIENCE and seen.used > 1 + peak:
            mesh = replace(mesh, margin=max(mesh.margin, 1 - (1 - mesh.margin) / seen.used))
        candidate = solve(setting, candidate.sign, gait, share, mesh)
        iterations += candidate.iterations
        if not (candidate.feasible and candidate.success):
            break
    return replace(candidate, iterations=iterations)


def _held(setting: Setting, mesh: Mesh, seen: Dense) -> Mesh:
    """The mesh with limits held where they were met."""
    if setting.problem.gait.shape == "sine":
        return mesh.with_nodes_at(seen.peaks)
    return mesh.with_torque_at(seen.peaks).with_checks_at(seen.checks)


def _finer(setting: Setting, mesh: Mesh, error: float) -> Mesh | None:
    """The mesh with which to go on; None if no finer one is left.

    The intervals of a free gait are the user's, as its accelerations are defined on them.
    """
    if error <= _CLAIM:
        return mesh
    if setting.problem.gait.shape == "free":
        return replace(mesh, substeps=2 * mesh.substeps) if mesh.substeps < _SUBSTEPS else None
    if mesh.intervals >= (LADDER[-1] if setting.problem.gait.shape == "sine" else _FINEST):
        return None
    finer = regular(intervals_for(mesh.intervals, error, _CLAIM / 4))
    return replace(finer, checks=mesh.checks, margin=mesh.margin)


Progress = Callable[[str], None]

SIGNS = {"forward": (1,), "backward": (-1,), "either": (1, -1)}


def find_sines(problem: Problem, progress: Progress) -> Finds:
    """Solve from every start; if nothing was found, the clash of limits that explains it."""
    box = decisions(problem)
    clash = posture_clashes(problem, box)
    if clash:
        return Finds(clash=clash)
    progress("scanning for starts")
    settings = settings_of(problem, box)
    starts: list[tuple[Setting, Seed]] = []
    fastest = -math.inf
    for setting in settings:
        inside = scanned(setting, box)
        seeds, best = find_seeds(
            setting.landscape, inside, problem.limits.torque, SIGNS[problem.direction]
        )
        starts += [(setting, seed) for seed in seeds]
        fastest = max(fastest, best)
    finds = Finds()
    for number, (setting, seed) in enumerate(starts, 1):
        progress(f"start {number} of {len(starts)}")
        known = [one for other, one in finds.pairs if other is setting]
        if not problem.turn and any(
            leads_to(setting.landscape, box, problem.limits.torque, seed, one) for one in known
        ):
            continue
        amplitude, period, offset, share = map(float, box.physical(seed.point[None])[:, 0])
        if setting.fixed_share is not None:
            share = setting.fixed_share
        gait = SineGait(amplitude, period, offset)
        try:
            finds.pairs.append((setting, solve_from(setting, seed.sign, gait, share)))
        except NotConvergedError as error:
            finds.lost.append(str(error))
    if finds.good:
        return finds
    landscapes = [setting.landscape for setting in settings]
    clash = torque_clash(problem, box, landscapes) or direction_clash(problem, fastest)
    return finds + Finds(clash=clash)


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
            for seed in scan_shapes(
                setting, SIGNS[problem.direction], _SCANNED if first else _SCANNED_LATER
            ):
                starts.append((setting, seed.sign, seed.gait, seed.share))
    name = "free gait" if problem.gait.shape == "free" else f"{problem.gait.harmonics} harmonics"
    finds = Finds()
    for number, start in enumerate(starts, 1):
        progress(f"{name}: start {number} of {len(starts)}")
        try:
            finds.pairs.append((start[0], solve_from(*start)))
        except NotConvergedError as error:
            finds.lost.append(str(error))
    return finds
