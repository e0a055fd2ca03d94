"""What is not a number of the right dimension is refused with what was read and expected."""

from __future__ import annotations

import time

import pytest

from rr_opt.outcome import InputError
from rr_opt.units import to_si

REFUSED = [
    ("3 s", "m", "Read '3 s', a time. Expected a number, or a number with a unit, in m."),
    ("5 deg", "", "Read '5 deg', an angle. Expected a number without a unit."),
    ("2 Hz", "rad/s", "Write rpm, rad/s or deg/s."),
    ("5 %", "rad", "Read '5 %', a plain number. Expected a number, or a number with a unit"),
    ("3 rad s", "s", "Read '3 rad s', another kind of quantity."),
    ("3 N m", "rad", "Read '3 N m', a torque."),
    ("3 N m s", "rad", "Read '3 N m s', a torque per angular rate."),
    ("3 N s/m", "m", "Read '3 N s/m', a force per speed."),
    ("3 m/s^2", "m", "Read '3 m/s^2', an acceleration."),
    ("3 kg m^2", "m", "Read '3 kg m^2', a moment of inertia."),
    ("1 kgs", "kg", "The unit 'kgs' is not known. Did you mean `kg`?"),
    ("20 degC", "", "The unit 'degC' is not known."),
    ("10 dB", "", "The unit 'dB' is not known."),
    ("3 m**9**9", "m", "Its unit cannot be understood"),
    ("3 )m(", "m", "Its unit cannot be understood"),
    ("3 m/", "m", "Its unit cannot be understood"),
    ("3 (m", "m", "Its unit cannot be understood"),
    ("0,469", "kg", "Its unit cannot be understood"),
    ("about 3", "kg", "Read the text 'about 3'."),
    ("", "kg", "Read the text ''."),
    (None, "kg", "Read nothing."),
    (True, "kg", "Read true."),
    ([1], "kg", "Read [1]."),
    (float("nan"), "kg", "Read `.nan`, not a number."),
    ("1e999", "kg", "Read a number that is too large."),
    ("1e300 Mm", "kg", "Read '1e300 Mm', a length."),
    (10**400, "kg", "Read a number that is too large."),
]


@pytest.mark.parametrize(("value", "unit", "message"), REFUSED)
def test_refused(value: object, unit: str, message: str):
    with pytest.raises(InputError) as caught:
        to_si(value, unit)
    assert message in str(caught.value)


@pytest.mark.parametrize(("value", "unit", "message"), REFUSED)
def test_base_units_that_nobody_writes_are_not_told(value: object, unit: str, message: str):
    with pytest.raises(InputError) as caught:
        to_si(value, unit)
    assert not set("·²") & set(str(caught.value))


@pytest.mark.parametrize(
    "text",
    ["9**9**9**9", "9**9**9**9 m", "1 " + "m" * 10**6, "(" * 50, "1 m" + "**9" * 15, "1" * 61],
)
def test_a_hostile_text_is_refused_at_once(text: str):
    begin = time.perf_counter()
    with pytest.raises(InputError):
        to_si(text, "m")
    assert time.perf_counter() - begin < 5
