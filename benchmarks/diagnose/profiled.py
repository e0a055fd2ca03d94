"""What the time of a diagnosis goes into, and the operations of its loops counted."""

from __future__ import annotations

import sys
import time
from collections import Counter
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from functools import cache
from pathlib import Path
from typing import Any
from unittest.mock import patch

from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.recordings.clock_fit import at_commanded_rate
from rr_opt.recordings.experiment import read_experiment, usable
from rr_opt.sysid import shooting
from rr_opt.sysid.diagnose import diagnose
from rr_opt.sysid.shooting import System

WATCHED = {
    "derivatives, summed up": "grams",
    "predictions": "predict_all",
    "unknown inputs": "unknown_terms",
}
"""Functions by which the time is spent; none calls another."""
COUNTED = ("derivatives, summed up", "predictions")


def lines(folder: Path) -> list[str]:
    """A paragraph: shares of the CPU time of one process, and operations counted."""
    experiment, _ = usable(read_experiment(folder))
    model = RollerRacer(at_commanded_rate(experiment))
    spent, done, works = Counter[str](), Counter[str](), Counter[str]()
    with ExitStack() as stack:
        for name, attribute in WATCHED.items():
            for module in _users(attribute):
                watch = _watched(getattr(module, attribute), name, spent, done, works)
                stack.enter_context(patch.object(module, attribute, watch))
        begun = time.process_time()
        diagnose(model)
        whole = time.process_time() - begun
    shares = ", ".join(f"{name} {spent[name] / whole:.0%}" for name in WATCHED if spent[name])
    rest = 1 - sum(spent.values()) / whole
    counted = "; ".join(
        f"{name}: {done[name] / 1e6:.1f} million steps of a run, {works[name] / done[name]:,.0f} "
        f"operations each, {1e9 * spent[name] / works[name]:.3f} ns an operation"
        for name in COUNTED
    )
    return [
        f"{whole:.1f} s of CPU in one process: {shares}, the rest {rest:.0%}.",
        "",
        f"{counted}.",
    ]


def _users(attribute: str) -> list[Any]:
    """The modules of the machine that call a function by that name."""
    return [
        module
        for name, module in list(sys.modules.items())
        if name.startswith("rr_opt.machines") and callable(getattr(module, attribute, None))
    ]


def _watched(
    call: Callable, name: str, spent: Counter[str], done: Counter[str], works: Counter[str]
) -> Callable:
    def watched(first: Any, *args: Any, **named: Any) -> Any:
        begun = time.process_time()
        try:
            return call(first, *args, **named)
        finally:
            spent[name] += time.process_time() - begun
            if isinstance(first, System) and args and isinstance(args[0], Sequence):
                for one in args[0]:
                    path = one[0] if isinstance(one, tuple) else one.path
                    done[name] += path.h.size
                    works[name] += path.h.size * _operations(first, name)

    return watched


@cache
def _operations(system: System, name: str) -> int:
    """Operations that CasADi counts in a step: of the step, or of the rates' Jacobian.

    What is done with that, some ten more for each quantity that is asked for, is not counted.
    """
    if name == "predictions":
        return shooting._step(system).n_instructions()
    import casadi as ca

    inputs = system.rates.sx_in()
    by = ca.jacobian(system.rates(*inputs), ca.vertcat(*inputs))
    return ca.Function("by", inputs, [ca.cse(by)]).n_instructions()
