"""The table of hidden effects and the functions that it names fit together."""

import inspect
import tomllib
from pathlib import Path

import pytest

from rr_lab import effects
from rr_lab.effects import EVERY, effect_named, rig_with
from rr_lab.rig import Rig
from rr_opt.model.robot import EffectUse
from tests.rr_lab.reduced import LONG

TABLE = tomllib.loads(Path(effects.__file__).with_name("effects.toml").read_text("utf-8"))


def test_every_function_is_named_in_the_table():
    there = {name.strip("_") for name, f in vars(effects).items()
             if inspect.isfunction(f) and name.startswith("_")}  # fmt: skip
    named = {row[key] for row in TABLE["effect"] for key in ("enter", "draw", "derived")
             if key in row}  # fmt: skip
    assert there - {"parameter", "effect"} == named


def test_no_effect_stands_twice():
    assert len({effect.key for effect in EVERY}) == len(EVERY)


@pytest.mark.parametrize("effect", EVERY, ids=lambda effect: effect.key)
def test_every_effect_changes_the_rig(effect):
    rig, plain = Rig(LONG), Rig(LONG)
    effect.enter(rig, {each.name: each.typical for each in effect.parameters})
    assert rig != plain


PAIRS = [
    ("coulomb_friction/load_proportional", "floor_patch"),
    ("stribeck_friction", "floor_patch"),
    ("servo_lag", "servo_rate_limit"),
]


@pytest.mark.parametrize("pair", PAIRS)
def test_effects_enter_in_the_order_of_the_table(pair):
    first, second = (
        EffectUse(name, {each.name: each.typical for each in effect_named(name).parameters})
        for name in pair
    )
    one, other = rig_with(LONG, [first, second]), rig_with(LONG, [second, first])
    assert one.laws == other.laws
    assert [f.__qualname__ for f in one.shapers] == [f.__qualname__ for f in other.shapers]
