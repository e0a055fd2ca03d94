"""What a case is depends on the seed, its number and the kinds asked for, and on nothing else."""

import hashlib
from collections import Counter
from dataclasses import replace

import pytest

from rr_lab.disturbances import DISTURBANCES
from rr_lab.effects import REALISATIONS, effect_named
from rr_lab.engines import ENGINES
from rr_lab.random_case import KINDS, SINGLES
from rr_lab.trial.lots import BLOCK, STRENGTHS, case_seed, draw_lot, read_kinds
from rr_opt.outcome import InputError

SEED = "1df794d0"
HUNDRED = [draw_lot(SEED, number) for number in range(1, 101)]


def kind(lot):
    return lot.kind.partition(":")[0]


def test_the_seed_of_a_case_is_a_hash_that_anybody_can_compute():
    digest = hashlib.sha256(b"1df794d0/17").hexdigest()
    assert case_seed(SEED, 17) == int(digest[:12], 16)


def test_seeds_differ():
    assert len({lot.seed for lot in HUNDRED}) == 100
    assert {case_seed("1df794d1", n) for n in range(100)}.isdisjoint({lot.seed for lot in HUNDRED})


def test_a_case_alone_is_the_same_as_among_others():
    assert draw_lot(SEED, 57) == HUNDRED[56]


def test_every_block_has_its_kinds_in_another_order():
    blocks = [[kind(lot) for lot in HUNDRED[at : at + 20]] for at in range(0, 100, 20)]
    usual = {name: count for name, count in BLOCK.items() if name != "disturbed"}
    assert all(Counter(block) == usual for block in blocks)
    assert len({tuple(block) for block in blocks}) == 5


def test_another_seed_has_another_order():
    other = [draw_lot("1df794d1", number) for number in range(1, 21)]
    assert [kind(lot) for lot in other] != [kind(lot) for lot in HUNDRED[:20]]


def test_effects_and_strengths_take_turns():
    singles = [lot for lot in HUNDRED if kind(lot) == "single"]
    counted = Counter(effect_named(lot.kind.partition(":")[2]).name for lot in singles)
    assert set(counted) == set(SINGLES)
    assert max(counted.values()) - min(counted.values()) <= 1
    for low, high in STRENGTHS.values():
        assert sum(low <= lot.target < high for lot in singles) == 15


def test_half_of_each_kind_has_nominal_values_that_are_off():
    for name in ("null", "single", "pair", "outside"):
        off = [lot.spread for lot in HUNDRED if kind(lot) == name]
        assert set(off) == {0.0, 1.0}
        assert abs(sum(off) - len(off) / 2) <= 1


def test_half_of_each_kind_is_driven_by_each_engine():
    for name in KINDS:
        engines = [lot.engine for lot in HUNDRED if kind(lot) == name]
        assert set(engines) == set(ENGINES)
        assert abs(engines.count("planar") - len(engines) / 2) <= 1


@pytest.mark.parametrize("seed", ["5eed", "1df794d0", "0", "abc"])
def test_of_two_cases_of_a_kind_each_engine_drives_one(seed):
    for name in BLOCK:
        lots = [draw_lot(seed, number, (name,)) for number in (1, 2)]
        assert {lot.engine for lot in lots} == set(ENGINES)


def test_realisations_take_turns():
    name = "servo_backlash"
    singles = [draw_lot(SEED, number, ("single",)) for number in range(1, 14 * 6 + 1)]
    keys = [lot.kind.partition(":")[2] for lot in singles]
    counted = Counter(key for key in keys if effect_named(key).name == name)
    assert set(counted) == {each.key for each in REALISATIONS[name]}
    assert max(counted.values()) - min(counted.values()) <= 1


def test_disturbances_take_turns_with_an_effect_and_without():
    lots = [draw_lot(SEED, number, ("disturbed",)) for number in range(1, 41)]
    counted = Counter((lot.disturbance, kind(lot)) for lot in lots)
    assert {name for name, _ in counted} == set(DISTURBANCES)
    assert set(counted.values()) == {2}
    assert len({(lot.engine, kind(lot)) for lot in lots}) == 4
    assert {lot.disturbance for lot in HUNDRED} == {""}


def test_a_kind_may_name_what_is_hidden():
    kinds = read_kinds("pair:servo_lag/second_order+clock_offset, single:servo_backlash")
    lots = [draw_lot(SEED, number, kinds) for number in range(1, 12)]
    assert {lot.kind for lot in lots} == set(kinds)


def test_what_is_hidden_does_not_depend_on_the_engine():
    for number, lot in enumerate(HUNDRED[:20], 1):
        alone = draw_lot(SEED, number, engines=("planar",))
        assert alone == replace(lot, engine="planar")


def test_halves_do_not_go_together():
    """Engines and nominal values that are off are in all four combinations."""
    nulls = [lot for lot in HUNDRED if kind(lot) == "null"]
    assert len({(lot.engine, lot.spread) for lot in nulls}) == 4


def test_only_the_kinds_asked_for():
    lots = [draw_lot(SEED, number, ("null", "pair")) for number in range(1, 15)]
    assert Counter(map(kind, lots)) == {"null": 10, "pair": 4}


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
    with pytest.raises(InputError, match=r"laboratory|does not go with"):
        read_kinds(text)
