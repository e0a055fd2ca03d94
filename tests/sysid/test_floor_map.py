"""Where a patch of other floor is looked for: on a map of what the drag of each wheel would do."""

import math
from dataclasses import replace

import numpy as np
import pytest

from rr_opt.machines.racer.floor_map import ROUND, STRAIGHT, STRIP, floor_map, likely, patches
from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.model.gait import SineGait
from rr_opt.sysid import candidates, estimation
from rr_opt.sysid.model import Choice
from rr_opt.sysid.selection import turned
from tests.sysid.made_up import base_of, experiment, predicted, with_effect

ROUND_ONE = {
    "floor_patch.multiplier": 8.0,
    "floor_patch.x": 0.25,
    "floor_patch.y": 0.1,
    "floor_patch.radius": 0.15,
}
EDGE = {
    "floor_patch.multiplier": 3.0,
    "floor_patch.normal": 2.2,
    "floor_patch.edge_x": 0.1,
    "floor_patch.edge_y": 0.05,
}


def fitted(values, effects=("floor_patch",), **about):
    model = with_effect(values, effects, **about)
    return model, base_of(model).fit


@pytest.fixture(scope="module")
def on_plain_floor():
    return fitted({}, ())


@pytest.fixture(scope="module")
def on_a_round_one():
    return fitted(ROUND_ONE)


def test_a_patch_all_over_the_floor_is_what_the_wheels_own_friction_is():
    model = with_effect({"kappa1": 8e-6, "kappa2": 8e-6}, ())
    values, runs = {q.name: q.value for q in model.parameters}, range(len(model.runs))
    gains = []
    for quantities in ((), model.parameters):
        problem, states = estimation.initial(model, (), quantities, values, runs)
        floor = floor_map(model, estimation.solve(problem, values, states, 0))
        gains.append(floor.gains(floor.at(lambda x, y: np.ones_like(x))[None])[0][0])
    assert gains[0] > 50
    assert gains[1] < 0.1 * gains[0]


def test_a_patch_multiplies_dry_friction_too():
    own = {"coulomb_friction.force1": 2e-3, "coulomb_friction.force2": 2e-3}
    patch = {"floor_patch.multiplier": 1.2, "floor_patch.radius": 50.0}
    model = with_effect(own | patch, ("coulomb_friction", "floor_patch"))
    values = {q.name: q.value for q in model.parameters} | own
    effects, runs = ("coulomb_friction",), range(len(model.runs))
    problem, states = estimation.initial(model, effects, (), values, runs)
    floor = floor_map(model, estimation.solve(problem, values, states, 0))
    _, (multiplier,) = floor.gains(np.ones((1, floor.slope.size)))
    assert multiplier == pytest.approx(1.2, abs=0.02)


def test_no_patch_gains_more_than_luck_where_there_is_none(on_plain_floor):
    floor = floor_map(*on_plain_floor)
    assert all(gain < 40 for shape in (ROUND, STRAIGHT, STRIP) for gain, _ in likely(floor, shape))


def test_a_round_patch_is_found_without_a_fit_of_it(on_a_round_one):
    best = next(values for form, values in patches(*on_a_round_one) if form == 0)
    floor = floor_map(*on_a_round_one)

    def shares(values):
        of = [values[f"floor_patch.{name}"] for name in ("x", "y", "radius")]
        return floor.at(ROUND.depth(of))

    # The wheels cross only a part of it, so that other circles are the same patch to them.
    found, true = shares(best), shares(ROUND_ONE)
    assert found @ true > 0.98 * np.linalg.norm(found) * np.linalg.norm(true)
    # What all the floor has is bent towards it, so that the patch seems weaker.
    assert 2.5 < best["floor_patch.multiplier"] < 10


STRIP_ACROSS = {**EDGE, "floor_patch.normal": 0.4, "floor_patch.width": 0.1}
BY_ITS_OTHER_EDGE = {
    **STRIP_ACROSS,
    "floor_patch.normal": 0.4 - math.pi,
    "floor_patch.edge_x": 0.1 + 0.1 * math.cos(0.4),
    "floor_patch.edge_y": 0.05 + 0.1 * math.sin(0.4),
}


@pytest.mark.parametrize(
    ("form", "patch", "turn", "away", "rel"),
    [(1, EDGE, 0.1, 0.02, 0.25), (2, STRIP_ACROSS, 0.2, 0.03, 0.5)],
    ids=["edge", "strip"],
)
def test_a_straight_one_is_too(form, patch, turn, away, rel):
    best = next(values for found, values in patches(*fitted(patch)) if found == form)
    normal = patch["floor_patch.normal"]
    off = [best[f"floor_patch.edge_{k}"] - EDGE[f"floor_patch.edge_{k}"] for k in "xy"]
    assert best["floor_patch.normal"] == pytest.approx(normal, abs=turn)
    assert off @ np.array([math.cos(normal), math.sin(normal)]) == pytest.approx(0.0, abs=away)
    assert best["floor_patch.multiplier"] == pytest.approx(3.0, rel=rel)
    if form == 2:
        assert best["floor_patch.width"] == pytest.approx(0.1, abs=0.03)


