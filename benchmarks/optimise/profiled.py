"""Where the package's warm time goes."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from benchmarks.optimise.problems import PROBLEMS
from rr_opt import sqp
from rr_opt.design import families, maximize_speed, seeds
from rr_opt.design.landscape import Landscape

_PARTS = {
    "scan and climbs": [(families, "tops")],
    "climbs' quadratics": [(seeds, "_best_step")],
    "ends of climbs": [(families, "solve_sine"), (maximize_speed, "refine")],
    "their quadratic programs": [(sqp, "_step")],
    "cycles": [(Landscape, "cycles")],
}
_WITHIN = {"climbs' quadratics": "scan and climbs", "their quadratic programs": "ends of climbs"}
"""Parts whose seconds are counted in another one too; cycles are in all of them."""


def shares(names: list[str], runs: int = 5) -> dict[str, float]:
    """Of all CPU seconds of warm runs of these problems."""
    spent: Counter[str] = Counter()
    for name in names:
        maximize_speed.maximize_speed(PROBLEMS[name])
        with _watched(spent):
            for _ in range(runs):
                begun = time.process_time()
                maximize_speed.maximize_speed(PROBLEMS[name])
                spent["all"] += time.process_time() - begun
    for part, whole in _WITHIN.items():
        spent[whole] -= spent[part]
    total = spent.pop("all")
    return {part: seconds / total for part, seconds in spent.most_common()}


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
