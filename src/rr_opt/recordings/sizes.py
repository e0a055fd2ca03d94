"""Sizes in the units that people think in."""

from __future__ import annotations

_UNITS = {
    "x": (1e3, "mm"),
    "y": (1e3, "mm"),
    "psi": (1e3, "mrad"),
    "phi": (1e3, "mrad"),
    "torque": (1e3, "mN m"),
}


def size_text(channel: str, size: float) -> str:
    """A size of a channel, from SI, to three digits: `1.2 mm`, `1230 mm`."""
    factor, unit = _UNITS.get(channel, (1.0, ""))
    return f"{float(f'{factor * size:.3g}'):g} {unit}".strip()
