"""The page's tables: limits, bounds, optima, and the robot with where its values come from."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict

from rr_opt.report.answer import Answer
from rr_opt.report.candidates import ratio_of
from rr_opt.report.html import Badge, Cell, table
from rr_opt.report.quantities import QUANTITIES, number, price_text, with_unit
from rr_opt.report.rows import LIMIT_NAMES, bound_rows, limit_rows
from rr_opt.robot.parameters import Robot

_PLATFORM = {
    "m": ("mass", 1.0, "kg"),
    "I": ("moment of inertia about the centre of mass", 1.0, "kg m²"),
    "c": ("axle to joint P", 1e3, "mm"),
    "a": ("axle to centre of mass, towards P", 1e3, "mm"),
    "b": ("half track", 1e3, "mm"),
    "kappa": ("viscous friction of a wheel", 1.0, "N m s"),
}
_SERVO = {"angle_limit": "angle", "rate_limit": "rate", "torque_limit": "torque"}
_ORIGINS = ("measured", "fitted", "assumed")


def limits_table(answer: Answer) -> str:
    """Each limit: what is reached, what is allowed, and what it costs."""
    if answer.replay is None:
        return _limits_asked(answer)
    rows: list[list[Cell]] = []
    for row in limit_rows(answer.optimum, answer.replay):
        kind = QUANTITIES[row.name]
        price = price_text(row.name, row.price) if row.active else "–"
        state = Badge("active", "yes") if row.active else Badge("not active", "no")
        rows.append([kind.words, kind.both(row.value), kind.both(row.limit), state, price])
    return table(["Limit", "Reached", "Allowed", "State", "Speed gained per unit"], rows)


def _limits_asked(answer: Answer) -> str:
    """The limits alone, where there is no gait to hold against them."""
    limits = answer.optimum.problem.limits
    rows = [
        [QUANTITIES[name].words, QUANTITIES[name].both(getattr(limits, name))]
        for name in LIMIT_NAMES
    ]
    return table(["Limit", "Allowed"], rows)


def bounds_table(answer: Answer) -> str:
    """Each decision, its range, and what its bound costs."""
    rows: list[list[Cell]] = []
    for row in bound_rows(answer.optimum):
        kind = QUANTITIES[row.name]
        unit = kind.unit
        span = (
            "fixed" if row.side == "fixed" else f"{number(row.low)} to {with_unit(row.high, unit)}"
        )
        states = {"low": "at its least", "high": "at its most", "fixed": "fixed", None: "inside"}
        at_bound = row.side in ("low", "high")
        state = Badge(states[row.side], "yes" if at_bound else "no")
        price = price_text(row.name, row.price) if at_bound and row.price is not None else "–"
        rows.append([kind.words, kind.both(row.value), span, state, price])
    return table(["Decision", "Value", "Range", "State", "Speed gained per unit"], rows)


def optima_table(answer: Answer) -> str:
    """The other local optima; nothing if there are none."""
    optimum = answer.optimum
    if len(optimum.optima) < 2:
        return ""
    ties = {id(one) for one in optimum.ties}
    rows: list[list[Cell]] = [
        [
            f"{1e3 * one.speed:+.2f} mm/s",
            with_unit(one.gait.amplitude, "rad"),
            with_unit(one.gait.period, "s"),
            with_unit(one.gait.offset, "rad"),
            number(ratio_of(optimum, one)),
            "the optimum" if one is optimum.best else "a tie" if id(one) in ties else "",
        ]
        for one in optimum.optima
    ]
    return table(["Speed", "Amplitude", "Period", "Offset", "J20/J10", "Remark"], rows)


def robot_table(robot: Robot, changed: str = "") -> str:
    """Every parameter of the robot, its value, and whether it was measured, fitted or assumed.

    changed: key path of a value that the optimiser chose.
    """
    rows: list[list[Cell]] = []
    for path, words, value in _parameters(robot):
        text = robot.provenance.get(path, "")
        origin = next((one for one in _ORIGINS if text.startswith(one)), "unsaid")
        remark = text.removeprefix(origin).lstrip(": ")
        badge = Badge("not stated" if origin == "unsaid" else origin, origin)
        if path == changed:
            badge, remark = Badge("chosen", "fitted"), "by the optimiser"
        # A number stays on one line with its unit.
        rows.append([path, words, value.replace(" ", "\N{NO-BREAK SPACE}"), badge, remark])
    return table(["Key", "Parameter", "Value", "Origin", "Source"], rows)


def _parameters(robot: Robot) -> Iterator[tuple[str, str, str]]:
    for key, platform in (("platform1", robot.platform1), ("platform2", robot.platform2)):
        for symbol, value in asdict(platform).items():
            words, factor, unit = _PLATFORM[symbol]
            yield f"{key}.{symbol}", words, with_unit(value * factor, unit)
    yield "h", "wheel radius", with_unit(1e3 * robot.h, "mm")
    for key, name in _SERVO.items():
        yield (
            f"servo.{key}",
            QUANTITIES[name].words,
            QUANTITIES[name].both(getattr(robot.servo, key)),
        )
    for use in robot.physics:
        for parameter, value in use.values.items():
            yield f"physics.{use.name}.{parameter}", "effect beyond the paper", number(value)
