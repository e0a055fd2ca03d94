"""Optima of a problem: among sines, then family by family of non-sinusoidal gaits.

Sines: multistart over the whole box, with each climb run to convergence. Every sine is a Fourier
gait, every Fourier gait is also one of more harmonics, and a free gait approximates them all. So
each family is warm-started from the optima of the previous one, and from random shapes as well.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from rr_opt.array import Array
from rr_opt.design.candidate import Finds, StartResult, distinct
from rr_opt.design.decisions import SQUARE, Setting, decisions, robot_of, scanned, settings_of
from rr_opt.design.infeasible import NODES, clash, posture_clashes
from rr_opt.design.seeds import tops
from rr_opt.design.sines import WAYS, climbed, refine_sine, solve_from_kept, solve_sine
from rr_opt.design.solve import dense, solve
from rr_opt.design.terrain import Terrain
from rr_opt.design.transcription import LADDER, Mesh, at_least, intervals_for, regular
from rr_opt.model.gait import FourierGait, Gait
from rr_opt.model.problem import GaitBounds, Problem
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.outcome import NotConvergedError
from rr_opt.sqp import FEASIBLE

Progress = Callable[[str], None]


def find_sines(problem: Problem, progress: Progress) -> Finds:
    """Climb from starts all over the box; if none succeeds, find the conflicting limits."""
    box = decisions(problem)
    posture = posture_clashes(problem, box)
    if posture:
        return Finds(clash=posture)
    progress("scanning for starts")
    way = WAYS[problem.direction]
    settings = settings_of(problem, box)
    finds = Finds()
    for setting in settings:
        inside = scanned(setting, box)
        starts = inside.physical(tops(Terrain(setting, inside, way))[0]).T
        for number, start in enumerate(starts, 1):
            progress(f"start {number} of {len(starts)}")
            finds.pairs.append((setting, solve_sine(setting, way, start)))
    if finds.good and problem.turn and not way:
        finds.pairs.extend(_turned_round(*finds.good[0]))
    if finds.good:
        return finds
    progress("no start led to an optimum: searching everywhere for gaits that keep all limits")
    found = clash(problem, box, settings)
    if isinstance(found, str):
        kept = any(one.feasible for _, one in finds.pairs)
        return finds if kept else finds + Finds(clash=found)
    setting = found.setting
    return finds + Finds([(setting, solve_from_kept(setting, way, found.gait, NODES))])


def _turned_round(setting: Setting, best: StartResult) -> list[tuple[Setting, StartResult]]:
    """The same circle driven the other way, if a climb leads to it. Its gait can be so close to
    this one, with V = 0 between them, that a scan does not separate them."""
    gait, way = best.gait, -best.sign
    terrain = Terrain(setting, decisions(setting.problem), way)
    start = np.array([gait.amplitude, gait.period, gait.offset, best.share])
    ascent, end = climbed(terrain, start)
    return [(setting, solve_sine(setting, way, end))] if ascent.violation <= FEASIBLE else []


_TRIAL = 36
"""Intervals of the trial mesh on which a gait's discretisation error is measured."""
_CLAIM = 3e-7
"""Largest relative error of the speed on the mesh."""
_PEAK = 3e-5
"""Largest relative violation of a limit between nodes, where the solver tends to move peaks."""
_PATIENCE = 5
"""Refinements before the intervals are halved; after as many again, a margin to the torque limit is
kept."""
_PER_HARMONIC = 12
"""Fewest intervals per period of the fastest harmonic."""
_REFINEMENTS = 14
_SUBSTEPS, _FINEST = 4, 192
"""Most substeps of a free gait's interval, and most intervals of a Fourier gait."""


def solve_from(setting: Setting, sign: int, gait: Gait, share: float) -> StartResult:
    """Solve from a gait; one that is not a sine gets a mesh fine enough for its cycle."""
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
    # Until an optimum is chosen, violations between nodes do not matter.
    intervals = max(intervals, at_least(_PER_HARMONIC * wanted.harmonics))
    return solve(setting, sign, gait, share, regular(intervals))


def refine(setting: Setting, candidate: StartResult) -> StartResult:
    """Re-solve until the mesh gives the true speed and no limit is violated between nodes."""
    if candidate.mesh is None:
        return refine_sine(setting, candidate)
    iterations, mesh = candidate.iterations, candidate.mesh
    for number in range(_REFINEMENTS):
        gait, share = candidate.gait, candidate.share
        seen = dense(setting, gait, share)
        error = abs(abs(candidate.speed) - abs(seen.speed)) / abs(seen.speed)
        finer = _finer(setting, mesh, error)
        if seen.used <= 1 + _PEAK and (finer is None or error <= _CLAIM):
            # On the finest mesh the gait is kept as it is, with its measured speed.
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
    """The mesh for the next refinement; None if there is none finer.

    A free gait keeps the user's intervals, as its accelerations are defined on them.
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
"""Numbers of harmonics of the intermediate families."""
_HANDED_ON = 3
"""Optima of a family used as warm starts for the next."""
_SCANNED, _SCANNED_LATER = 8, 2
"""Random shapes used as starts by the first family of several harmonics, and by later ones."""
_WORTH = 0.8
"""Optima slower than this fraction of the best are not used as warm starts."""


def find_families(
    problem: Problem, progress: Progress, on_the_way: tuple[int, ...] | None = None
) -> Iterator[tuple[Problem, Finds]]:
    """Optima of the sines, then of each family up to the problem's; or why there are none.

    on_the_way: numbers of harmonics of the intermediate families.
    """
    sine = replace(problem, gait=replace(problem.gait, shape="sine"))
    finds = find_sines(sine, progress)
    yield sine, finds
    # Another shape may do what a sine cannot, but this conflict rules out every shape.
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
    """The problem with its least amplitude lowered to what the least demanding shape would need."""
    amplitude = problem.gait.amplitude
    amplitude = replace(amplitude, low=SQUARE * amplitude.low)
    return replace(problem, gait=replace(problem.gait, amplitude=amplitude))


def _families(gait: GaitBounds, on_the_way: tuple[int, ...] | None) -> list[GaitBounds]:
    """The intermediate families, then the requested one."""
    before = _ON_THE_WAY[gait.shape] if on_the_way is None else on_the_way
    if gait.shape == "fourier":
        before = tuple(n for n in before if n < gait.harmonics)
    return [*(replace(gait, shape="fourier", harmonics=n) for n in before), gait]


def _next(problem: Problem, before: Finds, progress: Progress) -> Finds:
    """Solve in this problem's family, warm-started from the optima of the previous one."""
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
            seeds = _scan_shapes(setting, SIGNS[problem.direction], most)
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


