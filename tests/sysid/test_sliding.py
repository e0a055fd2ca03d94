"""Wheels that slide: how a run begins, and from where to look for their grip."""

from dataclasses import replace

import numpy as np
import pytest

from rr_opt.machines.racer.grip import slips
from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.machines.racer.simulation import side_speeds
from rr_opt.model.gait import SineGait
from rr_opt.sysid.candidates import Candidate, fitted
from rr_opt.sysid.diagnose import diagnose
from rr_opt.sysid.estimation import solve
from rr_opt.sysid.model import Choice, Request, Segment
from rr_opt.sysid.score_test import scores
from rr_opt.sysid.selection import Selection
from tests.sysid.made_up import GAITS, ROBOT, base_of, experiment, whole, with_effect

SLIDES = {"lateral_slip.mu": 0.012}


def axle_places(x, y, psi, phi):
    """Where the axles' centres are, from the joint's place; the second trails by c2."""
    one = np.array([x + ROBOT.platform1.c * np.cos(psi), y + ROBOT.platform1.c * np.sin(psi)])
    behind = psi + phi
    two = np.array([x - ROBOT.platform2.c * np.cos(behind), y - ROBOT.platform2.c * np.sin(behind)])
    return one, two


def test_side_speeds_are_those_of_the_axles_places():
    gait, t = GAITS[1][0], 5.0 + np.arange(40) / 100
    dt = t - t[0]
    x, y, psi = 0.2 + 0.1 * dt - 0.2 * dt**2, 0.05 * dt, 1.0 - 0.7 * dt + 0.3 * dt**2
    seen = side_speeds(ROBOT, gait, t, np.column_stack([x, y, psi, gait.angle(t)]))
    step = 1e-5
    before, after = (
        axle_places(0.2 + 0.1 * d, 0.05 * d, 1.0 - 0.7 * d, gait.angle(np.array([t[0] + d]))[0])
        for d in (-step, step)
    )
    for k, heading in enumerate((1.0, 1.0 + gait.angle(t[:1])[0])):
        velocity = (after[k] - before[k]) / (2 * step)
        across = velocity @ [-np.sin(heading), np.cos(heading)]
        assert seen[k] == pytest.approx(across, abs=1e-6)


@pytest.mark.parametrize("q", [0.02, 0.2, 2.0])
def test_wheels_that_hold_are_as_likely_as_wheels_that_cannot_slip(q):
    model = with_effect({}, (), seconds=30.0)
    plain, effects = base_of(model).fit, ("lateral_slip",)
    values = {**plain.values, "lateral_slip.creep_compliance": 0.0, "lateral_slip.mu": 10.0}
    states = {
        one: model.converted(Request(one, values, state), effects)
        for one, state in plain.states.items()
    }
    fits = [
        solve(replace(plain.problem, q=q), plain.values, plain.states),
        solve(replace(plain.problem, effects=effects, q=q), values, states),
    ]
    assert len(plain.problem.segments) > 2 * len(model.runs)
    assert fits[1].deviance == pytest.approx(fits[0].deviance, abs=5.0)


@pytest.mark.parametrize("friction", [0.0, 0.02])
def test_creep_is_slip_to_first_order(friction):
    """Against wheels that creep a little, whose side speeds are states."""
    beside, values = ("coulomb_friction",), {"coulomb_friction.force1": friction}
    model = with_effect(values, beside)
    segment, c = Segment(1, 0, 500, 499), 1e-3
    creep, slip = ("lateral_creep", *beside), ("lateral_slip", *beside)
    name = "lateral_creep.creep_compliance"
    start = model.initial_state(segment, creep, values)
    held = Request(segment, values | {name: 0.0}, start)
    (linear,) = model.linearise([held], creep, (name,))
    (off,) = model.simulate([held], creep)
    slipping = model.converted(held, slip)
    less, more = model.simulate(
        [
            Request(segment, values | {"lateral_slip.creep_compliance": some}, slipping)
            for some in (c, 2 * c)
        ],
        slip,
    )
    change = (more.residuals - less.residuals) / c
    own, size = start.size, float(np.linalg.norm(change))
    assert np.sqrt(linear.gram[own, own]) == pytest.approx(size, rel=0.02)
    # Not only as large but also in the same direction.
    along = float(np.vdot(off.residuals, change))
    assert linear.gram[own, -1] == pytest.approx(along, abs=0.02 * size * off.cost**0.5)


