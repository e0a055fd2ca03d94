"""Of candidates that predict about as well, the answer is the one with the fewest effects, then
with the likeliest ones, then with the fewest values."""

from types import SimpleNamespace
from typing import Any

import pytest

from rr_opt.sysid.selection import Selection


def candidate(elpd: float, values: int, *effects: str) -> Any:
    """Six recordings, each predicted as well."""
    return SimpleNamespace(
        effects=effects,
        elpd=elpd,
        given_up=False,
        predictive=dict.fromkeys(range(6), elpd / 6),
        fit=SimpleNamespace(problem=SimpleNamespace(quantities=["q"] * values)),
    )


class Tied(Selection):
    def __init__(self, *tied: Any) -> None:
        self.best = tied[0]
        self.tried = dict(enumerate(tied))  # pyright: ignore

    def alike(self) -> Any:
        return self.tried.values()

    def complete(self, candidate):
        return True


CLOCK, LAG = candidate(0.0, 1, "clock"), candidate(3.0, 2, "lag")
SIMPLER, FULLER = candidate(0.0, 1, "lag"), candidate(0.1, 2, "lag")
BOTH = candidate(4.0, 3, "clock", "lag")


@pytest.mark.parametrize(
    ("tied", "chosen"),
    [((CLOCK, LAG), LAG), ((FULLER, SIMPLER), SIMPLER), ((BOTH, CLOCK), CLOCK)],
    ids=["likelier", "simpler", "fewer"],
)
def test_the_answer_among_them(tied, chosen):
    assert Tied(*tied)._simplest() is chosen
