"""The speed with which a period begins and ends."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from benchmarks.sweep.case import Array

_CLOSE, _ROUNDS = 1e-9, 30


def secant(
    period: Callable[[Array], tuple[Array, Array]], start: Array, *, affine: bool
) -> tuple[Array, Array]:
    """v (K,) at the start of the steady cycle, and its turn (K,).

    period: v -> v and psi a period later. If that is affine two runs tell all of it, the third is
    not needed; otherwise secants until a step is 1e-9 of the speed.
    """
    end, turn = period(start)
    other = end if not affine else start + 1.0
    for _ in range(_ROUNDS):
        next_end, next_turn = period(other)
        gap, next_gap = end - start, next_end - other
        apart = next_gap - gap
        step = np.where(apart == 0, 0.0, -next_gap * (other - start) / np.where(apart, apart, 1.0))
        found = other + step
        if affine:
            return found, turn + (next_turn - turn) * (found - start)
        start, end, turn, other = other, next_end, next_turn, found
        if np.all(np.abs(step) <= _CLOSE * np.maximum(np.abs(found), 1e-3)):
            break
    return other, period(other)[1]
