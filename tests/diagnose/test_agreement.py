"""Held-out recordings that tell what the others left open are no contradiction; others are."""

from dataclasses import replace

from rr_opt.diagnose.agreement import together
from rr_opt.diagnose.explain import Chosen, nominal, windows
from rr_opt.diagnose.explanation import misfit
from rr_opt.diagnose.level import level_of
from rr_opt.diagnose.racer import RollerRacer
from tests.diagnose.made_up import base_of, explained, with_effect

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
