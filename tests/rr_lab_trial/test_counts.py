"""The counts of a tiny trial are those that a hand makes of it."""

import pytest

from rr_lab.trial.statistics import COUNTS, Rate, breakdown
from tests.rr_lab_trial.made_up import case, said, single, truth

DRAG, SLIP, TILT = "quadratic_drag", "lateral_slip", "floor_tilt"
RIGHT = said("missing_physics", DRAG)
NULL, ODD, PAIR = truth("null"), truth("outside", "tether"), truth("pair", DRAG, SLIP)
WRONG = truth("parameters", "m1", "a2")

TRIAL = [
    case(NULL, said("consistent")),
    case(truth("null", spread=1.0), said("parameters", "m1")),
    case(NULL, None),
    single(DRAG, RIGHT, size=3),
    single(DRAG, said("missing_physics", SLIP, groups=[(SLIP, DRAG)]), size=8),
    single(DRAG, said("missing_physics", DRAG, SLIP), size=8),
    single(DRAG, said("consistent"), size=20),
    single(DRAG, None, size=20),
    single(TILT, said("parameters", "m1"), remains=0.05),
    single(TILT, RIGHT, remains=0.05),
    case(PAIR, said("missing_physics", SLIP, DRAG)),
    case(PAIR, said("unexplained", SLIP)),
    case(PAIR, said("missing_physics", TILT, suspects=("tether",))),
    case(truth("pair", DRAG, SLIP, remains=0.0), None),
    case(WRONG, said("parameters", "a2", "m1")),
    case(WRONG, said("parameters", "m1")),
    case(WRONG, said("missing_physics", DRAG)),
    case(ODD, said("unexplained", suspects=("tether",))),
    case(ODD, said("unexplained", DRAG, sure=0.99)),
    case(ODD, said("missing_physics", DRAG, sure=0.6)),
    case(truth("disturbed", disturbance="dropouts"), said("consistent")),
    case(truth("disturbed", disturbance="dropouts"), said("missing_physics", DRAG)),
    case(truth("disturbed", DRAG, disturbance="dropouts"), RIGHT),
    case(truth("disturbed", DRAG, disturbance="outliers"), said("missing_physics", TILT)),
    case(truth("disturbed", DRAG, disturbance="outliers", remains=0.05), said("parameters")),
]

BY_HAND = {
    "false_claims": (1, 3),
    "false_claims_exact": (0, 2),
    "false_claims_off": (1, 1),
    "single": (2, 5),
    "single_faint": (1, 1),
    "single_medium": (1, 2),
    "single_strong": (0, 2),
    "single_exact": (1, 5),
    "single_invisible": (1, 2),
    "pair_both": (1, 3),
    "pair_one": (2, 3),
    "pair_wrong": (1, 3),
    "parameters": (2, 3),
    "parameters_named": (1, 3),
    "outside": (1, 3),
    "outside_named": (1, 3),
    "suspected": (1, 2),
    "disturbed_false_claims": (1, 2),
    "disturbed_single": (1, 2),
    "no_answer": (3, 25),
}


def test_breakdown():
    plain = truth("single", SLIP, realised={SLIP: "creep"})
    found = breakdown([*TRIAL, case(plain, said("missing_physics", SLIP))])
    assert {
        what: {key: (r.count, r.total) for key, r in rows.items()} for what, rows in found.items()
    } == {
        "effect": {DRAG: (2, 5), SLIP: (1, 1), "tether": (1, 3)},
        "realisation": {f"{SLIP}/creep": (1, 1)},
        "disturbance": {
            "dropouts, null": (1, 2),
            "dropouts, effect": (1, 1),
            "outliers, effect": (0, 1),
        },
    }


def test_every_count():
    assert {
        one.name: (rate.count, rate.total)
        for one, rate in ((one, one.rate(TRIAL)) for one in COUNTS)
    } == BY_HAND


def test_each_is_defined_in_a_sentence():
    for one in COUNTS:
        assert one.definition.startswith("Of ")
        assert one.definition.endswith(".")


@pytest.mark.parametrize(("name", "size"), [("faint", 1e-6), ("medium", 10.0), ("strong", 70.0)])
def test_a_strength_is_defined_by_the_sizes_it_stands_for(name, size):
    words = {"faint": "less than 5", "medium": "5 to 15", "strong": "at least 15"}
    assert truth("single", DRAG, size=size).strength == name
    (one,) = (one for one in COUNTS if one.name == f"single_{name}")
    assert f"an effect of {words[name]} sigma" in one.definition


@pytest.mark.parametrize(("count", "total"), [(0, 20), (3, 20), (20, 20), (1, 7)])
def test_the_interval_is_clopper_and_pearson(count, total):
    """Its ends are the chances at which so many, or so few, come once in forty times."""
    from math import comb

    def at_least(chance):
        return sum(comb(total, k) * chance**k * (1 - chance) ** (total - k)
                   for k in range(count, total + 1))  # fmt: skip

    low, high = Rate(count, total).interval
    if count:
        assert at_least(low) == pytest.approx(0.025)
    else:
        assert low == 0
    if count < total:
        above = comb(total, count) * high**count * (1 - high) ** (total - count)
        assert 1 - at_least(high) + above == pytest.approx(0.025)
    else:
        assert high == 1


def test_no_case_is_no_rate():
    assert Rate(0, 0).fraction is None
    assert Rate(0, 0).interval == (0, 1)
