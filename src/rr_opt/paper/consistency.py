"""Which readings of J20/J10, of kappa and of the speed columns the nine averages allow.

Each is fitted with everything else open (`rr_opt.paper.fit`), and judged by the chi-square that is
left. A standard error of three runs is itself a guess from two degrees of freedom, so what is left
is held against squares of Student's t: p is the share of random sets of nine - fitted such squares
that exceed it. That is rough: it takes each fitted unknown to take up one row.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rr_opt.paper.equation3 import CORRECTED, PRINTED, Signs
from rr_opt.paper.fit import COLUMNS, STUDENT, Column, Fit, fit
from rr_opt.paper.nine_rows import BOX, ROWS, prototype
from rr_opt.paper.printed import LOADED_RATIOS, RUNS, TABLE_1, TABLE_2, TABLE_3
from rr_opt.paper.readings import ABOUT_P, READINGS, Reading

Question = Literal["ratio", "kappa", "equation"]
QUESTIONS: tuple[Question, ...] = ("ratio", "kappa", "equation")

KAPPA = TABLE_1["kappa"].value
WIDEST_WHEEL = 0.04
"""A wheel radius, m, larger than the drawings allow: with it kappa in N m s brakes least."""

RATIOS = tuple(sorted({*LOADED_RATIOS, *(row.ratio for row in (*TABLE_2, *TABLE_3))}))
"""Every J20/J10 that the paper prints."""

_SETS, _SEED = 200_000, 5


@dataclass(frozen=True)
class Tried:
    """A reading fitted to one column; p as the module's head says."""

    question: Question
    name: str
    reading: Reading
    signs: Signs
    column: Column
    fit: Fit

    @property
    def p(self) -> float:
        """The share of sets that miss by more."""
        return float((_sets(len(ROWS) - self.fit.free) > self.fit.chi2).mean())


@dataclass(frozen=True)
class Bare:
    """What a reading makes of Table 1's robot without loads.

    low, high  J20/J10 over the box of a1 and a2
    reached    which of the printed ratios need platform 2 to be no lighter than without loads,
               at some a1 and a2 of the box
    """

    reading: Reading
    low: float
    high: float
    reached: tuple[float, ...]


@dataclass(frozen=True)
class Consistency:
    """All that was tried; still: chi-square of each column if the robot did not move at all."""

    tried: tuple[Tried, ...]
    bare: tuple[Bare, ...]
    still: dict[Column, float]

    def of(self, question: Question, column: Column) -> list[Tried]:
        """Those of one question and column."""
        return [one for one in self.tried if (one.question, one.column) == (question, column)]


def audit_readings(progress: Callable[[str], None]) -> Consistency:
    """Fit every reading to both columns; some twenty seconds."""
    asked: list[tuple[Question, str, Reading, Signs, dict[str, float]]] = [
        *(("ratio", one.name, one, CORRECTED, {}) for one in READINGS),
        *(("kappa", name, ABOUT_P, CORRECTED, {"k": k}) for name, k in kappas()),
        ("equation", "equation (3) as printed", ABOUT_P, PRINTED, {}),
    ]
    tried: list[Tried] = []
    for question, name, reading, signs, fixed in asked:
        for column in COLUMNS:
            progress(f"fit {len(tried) + 1} of {len(asked) * len(COLUMNS)}")
            found = fit(reading, column, signs=signs, fixed=fixed)
            tried.append(Tried(question, name, reading, signs, column, found))
    still: dict[Column, float] = {
        column: sum((getattr(row, column) * STUDENT / row.half_width) ** 2 for row in ROWS)
        for column in COLUMNS
    }
    return Consistency(tuple(tried), tuple(_bare(one) for one in READINGS), still)


def kappas() -> tuple[tuple[str, float], ...]:
    """Readings of kappa = 0.25, with the k of one wheel, N s/m, that each gives."""
    return (
        (f"{KAPPA:g} N s/m, each wheel's k", KAPPA),
        (f"{KAPPA:g} N s/m, for a pair of wheels", KAPPA / 2),
        (f"{KAPPA:g} N m s with wheels of {1e3 * WIDEST_WHEEL:g} mm", KAPPA / WIDEST_WHEEL**2),
    )


def stops_in(k: float) -> float:
    """Time in which friction k at four wheels brakes Table 1's masses to 1/e, straight ahead, s."""
    return (TABLE_1["m1"].value + TABLE_1["m2"].value) / (4 * k)


def wheel_for(k: float) -> float:
    """The wheel radius, m, at which kappa = 0.25 mN m s gives this k."""
    return math.sqrt(1e-3 * KAPPA / k)


def _bare(reading: Reading) -> Bare:
    robots = [
        prototype(float(a1), float(a2), 0.03, 0.1)
        for a1 in np.linspace(*BOX["a1"], 13)
        for a2 in np.linspace(*BOX["a2"], 13)
    ]
    ratios = [reading.ratio(one) for one in robots]
    reached = tuple(ratio for ratio in RATIOS if ratio >= min(ratios))
    return Bare(reading, min(ratios), max(ratios), reached)


@lru_cache
def _sets(count: int) -> NDArray[np.float64]:
    draws = np.random.default_rng(_SEED).standard_t(RUNS - 1, (_SETS, count))
    return (draws**2).sum(axis=1)
