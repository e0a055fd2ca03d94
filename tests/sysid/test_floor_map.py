"""Where a patch of other floor is looked for: on a map of what the drag of each wheel would do."""

import math
from dataclasses import replace

import numpy as np
import pytest

from rr_opt.machines.racer import proposals as racer_proposals
from rr_opt.machines.racer.floor_map import ROUND, STRAIGHT, floor_map, likely
from rr_opt.machines.racer.proposals import of_patch
from rr_opt.model.gait import SineGait
from rr_opt.sysid.candidate import nominal, parameters, windows
from rr_opt.sysid.least_squares import doubt
from tests.sysid.made_up import base_of, with_effect

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
    return model, parameters(model, nominal(model, windows(model, range(len(model.runs)))))


@pytest.fixture(scope="module")
def on_plain_floor():
    return fitted({}, ())


def test_a_patch_all_over_the_floor_is_what_the_wheels_own_friction_is():
    model, fit = fitted({"kappa1": 8e-6, "kappa2": 8e-6}, ())
    believed = nominal(model, windows(model, range(len(model.runs))))
    free = replace(
        believed, quantities=fit.quantities, values={q.name: q.value for q in fit.quantities}
    )
    gains = []
    for one in (believed, free):
        floor = floor_map(model, one)
        gains.append(floor.gains(floor.at(lambda x, y: np.ones_like(x))[None])[0][0])
    assert gains[0] > 1000
    assert gains[1] < 0.1 * gains[0]


def test_no_patch_gains_more_than_luck_where_there_is_none(on_plain_floor):
    assert all(one.gain < 40 for found in of_patch(*on_plain_floor) for one in found)


def test_a_round_patch_is_found_without_a_fit():
    best = of_patch(*fitted(ROUND_ONE))[0][0].values
    for name in ("x", "y", "radius"):
        assert best[f"floor_patch.{name}"] == pytest.approx(
            ROUND_ONE[f"floor_patch.{name}"], abs=0.05
        )
    assert best["floor_patch.multiplier"] == pytest.approx(8.0, rel=0.25)


def test_a_straight_one_is_too():
    best = of_patch(*fitted(EDGE))[1][0].values
    into = np.array([math.cos(2.2), math.sin(2.2)])
    off = [best[f"floor_patch.edge_{k}"] - EDGE[f"floor_patch.edge_{k}"] for k in "xy"]
    assert best["floor_patch.normal"] == pytest.approx(2.2, abs=0.1)
    assert off @ into == pytest.approx(0.0, abs=0.02)
    assert best["floor_patch.multiplier"] == pytest.approx(3.0, rel=0.25)


def test_those_proposed_are_unlike():
    model, fit = fitted(ROUND_ONE)
    floor = floor_map(model, fit)
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
    assert fit.cost > 2 * fit.count
    for found in of_patch(model, fit):
        assert all(np.isfinite(list(one.values.values())).all() for one in found)


def test_the_direction_of_an_edge_is_told_within_half_a_turn():
    model = with_effect({}, ())
    values = {"kappa1": 4e-6, "kappa2": 4e-6, **EDGE}
    assert model.twin(values) is None
    turned = model.twin({**values, "floor_patch.normal": 2.2 - 2 * math.pi})
    assert turned == pytest.approx(values)


def test_two_halves_of_a_floor_are_told_as_what_was_believed_and_a_patch():
    model = with_effect({}, ())
    believed = {"kappa1": 4e-6, "kappa2": 4e-6, **EDGE}
    seen = {
        **{"kappa1": 12e-6, "kappa2": 12e-6, **EDGE},
        "floor_patch.multiplier": 1 / 3,
        "floor_patch.normal": 2.2 - math.pi,
    }
    assert model.twin(seen) == pytest.approx(believed)


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


def test_where_few_runs_are_bent_by_a_patch_the_robot_is_as_believed(monkeypatch):
    model, fit = fitted({}, ())
    pieces = windows(model, range(len(model.runs)), 1e9)
    whole = nominal(model, pieces)
    bent = {**whole.values, **{q.name: q.value * 1.1 for q in fit.quantities}}
    seen = []
    monkeypatch.setattr(
        racer_proposals, "floor_map", lambda model, one: seen.append(one) or floor_map(model, one)
    )
    of_patch(model, replace(whole, quantities=fit.quantities, values=bent))
    assert [seen[0].values[q.name] for q in fit.quantities] == [q.value for q in fit.quantities]
    close = {**whole.values, **fit.values}
    of_patch(model, replace(whole, quantities=fit.quantities, values=close))
    assert seen[1].values == close


def test_a_gain_is_weighed_against_what_parameters_leave(monkeypatch):
    model = with_effect({}, (), seconds=5.0)
    fit = base_of(model).windows
    believed = replace(fit, cost=50 * fit.cost)
    monkeypatch.setattr(racer_proposals, "_unbent", lambda *_: believed)
    proposals = [one for shape in of_patch(model, fit) for one in shape]
    assert proposals
    assert all(one.doubt == doubt(fit.cost, fit.count) for one in proposals)
