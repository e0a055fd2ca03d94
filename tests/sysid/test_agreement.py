"""Held-out recordings that tell what the others left open are no contradiction; others are."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.sysid import diagnose as found
from rr_opt.sysid.candidate import Chosen, Explanation, misfit, nominal, windows
from rr_opt.sysid.evaluation import level_of, other_forms, together
from tests.sysid.made_up import base_of, explained, with_effect

FRICTION = {"coulomb_friction.force1": 0.003, "coulomb_friction.force2": 0.001}
TILT = {"floor_tilt.tilt_x": 0.002, "floor_tilt.tilt_y": 0.0}


def told(fitted, held_out, **about):
    """Dry friction fitted to some runs, and then to the others too."""
    others = [replace(run, use="holdout") for run in held_out]
    every = with_effect({}, (), **about).experiment
    few = RollerRacer(replace(every, runs=tuple(fitted)))
    model = RollerRacer(replace(every, runs=(*fitted, *others)))
    best = explained(few, base_of(few), Chosen("coulomb_friction"))
    level = level_of(model, best.whole, nominal(model, windows(model, range(len(model.runs)))))
    return together(model, best, level.starts), level


def test_what_one_recording_left_open():
    runs = with_effect(FRICTION, ("coulomb_friction",), seconds=2.0).experiment.runs
    fit, level = told(runs[:1], runs[1:], seconds=2.0)
    assert level.held() ** 2 - 1 > 1.0
    assert fit is not None
    assert misfit(fit) < 0.05


def test_a_contradiction():
    runs = with_effect(FRICTION, ("coulomb_friction",)).experiment.runs
    tilted = with_effect(FRICTION | TILT, ("coulomb_friction", "floor_tilt")).experiment.runs
    fit, level = told(runs[:2], tilted[2:])
    assert level.held() ** 2 - 1 > 1.0
    assert fit is None


def in_forms(monkeypatch, lead, held):
    """The form of a patch that is told, and of how many it was looked what they leave.

    lead  of the first form in score;  held  misfit each leaves of what was held out, RMS in sigma
    """
    few = with_effect({}, (), seconds=2.0)
    runs = few.experiment.runs
    model = RollerRacer(replace(few.experiment, runs=(*runs[:3], replace(runs[3], use="holdout"))))
    base = base_of(few)
    disc, edge = (replace(base, chosen=(Chosen("floor_patch", form),)) for form in (0, 1))
    scores = {0: 0.0, 1: lead}
    monkeypatch.setattr(Explanation, "score", property(lambda one: scores[one.chosen[0].form]))
    monkeypatch.setattr(found, "settled", lambda _, one: one)
    monkeypatch.setattr(found, "_plainest", lambda _, one: one)
    made = []

    def level(*_):
        leaves = (1 + held[len(made)] ** 2) ** 0.5
        made.append(SimpleNamespace(held=lambda: leaves))
        return made[-1]

    monkeypatch.setattr(found, "level_of", level)
    best, left = found._that_predicts(model, disc, [base, disc, edge], base.whole)
    assert left is made[best.chosen[0].form]
    return best.chosen[0].form, len(made)


@pytest.mark.parametrize(
    ("lead", "held", "told"),
    [
        # What predicts well is kept, and nothing else is looked at.
        (1.0, (0.1, 0.0), (0, 1)),
        # What the fitted recordings do not tell, those held out do.
        (1.0, (0.9, 0.1), (1, 2)),
        (1.0, (0.9, 1.2), (0, 2)),
        # What they do tell stands.
        (100.0, (0.9, 0.1), (0, 1)),
    ],
)
def test_what_form_it_has(monkeypatch, lead, held, told):
    assert in_forms(monkeypatch, lead, held) == told


def test_other_forms_are_of_the_same_effects():
    model = with_effect({}, (), seconds=2.0)
    base = base_of(model)
    patch, drag = (
        replace(base, chosen=(Chosen(name),)) for name in ("floor_patch", "left_right_drag")
    )
    edge = replace(base, chosen=(Chosen("floor_patch", 1),))
    assert other_forms(patch, [base, patch, drag, edge]) == [edge]
