"""Backward steps: what two effects account for together is not lost by dropping one at a time."""

from dataclasses import dataclass

from rr_opt.sysid.selection import Selection


@dataclass(frozen=True)
class Made:
    choices: tuple[str, ...]
    excess: float
    given_up: bool = False

    @property
    def elpd(self) -> float:
        return -self.excess


MADE = {one.choices: one for one in (Made((), 10.0), Made(("a",), 7.5), Made(("b",), 7.8),
                                     Made(("a", "b"), 6.0))}  # fmt: skip
"""The pair leaves 36 % of the mean square, and more than half of what either leaves alone."""


class Dropping(Selection):
    def __init__(self) -> None:
        self.best = MADE["a", "b"]  # pyright: ignore

    def _fewer(self, candidate):
        for choice in candidate.choices:
            yield MADE[tuple(c for c in candidate.choices if c != choice)]  # pyright: ignore

    def _simpler(self, candidate):
        return iter(())


def test_the_whole_is_held_against_what_is_left_of_it():
    selection = Dropping()
    selection._backward(lambda whole, part: whole.excess**2 < 0.5 * part.excess**2)
    assert selection.best.choices == ("a",)


def test_what_is_not_needed_at_all_goes():
    selection = Dropping()
    selection._backward(lambda *_: False)
    assert selection.best.choices == ()