def test_a_jump_of_the_joints_rate_moves_both_the_same_way():
    """The impulse on the wheels counts at the mean of the rates before and after it."""
    beside = ("servo_rate_limit", "coulomb_friction")
    values = {"servo_rate_limit.rate_limit": 1.5, "coulomb_friction.force1": 0.02}
    model, segment, c = with_effect(values, beside), Segment(1, 0, 500, 499), 4e-3

    def change(effect: str, least: float) -> np.ndarray:
        effects = (effect, *beside)
        start = model.initial_state(segment, effects, values)
        start[4:] = 0.0
        name = f"{effect}.creep_compliance"
        asked = [Request(segment, values | {name: least + more}, start) for more in (0.0, c)]
        less, more = model.simulate(asked, effects)
        return (more.residuals - less.residuals).ravel()

    creeping, slipping = change("lateral_creep", 0.0), change("lateral_slip", c)
    sizes = np.linalg.norm(creeping) * np.linalg.norm(slipping)
    assert creeping @ slipping > 0.9 * sizes


def test_a_score_test_sees_wheels_that_creep():
    values = {"lateral_slip.creep_compliance": 0.004}
    model = with_effect(values, ("lateral_slip",))
    best = scores(base_of(model).fit, 1)[0]
    assert best.choices == (Choice("lateral_slip"),)
    assert best.guess == pytest.approx(values, rel=0.4)


@pytest.fixture(scope="module")
def sliding():
    return with_effect(SLIDES, ("lateral_slip",))


def test_a_segment_may_begin_while_the_wheels_slide(sliding):
    segment, effects = Segment(1, 40, 240, 240), ("lateral_slip",)
    start = sliding.initial_state(segment, effects, SLIDES)
    (linear,) = sliding.linearise([Request(segment, SLIDES, start)], effects, ())
    step = 1e-4
    for k in (4, 5):
        up, down = sliding.simulate(
            [Request(segment, SLIDES, start + way * step * np.eye(6)[k]) for way in (1, -1)],
            effects,
        )
        change = (up.residuals - down.residuals) / (2 * step)
        assert np.abs(change).max() > 1.0
        assert np.sqrt(linear.gram[k, k]) == pytest.approx(np.linalg.norm(change), rel=0.1)


@pytest.mark.parametrize("mu", [0.012, 0.02, 0.05])
def test_derivatives_across_the_onset_of_sliding(mu):
    model = RollerRacer(experiment(((SineGait(0.7, 1.0, 0.2), "running"),), 5.0, 100.0))
    effects, start = ("lateral_slip",), np.array([0.0, 0.0, 0.3, 0.05, 0.0, 0.0])

    def request(mu: float) -> Request:
        values = {"lateral_slip.creep_compliance": 6e-4, "lateral_slip.mu": mu}
        return Request(whole(model, 0), values, start)

    (linear,) = model.linearise([request(mu)], effects, ("lateral_slip.mu",))
    step = 1e-4 * mu
    up, down = model.simulate([request(mu + step), request(mu - step)], effects)
    by_mu = np.linalg.norm(up.residuals - down.residuals) / (2 * step)
    assert np.sqrt(linear.gram[6, 6]) == pytest.approx(by_mu, rel=0.25)


