"""The summary says what was found, what it is worth, what remains, and what to record next."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.sysid.diagnosis import Remainder, Tie, summary_of
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
    text = summary_of(replace(found, verdict=verdict, ties=()))
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
    assert (
        "Suspected (few blind trials have tested this): dragged cable (confidence 87 %). " in text
    )
    assert "Suspected" not in summary_of(found)
    tied = replace(doubtful, ties=(Tie(("dragged_cable",), ("coulomb_friction",)),))
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
    said = "The remainder is small (3 % of the initial misfit beyond the noise): a force along the"
    assert said in summary_of(left)
    assert "What remains" not in summary_of(found)
    assert "What remains" not in summary_of(replace(left, verdict="consistent"))


def test_a_tie_is_called_one(found):
    tied = replace(found, ties=(Tie(("coulomb_friction",), ("lateral_slip",)),))
    said = "These recordings cannot distinguish this from lateral slip."
    assert said in summary_of(tied)
    values = replace(tied, verdict="parameters", ties=(Tie(("I1",), ("m1", "kappa1")),))
    assert "cannot distinguish this from a wrong m1 or kappa1." in summary_of(values)
    assert said not in summary_of(replace(tied, ties=()))
    assert said not in summary_of(replace(tied, verdict="unexplained"))


def test_a_tie_with_a_part_of_the_answer_is_not_one_with_another_effect(found):
    both = ("coulomb_friction", "lateral_slip")
    named = tuple(replace(found.findings[0], name=name) for name in both)
    ties = (Tie(both, both[1:]), Tie(both, ("floor_patch", "floor_tilt")))
    said = (
        "These recordings cannot distinguish this from lateral slip alone or from floor patch and "
        "floor tilt."
    )
    assert said in summary_of(replace(found, findings=named, ties=ties))
    # The answer has an effect that is not named: what is named is the rival.
    assert "cannot distinguish" not in summary_of(
        replace(found, ties=(Tie(both, ("coulomb_friction",)),))
    )


def test_the_next_recording_is_asked_for_where_something_is_open(found):
    plan = found.next_experiment.sentence
    assert summary_of(found).endswith(plan)
    settled = replace(found, ties=())
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
