"""Coverage, held-out error, p-values and the confusion matrix are counted as by hand."""

import numpy as np
import pytest

from rr_lab.trial.statistics import (
    confusion,
    coverage,
    held_out,
    intervals,
    quantiles,
    reliability,
    remainders,
    uniformity,
)
from tests.rr_lab_trial.made_up import case, said, single, truth

DRAG, SLIP, DRY = "quadratic_drag", "lateral_slip", "coulomb_friction"
NULL = truth("null")


def dry(low, high, verdict="missing_physics", name=DRY):
    """Dry friction of 5 mN and 6 mN, said to be between two values each."""
    hidden = truth("single", DRY, values={DRY: {"force1": 5e-3, "force2": 6e-3}})
    ends = {name: {"force1": (low, high), "force2": (low, high)}}
    return case(hidden, said(verdict, name, intervals=ends))


def test_coverage_counts_each_quantity_of_what_was_named():
    cases = [
        dry(4e-3, 5.5e-3),
        dry(4e-3, 7e-3),
        dry(4e-3, 7e-3, verdict="unexplained"),
        dry(4e-3, 7e-3, name=SLIP),
        case(NULL, said("missing_physics", DRY, intervals={DRY: {"force1": (0.0, 1.0)}})),
        case(NULL, None),
    ]
    found = coverage(intervals(cases))
    assert {name: (one.count, one.total) for name, one in found.items()} == {
        "all": (3, 4),
        "coulomb_friction.force1": (2, 2),
        "coulomb_friction.force2": (1, 2),
    }


def test_coverage_of_wrong_values():
    hidden = truth("parameters", "m1", values={"m1": {"m1": 0.5}})
    ends = {"m1": {"m1": (0.45, 0.49)}, "a2": {"a2": (0.0, 1.0)}}
    found = coverage(intervals([case(hidden, said("parameters", "m1", "a2", intervals=ends))]))
    assert {name: (one.count, one.total) for name, one in found.items()} == {
        "all": (0, 1),
        "m1": (0, 1),
    }


def test_held_out_error_by_kind():
    claims = [said("consistent", before=b, refitted=1.5, after=1.0) for b in (1.0, 2.0, 6.0)]
    table = held_out([*(case(NULL, one) for one in claims), case(NULL, None)])
    assert table["null"]["before"]["median"] == 2.0
    assert table["null"]["before"]["largest"] == 6.0
    assert table["null"]["after"]["count"] == 3


def test_remainders_by_kind():
    claims = [said("consistent", remainder="none", share=0.0)]
    claims += [said("unexplained", remainder=size, share=0.4) for size in ("small", "large")]
    cases = [*(case(NULL, one) for one in claims), case(NULL, None)]
    cases.append(single(DRAG, said("consistent")))
    assert remainders(cases) == {"null": {"none": 1, "small": 1, "large": 1, "share": 0.4}}


def test_confidences_are_compared_with_how_often_the_name_is_right():
    cases = [
        single(DRAG, said("missing_physics", DRAG, sure=0.9)),
        single(DRAG, said("missing_physics", SLIP, sure=0.88)),
        # One of both is right, and so is a name that cannot be told from the hidden one.
        single(DRAG, said("missing_physics", DRAG, SLIP, sure=0.6)),
        single(DRAG, said("missing_physics", DRY, sure=0.7, groups=[(DRAG, DRY)])),
        case(NULL, said("parameters", "m1", sure=0.7)),
        case(NULL, said("consistent")),
        case(NULL, None),
    ]
    table = reliability(cases)
    assert {band: (rate.count, rate.total) for band, (_, rate) in table.items()} == {
        "0.5 to 0.7": (2, 4),
        "0.85 to 1": (1, 2),
    }
    assert table["0.5 to 0.7"][0] == pytest.approx(0.65)


def test_quantiles_of_nothing():
    assert quantiles([None])["median"] is None


def test_even_p_values_and_others():
    even = (np.arange(40) + 0.5) / 40
    cases = [case(NULL, said("consistent", p_values={"good": p, "bad": p**4})) for p in even]
    # What is hidden elsewhere has no say in it.
    cases.append(single(DRAG, said("consistent", p_values={"good": 0.0})))
    told = uniformity(cases)
    assert told["good"]["count"] == 40
    assert told["good"]["below_005"] == 2
    assert told["good"]["distance"] == pytest.approx(0.5 / 40)
    assert told["good"]["chance"] > 0.99
    assert told["bad"]["chance"] < 1e-4
    # p^4 < 0.05 where p < 0.473.
    assert told["bad"]["below_005"] == 19


def test_few_p_values_tell_nothing():
    assert uniformity([case(NULL, said("consistent", p_values={"test": 0.5}))] * 7) == {}


def test_confusion():
    found = confusion(
        [
            case(NULL, said("consistent")),
            case(NULL, said("missing_physics", DRAG)),
            single(DRAG, said("missing_physics", DRAG)),
            single(DRAG, said("missing_physics", SLIP, groups=[(SLIP, DRAG)])),
            single(DRAG, said("missing_physics", SLIP)),
            single(DRAG, said("missing_physics", DRAG, SLIP)),
            single(DRAG, said("missing_physics", SLIP), remains=0.0),
            single(DRAG, None),
            case(truth("outside", "tether"), said("unexplained", DRAG)),
            case(truth("parameters", "m1"), said("parameters", "m1")),
            case(truth("pair", DRAG, SLIP), said("missing_physics", DRAG)),
        ]
    )
    assert found.rows == ("nothing", "a wrong value", DRAG, "no known effect")
    assert found.columns == (
        "nothing", "a wrong value", DRAG, SLIP, "no known effect", "several effects", "no answer",
    )  # fmt: skip
    assert found.counts == {
        ("nothing", "nothing"): 1,
        ("nothing", DRAG): 1,
        (DRAG, DRAG): 2,
        (DRAG, SLIP): 1,
        (DRAG, "several effects"): 1,
        (DRAG, "no answer"): 1,
        ("no known effect", "no known effect"): 1,
        ("a wrong value", "a wrong value"): 1,
    }


def test_what_is_hidden_only_on_request_has_a_row():
    found = confusion([single("wheel_inertia", said("missing_physics", DRAG))])
    assert found.rows == ("wheel_inertia",)
    assert found.columns == (DRAG, "wheel_inertia")


@pytest.mark.parametrize(("normal", "held"), [(3.98, True), (-2.30, True), (-2.60, False)])
def test_a_direction_is_the_same_a_turn_on_and_a_point_on_an_edge_is_not_counted(normal, held):
    true = {"floor_patch": {"multiplier": 2.0, "normal": -2.302, "edge_x": 0.2, "edge_y": 1.0}}
    ends = {
        "floor_patch": {
            "multiplier": (1.9, 2.1),
            "normal": (normal - 0.01, normal + 0.01),
            "edge_x": (5.0, 6.0),
            "edge_y": (5.0, 6.0),
        }
    }
    claim = said("missing_physics", "floor_patch", intervals=ends)
    found = intervals([single("floor_patch", claim, values=true)])
    assert {one.quantity: one.covers for one in found} == {
        "floor_patch.multiplier": True,
        "floor_patch.normal": held,
    }
