"""Where the package's warm time goes, and how few operations the work is made of."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from benchmarks.optimise.problems import PROBLEMS
from rr_opt.design import climb, solve
from rr_opt.design import search as refine
from rr_opt.design import search as sines
from rr_opt.design.interval import interval_of
from rr_opt.design.landscape import Landscape
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.design.shapes.sine import SineShape
from rr_opt.mechanics.runge_kutta import BUTCHER6
from rr_opt.motion.dynamics import derive

_PARTS = {
    "scan and climbs, their cycles": [(sines, "find_seeds")],
    "climbs' quadratics": [(climb, "_best_step")],
    "IPOPT with its functions": [(refine, "solve")],
    "looks at a gait, fine and on a mesh": [(refine, "dense"), (refine, "steady_cycle")],
    "starts passed over": [(sines, "leads_to")],
    "a start's cycle": [(solve, "_start")],
}
_WITHIN = {
    "climbs' quadratics": "scan and climbs, their cycles",
    "a start's cycle": "IPOPT with its functions",
}
"""Parts whose seconds are counted in another one too."""


def shares(names: list[str], runs: int = 5) -> dict[str, float]:
    """Of all CPU seconds of warm runs of these problems."""
    spent: Counter[str] = Counter()
    for name in names:
        maximize_speed(PROBLEMS[name])
        with _watched(spent):
            for _ in range(runs):
                begun = time.process_time()
                maximize_speed(PROBLEMS[name])
                spent["all"] += time.process_time() - begun
    for part, whole in _WITHIN.items():
        spent[whole] -= spent[part]
    total = spent.pop("all")
    found = {part: seconds / total for part, seconds in spent.most_common()}
    return {**found, "the rest": 1 - sum(found.values())}


@contextmanager
def _watched(spent: Counter[str]) -> Iterator[None]:
    def timed(call: Callable, part: str) -> Callable:
        def watched(*args: Any, **named: Any) -> Any:
            begun = time.process_time()
            try:
                return call(*args, **named)
            finally:
                spent[part] += time.process_time() - begun

        return watched

    before = [
        (place, name, getattr(place, name)) for all_ in _PARTS.values() for place, name in all_
    ]
    try:
        for part, places in _PARTS.items():
            for place, name in places:
                setattr(place, name, timed(getattr(place, name), part))
        yield
    finally:
        for place, name, call in before:
            setattr(place, name, call)


def operations(name: str) -> tuple[float, float]:
    """Floating point operations of an answer, in millions: of the landscape's cycles, and of the
    intervals of multiple shooting with their derivatives."""
    cycles: Counter[str] = Counter()
    run = Landscape.cycles

    def counted(self: Landscape, gaits: Any, nodes: int) -> Any:
        cycles["phases"] += gaits.shape[1] * nodes
        return run(self, gaits, nodes)

    Landscape.cycles = counted
    try:
        found = maximize_speed(PROBLEMS[name])
    finally:
        Landscape.cycles = run
    choice = PROBLEMS[name].inertia_ratio
    by = choice.by if choice else "inertia"
    terms = interval_of((), by, SineShape(), 0, 1, BUTCHER6)
    each = sum(one.n_instructions() for one in terms.code.functions)
    motion = derive().motion.n_instructions()
    # Lines are laid at a phase and halfway to the next, and the torque is told at the phase.
    return 3e-6 * motion * cycles["phases"], 1e-6 * each * found.intervals * found.iterations
