"""The joint's recorded angle tells which effect of the drive made it, in its fullest form too."""

from dataclasses import replace

import pytest

from rr_opt.machines.racer import actuation
from rr_opt.machines.racer.actuation import actuation_sets
from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import EffectUse
from tests.sysid.made_up import with_effect

SECOND_ORDER = {"servo_lag.tau": 0.009, "servo_lag.beta": 2.5e-5}
"""A late clock is like it to within little."""


def test_lag_of_second_order_beside_a_late_clock():
    model = with_effect(SECOND_ORDER, ("servo_lag",))
    (choices, values), *_ = actuation_sets(model, range(len(model.runs)))
    assert [one.name for one in choices] == ["servo_lag"]
    assert values["servo_lag.tau"] == pytest.approx(0.009, rel=0.02)
    assert values["servo_lag.beta"] == pytest.approx(2.5e-5, rel=0.5)


FAST = (
    (SineGait(0.94, 1.15), "running"),
    (SineGait(0.76, 0.95, -0.25), "running"),
    (SineGait(0.49, 0.85, -0.15), "running"),
    (SineGait(0.97, 1.1, -0.2), "rest"),
)
LIMITED = {"servo_rate_limit.rate_limit": 5.1, "clock_offset.offset": -0.008}
"""Only the last gait is faster than that by more than half a per cent."""


def test_rate_limit_that_one_recording_shows():
    model = with_effect(LIMITED, ("clock_offset", "servo_rate_limit"), gaits=FAST)
    (choices, values), *_ = actuation_sets(model, range(len(model.runs)))
    assert [one.name for one in choices] == ["clock_offset", "servo_rate_limit"]
    assert values == pytest.approx(LIMITED, rel=0.02)


def test_no_pairs_are_tried_where_no_single_effect_explains_anything(monkeypatch):
    sizes, fit = [], actuation._fitted

    def fitted(angle, racer, choices, *rest):
        sizes.append(len(choices))
        return fit(angle, racer, choices, *rest)

    monkeypatch.setattr(actuation._RecordedAngle, "explained", lambda *_: False)
    monkeypatch.setattr(actuation, "_fitted", fitted)
    model = with_effect({}, ())
    assert actuation_sets(model, range(len(model.runs))) == [((), {})]
    assert max(sizes) == 1


def test_a_robot_that_has_every_effect_of_servo_and_clock():
    model = with_effect({"servo_offset.offset": 0.1}, ("servo_offset",))
    every = [name for name, info in model.catalogue.items() if info.upstream]
    uses = (EffectUse(name, {}) for name in every)
    robot = replace(model.experiment.robot, physics=tuple(uses))
    listed = RollerRacer(replace(model.experiment, robot=robot))
    assert actuation_sets(listed, range(len(listed.runs))) == [((), {})]
