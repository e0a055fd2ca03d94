"""The summary says what was found, what it is worth, what remains, and what to record next."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.sysid.diagnosis import Remainder, summary_of
from tests.report.diagnosis.conftest import _experiment, _found


@pytest.fixture(scope="module")
def found():
    return replace(_found(_experiment()), before=8.1, after=1.02)


@pytest.mark.parametrize(
    ("verdict", "said"),
    [
        (
            "consistent",
            "The nominal model explains the recordings once its values are refitted within their "
            "uncertainties.",
        ),
        ("parameters", "The model is right, but the value of Coulomb friction is not."),
        ("missing_physics", "The model leaves out Coulomb friction (confidence 99 %)."),
        ("unexplained", "Physics is missing; no effect in the catalogue is shown to be the cause."),
    ],
)
def test_it_opens_with_the_verdict(found, verdict, said):
    text = summary_of(replace(found, verdict=verdict, indistinguishable=()))
    assert text.startswith(f"{said} On held-out recordings, the misfit fell from")
    assert "from 8.10 to 1.02 sigma, where 1 is noise alone." in text


def test_a_model_that_is_right_as_it_is_believed_to_be_is_not_refitted(found):
    text = summary_of(replace(found, verdict="consistent", before=1.01))
    assert text.startswith("The nominal model explains the recordings. On")


@pytest.mark.parametrize(
    ("after", "said"),
    [
        (1.02, "the misfit fell from 8.10 to 1.02 sigma"),
        (8.2, "the misfit rose from 8.10 to 8.20 sigma"),
        (8.101, "the misfit stayed at 8.10 sigma"),
    ],
)
def test_a_misfit_that_rises_is_not_said_to_fall(found, after, said):
    assert said in summary_of(replace(found, after=after))


def test_why_nothing_is_named_is_said(found):
    why = "The best candidate is slip, but the recordings disagree on the values."
    assert why in summary_of(replace(found, verdict="unexplained"), doubt=why)
    assert why not in summary_of(found, doubt=why)


def test_what_looks_alike_is_not_ruled_out(found):
    named = replace(found.findings[0], lookalikes=("a cable", "a stone in a wheel"))
    text = summary_of(replace(found, findings=(named,)))
    assert "Not ruled out: a cable or a stone in a wheel. " in text
    assert "ruled out" not in summary_of(found)


def test_what_is_suspected_is_said(found):
    suspect = replace(found.findings[0], name="dragged_cable", confidence=0.87)
    doubtful = replace(found, verdict="unexplained", findings=(), suspects=(suspect,))
    text = summary_of(doubtful)
    assert "Suspected, but untested in trials: dragged cable (confidence 87 %). " in text
    assert "Suspected" not in summary_of(found)
    tied = replace(doubtful, indistinguishable=(("dragged_cable", "coulomb_friction"),))
    assert "These recordings cannot distinguish this from Coulomb friction." in summary_of(tied)


@pytest.mark.parametrize(("off", "said"), [(0.05, "50.0 mm"), (0.0, "less than 0.1 mm")])
def test_a_place_is_never_said_to_be_off_by_nothing(off, said):
    recorded = np.zeros((50, 4))
    seen: Any = SimpleNamespace(
        held_out=True, predicted=np.tile([off, 0.0, 0, 0], (50, 1)), recorded=recorded, sigma=1e-6
    )
    nobody: Any = None
    assert f"is {said} off" in RollerRacer.accuracy(nobody, [seen])


def test_what_remains_is_told_with_what_it_depends_on(found):
    left = replace(found, remainder=Remainder("small", 0.4, 0.03, "a force along the wheels"))
    assert "The remainder is small (3 % of the misfit): a force along the wheels." in summary_of(
        left
    )
    assert "What remains" not in summary_of(found)
    assert "What remains" not in summary_of(replace(left, verdict="consistent"))


def test_a_tie_is_called_one(found):
    tied = replace(found, indistinguishable=(("coulomb_friction", "lateral_slip"),))
    said = "These recordings cannot distinguish this from lateral slip."
    assert said in summary_of(tied)
    assert said in summary_of(replace(tied, verdict="parameters"))
    assert said not in summary_of(replace(tied, indistinguishable=()))
    assert said not in summary_of(replace(tied, verdict="unexplained"))


def test_the_next_recording_is_asked_for_where_something_is_open(found):
    plan = found.next_experiment.sentence
    assert summary_of(found).endswith(plan)
    settled = replace(found, indistinguishable=())
    assert plan not in summary_of(settled)
    assert plan not in summary_of(replace(found, verdict="consistent"))


def test_recordings_that_were_all_fitted_are_called_so(found):
    final = tuple(replace(one, held_out=False) for one in found.final)
    assert "On the recordings, all of which were fitted, " in summary_of(
        replace(found, final=final)
    )


def test_its_worth_in_the_machines_own_terms(found):
    assert "the place was 8 mm off; the misfit fell" in summary_of(
        found, "the place was 8 mm off; "
    )
