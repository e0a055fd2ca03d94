"""What a case is depends on the seed, its number and the kinds asked for, and on nothing else."""

import hashlib
from collections import Counter
from dataclasses import replace

import pytest

from rr_lab.case import ENGINES
from rr_lab.disturbances import DISTURBANCES
from rr_lab.effects import OUTSIDE_NAMES, REALISATIONS
from rr_lab.random_case import SINGLES
from rr_lab.trial.draws import BLOCK, KINDS, STRENGTHS, Basis, case_seed, read_kinds
from rr_opt.outcome import InputError

SEED = "1df794d0"
DRAWS = [Basis(SEED).draw(number) for number in range(1, 201)]
REALISED = {each.key for name in SINGLES for each in REALISATIONS[name]}


def kind(draw):
    return "disturbed" if draw.disturbance else draw.kind.partition(":")[0]


def named(draw):
    return draw.kind.partition(":")[2]


def test_the_seed_of_a_case_is_a_hash_that_anybody_can_compute():
    digest = hashlib.sha256(b"1df794d0/17").hexdigest()
    assert case_seed(SEED, 17) == int(digest[:12], 16)


def test_seeds_differ():
    assert len({draw.seed for draw in DRAWS}) == len(DRAWS)
    assert {case_seed("1df794d1", n) for n in range(200)}.isdisjoint({one.seed for one in DRAWS})


def test_a_case_alone_is_the_same_as_among_others():
    assert Basis(SEED).draw(57) == DRAWS[56]


def test_every_block_has_its_kinds_in_another_order():
    blocks = [[kind(draw) for draw in DRAWS[at : at + 40]] for at in range(0, 200, 40)]
    assert all(Counter(block) == {name: 2 * n for name, n in BLOCK.items()} for block in blocks)
    assert len({tuple(block) for block in blocks}) == 5


def test_another_seed_has_another_order():
    other = [Basis("1df794d1").draw(number) for number in range(1, 41)]
    assert [kind(draw) for draw in other] != [kind(draw) for draw in DRAWS[:40]]


@pytest.mark.parametrize("seed", ["5eed", "1df794d0", "0", "abc"])
@pytest.mark.parametrize("kinds", [(name,) for name in BLOCK] + [KINDS], ids=str)
def test_every_pair_of_cases_is_of_one_kind_with_both_engines(seed, kinds):
    """So that half of any even number of cases is driven by each."""
    for number in range(1, 61, 2):
        one, other = (Basis(seed, kinds).draw(n) for n in (number, number + 1))
        assert {one.engine, other.engine} == set(ENGINES)
        assert kind(one) == kind(other)


@pytest.mark.parametrize(
    ("name", "items"),
    [("single", REALISED), ("outside", set(OUTSIDE_NAMES)), ("disturbed", set(DISTURBANCES))],
)
def test_everything_that_a_kind_stands_for_takes_turns_with_both_engines(name, items):
    count = 2 * (len(items) if name != "disturbed" else 2 * len(items))
    draws = [Basis(SEED, (name,)).draw(number) for number in range(1, count + 1)]
    items_of = [(draw.disturbance, draw.kind if draw.disturbance else named(draw), draw.engine)
                for draw in draws]  # fmt: skip
    assert len(set(items_of)) == count
    assert {item[0] or item[1] for item in items_of} == items


def test_there_are_eight_effects_outside_the_catalogue():
    names = ("stribeck_friction", "dragged_cable", "tether", "shifting_load", "drifting_friction")
    assert set(names) <= set(OUTSIDE_NAMES)
    assert len(OUTSIDE_NAMES) >= 8


def test_strengths_take_turns():
    singles = [draw for draw in DRAWS if kind(draw) == "single"]
    for low, high in STRENGTHS.values():
        count = sum(low <= draw.target < high for draw in singles)
        assert abs(count - len(singles) / 3) < 1


def test_half_of_each_kind_has_nominal_values_that_are_off():
    for name in ("null", "single", "pair", "outside"):
        off = [draw.spread for draw in DRAWS if kind(draw) == name]
        assert set(off) == {0.0, 1.0}
        assert abs(sum(off) - len(off) / 2) <= 1


def test_halves_do_not_go_together():
    """Engines and nominal values that are off are in all four combinations."""
    nulls = [draw for draw in DRAWS if kind(draw) == "null"]
    assert len({(draw.engine, draw.spread) for draw in nulls}) == 4


def test_a_kind_may_name_what_is_hidden():
    kinds = read_kinds("pair:servo_lag/second_order+clock_offset, single:servo_backlash")
    draws = [Basis(SEED, kinds).draw(number) for number in range(1, 25)]
    keys = {f"single:{each.key}" for each in REALISATIONS["servo_backlash"]}
    assert {draw.kind for draw in draws} == {"pair:servo_lag/second_order+clock_offset", *keys}
    (only,) = read_kinds("single:servo_backlash/frictional")
    assert Basis(SEED, (only,)).draw(1).kind == only


def test_what_is_hidden_does_not_depend_on_the_engine():
    for number, draw in enumerate(DRAWS[:40], 1):
        alone = Basis(SEED, engines=("planar",)).draw(number)
        assert alone == replace(draw, engine="planar")


def test_only_the_kinds_asked_for():
    draws = [Basis(SEED, ("null", "pair")).draw(number) for number in range(1, 21)]
    assert Counter(map(kind, draws)) == {"null": 12, "pair": 8}


def test_kinds_are_read_in_one_order():
    assert read_kinds(" pair, null ") == ("null", "pair")


@pytest.mark.parametrize("text", ["", "null, strange", ","])
def test_wrong_kinds(text):
    with pytest.raises(InputError, match=r"--kinds: Read .* Expected .*null.* Correct it"):
        read_kinds(text)


@pytest.mark.parametrize(
    "text",
    [
        "single:gremlins",
        "single:tether",
        "outside:servo_lag",
        "pair:servo_lag",
        "null:x",
        "disturbed:x",
    ],
)
def test_wrong_effects(text):
    with pytest.raises(InputError, match=r"laboratory|does not match"):
        read_kinds(text)
