"""report.html: one file that opens anywhere, the verdict first."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from html import escape

from rr_opt.answers.quantities import QUANTITIES, direction_text, number, price_text, with_unit
from rr_opt.answers.speed import LIMIT_NAMES, SpeedAnswer
from rr_opt.model.parameters import PARAMETERS, parameters_of
from rr_opt.model.robot import Robot
from rr_opt.outcome import Status
from rr_opt.report.html import Badge, Cell, card, document, figure, table
from rr_opt.report.summary import cycle_text, holding_sentence, ratio_text
from rr_opt.version import __version__

_SHOWN = {"m": ("mm", 1e3), "kg m^2": ("kg m²", 1.0)}
"""SI unit -> the unit shown, and how many of it are one SI unit."""
_SERVO = {"angle_limit": "angle", "rate_limit": "rate", "torque_limit": "torque"}
_ORIGINS = ("measured", "fitted", "assumed")


def limits_table(answer: SpeedAnswer) -> str:
    """Each limit: what is reached, what is allowed, and what it costs."""
    if answer.replay is None:
        return _limits_asked(answer)
    rows: list[list[Cell]] = []
    for row in answer.limits.values():
        kind = QUANTITIES[row.name]
        price = price_text(row.name, row.shadow_price) if row.active else "–"
        state = Badge("active", "yes") if row.active else Badge("not active", "no")
        rows.append([kind.words, kind.both(row.value), kind.both(row.limit), state, price])
    return table(["Limit", "Reached", "Allowed", "State", "Speed gained per unit"], rows)


def _limits_asked(answer: SpeedAnswer) -> str:
    """The limits alone, where there is no gait to hold against them."""
    limits = answer.optimum.problem.limits
    rows = [
        [QUANTITIES[name].words, QUANTITIES[name].both(getattr(limits, name))]
        for name in LIMIT_NAMES
    ]
    return table(["Limit", "Allowed"], rows)


def bounds_table(answer: SpeedAnswer) -> str:
    """Each decision, its range, and what its bound costs."""
    rows: list[list[Cell]] = []
    for row in answer.bounds.values():
        kind = QUANTITIES[row.name]
        unit = kind.unit
        span = (
            "fixed"
            if row.active == "fixed"
            else f"{number(row.low)} to {with_unit(row.high, unit)}"
        )
        states = {"low": "at its least", "high": "at its most", "fixed": "fixed", None: "inside"}
        at_bound = row.active in ("low", "high")
        state = Badge(states[row.active], "yes" if at_bound else "no")
        price = (
            price_text(row.name, row.shadow_price)
            if at_bound and row.shadow_price is not None
            else "–"
        )
        rows.append([kind.words, kind.both(row.value), span, state, price])
    return table(["Decision", "Value", "Range", "State", "Speed gained per unit"], rows)


def optima_table(answer: SpeedAnswer) -> str:
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
            number(answer.ratio_of(one)),
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
    for name, value in parameters_of(robot).items():
        parameter = PARAMETERS[name]
        unit, factor = _SHOWN.get(parameter.unit, (parameter.unit, 1.0))
        yield ".".join(parameter.key), parameter.words, with_unit(value * factor, unit)
    for key, name in _SERVO.items():
        yield (
            f"servo.{key}",
            QUANTITIES[name].words,
            QUANTITIES[name].both(getattr(robot.servo, key)),
        )
    for use in robot.physics:
        for parameter, value in use.values.items():
            yield f"physics.{use.name}.{parameter}", "effect beyond the paper", number(value)


_HEADS = {
    Status.OPTIMAL: "",
    Status.INFEASIBLE: "No gait keeps all limits",
    Status.NOT_CONVERGED: "No confirmed optimum",
}

_CAPTIONS = {
    "speed-map": (
        "Mean speed over period and amplitude",
        "At the optimum's offset and inertia ratio. Hatched: a limit is broken. "
        "The star is the optimum; rings are other local optima with the same offset and ratio.",
    ),
    "path": (
        "The path in steady state",
        "P's path with the robot at a few instants, darker later. "
        "Platform 1 is green, platform 2 amber.",
    ),
    "cycle": ("One steady period", "Against the limits, simulated by CVODES."),
    "prices": (
        "What the limits cost",
        "Speed gained if a limit or a bound gave way by one per cent, from the shadow prices.",
    ),
}


def page(answer: SpeedAnswer, figures: Mapping[str, str], first: str = "") -> str:
    """The whole page; figures are SVG texts by name, `first` a card that leads the others."""
    optimum = answer.optimum
    choice = optimum.problem.inertia_ratio
    chosen = "platform2.I" if choice and choice.by == "inertia" and optimum.best else ""
    body = [
        _header(answer),
        _tiles(answer),
        first,
        card("Checks", _checks(answer)),
        _gallery(figures),
        card("Limits", limits_table(answer)),
        card("Decisions and their bounds", bounds_table(answer) if optimum.best else ""),
        card("Local optima", optima_table(answer)),
        card("Robot", robot_table(optimum.robot or optimum.problem.robot, chosen)),
        _footer(answer),
    ]
    return document(f"{answer.name}: {_verdict(answer)}", body)


def _gallery(figures: Mapping[str, str]) -> str:
    """Two columns of figures, one below the other where the screen is narrow."""
    columns = [
        "".join(figure(figures[name], *_CAPTIONS[name]) for name in names if name in figures)
        for names in (("speed-map", "prices"), ("path", "cycle"))
    ]
    inner = "".join(f"<div>{column}</div>" for column in columns if column)
    return f'<div class="grid">{inner}</div>' if inner else ""


def _verdict(answer: SpeedAnswer) -> str:
    return answer.headline or _HEADS[answer.status]


def _header(answer: SpeedAnswer) -> str:
    good = answer.status is Status.OPTIMAL
    lead = answer.message.removeprefix(f"{_verdict(answer)}. ")
    if good:
        lead = f"Every check confirms it. {_why(answer)}"
    return (
        f'<header class="{"" if good else "bad"}"><p class="kind">Roller Racer · '
        f"{escape(answer.name)} · fastest gait</p><h1>{escape(_verdict(answer))}</h1>"
        f'<p class="lead">{escape(lead)}</p></header>'
    )


def _why(answer: SpeedAnswer) -> str:
    """What holds the optimum back, and whether it stands alone."""
    ties = len(answer.optimum.ties)
    tie = f" {ties} other local optimum is as fast." if ties == 1 else ""
    tie = f" {ties} other local optima are as fast." if ties > 1 else tie
    return holding_sentence(answer) + tie


def _tiles(answer: SpeedAnswer) -> str:
    best, replay = answer.optimum.best, answer.replay
    if best is None or replay is None:
        return ""
    gait = best.gait
    tiles = [
        (f"{1e3 * best.speed:+.1f} mm/s", f"mean speed, {direction_text(best.speed)}"),
        *([(f"{1e3 * answer.as_built:+.1f} mm/s", "at best with the inertia ratio as built")]
          if answer.as_built is not None else []),
        (with_unit(gait.amplitude, "rad"), f"amplitude, {math.degrees(gait.amplitude):.2f}°"),
        (with_unit(gait.period, "s"), f"period, {number(1 / gait.period)} Hz"),
        (with_unit(gait.offset, "rad"), f"offset, {math.degrees(gait.offset):.2f}°"),
        (number(answer.optimum.ratio or 0.0), "J20/J10 " + ratio_text(answer).split(" ", 1)[-1]),
        (cycle_text(answer).split(" a period")[0], "a period" + cycle_text(answer).split(
            " a period", 1)[-1]),
    ]  # fmt: skip
    inner = "".join(
        f'<div class="tile"><b>{escape(value)}</b><span>{escape(words)}</span></div>'
        for value, words in tiles
    )
    return f'<div class="tiles">{inner}</div>'


def _checks(answer: SpeedAnswer) -> str:
    items = "".join(
        f'<li class="{"" if check.passed else "bad"}">{escape(check.sentence)}</li>'
        for check in answer.checks
    )
    return f'<ul class="checks">{items}</ul>' if items else ""


def _footer(answer: SpeedAnswer) -> str:
    solver = answer.optimum
    return (
        f"<footer>rr-opt {escape(__version__)} · {solver.starts} starts, {solver.iterations} "
        f"iterations, {solver.intervals} intervals a period · input SHA-256 "
        f"<code>{escape(answer.sha256)}</code></footer>"
    )
