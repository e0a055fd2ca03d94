"""What holds an optimum: the active limits and bounds, in a sentence."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path

from rr_opt.answers.quantities import (
    QUANTITIES,
    direction_text,
    number,
    price_text,
    speed_text,
    with_unit,
)
from rr_opt.answers.speed import SpeedAnswer
from rr_opt.model.ballast import inertia_ratio
from rr_opt.report.result import turns
from rr_opt.report.text import columns, gait_formula, gait_lines


def holding_sentence(answer: SpeedAnswer) -> str:
    """`It is held by the rate limit, the shortest period and the largest inertia ratio.`"""
    if answer.replay is None:
        return ""
    held = [
        "the singularity margin" if row.name == "singularity" else f"the {row.name} limit"
        for row in answer.limits.values()
        if row.active
    ]
    held += [
        f"the {'least' if row.active == 'low' else 'largest'} {QUANTITIES[row.name].words} allowed"
        for row in answer.bounds.values()
        if row.active in ("low", "high")
    ]
    if not held:
        return "No limit and no bound holds it: it is an optimum inside its ranges."
    listed = held[0] if len(held) == 1 else ", ".join(held[:-1]) + " and " + held[-1]
    return f"It is held by {listed}."


_LEADS = {"forward": "platform 1 leads", "backward": "platform 2 leads"}


def summary(answer: SpeedAnswer, files: Iterable[Path]) -> str:
    """The whole summary, with a newline at its end."""
    best = answer.optimum.best
    # Without a gait the message says all, and it goes to stderr.
    words = answer.message if best else answer.status.value.replace("_", " ")
    blocks = [[f"{answer.name}: {words}"]]
    if best and answer.replay:
        blocks += [_gait(answer), _limits(answer), _bounds(answer), _checks(answer)]
        blocks += [_optima(answer), _solver(answer)]
    blocks.append(columns([("files" if not i else "", str(f)) for i, f in enumerate(files)]))
    return "\n\n".join("\n".join(block) for block in blocks if block) + "\n"


def ratio_text(answer: SpeedAnswer) -> str:
    """J20/J10, about which point, and how it is realised."""
    optimum, choice = answer.optimum, answer.optimum.problem.inertia_ratio
    ratio, robot = optimum.ratio, optimum.robot
    if ratio is None or robot is None:
        return ""
    about = choice.about if choice else "joint"
    text = f"{number(ratio)} about {'the joint P' if about == 'joint' else 'the centres of mass'}"
    if choice is None:
        return text + ", the robot as it is"
    means = ", by loads on platform 2" if choice.by == "loads" else ""
    built = answer.problem.robot
    if not answer.rebuilt:
        return f"{text}, the robot as it is (I2 = {built.platform2.I:.4g} kg m2)"
    own = inertia_ratio(built, about)
    return (
        f"{text}{means}: I2 {built.platform2.I:.4g} -> {robot.platform2.I:.4g} kg m2 "
        f"(ratio {number(own)} -> {number(ratio)})"
    )


def as_built_text(answer: SpeedAnswer) -> str:
    """The best speed with the inertia ratio unchanged; empty if it has not changed."""
    if not answer.rebuilt or answer.as_built is None:
        return ""
    return f"{speed_text(answer.as_built)} at best, with I2 unchanged"


def cycle_text(answer: SpeedAnswer) -> str:
    """What one period does: a step along a line or round a circle."""
    if answer.replay is None:
        return ""
    cycle = answer.replay.steady.cycle
    step = f"{1e3 * math.hypot(cycle.dx, cycle.dy):.1f} mm a period"
    if not turns(answer):
        return f"{step}, straight"
    return (
        f"{step}, round a circle of radius {with_unit(cycle.radius, 'm')}, "
        f"turning {math.degrees(cycle.dpsi):+.3g} deg a period"
    )


def _gait(answer: SpeedAnswer) -> list[str]:
    best = answer.optimum.best
    if best is None:
        return []
    way = direction_text(best.speed)
    rows = [
        ("gait", gait_formula(best.gait)),
        *gait_lines(best.gait),
        ("  J20/J10", ratio_text(answer)),
        ("speed", f"{speed_text(best.speed)}, {way}: {_LEADS[way]}"),
        *([("  as built", as_built)] if (as_built := as_built_text(answer)) else []),
        ("cycle", cycle_text(answer)),
    ]
    return columns(rows)


def _limits(answer: SpeedAnswer) -> list[str]:
    if answer.replay is None:
        return []
    rows = [("limit", "reached", "allowed", "active", "shadow price")]
    for row in answer.limits.values():
        kind = QUANTITIES[row.name]
        price = price_text(row.name, row.shadow_price) if row.active else "-"
        active = "yes" if row.active else "no"
        rows.append((f"  {row.name}", kind.both(row.value), kind.both(row.limit), active, price))
    return columns(rows)


def _bounds(answer: SpeedAnswer) -> list[str]:
    rows = [("bounds that hold", "at", "", "shadow price")]
    for row in answer.bounds.values():
        if row.active in ("low", "high"):
            side = "lower bound" if row.active == "low" else "upper bound"
            price = "-" if row.shadow_price is None else price_text(row.name, row.shadow_price)
            rows.append((f"  {row.name}", QUANTITIES[row.name].both(row.value), side, price))
    return columns(rows) if len(rows) > 1 else []


def _checks(answer: SpeedAnswer) -> list[str]:
    rows = [("  ok" if check.passed else "  FAILED", check.sentence) for check in answer.checks]
    return ["checks", *columns(rows)]


def _optima(answer: SpeedAnswer) -> list[str]:
    optima = answer.optimum.optima
    if len(optima) < 2:
        return []
    ties = {id(one) for one in answer.optimum.ties}
    rows = [("other optima", "amplitude", "period", "offset", "J20/J10", "")]
    for one in optima[1:]:
        gait, ratio = one.gait, number(answer.ratio_of(one))
        rows.append(
            (
                f"  {1e3 * one.speed:+.2f} mm/s",
                with_unit(gait.amplitude, "rad"),
                with_unit(gait.period, "s"),
                with_unit(gait.offset, "rad"),
                ratio,
                "a tie" if id(one) in ties else "",
            )
        )
    return columns(rows)


def _solver(answer: SpeedAnswer) -> list[str]:
    optimum = answer.optimum
    lines = [
        f"solver  {optimum.starts} starts, {optimum.iterations} iterations, "
        f"{len(optimum.optima)} distinct optima"
    ]
    if optimum.failures:
        lines.append(f"        {len(optimum.failures)} of the starts ended without an optimum")
    return lines
