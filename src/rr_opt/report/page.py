"""report.html: one file that opens anywhere, the verdict first."""

from __future__ import annotations

import math
from collections.abc import Mapping
from html import escape

from rr_opt import __version__
from rr_opt.outcome import Status
from rr_opt.report.answer import Answer
from rr_opt.report.holding import holding_sentence
from rr_opt.report.html import card, document, figure
from rr_opt.report.page_tables import bounds_table, limits_table, optima_table, robot_table
from rr_opt.report.quantities import direction_text, number, with_unit
from rr_opt.report.summary import cycle_text, ratio_text

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


def page(answer: Answer, figures: Mapping[str, str], first: str = "") -> str:
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


def _verdict(answer: Answer) -> str:
    return answer.headline or _HEADS[answer.status]


def _header(answer: Answer) -> str:
    good = answer.status is Status.OPTIMAL
    lead = answer.message.removeprefix(f"{_verdict(answer)}. ")
    if good:
        lead = f"Every check confirms it. {_why(answer)}"
    return (
        f'<header class="{"" if good else "bad"}"><p class="kind">Roller Racer · '
        f"{escape(answer.name)} · fastest gait</p><h1>{escape(_verdict(answer))}</h1>"
        f'<p class="lead">{escape(lead)}</p></header>'
    )


def _why(answer: Answer) -> str:
    """What holds the optimum back, and whether it stands alone."""
    ties = len(answer.optimum.ties)
    tie = f" {ties} other local optimum is as fast." if ties == 1 else ""
    tie = f" {ties} other local optima are as fast." if ties > 1 else tie
    return holding_sentence(answer) + tie


def _tiles(answer: Answer) -> str:
    best, replay = answer.optimum.best, answer.replay
    if best is None or replay is None:
        return ""
    gait = best.gait
    tiles = [
        (f"{1e3 * best.speed:+.1f} mm/s", f"mean speed, {direction_text(best.speed)}"),
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


def _checks(answer: Answer) -> str:
    items = "".join(
        f'<li class="{"" if check.passed else "bad"}">{escape(check.sentence)}</li>'
        for check in answer.checks
    )
    return f'<ul class="checks">{items}</ul>' if items else ""


def _footer(answer: Answer) -> str:
    solver = answer.optimum
    return (
        f"<footer>rr-opt {escape(__version__)} · {solver.starts} starts, {solver.iterations} "
        f"iterations, {solver.intervals} intervals a period · input SHA-256 "
        f"<code>{escape(answer.sha256)}</code></footer>"
    )
