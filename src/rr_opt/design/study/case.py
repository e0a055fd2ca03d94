"""A study: one problem solved with many values of its keys, neighbours from neighbours' optima."""

import math
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from rr_opt.design.candidate import StartResult, distinct
from rr_opt.design.decisions import Setting, decisions, robot_of, settings_of
from rr_opt.design.families import SIGNS, refine, solve_from
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.design.study.measure import measured
from rr_opt.design.study.plan import Foothold, Plan, expected_speed, footholds
from rr_opt.design.study.row import Row
from rr_opt.model.ballast import inertia_ratio
from rr_opt.model.problem import Problem
from rr_opt.motion.servo import for_joint
from rr_opt.outcome import NotConvergedError, RollerRacerError, Status

_SURPRISE = 0.01
"""A speed beyond the expected ones by more, relative, is checked from cold starts."""
_SAME_SPEED = 1e-6


@dataclass(frozen=True)
class Task:
    """A case to solve; without footholds, from cold starts.

    expected  least and largest |speed| that the neighbours let expect, m/s
    """

    problem: Problem
    footholds: tuple[Foothold, ...] = ()
    expected: tuple[float, float] | None = None


def solve_case(task: Task) -> Row:
    """Solve a case. Whatever goes wrong is a row that says so."""
    begun = time.process_time()
    try:
        row = _solve(replace(task, problem=for_joint(task.problem)))
    except RollerRacerError as error:
        row = Row(Status.NOT_CONVERGED, str(error))
    except Exception as error:  # a study of a thousand cases shall not end with one of them
        what = f"{type(error).__name__}: {error}"
        row = Row(Status.NOT_CONVERGED, f"The case ended in an error that is a defect: {what}.")
    return replace(row, seconds=time.process_time() - begun)


def _solve(task: Task) -> Row:
    # Neighbours foretell speeds, not costs.
    warm = task.footholds and task.problem.objective == "speed"
    setting = _only_setting(task.problem) if warm else None
    if setting is None:
        return _cold(task.problem)
    reached: list[tuple[Foothold, StartResult]] = []
    for foothold in task.footholds:
        candidate = _continued(setting, foothold)
        if candidate is not None:
            reached.append((foothold, candidate))
    best = _best(setting, [candidate for _, candidate in reached])
    row = _warm(setting, best) if best else None
    if row is None or _doubtful(task, row, [candidate for _, candidate in reached]):
        cold = _cold(task.problem)
        row = replace(_faster(row, cold), started="warm and cold")
    return replace(
        row,
        tried=_cases(task.footholds),
        continued=_cases(foothold for foothold, candidate in reached if _is(candidate, row)),
        expected=task.expected,
    )


def _cases(footholds: Iterable[Foothold]) -> tuple[int, ...]:
    return tuple(case for one in footholds for case in one.cases)


def _only_setting(problem: Problem) -> Setting | None:
    """The problem made ready; None where there is no inside to continue in, or where whole
    numbers of loads make it several problems."""
    box = decisions(problem)
    if box.empty or box.amplitude_pinned:
        return None
    settings = settings_of(problem, box)
    return settings[0] if len(settings) == 1 else None


def _continued(setting: Setting, foothold: Foothold) -> StartResult | None:
    """The optimum that a neighbour's leads to, if it leads to one."""
    wanted, shape = SIGNS[setting.problem.direction], setting.problem.gait.shape
    if foothold.sign not in wanted or foothold.gait.shape != shape:
        return None
    try:
        found = solve_from(setting, foothold.sign, foothold.gait, foothold.share)
    except NotConvergedError:
        return None
    return found if found.feasible and found.success else None


def _best(setting: Setting, candidates: list[StartResult]) -> StartResult | None:
    """The fastest of them, each optimum refined once."""
    ranked = [(setting, one) for one in sorted(candidates, key=lambda one: one.rank)]
    refined = [refine(setting, one) for _, one in distinct(ranked)]
    good = [one for one in refined if one.feasible and one.success]
    return min(good, key=lambda one: one.rank, default=None)


def _doubtful(task: Task, row: Row, reached: list[StartResult]) -> bool:
    """Whether neighbours disagree, or let expect another speed than was found."""
    if task.expected is None or len(reached) < len(task.footholds) or row.optimum is None:
        return True
    least, most = task.expected
    as_expected = least * (1 - _SURPRISE) <= abs(row.optimum.speed) <= most * (1 + _SURPRISE)
    return not as_expected or not all(_is(one, row) for one in reached)


def _is(candidate: StartResult, row: Row) -> bool:
    """Whether a candidate, not yet refined, is the optimum of a row; a gait and its mirror image
    are one."""
    one, other = candidate.gait, row.optimum
    return other is not None and (
        candidate.sign == other.sign
        and math.isclose(candidate.speed, other.speed, rel_tol=1e-3)
        and math.isclose(one.amplitude, other.amplitude, rel_tol=1e-2)
        and math.isclose(one.period, other.period, rel_tol=1e-2)
        and math.isclose(abs(one.offset), abs(other.offset), abs_tol=1e-2)
    )


def _faster(warm: Row | None, cold: Row) -> Row:
    """The faster row; the cold one if they are equal."""
    if warm is None or warm.optimum is None:
        return cold
    if cold.optimum is None:
        return warm
    least = abs(warm.optimum.speed) * (1 - _SAME_SPEED)
    return cold if abs(cold.optimum.speed) >= least else warm


def _cold(problem: Problem) -> Row:
    solved = maximize_speed(problem)
    if solved.best is None or solved.robot is None or solved.ratio is None:
        return Row(solved.status, solved.message, iterations=solved.iterations)
    row = measured(problem, solved.best, solved.robot, solved.ratio)
    return replace(row, iterations=solved.iterations)


def _warm(setting: Setting, best: StartResult) -> Row:
    robot, choice = robot_of(setting, best.share), setting.problem.inertia_ratio
    ratio = inertia_ratio(robot, choice.about if choice else "joint")
    return replace(measured(setting.problem, best, robot, ratio), started="warm")


Solve = Callable[[Mapping[int, Task]], Iterator[tuple[int, Row | str]]]
"""Solves tasks in any order, on one process or many, and yields each case's row as it is found,
or a sentence where the process was lost that solved it."""


def solve_study(
    problems: Sequence[Problem],
    planned: Plan,
    known: Mapping[int, Row],
    solve: Solve,
    *,
    cold: bool = False,
) -> Iterator[tuple[int, Row]]:
    """The rows of all cases but those that are known, as they are found.

    cold: no case is continued from another. Rows do not depend on the order of work.
    """
    rows = dict(known)

    def found(tasks: Mapping[int, Task]) -> Iterator[tuple[int, Row]]:
        for case, outcome in solve(tasks):
            lost = isinstance(outcome, str)
            rows[case] = Row(Status.NOT_CONVERGED, outcome) if lost else outcome
            yield case, rows[case]

    first = range(len(problems)) if cold else planned.anchors
    yield from found({case: Task(portable(problems[case])) for case in first if case not in rows})
    if cold:
        return
    left = {case: donors for case, donors in planned.donors.items() if case not in rows}
    yield from found(
        {
            case: replace(
                Task(portable(problems[case])),
                footholds=tuple(footholds(donors, rows)),
                expected=expected_speed(problems[case], donors, rows, problems),
            )
            for case, donors in left.items()
        }
    )


def portable(problem: Problem) -> Problem:
    """A problem that can be sent to another process, without what it does not need there."""
    physics = tuple(replace(use, values=dict(use.values)) for use in problem.robot.physics)
    return replace(problem, robot=replace(problem.robot, provenance={}, physics=physics))
