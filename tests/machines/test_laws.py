"""The laws of friction and of the motor are those of the textbooks, in numbers worked by hand."""

from types import SimpleNamespace

import pytest

from rr_opt.machines import laws

HALF = 2 * laws.STRIBECK
"""A speed at which a law has to be told from its neighbours, rad/s."""


@pytest.mark.parametrize(
    ("effect", "constants", "torque"),
    [
        (laws.COULOMB, {"torque": 0.2}, -0.2),
        # A Gaussian in the speed: at twice the Stribeck speed exp(-4) of it.
        (laws.STRIBECK_FRICTION, {"torque": 0.2}, -0.2 * 0.01831564),
        (laws.QUADRATIC_DRAG, {"coefficient": 0.3}, -0.3),
        # A tenth of what the gears transmit, drive and load together.
        (laws.LOAD_FRICTION, {"share": 0.1}, -0.1 * 1.5),
        (laws.DIRECTION_FRICTION, {"difference": 0.2}, -0.1),
        # R 4 ohm sees 0.5 ohm more; half of the time, so a quarter of the drop counts.
        (laws.SUPPLY_SAG, {"resistance": 0.5}, -0.5 / 4 * 0.25 * 2.0),
        (laws.TORQUE_OFFSET, {"torque": 0.07}, 0.07),
    ],
    ids=lambda one: getattr(one, "name", ""),
)
@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_torque(effect, constants, torque, direction):
    sees = SimpleNamespace(w=direction * HALF, drive=direction * 2.0, load=direction * -0.5, R=4.0,
                           duty=0.5 * direction)  # fmt: skip
    found = float(effect.law(sees, SimpleNamespace(**constants)))
    turns = effect.name in ("direction_friction", "torque_offset")
    assert found == pytest.approx(torque if turns else direction * torque, rel=1e-3)
