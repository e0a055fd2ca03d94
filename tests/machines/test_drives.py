"""What an effect of the servo begins from is worked out once, however often its values change."""

import numpy as np

from rr_opt.effects import CATALOGUE
from rr_opt.machines.racer import drive as module
from rr_opt.machines.racer.drive import Drives, drive_path, steps_of
from rr_opt.mechanics.drive import commanded
from rr_opt.model.experiment import CHANNELS, Recording, Run
from rr_opt.model.gait import SineGait

GAIT = SineGait(0.6, 1.0, 0.1)
EFFECTS = ("servo_lag", "servo_rate_limit")
GIVEN = {"servo_lag.tau": 0.03, "servo_lag.beta": 0.0, "servo_rate_limit.rate_limit": 3.0}


def drives() -> Drives:
    t = np.linspace(0.0, 6.0, 601)
    still = {name: np.zeros(t.size) for name in CHANNELS}
    flags = {name: np.zeros(t.size, np.uint8) for name in CHANNELS}
    return Drives([Run(Recording("run", t, still, still, flags), GAIT, "fit", "rest")])


def test_the_command_is_asked_once(monkeypatch):
    asked = []

    def counted(gait, rest):
        command = commanded(gait, rest)
        return type(command)(
            lambda t: asked.append(np.size(t)) or command.at(t), command.period, command.rest
        )

    monkeypatch.setattr(module, "commanded", counted)
    some, t = drives(), np.linspace(0.0, 6.0, 601)
    for limit in (3.0, 2.9, 2.8):
        here = some.of(0, {**GIVEN, "servo_rate_limit.rate_limit": limit}, EFFECTS[1:])
        here.at(t)
    assert asked.count(t.size) == 1


def test_as_by_applying_one_after_the_other():
    some, t = drives(), np.linspace(-0.5, 6.0, 651)
    by_hand = commanded(GAIT, rest=True)
    for name in EFFECTS:
        values = {q.name: GIVEN[f"{name}.{q.name}"] for q in CATALOGUE[name].parameters}
        (by_hand,) = CATALOGUE[name].actuated([by_hand], [values], [None])
    for _ in range(2):
        np.testing.assert_array_equal(some.of(0, GIVEN, EFFECTS).at(t), by_hand.at(t))


def test_a_rate_limit_parts_from_its_command_and_meets_it():
    # Where the limited angle leaves the command and comes back it is the command's, to rounding.
    (limited,) = CATALOGUE["servo_rate_limit"].actuated(
        [commanded(GAIT, rest=False)], [{"rate_limit": 3.0}], [None]
    )
    assert limited.jumps is not None
    met = limited.jumps[limited.jumps > 5.0]
    off = limited.at(met)[0] - GAIT.angle(met)
    assert met.size
    np.testing.assert_allclose(off, 0.0, atol=1e-9)
    steps = steps_of(limited, np.linspace(6.0, 8.0, 201), 0.0)
    assert np.isfinite(drive_path(limited, steps, 0.0).nodes).all()
