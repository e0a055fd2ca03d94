"""What holds an optimum: the active limits and bounds, in a sentence."""

from __future__ import annotations

from rr_opt.report.answer import Answer
from rr_opt.report.quantities import QUANTITIES
from rr_opt.report.rows import bound_rows, limit_rows


def holding_sentence(answer: Answer) -> str:
    """`It is held by the rate limit, the shortest period and the largest inertia ratio.`"""
    if answer.replay is None:
        return ""
    held = [
        "the singularity margin" if row.name == "singularity" else f"the {row.name} limit"
        for row in limit_rows(answer.optimum, answer.replay)
        if row.active
    ]
    held += [
        f"the {'least' if row.side == 'low' else 'largest'} {QUANTITIES[row.name].words} allowed"
        for row in bound_rows(answer.optimum)
        if row.side in ("low", "high")
    ]
    if not held:
        return "No limit and no bound holds it: it is an optimum inside its ranges."
    listed = held[0] if len(held) == 1 else ", ".join(held[:-1]) + " and " + held[-1]
    return f"It is held by {listed}."
