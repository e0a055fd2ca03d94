"""The quantities that functions and verbs take: numbers in SI, or text with a unit."""

from __future__ import annotations

from collections.abc import Mapping

from rr_opt.model.gait import AMPLITUDE, OFFSET, PERIOD
from rr_opt.outcome import InputError
from rr_opt.units import Quantity

QUANTITIES = {
    "amplitude": AMPLITUDE,
    "period": PERIOD,
    "offset": OFFSET,
    "seconds": Quantity("s", "10", above=0),
    "rate": Quantity("1/s", "100", above=0),
    "radius": Quantity("m", "1.5 m"),
    "heading": Quantity("rad", "90 deg"),
    "within": Quantity("s", "4 s", above=0),
    "length": Quantity("m", "80 cm", above=0),
}
"""By the argument's name."""


def read_arguments(given: Mapping[str, float | str | None], prefix: str = "") -> dict[str, float]:
    """The arguments in SI, those that are None left out.

    prefix: of the names in messages, `--` for options. Raises InputError with everything that is
    wrong with all of them.
    """
    values, wrong = {}, []
    for name, value in given.items():
        if value is not None:
            try:
                values[name] = QUANTITIES[name].read(value)
            except InputError as error:
                wrong.append(f"{prefix}{name}: {error}")
    if wrong:
        raise InputError("\n".join(wrong))
    return values
