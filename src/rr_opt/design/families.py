"""Optima among gaits that are no sines, found family by family.

Every sine is a Fourier gait, and one of few harmonics is one of many; a free gait comes close to
them all. So the optima of each family are starts in the next, which can only be faster, and
shapes at random are other starts.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from rr_opt.design.decisions import SQUARE, decisions
from rr_opt.design.finds import Finds
from rr_opt.design.infeasible import posture_clashes
from rr_opt.design.ranking import distinct
from rr_opt.design.refine import solve_from
from rr_opt.design.setting import Setting, settings_of
from rr_opt.design.shape_scan import scan_shapes
from rr_opt.design.sines import SIGNS, Progress, find_sines
from rr_opt.outcome import NotConvergedError
from rr_opt.problem import GaitBounds, Problem
from rr_opt.robot.gait import Gait

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
