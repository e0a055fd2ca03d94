"""What the sweep's time goes into where nothing is compiled and friction is not viscous."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from typing import Any
from unittest.mock import patch

import numpy as np

from benchmarks.sweep.case import Work
from benchmarks.sweep.ways.ours import run_plain
from rr_opt.motion.dynamics import dynamics_of
from rr_opt.verify import steady_fourier
from rr_opt.verify.speeds import model_of


def lines(cases: Mapping[str, Work], points: int = 200) -> list[str]:
    """A line for each case: shares of the time, and what is counted."""
    return [
        f"- {label[0].upper()}{label[1:]}: {_line(work, points)}" for label, work in cases.items()
    ]


def _line(work: Work, points: int) -> str:
    some = work.part(points)
    run_plain(some, 0)
    model, spent, count = model_of(some.problem.robot), Counter[str](), Counter[str]()
    watched = {
        "vdot and its slope": (model, "_tangent"),
        "linear cycles": (steady_fourier, "solve_stiff"),
        "derivatives of v": (steady_fourier, "derivative"),
    }
    with ExitStack() as stack:
        for name, (owner, attribute) in watched.items():
            inner = getattr(owner, attribute)
            stack.enter_context(patch.object(owner, attribute, _timed(inner, name, spent, count)))
        begun = time.process_time()
        run_plain(some, 0)
        whole = time.process_time() - begun
    motion = dynamics_of(some.problem.robot).motion
    tangent = motion.factory("tangent", motion.name_in(), ["vdot", "jac:vdot:v"])
    samples, operations = count["vdot and its slope"], tangent.n_instructions()
    shares = ", ".join(f"{name} {spent[name] / whole:.0%}" for name in watched)
    return (
        f"{shares}, the rest {1 - sum(spent.values()) / whole:.0%}. vdot and its slope are "
        f"evaluated {samples / some.size:,.0f} times a point, {operations} operations each, at "
        f"{1e9 * spent['vdot and its slope'] / samples / operations:.1f} ns an operation."
    )


def _timed(call: Callable, name: str, spent: Counter[str], count: Counter[str]) -> Callable:
    def timed(first: Any, *args: Any, **named: Any) -> Any:
        begun = time.process_time()
        try:
            return call(first, *args, **named)
        finally:
            spent[name] += time.process_time() - begun
            count[name] += np.size(first)

    return timed
