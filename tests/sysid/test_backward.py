"""Backward steps: what two effects account for together is not lost by dropping one at a time."""

from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import pytest

from rr_opt.sysid.selection import Selection


@dataclass(frozen=True)
class Made:
    choices: Any
    excess: float
    given_up: bool = False
    fit: Any = None

    @property
    def elpd(self) -> float:
        return -self.excess

    def predicts_better(self, other) -> bool:
        return self.excess < 0.9 * other.excess


MADE = {
    one.choices: one
    for one in (
        *(Made((), 10.0), Made(("a",), 7.5), Made(("b",), 7.8), Made(("a", "b"), 6.0)),
        *(Made(("a plain",), 9.0), Made(("a plain", "b"), 6.1)),
    )
}
"""The pair leaves 36 % of the mean square, and more than half of what either leaves alone."""


class Dropping(Selection):
    def __init__(self) -> None:
        self.best = MADE["a", "b"]  # pyright: ignore

    def _fewer(self, candidate) -> Any:
        for choice in candidate.choices:
            yield MADE[tuple(c for c in candidate.choices if c != choice)]  # pyright: ignore

    def _simpler(self, candidate) -> Any:
        if candidate.choices == ("a", "b"):
            yield MADE["a plain", "b"]  # pyright: ignore


def test_the_whole_is_held_against_what_is_left_of_it():
    selection = Dropping()
    selection._backward(lambda whole, part: whole.excess**2 < 0.5 * part.excess**2)
    assert selection.best.choices == ("a",)


def test_what_is_not_needed_at_all_goes():
    selection = Dropping()
    selection._backward(lambda *_: False)
    assert selection.best.choices == ()


def test_an_effect_is_dropped_before_another_is_simplified():
    selection = Dropping()
    selection._backward(lambda _, part: part.excess > 7.6)
    assert selection.best.choices == ("a",)


class Near(Selection):
    """One effect leaves 7.5 % of the first misfit (RMS)."""

    def __init__(self, form_error: float) -> None:
        self.base: Any = MADE[()]
        self.best: Any = SimpleNamespace(
            choices=("a",), form_errors={"a": form_error}, excess=0.075 * MADE[()].excess
        )
        self.forward = 0

    def _better(self, candidate, other) -> bool:
        return True

    def _enough(self, candidate) -> bool:
        return False

    insignificant = _enough

    def _forward(self) -> None:
        self.forward += 1

    def _backward(self, needed) -> None: ...

    def _contest(self) -> None: ...


@pytest.mark.parametrize(
    ("form_error", "sought", "kept"),
    [(0.03, True, True), (0.07, True, False), (0.08, False, False)],
)
def test_what_machines_differ_by_calls_for_no_second_effect(form_error, sought, kept):
    both: Any = SimpleNamespace(excess=0.0)
    selection = Near(form_error)
    assert selection.needed(both, selection.best) == kept
    selection.run()
    assert selection.forward == sought


@pytest.mark.parametrize(("left", "kept"), [(0.073, False), (0.07, True)])
def test_a_second_effect_is_needed_if_it_removes_more_than_machines_differ_by(left, kept):
    """Of 7.5 % it has to remove 2 %, in squares."""
    both: Any = SimpleNamespace(excess=left * MADE[()].excess)
    selection = Near(0.01)
    assert selection.needed(both, selection.best) == kept


def test_what_the_motion_does_not_show_goes_before_more_is_sought():
    class Looking(Dropping):
        def _enough(self, candidate) -> bool:
            return False

        def _better(self, candidate, other) -> bool:
            return other.excess > 7.6

        def _forward(self) -> None:
            raise LookupError(self.best.choices)

        def _close(self, candidate) -> bool:
            return False

    with pytest.raises(LookupError, match=r"\('a',\)"):
        Looking().run()


def test_a_part_that_is_enough_is_taken_to_its_end(monkeypatch):
    """It need not predict as well as the whole, by which it was given up."""

    class GivingUp(Dropping):
        def _fewer(self, candidate) -> Any:
            return (replace(one, given_up=True) for one in super()._fewer(candidate))

    selection = GivingUp()
    selection.tried, selection.model = {}, None  # pyright: ignore
    monkeypatch.setattr("rr_opt.sysid.selection.fitted", lambda _, key, *__: MADE[key])
    selection._backward(lambda _, part: part.excess > 7.6)
    assert selection.best == selection.tried[("a",)] == MADE[("a",)]  # pyright: ignore
