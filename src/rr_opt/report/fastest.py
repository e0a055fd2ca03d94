"""The report of a fastest gait."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from rr_opt.documents import document as doc
from rr_opt.documents.report import Report
from rr_opt.formatting import QUANTITIES, counted, number, price_text, with_unit
from rr_opt.messages import listed
from rr_opt.model.ballast import inertia_ratio
from rr_opt.model.parameters import PARAMETERS, parameters_of
from rr_opt.model.robot import Robot
from rr_opt.motion.rollout import one_period
from rr_opt.motion.steady_cycle import Cycle
from rr_opt.outcome import Status
from rr_opt.report.captions import captions
from rr_opt.report.fastest_record import fastest_record
from rr_opt.report.gait import gait_facts, signed_fact, speed_fact
from rr_opt.report.trajectory_file import trajectory_csv
from rr_opt.results.fastest import FastestGait

_TITLES = {
    Status.OPTIMAL: "The robot does not move",
    Status.INFEASIBLE: "No gait respects all limits",
    Status.NOT_CONVERGED: "No confirmed optimum",
}


def fastest_document(
    result: FastestGait, figures: Sequence[doc.Figure] = (), turn: doc.Section | None = None
) -> doc.Document:
    """The report of a fastest gait; turn: a section that leads the others."""
    choice, solved = result.problem.inertia_ratio, result.gait is not None
    chosen = "platform2.I" if choice and choice.by == "inertia" and solved else ""
    good = result.status is Status.OPTIMAL
    confirmed = [] if result.climbed else ["Every check confirms it."]
    lead = " ".join([*confirmed, *result.remarks, limited_by(result)])
    return doc.Document(
        name=result.name,
        kind="fastest gait",
        title=result.headline or _TITLES[result.status],
        lead=lead if good else result.message,
        good=good,
        sections=(
            doc.Section("", (doc.Facts(tuple(_facts(result)), key=True),)),
            *([turn] if turn else []),
            doc.Section(
                "Checks", (doc.checks((one.passed, one.sentence) for one in result.checks),)
            ),
            doc.gallery(figures),
            doc.Section("Limits", (_limits(result),), brief=solved),
            doc.Section("Decisions and their bounds", (_bounds(result),)),
            doc.Section("Local optima", (_optima(result),)),
            doc.Section("Robot", (_robot(result.robot, chosen),), brief=False),
            doc.Section("Solver", (_solver(result),), brief=solved),
        ),
        footer=doc.versions(result.sha256),
    )


def limited_by(result: FastestGait) -> str:
    """`It is limited by the rate limit and the lower bound of the period.`"""
    if result.replay is None:
        return ""
    active = [
        "the singularity margin" if row.name == "singularity" else f"the {row.name} limit"
        for row in result.limits.values()
        if row.active
    ]
    active += [
        f"the {'lower' if row.active == 'low' else 'upper'} bound of the "
        f"{QUANTITIES[row.name].words}"
        for row in result.bounds.values()
        if row.active in ("low", "high")
    ]
    if not active:
        return "No limit or bound is active: it is an interior optimum."
    return f"It is limited by {listed(active)}."


def _facts(result: FastestGait) -> Iterator[doc.Fact]:
    if result.speed is None or result.gait is None or result.cycle is None:
        return
    yield speed_fact(result.speed)
    if result.rebuilt and result.as_built is not None:
        yield signed_fact("as built", result.as_built, "at best, with I2 unchanged")
    yield from gait_facts(result.gait)
    yield _ratio(result)
    yield _cycle(result.cycle, turning=result.turns)


def _ratio(result: FastestGait) -> doc.Fact:
    """J20/J10, about which point, and how it is realised."""
    choice, built = result.problem.inertia_ratio, result.problem.robot
    about = choice.about if choice else "joint"
    ratio = number(result.inertia_ratio or 0.0)
    where = f"about {'the joint P' if about == 'joint' else 'the centres of mass'}"
    if choice is None or not result.rebuilt:
        return doc.Fact("J20/J10", ratio, f"{where}, the robot as it is")
    means = ", by loads on platform 2" if choice.by == "loads" else ""
    return doc.Fact(
        "J20/J10",
        ratio,
        f"{where}{means}: I2 {built.platform2.I:.4g} -> {result.robot.platform2.I:.4g} kg m2 "
        f"(ratio {number(inertia_ratio(built, about))} -> {ratio})",
    )


def _cycle(cycle: Cycle, *, turning: bool) -> doc.Fact:
    """What one period does: a step along a line or round a circle."""
    step = f"{1e3 * math.hypot(cycle.dx, cycle.dy):.1f} mm a period"
    if not turning:
        return doc.Fact("cycle", step, "straight")
    return doc.Fact(
        "cycle",
        step,
        f"round a circle of radius {with_unit(cycle.radius, 'm')}, "
        f"turning {math.degrees(cycle.dpsi):+.3g} deg a period",
    )


def _limits(result: FastestGait) -> doc.Table:
    """Each limit: what is reached, what is allowed, and its shadow price."""
    kinds = [(QUANTITIES[row.name], row) for row in result.limits.values()]
    if result.replay is None:
        return doc.table(["Limit", "Allowed"], [[k.words, k.both(row.limit)] for k, row in kinds])
    return doc.table(
        ["Limit", "Reached", "Allowed", "State", "Shadow price"],
        [
            [
                kind.words,
                kind.both(row.value),
                kind.both(row.limit),
                doc.Badge("active", "good") if row.active else doc.Badge("not active"),
                price_text(row.name, row.shadow_price) if row.active else None,
            ]
            for kind, row in kinds
        ],
    )


def _bounds(result: FastestGait) -> doc.Table:
    """Each decision, its range, and the shadow price of its active bound."""
    states = {
        "low": doc.Badge("at lower bound", "good"),
        "high": doc.Badge("at upper bound", "good"),
        "fixed": doc.Badge("fixed"),
        None: doc.Badge("inside"),
    }
    rows = []
    for row in result.bounds.values():
        kind, fixed = QUANTITIES[row.name], row.active == "fixed"
        span = "fixed" if fixed else f"{number(row.low)} to {with_unit(row.high, kind.unit)}"
        price = None
        if row.active in ("low", "high") and row.shadow_price is not None:
            price = price_text(row.name, row.shadow_price)
        rows.append([kind.words, kind.both(row.value), span, states[row.active], price])
    return doc.table(["Decision", "Value", "Range", "State", "Shadow price"], rows)


def _optima(result: FastestGait) -> doc.Table:
    """All local optima; nothing if there is one only."""
    optimum = result.optimum
    ties = {id(one) for one in optimum.ties}
    rows = [
        [
            f"{1e3 * one.speed:+.2f} mm/s",
            with_unit(told.amplitude, "rad"),
            with_unit(told.period, "s"),
            with_unit(told.offset, "rad"),
            number(result.ratio_of(one)),
            "the optimum" if one is optimum.best else "a tie" if id(one) in ties else "",
        ]
        for one, told in ((one, result.told(one.gait)) for one in optimum.optima)
    ]
    head = ["Speed", "Amplitude", "Period", "Offset", "J20/J10", "Remark"]
    return doc.table(head, rows if len(rows) > 1 else [])


_SHOWN = {"m": ("mm", 1e3), "kg m^2": ("kg m²", 1.0)}
"""SI unit -> the unit shown, and how many of it are one SI unit."""
_SERVO = {"angle_limit": "angle", "rate_limit": "rate", "torque_limit": "torque"}
_ORIGINS: dict[str, doc.Tone] = {"measured": "good", "fitted": "note", "assumed": "warn"}


def _robot(robot: Robot, chosen: str) -> doc.Table:
    """Every parameter of the robot, its value, and whether it was measured, fitted or assumed.

    chosen: key path of a value that the optimiser chose.
    """
    rows = []
    for path, words, value in _parameters(robot):
        text = robot.provenance.get(path, "")
        origin = next((one for one in _ORIGINS if text.startswith(one)), "")
        badge = doc.Badge(origin or "not stated", _ORIGINS.get(origin, "quiet"))
        source = text.removeprefix(origin).lstrip(": ")
        if path == chosen:
            badge, source = doc.Badge("chosen", "note"), "by the optimiser"
        # A number stays on one line with its unit.
        rows.append([path, words, value.replace(" ", "\N{NO-BREAK SPACE}"), badge, source])
    return doc.table(["Key", "Parameter", "Value", "Origin", "Source"], rows)


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


def _solver(result: FastestGait) -> str:
    optimum, guesses = result.optimum, ("initial guess", "initial guesses")
    text = (
        f"{counted(optimum.starts, *guesses)}, {counted(optimum.iterations, 'iteration')}, "
        f"{optimum.intervals} intervals a period, "
        f"{counted(len(optimum.optima), 'distinct optimum', 'distinct optima')}."
    )
    failed = len(optimum.failures)
    return f"{text} {counted(failed, *guesses)} led to no optimum." if failed else text


def tables(result: FastestGait) -> dict[str, str]:
    """The cycle as CSV; nothing without a gait."""
    if result.replay is None:
        return {}
    return {"trajectory.csv": trajectory_csv(one_period(result.replay.steady))}


REPORT = Report(
    fastest_record,
    fastest_document,
    "result.json",
    tables=tables,
    others=("trajectory.csv",),
    figures="rr_opt.report.figures.fastest",
    captions=captions("fastest"),
)
