"""Each case comes out as it would by hand: right, or wrong in a way that has its own words."""

import pytest

from tests.rr_lab_trial.made_up import case, said, single, truth

DRAG, SLIP, TILT = "quadratic_drag", "lateral_slip", "floor_tilt"
PAIR = truth("pair", DRAG, SLIP)
ODD = truth("outside", "tether")
WRONG = truth("parameters", "m1", "kappa2")
NULL = truth("null")

TABLE = [
    (NULL, said("consistent"), "right"),
    (NULL, said("parameters", "m1"), "false claim"),
    (NULL, said("missing_physics", DRAG), "false claim"),
    (NULL, said("unexplained"), "false claim"),
    (NULL, None, "no answer"),
    (WRONG, said("parameters", "I2"), "right"),
    (WRONG, said("consistent"), "said consistent"),
    (truth("single", DRAG), said("missing_physics", DRAG), "right"),
    (truth("single", DRAG), said("missing_physics", SLIP), "wrong name"),
    (truth("single", DRAG), said("missing_physics", SLIP, groups=[(SLIP, DRAG)]), "right"),
    (truth("single", DRAG), said("missing_physics", SLIP, groups=[(SLIP, TILT)]), "wrong name"),
    (truth("single", DRAG), said("missing_physics", DRAG, SLIP), "right, and more"),
    (truth("single", DRAG), said("unexplained", DRAG), "said unexplained"),
    (truth("single", DRAG, same_as={DRAG: (SLIP,)}), said("missing_physics", SLIP), "right"),
    (truth("single", DRAG, same_as={DRAG: (TILT,)}), said("missing_physics", SLIP), "wrong name"),
    (truth("single", DRAG), said("consistent"), "said consistent"),
    (truth("single", DRAG), None, "no answer"),
    (PAIR, said("missing_physics", SLIP, DRAG), "right"),
    (PAIR, said("missing_physics", SLIP), "one of two"),
    (PAIR, said("missing_physics", SLIP, TILT), "one of two, and a wrong one"),
    (PAIR, said("missing_physics", TILT), "wrong name"),
    (PAIR, said("missing_physics", SLIP, DRAG, TILT), "right, and more"),
    (ODD, said("unexplained"), "right"),
    (ODD, said("unexplained", DRAG, sure=0.5), "right"),
    (ODD, said("unexplained", DRAG, sure=0.95), "named with confidence"),
    (ODD, said("missing_physics", DRAG, sure=0.95), "named with confidence"),
    (ODD, said("missing_physics", DRAG, sure=0.5), "said missing_physics"),
    (ODD, said("consistent"), "said consistent"),
]


@pytest.mark.parametrize(("hidden", "claim", "outcome"), TABLE)
def test_outcome(hidden, claim, outcome):
    one = case(hidden, claim)
    assert one.outcome == outcome
    assert one.missed == (outcome != "right")


@pytest.mark.parametrize(
    ("claim", "missed"),
    [
        (said("consistent"), False),
        (said("parameters", "kappa1"), False),
        (said("missing_physics", DRAG), False),
        (said("missing_physics", SLIP), True),
        (None, True),
    ],
)
def test_of_what_is_invisible_only_a_wrong_name_is_a_miss(claim, missed):
    one = single(DRAG, claim, remains=0.09)
    assert not one.scored
    assert one.missed == missed


def test_the_floor_itself_is_visible():
    assert single(DRAG, None, remains=0.1).scored


def test_a_group_makes_one_name_stand_for_one_effect_only_if_it_holds_both():
    one = case(PAIR, said("missing_physics", TILT, SLIP, groups=[(TILT, DRAG)]))
    assert one.outcome == "right"
    assert one.found == (DRAG, SLIP)
    assert one.extra == ()


@pytest.mark.parametrize(
    ("size", "strength"),
    [(2.1, "faint"), (4.9, "faint"), (5.1, "medium"), (16, "strong"), (60, "strong")],
)
def test_strength_goes_by_the_size(size, strength):
    assert truth("single", DRAG, size=size).strength == strength
