"""The fastest gait of a problem as a document, and as a folder."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

from rr_opt.answers.answer import listed
from rr_opt.answers.quantities import QUANTITIES, number, price_text, speed_text, with_unit
from rr_opt.answers.speed import LIMIT_NAMES, SpeedAnswer
from rr_opt.model.ballast import inertia_ratio
from rr_opt.model.parameters import PARAMETERS, parameters_of
from rr_opt.model.robot import Robot
from rr_opt.motion.rollout import one_period
from rr_opt.outcome import Status
from rr_opt.report.archive import remove, write_json
from rr_opt.report.document import (
    Badge,
    Cell,
    Document,
    Fact,
    Facts,
    Figure,
    Gallery,
    Section,
    Table,
    Tone,
    checks,
    table,
)
from rr_opt.report.gait import gait_facts, speed_fact
from rr_opt.report.result import result, turns
from rr_opt.report.text import terminal
from rr_opt.report.trajectory_file import write_csv
from rr_opt.report.webpage import PAGE, write_page
from rr_opt.version import __version__

_SHOWN = {"m": ("mm", 1e3), "kg m^2": ("kg m²", 1.0)}
"""SI unit -> the unit shown, and how many of it are one SI unit."""
_SERVO = {"angle_limit": "angle", "rate_limit": "rate", "torque_limit": "torque"}
_ORIGINS: dict[str, Tone] = {"measured": "good", "fitted": "note", "assumed": "warn"}
_TITLES = {
    Status.OPTIMAL: "The robot does not move",
    Status.INFEASIBLE: "No gait respects all limits",
    Status.NOT_CONVERGED: "No confirmed optimum",
}


def speed_document(
    answer: SpeedAnswer, figures: Iterable[Figure] = (), turn: Section | None = None
) -> Document:
    """The report of a fastest gait; turn: a section that leads the others."""
    optimum = answer.optimum
    good = answer.status is Status.OPTIMAL
    lead = " ".join(["Every check confirms it.", *answer.remarks, limited_by(answer)])
    choice = optimum.problem.inertia_ratio
    chosen = "platform2.I" if choice and choice.by == "inertia" and optimum.best else ""
    return Document(
        name=answer.name,
        kind="fastest gait",
        title=answer.headline or _TITLES[answer.status],
        lead=lead if good else answer.message,
        good=good,
        sections=(
            Section("", (Facts(_facts(answer), key=True),)),
            *([turn] if turn else []),
            Section("Checks", (checks((one.passed, one.sentence) for one in answer.checks),)),
            Section("", (Gallery(tuple(figures)),), brief=False),
            Section("Limits", (_limits(answer),), brief=optimum.best is not None),
            Section("Decisions and their bounds", (_bounds(answer),)),
            Section("Local optima", (_optima(answer),)),
            Section(
                "Robot", (robot_table(optimum.robot or optimum.problem.robot, chosen),), brief=False
            ),
            Section("Solver", (_solver(answer),), brief=optimum.best is not None),
        ),
        footer=(f"rr-opt {__version__}", f"input SHA-256 `{answer.sha256}`"),
    )


def summary(answer: SpeedAnswer, files: Iterable[Path]) -> str:
    """The report as text for a terminal."""
    return terminal(speed_document(answer), files)


def limited_by(answer: SpeedAnswer) -> str:
    """`It is limited by the rate limit and the lower bound of the period.`"""
    if answer.replay is None:
        return ""
    active = [
        "the singularity margin" if row.name == "singularity" else f"the {row.name} limit"
        for row in answer.limits.values()
        if row.active
    ]
    active += [
        f"the {'lower' if row.active == 'low' else 'upper'} bound of the "
        f"{QUANTITIES[row.name].words}"
        for row in answer.bounds.values()
        if row.active in ("low", "high")
    ]
    if not active:
        return "No limit or bound is active: it is an interior optimum."
    return f"It is limited by {listed(active)}."


def _facts(answer: SpeedAnswer) -> tuple[Fact, ...]:
    best = answer.optimum.best
    if best is None or answer.replay is None:
        return ()
    return (
        speed_fact(best.speed),
        *_as_built(answer),
        *gait_facts(best.gait),
        _ratio(answer),
        _cycle(answer),
    )


def _ratio(answer: SpeedAnswer) -> Fact:
    """J20/J10, about which point, and how it is realised."""
    choice, built = answer.optimum.problem.inertia_ratio, answer.problem.robot
    about = choice.about if choice else "joint"
    ratio = number(answer.optimum.ratio or 0.0)
    where = f"about {'the joint P' if about == 'joint' else 'the centres of mass'}"
    if choice is None or not answer.rebuilt:
        return Fact("J20/J10", ratio, f"{where}, the robot as it is")
    means = ", by loads on platform 2" if choice.by == "loads" else ""
    return Fact(
        "J20/J10",
        ratio,
        f"{where}{means}: I2 {built.platform2.I:.4g} -> {answer.robot.platform2.I:.4g} kg m2 "
        f"(ratio {number(inertia_ratio(built, about))} -> {ratio})",
    )


def _as_built(answer: SpeedAnswer) -> tuple[Fact, ...]:
    """The best speed with the inertia ratio unchanged; nothing if it has not changed."""
    if not answer.rebuilt or answer.as_built is None:
        return ()
    return (Fact("as built", speed_text(answer.as_built), "at best, with I2 unchanged"),)


def _cycle(answer: SpeedAnswer) -> Fact:
    """What one period does: a step along a line or round a circle."""
    if answer.replay is None:
        return Fact("cycle", "")
    cycle = answer.replay.steady.cycle
    step = f"{1e3 * math.hypot(cycle.dx, cycle.dy):.1f} mm a period"
    if not turns(answer):
        return Fact("cycle", step, "straight")
    return Fact(
        "cycle",
        step,
        f"round a circle of radius {with_unit(cycle.radius, 'm')}, "
        f"turning {math.degrees(cycle.dpsi):+.3g} deg a period",
    )


def _limits(answer: SpeedAnswer) -> Table:
    """Each limit: what is reached, what is allowed, and its shadow price."""
    if answer.replay is None:
        limits = answer.optimum.problem.limits
        return table(
            ["Limit", "Allowed"],
            [
                [QUANTITIES[name].words, QUANTITIES[name].both(getattr(limits, name))]
                for name in LIMIT_NAMES
            ],
        )
    rows: list[list[Cell]] = []
    for row in answer.limits.values():
        kind = QUANTITIES[row.name]
        price = price_text(row.name, row.shadow_price) if row.active else None
        state = Badge("active", "good") if row.active else Badge("not active")
        rows.append([kind.words, kind.both(row.value), kind.both(row.limit), state, price])
    return table(["Limit", "Reached", "Allowed", "State", "Shadow price"], rows)


def _bounds(answer: SpeedAnswer) -> Table:
    """Each decision, its range, and the shadow price of its active bound."""
    rows: list[list[Cell]] = []
    states = {"low": "at lower bound", "high": "at upper bound", "fixed": "fixed", None: "inside"}
    for row in answer.bounds.values():
        kind = QUANTITIES[row.name]
        fixed, active = row.active == "fixed", row.active in ("low", "high")
        span = "fixed" if fixed else f"{number(row.low)} to {with_unit(row.high, kind.unit)}"
        state = Badge(states[row.active], "good" if active else "quiet")
        priced = active and row.shadow_price is not None
        price = price_text(row.name, row.shadow_price or 0.0) if priced else None
        rows.append([kind.words, kind.both(row.value), span, state, price])
    return table(["Decision", "Value", "Range", "State", "Shadow price"], rows)


def _optima(answer: SpeedAnswer) -> Table:
    """All local optima; nothing if there is one only."""
    optimum = answer.optimum
    ties = {id(one) for one in optimum.ties}
    rows: list[list[Cell]] = [
        [
            f"{1e3 * one.speed:+.2f} mm/s",
            with_unit(one.gait.amplitude, "rad"),
            with_unit(one.gait.period, "s"),
            with_unit(one.gait.offset, "rad"),
            number(answer.ratio_of(one)),
            "the optimum" if one is optimum.best else "a tie" if id(one) in ties else "",
        ]
        for one in optimum.optima
    ]
    head = ["Speed", "Amplitude", "Period", "Offset", "J20/J10", "Remark"]
    return table(head, rows if len(rows) > 1 else [])


def robot_table(robot: Robot, changed: str = "") -> Table:
    """Every parameter of the robot, its value, and whether it was measured, fitted or assumed.

    changed: key path of a value that the optimiser chose.
    """
    rows: list[list[Cell]] = []
    for path, words, value in _parameters(robot):
        text = robot.provenance.get(path, "")
        origin = next((one for one in _ORIGINS if text.startswith(one)), "")
        badge = Badge(origin or "not stated", _ORIGINS.get(origin, "quiet"))
        source = text.removeprefix(origin).lstrip(": ")
        if path == changed:
            badge, source = Badge("chosen", "note"), "by the optimiser"
        # A number stays on one line with its unit.
        rows.append([path, words, value.replace(" ", "\N{NO-BREAK SPACE}"), badge, source])
    return table(["Key", "Parameter", "Value", "Origin", "Source"], rows)


def _parameters(robot: Robot) -> Iterator[tuple[str, str, str]]:
    for name, value in parameters_of(robot).items():
        parameter = PARAMETERS[name]
        unit, factor = _SHOWN.get(parameter.unit, (parameter.unit, 1.0))
        yield ".".join(parameter.key), parameter.words, with_unit(value * factor, unit)
    for key, name in _SERVO.items():
        kind = QUANTITIES[name]
        yield f"servo.{key}", kind.words, kind.both(getattr(robot.servo, key))
    for use in robot.physics:
        for parameter, value in use.values.items():
            yield f"physics.{use.name}.{parameter}", "effect beyond the paper", number(value)


def _solver(answer: SpeedAnswer) -> str:
    optimum = answer.optimum
    text = (
        f"{_count(optimum.starts, 'initial guess', 'es')}, "
        f"{_count(optimum.iterations, 'iteration')}, {optimum.intervals} intervals a period, "
        f"{_count(len(optimum.optima), 'distinct optim', 'a', 'um')}."
    )
    failed = len(optimum.failures)
    return f"{text} {_count(failed, 'initial guess', 'es')} led to no optimum." if failed else text


def _count(number_: int, word: str, plural: str = "s", singular: str = "") -> str:
    return f"{number_} {word}{singular if number_ == 1 else plural}"


_FIGURES = {
    "speed-map": (
        "Mean speed over period and amplitude",
        "Map of the mean speed, the region within the limits, and the optimum",
        "At the optimum's offset and inertia ratio. Hatched: a limit is exceeded. "
        "The star is the optimum; rings are other local optima with the same offset and ratio.",
    ),
    "prices": (
        "What the limits cost",
        "The speed that relaxing each limit or bound by one per cent would gain",
        "From the shadow prices.",
    ),
    "path": (
        "The path in steady state",
        "Path of the joint seen from above, with the robot drawn at a few instants",
        "P's path with the robot at a few instants, darker later. "
        "Platform 1 is green, platform 2 amber.",
    ),
    "cycle": (
        "One steady period",
        "Angle, rate, speed and torque over one period, with their limits",
        "Simulated by CVODES.",
    ),
}

RESULT, TRAJECTORY = "result.json", "trajectory.csv"


def write_results(
    answer: SpeedAnswer, folder: Path, *, figures: bool, progress: Callable[[str], None]
) -> list[Path]:
    """Write everything; returns the files in the order to name them."""
    return write_speed(answer, folder, result(answer), None, figures, progress)


def write_speed(
    answer: SpeedAnswer,
    folder: Path,
    record: dict[str, Any],
    turn: Section | None,
    figures: bool,
    progress: Callable[[str], None],
) -> list[Path]:
    """Write record, steady cycle, figures and page. What an earlier run left is removed before."""
    remove(folder, (RESULT, TRAJECTORY, PAGE, *(f"{name}.svg" for name in _FIGURES)))
    written = [write_json(folder / RESULT, record)]
    if answer.replay:
        written.append(write_csv(folder / TRAJECTORY, one_period(answer.replay.steady)))
    if not figures:
        return written
    progress("figures")
    # Here and not above: without figures matplotlib need not be loaded.
    from rr_opt.report.figures.speed import draw

    drawn = draw(answer)
    shown = [
        Figure(name, title, drawn[name], alt, caption)
        for name, (title, alt, caption) in _FIGURES.items()
        if name in drawn
    ]
    return write_page(folder, speed_document(answer, shown, turn), written)
