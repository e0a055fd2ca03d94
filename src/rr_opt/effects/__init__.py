"""The catalogue: every effect of physics beyond the paper's model, in files of their kind.

To add an effect, define it there and name it in `_EFFECTS`.
"""

from collections.abc import Mapping
from types import MappingProxyType

from rr_opt.effects import assembly, floor, measurement, rolling, servo
from rr_opt.effects.effect import Effect
from rr_opt.effects.lateral_slip import LATERAL_SLIP
from rr_opt.effects.servo_backlash import SERVO_BACKLASH

_EFFECTS = (
    servo.SERVO_LAG,
    servo.SERVO_RATE_LIMIT,
    SERVO_BACKLASH,
    servo.SERVO_OFFSET,
    rolling.COULOMB_FRICTION,
    rolling.QUADRATIC_DRAG,
    rolling.ROLLING_FORCE_CURVE,
    rolling.LEFT_RIGHT_DRAG,
    rolling.WHEEL_INERTIA,
    assembly.AXLE_MISALIGNMENT,
    floor.FLOOR_TILT,
    floor.FLOOR_PATCH,
    LATERAL_SLIP,
    assembly.COM_OFFSET,
    measurement.MARKER_OFFSET,
    measurement.CLOCK_OFFSET,
    measurement.ZERO_OFFSET,
)
CATALOGUE: Mapping[str, Effect] = MappingProxyType({one.name: one for one in _EFFECTS})

OF_ROBOTS: Mapping[str, Effect] = MappingProxyType(
    {name: effect for name, effect in CATALOGUE.items() if name != "zero_offset"}
)
"""What a robot file may list: the zeros of a capture system are stated by an experiment."""
