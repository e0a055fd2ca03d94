"""Optima among gaits that are no sines, found family by family.

Every sine is a Fourier gait, and one of few harmonics is one of many; a free gait comes close to
them all. So the optima of each family are starts in the next, which can only be faster, and
shapes at random are other starts.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from rr_opt.design.decisions import decisions
from rr_opt.design.finds import Finds
from rr_opt.design.ranking import distinct
from rr_opt.design.refine import solve_from
from rr_opt.design.setting import Setting, settings_of
from rr_opt.design.shape_scan import scan_shapes
from rr_opt.design.sines import SIGNS, Progress, find_sines
from rr_opt.outcome import NotConvergedError
from rr_opt.problem import GaitBounds, Problem
from rr_opt.robot.gait import Gait

_HARMONICS = (3, 5, 8, 12)
"""Families on the way to a larger one."""
_HANDED_ON = 3
"""How many optima of a family the next one starts from."""
_SCANNED, _SCANNED_LATER = 8, 2
"""How many shapes at random the first family of several harmonics starts from, and a later one."""
_WORTH = 0.8
"""Optima so much slower than the best are not handed on."""


def find_families(problem: Problem, progress: Progress) -> Iterator[tuple[Problem, Finds]]:
    """Optima, or why there are none, of the sines, then of each family up to the problem's."""
    sine = replace(problem, gait=replace(problem.gait, shape="sine"))
    finds = find_sines(sine, progress)
    clash = Finds(clash=finds.clash)
    yield sine, finds
    for gait in _families(problem.gait):
        larger = replace(problem, gait=gait)
        finds = _next(larger, finds, progress)
        yield larger, finds if finds.good else finds + clash


def _families(gait: GaitBounds) -> list[GaitBounds]:
    """The family that is asked for, after those on the way to it."""
    if gait.shape == "free":
        return [replace(gait, shape="fourier", harmonics=n) for n in _HARMONICS[:2]] + [gait]
    before = [n for n in _HARMONICS if n < gait.harmonics]
    return [replace(gait, harmonics=n) for n in before] + [gait]


def _next(problem: Problem, before: Finds, progress: Progress) -> Finds:
    """Solve in this problem's family from the optima of the one before."""
    settings = settings_of(problem, decisions(problem))
    starts: list[tuple[Setting, int, Gait, float]] = []
    for old, one in distinct(before.good)[:_HANDED_ON]:
        if abs(one.speed) < _WORTH * before.fastest:
            break
        setting = next(new for new in settings if new.fixed_share == old.fixed_share)
        starts.append((setting, one.sign, one.gait, one.share))
    if problem.gait.shape == "fourier":
        for setting in settings[:1] if starts else settings:
            most = _SCANNED if problem.gait.harmonics <= _HARMONICS[0] else _SCANNED_LATER
            for seed in scan_shapes(
                setting, problem.gait.harmonics, SIGNS[problem.direction], most
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
