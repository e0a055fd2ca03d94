"""A study: one problem solved with many values of its keys, neighbours from neighbours' optima."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace

from rr_opt.design.study.case import Task
from rr_opt.design.study.neighbours import expected_speed, footholds
from rr_opt.design.study.plan import Plan
from rr_opt.design.study.row import Row
from rr_opt.outcome import Status
from rr_opt.problem import Problem

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
    yield from found({case: _cold(problems[case]) for case in first if case not in rows})
    if cold:
        return
    left = {case: donors for case, donors in planned.donors.items() if case not in rows}
    yield from found(
        {
            case: replace(
                _cold(problems[case]),
                footholds=tuple(footholds(donors, rows)),
                expected=expected_speed(problems[case], donors, rows, problems),
            )
            for case, donors in left.items()
        }
    )


def _cold(problem: Problem) -> Task:
    """A task that can be sent to another process, without what it does not need there."""
    physics = tuple(replace(use, values=dict(use.values)) for use in problem.robot.physics)
    return Task(replace(problem, robot=replace(problem.robot, provenance={}, physics=physics)))