def test_those_proposed_are_unlike(on_a_round_one):
    floor = floor_map(*on_a_round_one)
    for shape, names in ((ROUND, ("x", "y", "radius")), (STRAIGHT, ("normal",))):
        one, other = (values for _, values in likely(floor, shape))
        assert any(one[name] != pytest.approx(other[name], rel=0.02) for name in names)


def test_nothing_breaks_where_the_robot_hardly_moves():
    model, fit = fitted(
        {"servo_offset.offset": 0.1},
        ("servo_offset",),
        gaits=((SineGait(0.05, 1.0), "rest"),),
        seconds=4.0,
    )
    assert fit.excess > 1
    assert all(np.isfinite(list(values.values())).all() for _, values in patches(model, fit))


def test_the_direction_of_an_edge_is_told_within_half_a_turn():
    model = with_effect({}, ())
    values = {"kappa1": 4e-6, "kappa2": 4e-6, **EDGE}
    assert model.equivalent(values) is None
    wrapped = model.equivalent({**values, "floor_patch.normal": 2.2 - 2 * math.pi})
    assert wrapped == pytest.approx(values)


def test_of_the_edges_of_a_strip_one_is_told():
    model = with_effect({}, ())
    assert model.equivalent(STRIP_ACROSS) is None
    assert model.equivalent(BY_ITS_OTHER_EDGE) == pytest.approx(STRIP_ACROSS)


def test_the_other_edge_of_a_strip_is_the_same_fit():
    model = with_effect(STRIP_ACROSS, ("floor_patch",))
    base = base_of(model).fit
    found = candidates.fitted(model, (Choice("floor_patch", 2),), base, [BY_ITS_OTHER_EDGE])
    again = turned(model, found)
    one, other = (fit.values["floor_patch.normal"] for fit in (found.fit, again.fit))
    assert abs(one) > math.pi / 2
    assert other == pytest.approx(one + math.pi, abs=0.01)
    ended = estimation.solve(found.fit.problem, found.fit.values, found.fit.states)
    assert again.fit.deviance == pytest.approx(ended.deviance, abs=1.0)


def test_two_halves_of_a_floor_are_told_as_what_was_believed_and_a_patch():
    model = with_effect({}, ())
    believed = {"kappa1": 4e-6, "kappa2": 4e-6, **EDGE}
    seen = {
        **{"kappa1": 12e-6, "kappa2": 12e-6, **EDGE},
        "floor_patch.multiplier": 1 / 3,
        "floor_patch.normal": 2.2 - math.pi,
    }
    assert model.equivalent(seen) == pytest.approx(believed)


@pytest.mark.parametrize("effect", ["coulomb_friction", "stribeck_friction"])
def test_with_all_that_a_patch_multiplies(effect):
    model, effects = with_effect({}, ()), (effect, "floor_patch")
    drag = {"kappa1": 4e-6, "kappa2": 4e-6, f"{effect}.force1": 2e-3, f"{effect}.force2": 1e-3}
    believed = {**drag, **EDGE}
    factor, turn = EDGE["floor_patch.multiplier"], EDGE["floor_patch.normal"] - math.pi
    seen = {name: factor * value for name, value in drag.items()}
    seen = {**EDGE, **seen, "floor_patch.multiplier": 1 / factor, "floor_patch.normal": turn}
    assert model.equivalent(seen) == pytest.approx(believed)
    start = np.array([0.0, 0.0, 0.3, 0.05, 0.0, 0.0])
    one, other = (predicted(model, 1, values, effects, start) for values in (seen, believed))
    assert one == pytest.approx(other, abs=1e-5)
    del seen["kappa2"]
    assert model.equivalent(seen) is None


def test_friction_of_zero_says_nothing_about_which_half_is_the_usual_one():
    given = experiment()
    smooth = replace(given.robot, platform2=replace(given.robot.platform2, kappa=0.0))
    model = RollerRacer(replace(given, robot=smooth))
    seen = {
        **{"kappa1": 12e-6, "kappa2": 0.0, **EDGE},
        "floor_patch.multiplier": 1 / 3,
        "floor_patch.normal": 2.2 - math.pi,
    }
    assert model.equivalent(seen) == pytest.approx({"kappa1": 4e-6, "kappa2": 0.0, **EDGE})
    assert model.equivalent({**seen, "kappa1": 0.0, "kappa2": 12e-6}) is None


def test_what_fits_worse_is_not_told_instead():
    model = with_effect(EDGE, ("floor_patch",))
    found = candidates.fitted(model, (Choice("floor_patch", 1),), base_of(model).fit, [EDGE])
    model.equivalent = lambda values: {**values, "floor_patch.edge_x": 5.0}
    assert turned(model, found) is found


def test_a_circle_is_no_larger_than_twice_the_room_there_was():
    model = with_effect({}, ())
    places = np.vstack([run.values[:, :2] for run in model.runs])
    room = (np.nanmax(places, axis=0) - np.nanmin(places, axis=0)).max()
    (radius,) = (
        q
        for q in model.catalogue["floor_patch"].forms[0].quantities
        if q.name == "floor_patch.radius"
    )
    assert radius.high == pytest.approx(max(2 * room, 0.5))
