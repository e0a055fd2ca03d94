"""A range of values, `{from: 10 rpm, to: 60 rpm, count: 11}`, to numbers."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from rr_opt.files.issue import shown
from rr_opt.files.study.model import MOST_CASES
from rr_opt.files.study.units import Key
from rr_opt.files.units import to_si
from rr_opt.outcome import InputError

_ROUNDING = 1e-9


def range_values(given: Any, key: Key) -> tuple[float, ...]:
    """The values of a RangeModel in SI, both ends included. Raises InputError if it has none."""
    first, last = getattr(given, "from"), given.to
    if key.unit is None:
        raise InputError(
            f"Read a range. Expected a list: `{key.name}` is not a number. Write [one, another]."
        )
    low, high = (to_si(value, key.unit) for value in (first, last))
    if not (math.isfinite(low) and math.isfinite(high)) or low == high:
        raise InputError(
            f"Read a range from {low:.6g} to {high:.6g}. Expected two different finite numbers. "
            "Write a list to vary nothing."
        )
    if bool(given.count) == (given.step is not None):
        raise InputError(
            "Read a range with "
            + ("both count and step" if given.count else "neither count nor step")
            + ". Expected one of them. Write for example `{from: 1, to: 3, count: 5}`."
        )
    if given.spacing == "log":
        if not given.count or low <= 0 or high <= 0:
            raise InputError(
                "Read `spacing: log`. Expected it with a count, from and to above 0. "
                "Give a count, or delete it."
            )
        values = np.geomspace(low, high, given.count)
    elif given.count:
        values = np.linspace(low, high, given.count)
    else:
        step = to_si(given.step, key.unit)
        steps = (high - low) / step if step else math.inf
        if not 0 < steps < MOST_CASES:
            raise InputError(
                f"Read the step {shown(given.step)}. Expected one that leads from "
                f"{shown(first)} to {shown(last)} in less than {MOST_CASES} steps. "
                "Change its sign or its size."
            )
        values = low + step * np.arange(math.floor(steps * (1 + _ROUNDING)) + 1)
    return tuple(float(value) for value in values)


def doubt_about_units(given: Any, key: Key) -> str | None:
    """A sentence on a range in which a number without a unit stands beside one with a unit.

    Zero is the same in every unit.
    """
    written = {"from": getattr(given, "from"), "to": given.to, "step": given.step}
    bare = [
        name
        for name, value in written.items()
        if value is not None and not _has_unit(value) and to_si(value, key.unit or "") != 0
    ]
    if not bare or not any(_has_unit(value) for value in written.values()):
        return None
    told = " and ".join(f"`{name}: {shown(written[name])}`" for name in bare)
    return (
        f"Read {told} without a unit beside a value that has one. Expected a unit with each: "
        f"what has none is in {key.unit}. Write the unit."
    )


def _has_unit(value: object) -> bool:
    if not isinstance(value, str):
        return False
    try:
        float(value)
    except ValueError:
        return True
    return False
