"""Where nothing is named, what predicts best is, with the reason why it is not named."""

from types import SimpleNamespace
from typing import Any

import pytest

from rr_opt.sysid.verdict import Identification


def candidate(*effects: str, elpd: float = 0.0, better: bool = True) -> Any:
    return SimpleNamespace(
        choices=effects, effects=effects, elpd=elpd, excess=0.0, predicts_better=lambda _: better
    )


def doubt(
    best: Any,
    *others: Any,
    constant=0.9,
    single=1.0,
    alike=0.9,
    predicts=0.9,
    none=False,
    foreseen=True,
    suspected=(),
    after=(),
    left=0.0,
) -> str:
    made: Any = SimpleNamespace(
        best=best,
        suspected=suspected,
        after=after,
        nominal=SimpleNamespace(excess=0.0),
        final=SimpleNamespace(excess=left),
        _ended=[best, *others],
        selection=SimpleNamespace(
            base=candidate(),
            insignificant=lambda _: none,
            foreseen=foreseen,
            model=SimpleNamespace(inputs={"rolling": "a force along the wheels"}, form_error=0.0),
        ),
        _disagree=constant <= 0.5,
        _hints=lambda: Identification._hints(made),
        sound=constant * single * alike * predicts,
        _constant=constant * single,
        _as_machines_differ=alike,
        _predicts=predicts,
    )
    return Identification.doubt.fget(made)  # pyright: ignore


@pytest.mark.parametrize(
    ("factors", "reason"),
    [
        ({"constant": 0.1}, "but the recordings disagree on the values. Check whether something"),
        (
            {"alike": 0.1},
            "but the remaining misfit exceeds the usual error of such models. Look for a cause",
        ),
        ({"single": 0.5}, "but that many effects can mimic almost anything. Record gaits"),
        ({"predicts": 0.1}, "but the held-out recordings do not confirm it. Check the held-out"),
        (
            {"constant": 0.1, "alike": 0.1},
            "disagree on the values and the remaining misfit exceeds",
        ),
        ({"alike": 0.6, "predicts": 0.7}, "but the remaining misfit exceeds"),
        ({}, "but others do about as well. Record gaits"),
    ],
)
def test_the_reason(factors, reason):
    said = doubt(candidate("lateral_slip", "coulomb_friction"), **factors)
    assert said.startswith("The best candidate is lateral slip and Coulomb friction, but")
    assert reason in said


def test_what_was_not_needed_is_said_to_leave_most():
    said = doubt(candidate(), candidate("servo_lag", elpd=9.0))
    assert said == (
        "The best candidate is servo lag, but most of the misfit remains. Look for a cause where "
        "the remaining misfit shows."
    )


def test_what_predicts_too_little_better_is_said_to_be_open():
    said = doubt(candidate(), candidate("coulomb_friction", elpd=3.0, better=False))
    assert said.startswith("The best candidate is Coulomb friction, but its lead is too small")


@pytest.mark.parametrize("others", [(), (candidate("coulomb_friction", elpd=-1.0),)])
def test_where_nothing_predicts_better_what_remains_is_told(others):
    nominal = candidate(better=False)
    nominal.excess = 1.79
    assert doubt(nominal, *others) == (
        "No effect predicts the recordings better than the nominal model, which leaves 1.8 sigma "
        "beyond the noise in the fitted ones. Look for a cause where the remaining misfit shows."
    )


def test_nothing_is_said_beside_a_suspicion():
    assert doubt(candidate("dragged_cable"), suspected=("dragged_cable",)) == ""


DISAGREE = (
    "The recordings disagree on the values of the nominal model. Check whether something changed "
    "between the recordings."
)
FIT = (
    "The missing physics shows mainly in the held-out recordings. Change them to `use: fit`, hold "
    "out others, and diagnose again."
)

TIME: Any = SimpleNamespace(certain=True, channel="rolling", variable="time")
NOISE: Any = SimpleNamespace(certain=False, channel="rolling", variable="time")
SLIGHT = (
    "What remains is slight, but it is not noise: it looks like a force along the wheels that "
    "depends on time."
)


@pytest.mark.parametrize(
    ("about", "hints"),
    [
        ({"after": [TIME, NOISE]}, SLIGHT),
        # What depends on it is told with the remainder.
        ({"after": [TIME], "left": 1.0}, ""),
        ({"after": [NOISE]}, FIT),
        ({"constant": 0.1}, DISAGREE),
        ({}, FIT),
        ({"foreseen": False}, FIT),
        ({"constant": 0.1, "foreseen": False}, f"{DISAGREE} {FIT}"),
    ],
)
def test_where_the_fitted_recordings_leave_nothing(about, hints):
    assert doubt(candidate(better=False), none=True, **about) == hints
