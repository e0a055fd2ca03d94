"""The catalogue: every effect of physics beyond the paper's model, one file each.

To add an effect, add a file that defines `EFFECT` and name it in `_MODULES`.
"""

from collections.abc import Mapping
from importlib import import_module
from types import MappingProxyType

from rr_opt.effects.effect import Effect

_MODULES = """
servo_lag servo_rate_limit servo_backlash servo_offset coulomb_friction stribeck_friction
quadratic_drag rolling_force_curve left_right_drag wheel_inertia axle_misalignment floor_tilt
floor_patch lateral_slip lateral_creep com_offset marker_offset clock_offset zero_offset
dragged_cable
"""
"""What the floor does to a wheel comes before a patch of it, and that before sliding on it."""

_EFFECTS = [import_module(f"{__name__}.{module}").EFFECT for module in _MODULES.split()]
CATALOGUE: Mapping[str, Effect] = MappingProxyType({one.name: one for one in _EFFECTS})

OF_ROBOTS: Mapping[str, Effect] = MappingProxyType(
    {n: effect for n, effect in CATALOGUE.items() if n not in ("zero_offset", "lateral_creep")}
)
"""What a robot file may list: an experiment states the zeros of its capture system, and creep is
slip."""
