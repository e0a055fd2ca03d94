"""What a quantity measures, in the words of those who write it."""

from __future__ import annotations

_KINDS = {
    "": "a plain number",
    "m": "a length",
    "m²": "an area",
    "s": "a time",
    "1/s": "a frequency",
    "kg": "a mass",
    "rad": "an angle",
    "rad/s": "an angular rate",
    "m/s": "a speed",
    "m/s²": "an acceleration",
    "kg·m/s²": "a force",
    "kg·m²/s²": "a torque",
    "kg·m²": "a moment of inertia",
    "kg·m²/s": "a torque per angular rate",
    "kg/s": "a force per speed",
}
"""What base units, as pint writes them, measure."""


def kind_of_quantity(base: str) -> str:
    """The kind of quantity that has these base units: `kg·m²/s²` is a torque."""
    return _KINDS.get(base, "another kind of quantity")
