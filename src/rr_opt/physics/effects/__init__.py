"""The catalogue: every effect of physics beyond the paper's model, one file each.

To add an effect, add a file that defines `EFFECT` and name it in `_MODULES`.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from rr_opt.physics.effects import coulomb_friction, quadratic_drag, wheel_inertia
from rr_opt.physics.effects.effect import Effect, Parameter, Port

_MODULES = (coulomb_friction, quadratic_drag, wheel_inertia)

CATALOGUE: Mapping[str, Effect] = MappingProxyType({m.EFFECT.name: m.EFFECT for m in _MODULES})

__all__ = ["CATALOGUE", "Effect", "Parameter", "Port"]
