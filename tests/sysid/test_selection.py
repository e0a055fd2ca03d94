"""An effect that is put into the robot is the one that the search names."""

import pytest

from rr_opt.model.gait import SineGait
from rr_opt.sysid.candidates import first
from rr_opt.sysid.constancy import constancy
from rr_opt.sysid.intervals import released, wrong
from rr_opt.sysid.model import ChannelNoise, Choice
from rr_opt.sysid.selection import Selection
from tests.sysid.made_up import with_effect

HIDDEN = {
    "coulomb_friction": {"force1": 0.005, "force2": 0.003},
    "left_right_drag": {"asymmetry1": 0.8, "asymmetry2": -0.3},
    "floor_tilt": {"tilt_x": 0.004, "tilt_y": 0.002},
    "marker_offset": {"dx": 0.01, "dy": 0.006},
    "servo_lag": {"tau": 0.03},
}
"""Their usual sizes, about."""

DRAG = {"kappa1": 1.2e-5, "kappa2": 1.2e-5}
"""Three times what is believed, so that a share of it shows in so short recordings."""

UNLIKE = (
    (SineGait(0.3, 0.7), "running"),
    (SineGait(1.0, 2.8, 0.2), "running"),
    (SineGait(0.5, 0.8, -0.25), "running"),
    (SineGait(0.9, 1.4), "rest"),
)
"""Slow and fast: at one speed, any drag is like any other."""


@pytest.mark.parametrize("effect", HIDDEN)
def test_named(effect):
    values = {f"{effect}.{name}": value for name, value in HIDDEN[effect].items()}
    drag = DRAG if effect == "left_right_drag" else {}
    model = with_effect({**values, **drag}, (effect,), gaits=UNLIKE)
    best = Selection(model, first(model, range(len(model.runs)))).run()
    assert best.effects == (effect,)
    for name, value in values.items():
        assert best.fit.values[name] == pytest.approx(value, rel=0.3)


LOOKALIKES = {
    "dragged_cable": {"force2": 0.01, "distance2": 0.1},
    "stribeck_friction": {"force1": 0.005, "force2": 0.005, "sliding": 0.2, "speed": 0.03},
}


@pytest.mark.parametrize("effect", LOOKALIKES)
def test_what_the_best_effect_imitates_is_found(effect):
    values = {f"{effect}.{name}": value for name, value in LOOKALIKES[effect].items()}
    model = with_effect(values, (effect,), gaits=UNLIKE)
    best = Selection(model, first(model, range(len(model.runs)))).run()
    assert best.effects == (effect,)
    for name, value in values.items():
        assert best.fit.values[name] == pytest.approx(value, rel=0.3)


def test_an_effect_is_compared_with_what_looks_like_it():
    values = {
        f"coulomb_friction.{name}": force for name, force in HIDDEN["coulomb_friction"].items()
    }
    model = with_effect(values, ("coulomb_friction",), gaits=UNLIKE)
    search = Selection(model, first(model, range(len(model.runs))))
    best = search.run()
    assert {one.effects for one in search.lookalikes} == {(name,) for name in LOOKALIKES}
    assert not set(search.lookalikes) & set(search.tried.values())
    cables = [one for one in search.lookalikes if one.effects == ("dragged_cable",)]
    assert all(best.predicts_better(one) for one in cables)


def test_a_lookalike_is_tried_in_the_place_of_two_effects():
    model = with_effect({}, (), gaits=UNLIKE[:2])
    base = first(model, range(len(model.runs)))
    search = Selection(model, base)
    pair = (Choice("coulomb_friction"), Choice("quadratic_drag"))
    search.best = search.fitted(pair, [{}], base)
    alone = {(name,) for name in LOOKALIKES}
    beside = {(name, "quadratic_drag") for name in LOOKALIKES}
    assert {tuple(sorted(one.effects)) for one in search._lookalikes()} == alone | {
        tuple(sorted(one)) for one in beside
    }


def test_a_search_with_less_noise_begins_anew():
    model = with_effect({}, ())
    search = Selection(model, first(model, range(len(model.runs))))
    again = search.again([ChannelNoise(0.5)] * len(model.channels))
    assert again.base.fit.problem.model.runs[0].sigma == pytest.approx(model.runs[0].sigma / 2)
    assert again.base.fit.excess > search.base.fit.excess + 1


def test_slip_is_found_beside_an_effect_that_alone_explains_little():
    pair = {f"com_offset.d{i}": 0.03 for i in (1, 2)}
    pair |= {"lateral_slip.creep_compliance": 0.03, "lateral_slip.mu": 0.02}
    model = with_effect(pair, ("com_offset", "lateral_slip"), gaits=UNLIKE)
    search = Selection(model, first(model, range(len(model.runs))))
    assert set(search.run().effects) == {"com_offset", "lateral_slip"}


def test_the_search_goes_on_where_recordings_disagree_on_the_values():
    """Either effect alone leaves next to nothing."""
    pair = {"marker_offset.dx": 0.005, "floor_tilt.tilt_x": 2e-4}
    model = with_effect(pair, ("marker_offset", "floor_tilt"), gaits=UNLIKE)
    search = Selection(model, first(model, range(len(model.runs))))
    assert set(search.run().effects) == {"marker_offset", "floor_tilt"}
    alone = search.tried[Choice("floor_tilt"),]
    assert search.insignificant(alone)
    assert not search.complete(alone)


def test_nothing_is_named_where_nothing_is_missing():
    model = with_effect({}, (), gaits=UNLIKE)
    assert Selection(model, first(model, range(len(model.runs)))).run().effects == ()


@pytest.mark.parametrize("name", ["m1", "m2"])
def test_a_wrong_value_is_no_missing_effect(name):
    """What is believed of it bends others, in each recording differently."""
    believed = with_effect({}, ()).nominal[name]
    model = with_effect({name: 0.8 * believed}, (), gaits=UNLIKE)
    base = first(model, range(len(model.runs)))
    assert constancy(base.fit, base.excess).probability < 0.01
    assert Selection(model, base).complete(base)


@pytest.mark.parametrize(("J", "wrong_ones"), [(4e-6, 1), (1.5e-5, 4)])
def test_an_effect_is_likelier_than_values_that_disagree_or_many_wrong_ones(J, wrong_ones):
    """Heavy wheels move the robot as other masses, inertias and lengths would."""
    model = with_effect({"wheel_inertia.J": J}, ("wheel_inertia",), gaits=UNLIKE)
    base = first(model, range(len(model.runs)))
    search = Selection(model, base)
    assert search.insignificant(base)
    assert len(wrong(released(base.fit))) == wrong_ones
    assert search.run().effects == ("wheel_inertia",)
