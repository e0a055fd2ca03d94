"""All optima among sines: tops all over the box, each climbed to its end."""

from collections.abc import Callable

from rr_opt.design.candidate import Finds
from rr_opt.design.decisions import decisions, scanned, settings_of
from rr_opt.design.infeasible import NODES, clash, posture_clashes
from rr_opt.design.seeds import tops
from rr_opt.design.sines import WAYS, solve_from_kept, solve_sine
from rr_opt.design.terrain import Terrain
from rr_opt.model.problem import Problem

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
    if any(one.feasible for _, one in finds.pairs):
        return finds
    progress("no start keeps all limits: looking everywhere for gaits that do")
    found = clash(problem, box, settings)
    if isinstance(found, str):
        return finds + Finds(clash=found)
    setting = found.setting
    return finds + Finds([(setting, solve_from_kept(setting, way, found.gait, NODES))])
