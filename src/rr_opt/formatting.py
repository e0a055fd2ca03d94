"""How numbers and quantities are written for people: the SI value, and the customary unit."""

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class ReportedQuantity:
    """A quantity in reports: its name, SI unit, and a second unit with its factor per SI unit."""

    words: str
    unit: str
    other: str = ""
    factor: float = 1.0

    @property
    def common(self) -> tuple[str, float]:
        """The customary unit, and how many of it are one SI unit."""
        return (self.other, self.factor) if self.other else (self.unit, 1.0)

    def both(self, value: float | None) -> str:
        """`3.142 rad/s (30 rpm)`; `no limit` for None and infinity."""
        if value is None or math.isinf(value):
            return "no limit"
        value = 0.0 if abs(value) < _ROUNDING else value
        first = with_unit(value, self.unit)
        return f"{first} ({with_unit(value * self.factor, self.other)})" if self.other else first


_DEGREES = 180 / math.pi

QUANTITIES = {
    "angle": ReportedQuantity("largest joint angle", "rad", "deg", _DEGREES),
    "rate": ReportedQuantity("largest joint rate", "rad/s", "rpm", 30 / math.pi),
    "torque": ReportedQuantity("largest servo torque", "N m"),
    "singularity": ReportedQuantity("least S1 = c1 cos φ + c2", "m", "mm", 1e3),
    "grip": ReportedQuantity("largest side force over load", ""),
    "power": ReportedQuantity("mean positive power of the servo", "W", "mW", 1e3),
    "cost_of_transport": ReportedQuantity("cost of transport", ""),
    "speed": ReportedQuantity("least speed", "m/s", "mm/s", 1e3),
    "amplitude": ReportedQuantity("amplitude", "rad", "deg", _DEGREES),
    "period": ReportedQuantity("period", "s"),
    "offset": ReportedQuantity("offset", "rad", "deg", _DEGREES),
    "inertia_ratio": ReportedQuantity("inertia ratio J20/J10", ""),
}
"""By the name of a limit or a decision in files and results."""


_ROUNDING = 1e-12
_CRAWLING = 1e-3
"""Slower speeds are given in mm/s alone, m/s."""


def number(value: float, digits: int = 4) -> str:
    """A number with `digits` significant digits, without an exponent where it is readable.

    Anything smaller than what is reported here is rounding error.
    """
    if not math.isfinite(value):
        return f"{value}"
    if abs(value) < _ROUNDING:
        return "0"
    size = math.floor(math.log10(abs(value)))
    if -4 <= size < 6:
        text = f"{value:.{max(digits - 1 - size, 0)}f}"
        return text.rstrip("0").rstrip(".") if "." in text else text
    mantissa, power = f"{value:.{digits - 1}e}".split("e")
    return f"{mantissa.rstrip('0').rstrip('.')}e{power}"


def with_unit(value: float, unit: str, digits: int = 4) -> str:
    """A number and its unit."""
    return f"{number(value, digits)} {unit}".strip()


def words_of(name: str) -> str:
    """An effect's name as words, `coulomb_friction` as `Coulomb friction`, or that of a value of
    it, `servo_lag.tau` as `tau of servo lag`."""
    words = " of ".join(reversed(name.split(".")))
    words = words.replace("com_", "centre-of-mass ").replace("left_right", "left-right")
    return words.replace("_", " ").replace("coulomb", "Coulomb").replace("stribeck", "Stribeck")


def counted(count: int, singular: str, plural: str = "") -> str:
    """`1 iteration`, `2 iterations`; plural: if it is not the singular with an s."""
    return f"{count} {singular if count == 1 else plural or f'{singular}s'}"


def speed_text(speed: float) -> str:
    """A signed speed in m/s and mm/s, `-0.12896 m/s (-129.0 mm/s)`, or `+0.0738 mm/s`."""
    if abs(speed) < _CRAWLING:
        return f"{'+' if speed > _ROUNDING else ''}{number(1e3 * speed)} mm/s"
    return f"{speed:+.5f} m/s ({1e3 * speed:+.1f} mm/s)"


def pace_text(speed: float) -> str:
    """The speed without its direction: `0.1290 m/s`, or `0.0738 mm/s`."""
    if abs(speed) < _CRAWLING:
        return f"{number(1e3 * abs(speed))} mm/s"
    return f"{abs(speed):.4f} m/s"


def direction_text(speed: float) -> str:
    """The direction of a signed speed."""
    return "forward" if speed > 0 else "backward"


def side_text(value: float) -> str:
    """The side of a positive or negative turn."""
    return "left" if value > 0 else "right"


def price_text(name: str, price: float, objective: str = "speed") -> str:
    """A shadow price, per SI unit, as `+8.57 mm/s per rpm`; of the cost of transport or a time,
    which decrease, as `-0.0012 per rpm`."""
    unit, factor = QUANTITIES[name].common
    gained, kind = {"speed": (1e3, " mm/s"), "time": (-1.0, " s")}.get(objective, (-1.0, ""))
    per = gained * price / factor
    if not unit:
        per, unit = per / 100, "0.01"
    return f"{'' if per < 0 else '+'}{number(per, 3)}{kind} per {unit}"
