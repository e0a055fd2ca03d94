"""All optima among sines: scan the box of gaits, then solve from every promising point."""

from __future__ import annotations

import math
from collections.abc import Callable

from rr_opt.design.basin import leads_to
from rr_opt.design.decisions import decisions
from rr_opt.design.finds import Finds
from rr_opt.design.infeasible import direction_clash, posture_clashes, torque_clash
from rr_opt.design.refine import solve_from
from rr_opt.design.seeds import Seed, find_seeds
from rr_opt.design.setting import Setting, scanned, settings_of
from rr_opt.outcome import NotConvergedError
from rr_opt.problem import Problem
from rr_opt.robot.gait import SineGait

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
