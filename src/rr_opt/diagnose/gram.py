"""J'J of predicted runs against what was recorded: all that a least-squares step needs of them.

J has the derivatives of what is seen, in sigmas, at every sample and channel with data: by the
start, by what is asked for, any further columns, and last what the prediction is off.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rr_opt.diagnose.compiled import Rows
from rr_opt.diagnose.linear import DriveSlopes, slopes
from rr_opt.diagnose.model import Array
from rr_opt.diagnose.shoot import DrivePath, Path, System, code_of


@dataclass(frozen=True)
class Recorded:
    """What was recorded (samples, channels), 0 for no data, and 1/sigma, 0 for no data."""

    values: Array
    weight: Array

    @classmethod
    def of(cls, values: Array, sigma: Array) -> Recorded:
        """From values that are NaN where there are no data."""
        seen = np.isfinite(values)
        return cls(np.where(seen, values, 0.0), np.where(seen, 1 / sigma, 0.0))

    def off(self, predicted: Array) -> Array:
        """(predicted - recorded)/sigma, 0 for no data."""
        return (predicted - self.values) * self.weight


@dataclass(frozen=True)
class Sought:
    """A predicted run, and by what it is to be differentiated; see `linear.linear`.

    more  (samples, channels, k) further columns
    """

    path: DrivePath
    made: Path
    p: Array
    wanted: Array
    drive_by: DriveSlopes | None
    recorded: Recorded
    more: Array | None = None


def grams(system: System, asked: Sequence[Sought]) -> list[Array]:
    """J'J (n, n) of each run, without the samples where a prediction has left the numbers."""
    if not asked:
        return []
    code = code_of(system, 4 * sum(one.path.h.size for one in asked))
    return code.grams([_rows(one) for one in asked]) if code else [_gram(system, a) for a in asked]


def gram_of(*columns: Array) -> Array:
    """J'J of columns (samples, k) side by side."""
    J = np.column_stack(columns)
    return J.T @ J


def _rows(one: Sought) -> Rows:
    by, path = one.drive_by, one.path
    moved = (by.at, by.nodes) if by else None
    return Rows(
        *(path.inputs, path.at, path.each, one.p, one.made.states, one.wanted, moved),
        *(one.recorded.values, one.recorded.weight, one.more),
    )


def _gram(system: System, one: Sought) -> Array:
    by = slopes(system, one.path, one.made, one.p, one.wanted, one.drive_by)
    off = one.made.seen - one.recorded.values
    weight = np.where(np.isfinite(off), one.recorded.weight, 0.0)
    parts = [
        by.by_start,
        by.by_parameter,
        *([] if one.more is None else [one.more]),
        off[..., None],
    ]
    known = weight[:, :, None] > 0
    return gram_of(
        *(
            np.where(known, part, 0.0).reshape(weight.size, -1) * weight.reshape(-1, 1)
            for part in parts
        )
    )
