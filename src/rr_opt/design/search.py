"""All optima among sines: tops all over the box, each climbed to its end."""

from collections.abc import Callable

import numpy as np

from rr_opt.design.candidate import Finds, StartResult
from rr_opt.design.decisions import Setting, decisions, scanned, settings_of
from rr_opt.design.infeasible import NODES, clash, posture_clashes
from rr_opt.design.seeds import tops
from rr_opt.design.sines import WAYS, climbed, solve_from_kept, solve_sine
from rr_opt.design.terrain import Terrain
from rr_opt.model.problem import Problem
from rr_opt.sqp import FEASIBLE

Progress = Callable[[str], None]


def find_sines(problem: Problem, progress: Progress) -> Finds:
    """Climb from all over the box; if nothing was found, the clash of limits that explains it."""
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
    progress("no start led to an optimum: looking everywhere for gaits that keep all limits")
    found = clash(problem, box, settings)
    if isinstance(found, str):
        kept = any(one.feasible for _, one in finds.pairs)
        return finds if kept else finds + Finds(clash=found)
    setting = found.setting
    return finds + Finds([(setting, solve_from_kept(setting, way, found.gait, NODES))])


def _turned_round(setting: Setting, best: StartResult) -> list[tuple[Setting, StartResult]]:
    """The same circle driven the other way, where a climb leads to it: a gait that does can be next
    to this one, V = 0 between them, too close for a scan to tell them apart."""
    gait, way = best.gait, -best.sign
    terrain = Terrain(setting, decisions(setting.problem), way)
    start = np.array([gait.amplitude, gait.period, gait.offset, best.share])
    ascent, end = climbed(terrain, start)
    return [(setting, solve_sine(setting, way, end))] if ascent.violation <= FEASIBLE else []
