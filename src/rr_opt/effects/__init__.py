"""The catalogue: every effect of physics beyond the paper's model, one file each.

To add an effect, add a file that defines `EFFECT` and name it in `_MODULES`.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from rr_opt.effects import (
    axle_misalignment,
    clock_offset,
    com_offset,
    coulomb_friction,
    floor_patch,
    floor_tilt,
    lateral_slip,
    left_right_drag,
    marker_offset,
    quadratic_drag,
    rolling_force_curve,
    servo_backlash,
    servo_lag,
    servo_offset,
    servo_rate_limit,
    wheel_inertia,
    zero_offset,
)
from rr_opt.effects.effect import Effect

_MODULES = (
    servo_lag,
    servo_rate_limit,
    servo_backlash,
    servo_offset,
    coulomb_friction,
    quadratic_drag,
    rolling_force_curve,
    left_right_drag,
    wheel_inertia,
    axle_misalignment,
    floor_tilt,
    floor_patch,
    lateral_slip,
    com_offset,
    marker_offset,
    clock_offset,
    zero_offset,
)

CATALOGUE: Mapping[str, Effect] = MappingProxyType({m.EFFECT.name: m.EFFECT for m in _MODULES})

OF_ROBOTS: Mapping[str, Effect] = MappingProxyType(
    {name: effect for name, effect in CATALOGUE.items() if effect is not zero_offset.EFFECT}
)
"""What a robot file may list: the zeros of a capture system are stated by an experiment."""
