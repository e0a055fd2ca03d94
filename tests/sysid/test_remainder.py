"""What is left of a fit points to where it enters and to what it depends on."""

from dataclasses import replace

import numpy as np
import pytest

from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.machines.racer.unknown_input import unknown_terms
from rr_opt.sysid.diagnosis import Curve
from rr_opt.sysid.machine import CONSTANT, Term
from rr_opt.sysid.remainder import Dependence, dependences, stages
from tests.sysid.made_up import base_of, with_effect

COULOMB = {"coulomb_friction.force1": 0.005, "coulomb_friction.force2": 0.003}
TILT = {"floor_tilt.tilt_x": 0.004, "floor_tilt.tilt_y": 0.002}


def left(values, effects):
    """Beside a fit of a robot whose wheels' friction is known, lest that imitates anything."""
    made = with_effect(values, effects).experiment
    known = {name: one for name, one in made.uncertainty.items() if "kappa" not in name}
    model = RollerRacer(replace(made, uncertainty=known))
    fit = base_of(model).fit
    return dependences(fit, *unknown_terms(model, fit))


@pytest.mark.parametrize(
    ("values", "effect", "channel", "variable"),
    [(COULOMB, "coulomb_friction", "rolling", "speed"), (TILT, "floor_tilt", "rolling", "heading")],
)
def test_it_points_there(values, effect, channel, variable):
    first = left(values, (effect,))[0]
    assert (first.channel, first.variable) == (channel, variable)
    assert first.p_value < 1e-6
    assert first.share > 0.1


def test_nothing_is_left_of_a_right_model():
    assert all(one.p_value > 1e-6 for one in left({}, ()))
    assert max(one.gain - one.degrees for one in left({}, ())) < 20


class Exact(RollerRacer):
    form_error = 0.0  # pyright: ignore


class Loose(RollerRacer):
    form_error = 1.0  # pyright: ignore


def test_what_machines_deviate_by_weighs_less():
    experiment = with_effect(COULOMB, ("coulomb_friction",)).experiment
    exact, loose = (model(experiment) for model in (Exact, Loose))
    fit = base_of(exact).fit
    terms = unknown_terms(exact, fit)
    vaguer = replace(fit, problem=replace(fit.problem, model=loose))
    own, other = (
        next(d for d in dependences(one, *terms) if (d.channel, d.variable) == ("rolling", "speed"))
        for one in (fit, vaguer)
    )
    problem = fit.problem
    times = {run: problem.correlation_times(run) for run in problem.samples}
    ratios = [
        (1 + n / times[run]) / (1 + max(fit.evidences[run].excess, 0) / times[run])
        for run, n in problem.samples.items()
    ]
    phi = np.mean(np.maximum(ratios, 1))
    assert phi > 1
    assert other.gain == pytest.approx(own.gain / phi)
    assert other.share == pytest.approx(own.share)
    assert other.curve.error == pytest.approx(own.curve.error * np.sqrt(phi))


@pytest.mark.parametrize(("more", "leads"), [(2.0, "constant"), (20.0, "phase")])
def test_a_term_has_to_gain_more_than_its_functions_do_by_chance(more, leads):
    def one(variable, degrees, gain):
        columns, none = tuple(range(degrees)), np.zeros(0)
        term = Term("rolling", variable, columns, "", none, np.zeros((0, degrees)))
        return Dependence(term, gain, 0.5, Curve(variable, "", none, none, none))

    found = [one(CONSTANT, 1, 500.0), one("phase", 6, 500.0 + more)]
    (stage,) = stages(found, {"rolling": "a force"}, 1.0, faulty=True)
    assert leads in stage.where
