"""Gaits of a problem: the fastest, of each waveform, turn and study, checked; and plain sweeps."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rr_opt.api.load import PathLike, identity, problem_of, read_arguments
from rr_opt.batch.journal import JOURNAL, Journal
from rr_opt.batch.run import pool_of, run
from rr_opt.design import maximize_speed as design
from rr_opt.design.decisions import decisions
from rr_opt.design.infeasible import posture_clashes
from rr_opt.design.maximize_speed import Optimum
from rr_opt.design.robust import RELIABLE, RobustGait, robust_gait
from rr_opt.design.study.case import solve_case, solve_study
from rr_opt.design.study.plan import plan
from rr_opt.design.study.row import Row, row_from, row_record
from rr_opt.design.turn import arc_of, fastest_turn
from rr_opt.design.turn_target import Target, checked
from rr_opt.documents.archive import folder_for_results
from rr_opt.files.study_file import Study, read_study
from rr_opt.messages import listed
from rr_opt.model.ballast import inertia_ratio
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Problem, Spreads
from rr_opt.motion.dynamics import require_friction
from rr_opt.outcome import InputError, Status
from rr_opt.results.fastest import FastestGait
from rr_opt.results.result import Progress, quiet
from rr_opt.results.robust import Robust
from rr_opt.results.shapes import FastestShapes, family_name
from rr_opt.results.study import SolvedStudy
from rr_opt.results.sweep import Sweep
from rr_opt.results.turn import FastestTurn
from rr_opt.results.turn_chart import TurnChart
from rr_opt.verify import sweep as verify
from rr_opt.verify.grid import free_decisions
from rr_opt.verify.replay import Replay, check_circle, replay
from rr_opt.verify.spread import drawn
from rr_opt.verify.sweep import SweepCheck, SweepResult, check_optimum
from rr_opt.verify.turn_chart import radius_claim, sign_claim, tightest, turn_map
from rr_opt.version import __version__

if TYPE_CHECKING:
    from rr_opt.batch.pools import Pool
    from rr_opt.machines.racer.driven import DrivenOptimum


def maximize_speed(problem: Problem | PathLike, *, progress: Progress = quiet) -> FastestGait:
    """The best gait of a problem or its file, checked by simulation and against a plain sweep: the
    fastest, or that of the least cost of transport.

    Where no gait respects every limit, or a check fails, the result's `status` and `message` say
    so. With `robust` it has besides the gait that is fast on most of the robots that the file may
    mean. Raises InputError for a robot without friction, which has no steady speed.
    """
    problem = problem_of(problem)
    _require_known(problem)
    optimum, replayed, swept = _checked(design.maximize_speed(problem, progress), progress)
    driven = _driven(optimum, progress)
    best = FastestGait(*identity(problem), optimum, replayed, swept, driven=driven)
    if problem.robust and best.gait is not None:
        progress("the robust gait")
        best = replace(best, robust=_robust(best, problem.robust))
    if optimum.best is None or not best.rebuilt:
        return best
    progress("the robot as built")
    as_built = design.maximize_speed(replace(problem, inertia_ratio=None)).best
    return replace(best, as_built=as_built.speed if as_built else None)


def _require_known(problem: Problem) -> None:
    """Raise InputError where energy counts and the optimiser lacks an effect on it."""
    if not (problem.economy and problem.robot.physics):
        return
    from rr_opt.machines.racer.driven import beyond_optimiser

    if names := beyond_optimiser(problem.robot):
        raise InputError(
            f"Read {listed(names)} in the robot's physics with `objective: cost_of_transport` or "
            "one of the limits power, cost_of_transport and speed. The optimiser knows no energy "
            "of a robot with such effects. Leave them out, or ask for the speed alone."
        )


def _driven(optimum: Optimum, progress: Progress) -> DrivenOptimum | None:
    """The optimum driven with all effects of its robot, where the optimiser lacks some."""
    if not optimum.problem.robot.physics:
        return None
    from rr_opt.machines.racer.driven import drive_optimum

    progress("drive with all effects")
    return drive_optimum(optimum)


_MARGIN, _TIGHTENED = 1e-3, 6
"""By so much more than enough robots shall keep the limit, so that the next try does; tries."""
_SCALES = tuple(np.linspace(0.0, 2.0, 9).tolist())


def _robust(best: FastestGait, spreads: Spreads) -> Robust | None:
    """The robust gait beside the nominal optimum, and what robots drawn at random make of both."""
    torque, choice = best.problem.limits.torque, best.problem.inertia_ratio
    nominal = best.optimum.best.gait if best.optimum.best else None
    if not isinstance(nominal, SineGait):
        return None
    found = _kept_by_most(best.optimum, spreads)
    if found is None:
        return None
    gaits = (found.robot, found.gait), (best.robot, nominal)
    seen, mine = (drawn(*one, spreads) for one in gaits)
    other, speed = drawn(found.robot, found.gait, spreads, seed=2), seen.reached(RELIABLE)
    first, second = (
        tuple(drawn(*one, spreads, scale).reached(RELIABLE) for scale in _SCALES) for one in gaits
    )
    return Robust(
        gait=best.command_for(found.gait),
        ratio=inertia_ratio(found.robot, choice.about if choice else "joint"),
        speed=speed,
        nominal=found.nominal,
        without=mine.reached(RELIABLE),
        kept=mine.keeping(torque),
        reaching=other.reaching(speed),
        keeping=other.keeping(torque),
        scales=_SCALES,
        curves=(first, second),
    )


def _kept_by_most(optimum: Optimum, spreads: Spreads) -> RobustGait | None:
    """The robust gait, the limit on torque tightened until enough of the robots drawn keep it."""
    problem, torque = optimum.problem, optimum.problem.limits.torque
    tightened = torque
    for _ in range(_TIGHTENED):
        limits = replace(problem.limits, torque=tightened)
        found = robust_gait(replace(optimum, problem=replace(problem, limits=limits)), spreads)
        if found is None:
            return None
        seen = drawn(found.robot, found.gait, spreads)
        if seen.keeping(torque) >= RELIABLE:
            return found
        tightened *= torque / float(np.quantile(seen.torque, RELIABLE + _MARGIN))
    return None


def _require_exact(problem: Problem) -> None:
    """Raise InputError where robust gaits are asked for that only `maximize_speed` knows."""
    if problem.robust:
        raise InputError(
            "Read `robust` in the problem. Robust gaits are found by `maximize-speed` only, not "
            "for turns, other shapes or studies. Leave it out here."
        )


_RESUMED = 2
"""Climbs on from what the sweep found, at most."""


def _checked(
    optimum: Optimum, progress: Progress, swept: SweepResult | None = None
) -> tuple[Optimum, Replay | None, SweepCheck | None]:
    """The optimum with its replay and the sweep against it; None and None if there is no gait.

    Where the sweep found a better gait the optimiser climbs on from there, and what it comes to is
    checked instead.

    swept  a sweep of the whole problem, where that is done already
    """
    if optimum.best is None and optimum.problem.gait.shape != "sine":
        return optimum, None, None
    progress("check against a sweep")
    swept = swept or verify.sweep(optimum.problem)
    check = _held(optimum, swept)
    for _ in range(_RESUMED):
        better = check.better if check else swept.refined
        if better is None:
            break
        progress("climb on from a gait that the sweep found")
        climbed = design.resumed(optimum, better.gait, better.ratio)
        if climbed is optimum:
            break
        optimum, check = climbed, _held(climbed, swept)
    if optimum.best is None or optimum.robot is None:
        proved = posture_clashes(optimum.problem, decisions(optimum.problem))
        if optimum.status is Status.INFEASIBLE and not proved:
            second = f" A sweep of {swept.points} gaits by another model finds none either."
            optimum = replace(optimum, message=optimum.message + second)
        return optimum, None, None
    progress("replay by CVODES")
    replayed = replay(optimum.robot, optimum.best.gait, optimum.problem.limits, optimum.best.speed)
    return optimum, replayed, check


def _held(optimum: Optimum, swept: SweepResult) -> SweepCheck | None:
    if optimum.best is None:
        return None
    best, posed = optimum.best, optimum.problem
    cost = best.cost or math.nan
    return check_optimum(posed, best.gait, optimum.ratio, best.speed, everywhere=swept, cost=cost)


def shapes(problem: Problem | PathLike, *, progress: Progress = quiet) -> FastestShapes:
    """The fastest sine, compared with the fastest gaits of 3 and 5 harmonics and of free shape.

    All respect the limits of the problem, whose own shape is ignored, and each is checked. Raises
    InputError for a robot without friction.
    """
    problem = problem_of(problem)
    _require_exact(problem)
    name, sha256 = identity(problem)
    optima = design.compare_shapes(problem, progress)
    swept = None
    if any(one.best for one in optima):
        # One for all: it is a sweep of the sines, whatever the shape.
        progress("sweep of all sines")
        swept = verify.sweep(problem)
    answers = []
    for one in optima:
        own = f"{name}, {family_name(one.problem.gait)}"
        optimum, replayed, check = _checked(one, progress, swept)
        driven = _driven(optimum, progress)
        answers.append(FastestGait(own, sha256, optimum, replayed, check, driven=driven))
    return FastestShapes(name, sha256, tuple(answers))


def turn(
    problem: Problem | PathLike,
    *,
    radius: float | str | None = None,
    heading: float | str | None = None,
    within: float | str | None = None,
    length: float | str | None = None,
    whole: bool = False,
    progress: Progress = quiet,
) -> FastestTurn:
    """The fastest gait round a circle or through a change of heading, checked.

    radius   of the circle, m, positive to the left
    heading  change of heading, rad, positive to the left; with radius, within or length
    within   longest time for the change of heading, s
    length   longest path for it, m
    whole    make it in a whole number of periods

    Each is a number in SI or a text with its unit. Where the problem fixes the offset, it is freed.
    Raises InputError for what is no turn.
    """
    asked = {"radius": radius, "heading": heading, "within": within, "length": length}
    target = checked(Target(**read_arguments(asked), whole=whole))
    problem = problem_of(problem)
    _require_known(problem)
    _require_exact(problem)
    name, sha256 = identity(problem)
    turned = fastest_turn(problem, target, progress)
    optimum, replayed, swept = _checked(turned.optimum, progress)
    best, robot, arc = optimum.best, optimum.robot, arc_of(optimum, target.heading)
    found = FastestTurn(name, sha256, optimum, target=target, opened=turned.opened)
    if best is None or robot is None or arc is None:
        return found
    progress("check of the circle")
    wanted = target.turn.curvature
    circle = check_circle(robot, best.gait, wanted.low if wanted.fixed else arc.curvature)
    driven = _driven(optimum, progress)
    return replace(found, replay=replayed, sweep=swept, arc=arc, circle=circle, driven=driven)


def load_study(path: str | Path) -> Study:
    """The study of a file. Raises InputError with everything that is wrong in any case."""
    return read_study(path)[0]


def study(
    asked: Study | str | Path,
    *,
    folder: str | Path | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    cold: bool = False,
    restart: bool = False,
    progress: Progress = quiet,
) -> SolvedStudy:
    """Solve every case of a study, or of a study file; each begins at its neighbours' optima.

    folder     where finished rows are kept, so that the same call resumes after an interruption
    workers    processes here; None: one for each core. A script that uses more than one keeps its
               own work under `if __name__ == "__main__":`
    scheduler  of a dask cluster to work on instead, `tcp://HOST:PORT`
    cold       solve every case from cold starts alone
    restart    discard the rows of an earlier run

    Raises InputError for a folder with the rows of another study.
    """
    if not isinstance(asked, Study):
        asked = load_study(asked)
    _require_exact(asked.problems[0])
    pool = partial(pool_of, workers, scheduler)
    if folder is None:
        return _solved(asked, {}, lambda *_: None, pool, progress, cold=cold)
    identity = {"input_sha256": asked.sha256, "version": __version__, "cold": cold}
    path, cases = folder_for_results(Path(folder)) / JOURNAL, len(asked.problems)
    with Journal(path, identity, read=row_from, cases=cases, restart=restart) as journal:
        rows = journal.rows
        if rows:
            progress(f"{len(rows)} of {cases} rows were solved in an earlier run.")

        def keep(case: int, row: Row) -> None:
            journal.append(case, row_record(row))

        try:
            return _solved(asked, rows, keep, pool, progress, cold=cold)
        except KeyboardInterrupt:
            raise KeyboardInterrupt(
                f"{len(rows)} of {cases} rows are kept. Repeat the command to resume."
            ) from None


def _solved(
    asked: Study,
    rows: dict[int, Row],
    keep: Callable[[int, Row], object],
    open_pool: Callable[[], Pool],
    progress: Progress,
    *,
    cold: bool,
) -> SolvedStudy:
    """With the rows that are not there yet solved, each kept as soon as it is."""
    rows, total = dict(rows), len(asked.problems)
    if len(rows) < total:
        planned = plan([axis.numbers for axis in asked.axes], asked.shape)
        with closing(open_pool()) as pool:
            progress(f"case {len(rows) + 1} of {total}")
            solve = partial(run, pool, solve_case)
            for case, row in solve_study(asked.problems, planned, rows, solve, cold=cold):
                keep(case, row)
                rows[case] = row
                progress(f"case {min(len(rows) + 1, total)} of {total}")
    return SolvedStudy(asked, tuple(rows[case] for case in range(total)))


def sweep(
    problem: Problem | PathLike, points: int = 10_000, *, progress: Progress = quiet
) -> Sweep:
    """Evaluate about `points` gaits all over the bounds, and refine the best.

    Raises InputError for a robot without friction.
    """
    problem = problem_of(problem)
    require_friction(problem.robot)
    counts = max(2, math.ceil(points ** (1 / max(len(free_decisions(problem)), 1))))
    tried = verify.sweep(problem, counts, lambda done, of: progress(f"gait {done} of {of}"))
    return Sweep(*identity(problem), problem, tried)


_DRAWN = (6, 4, 121)
"""Amplitudes, periods and offsets of the chart."""
_TESTED = (24, 10, 101)
"""The same of the map on which the paper's claim is tested."""


def turn_chart(problem: Problem | PathLike, *, progress: Progress = quiet) -> TurnChart:
    """Radius over offset, amplitude and period, and the tightest circle within the limits.

    The inertia ratio is that of the robot as it is. Raises InputError for a robot without friction.
    """
    problem = problem_of(problem)
    require_friction(problem.robot)
    progress("chart")
    seen = turn_map(problem, _DRAWN)
    progress("the paper's claim")
    fine = turn_map(problem, _TESTED)
    progress("tightest circle")
    tight = tightest(problem)
    claims = sign_claim(fine), radius_claim(fine)
    return TurnChart(*identity(problem), problem, seen, tight, *claims)