_SHAPES, _TRIANGLES, _PHASES = 1500, 100, 48
_CONSIDERED = 5
"""Harmonics of the random shapes; higher ones are left to the solver."""
_SHAPES_APART = 0.25


def _scan_shapes(
    setting: Setting, signs: tuple[int, ...], most: int
) -> list[tuple[int, FourierGait, float]]:
    """Direction (+1 forward, -1 backward), gait and ballast share of the best few random shapes
    within all limits but perhaps the torque's, best first; if none reaches the least amplitude, of
    those closest to it."""
    gait = setting.problem.gait
    harmonics = _CONSIDERED if gait.shape == "free" else min(gait.harmonics, _CONSIDERED)
    if decisions(setting.problem).empty or harmonics < 2:
        return []
    T, phi0, share, sines, cosines = _random_shapes(setting, harmonics)
    theta = 2 * math.pi * np.arange(2 * _PHASES) / (2 * _PHASES)
    with np.errstate(all="ignore"):
        omega = 2 * math.pi / T
        swing, rate, bend = (_waves(sines, cosines, theta, k) for k in range(3))
        angle = phi0 + swing, omega * rate, omega**2 * bend
        cycles = setting.landscape.along(angle, T, share)
        excess = np.maximum(cycles.peak_torque / setting.problem.limits.torque - 1, 0.0)
    known = np.isfinite(cycles.speed + excess) & np.isin(np.sign(cycles.speed), signs)
    allowed = known & (sines[0] >= gait.amplitude.low)
    size = np.where(allowed, np.abs(cycles.speed), 0.0)
    merit = np.where(allowed, size - 3 * size.max() * excess, -np.inf)
    if not allowed.any():
        merit = np.where(known, sines[0], -np.inf)
    vectors, found = np.vstack([sines, cosines]), []
    for k in _unlike(merit, vectors / np.linalg.norm(vectors, axis=0), most):
        coefficients = tuple(sines[:, k].tolist()), tuple(cosines[:, k].tolist())
        shape = FourierGait(float(T[k]), float(phi0[k]), *coefficients)
        found.append((int(np.sign(cycles.speed[k])), shape, float(share[k])))
    return found


def _random_shapes(setting: Setting, n: int) -> tuple[Array, Array, Array, Array, Array]:
    """Period (s), offset (rad) and ballast share (K,), sines and cosines (n, K), rad, of random
    shapes that are at most as large as the limits on angle and rate allow."""
    problem = setting.problem
    box, rng = decisions(problem), np.random.default_rng(0)
    T = box.period.low * (box.period.high / box.period.low) ** rng.random(_SHAPES)
    phi0 = box.offset.low + (box.offset.high - box.offset.low) * rng.random(_SHAPES)
    share = rng.random(_SHAPES)
    if setting.fixed_share is not None:
        share[:] = setting.fixed_share
    order = np.arange(1, n + 1)[:, None]
    sines, cosines = (rng.normal(0, 0.5, (n, _SHAPES)) / order for _ in range(2))
    sines[0], cosines[0] = 1.0, 0.0
    # Triangle waves, which need the least rate for their first harmonic.
    sines[:, :_TRIANGLES], cosines[:, :_TRIANGLES] = _triangle(n)[:, None], 0.0
    theta = np.linspace(0, 2 * math.pi, 4 * _PHASES)
    swing, rate = (np.abs(_waves(sines, cosines, theta, k)).max(axis=0) for k in range(2))
    most_swing = np.minimum(problem.gait.amplitude.high, box.reach - np.abs(phi0))
    largest = np.minimum(most_swing / swing, problem.limits.rate * T / (2 * math.pi * rate))
    scale = largest * np.append(np.ones(_TRIANGLES), rng.uniform(0.3, 1.0, _SHAPES - _TRIANGLES))
    return T, phi0, share, scale * sines, scale * cosines


def _triangle(n: int) -> Array:
    """Sine coefficients of a triangle wave, the first equal to 1."""
    order = np.arange(1, n + 1)
    return np.sin(order * math.pi / 2) / order**2


def _waves(sines: Array, cosines: Array, theta: Array, order: int) -> Array:
    """The order-th derivative in theta at every phase, (len(theta), K)."""
    n = np.arange(1, len(sines) + 1)
    turned = theta[:, None] * n + order * math.pi / 2
    return (n**order * np.sin(turned)) @ sines + (n**order * np.cos(turned)) @ cosines


def _unlike(merit: Array, shapes: Array, most: int) -> list[int]:
    """Indices of the best shapes that differ from better ones, best first."""
    merit, chosen = merit.copy(), []
    while len(chosen) < most and merit.max() > 0:
        best = int(merit.argmax())
        chosen.append(best)
        merit[np.linalg.norm(shapes - shapes[:, [best]], axis=0) <= _SHAPES_APART] = -np.inf
    return chosen