def test_one_of_the_grips_to_begin_with_is_near_the_true_one(sliding):
    bent = base_of(sliding).fit
    forms = sliding.catalogue["lateral_slip"].forms
    guesses = slips(sliding, bent)
    tried = [guess["lateral_slip.mu"] for _, guess in guesses if "lateral_slip.mu" in guess]
    nearest = min(abs(np.log(mu / SLIDES["lateral_slip.mu"])) for mu in tried)
    assert nearest < np.log(1.3)
    for form, guess in guesses:
        assert set(guess) == {q.name for q in forms[form].quantities}


FAST = (
    (SineGait(1.0, 1.0), "rest"),
    (SineGait(0.8, 1.0, 0.2), "running"),
    (SineGait(1.0, 1.2, -0.25), "running"),
    (SineGait(1.2, 1.4), "rest"),
)


def test_wheels_that_slide_far_are_found_though_hardly_any_creep_scores():
    grip = {"lateral_slip.creep_compliance": 3e-4, "lateral_slip.mu": 0.012}
    found = diagnose(with_effect(grip, ("lateral_slip",), gaits=FAST, seconds=6.0))
    assert [one.name for one in found.findings] == ["lateral_slip"]
    assert found.findings[0].parameters["mu"].value == pytest.approx(0.012, rel=0.02)


def test_sliding_is_not_proposed_where_it_would_explain_nothing():
    model = with_effect({"coulomb_friction.force1": 0.02}, ("coulomb_friction",))
    assert slips(model, base_of(model).fit) == []


@pytest.mark.parametrize("ratio", [0.0, 1.0])
def test_the_friction_circle_is_proposed_for_wheels_that_have_one(ratio):
    """Wheels that hardly resist show none."""
    parts = {"lateral_slip.creep_compliance": 6e-4, "lateral_slip.mu": 0.02}
    parts |= {"coulomb_friction.force1": 0.02, "coulomb_friction.force2": 0.02}
    effects, form = ("coulomb_friction", "lateral_slip"), Choice("lateral_slip", 1)
    values = {**parts, "lateral_slip.mu_ratio": ratio}
    model = with_effect(values, effects, gaits=FAST, seconds=6.0)
    fit = fitted(model, [Choice("coulomb_friction"), form], base_of(model).fit, [parts]).fit
    proposed = [(2, {"lateral_slip.mu_ratio": 1.0})] if ratio else []
    assert slips(model, fit) == proposed


def test_wheels_that_hardly_hold_are_found():
    """A guess near the true grip is behind those of other minima after a step."""
    ice = {"lateral_slip.mu": 0.0012}
    model = with_effect(ice, ("lateral_slip",))
    bent = base_of(model).fit
    guesses = [guess for form, guess in slips(model, bent) if form == 1]
    found = fitted(model, [Choice("lateral_slip", 1)], bent, guesses, bent)
    assert found.fit.values["lateral_slip.mu"] == pytest.approx(0.0012, rel=0.1)


def test_slip_beside_a_nested_fit_begins_where_it_moves_something():
    """Its compliance enters squared: from 0 a fit hardly moves."""
    model = with_effect({}, (), seconds=3.0)
    base = base_of(model)
    search = Selection(model, base)
    begun = []

    def tried(model, key, parent, guesses, rival=None):
        begun.extend(guesses)
        return Candidate(tuple(key), base.fit)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("rr_opt.sysid.selection.fitted", tried)
        tilt = fitted(model, [Choice("floor_tilt")], base.fit, [{}])
        search.tried[tilt.choices] = tilt
        guess = {"floor_tilt.tilt_x": 0.1, "lateral_slip.creep_compliance": 0.003}
        search.fitted([Choice("floor_tilt"), Choice("lateral_slip")], [guess])
    assert begun[0] == guess
    assert begun[1]["lateral_slip.creep_compliance"] == 0.003
    assert begun[1]["floor_tilt.tilt_x"] == tilt.fit.values["floor_tilt.tilt_x"]
