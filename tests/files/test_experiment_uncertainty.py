"""How well a nominal value is known is read as written, and else is the documented default."""

from __future__ import annotations

import math

import pytest

from rr_opt.files.experiment_file import read_plan
from rr_opt.files.issue import InvalidFileError
from rr_opt.model.experiment import Uncertainty

TEXT = """\
robot:
  platform1: {m: 0.4, I: 0.002, c: 0.2, a: 0.02, b: 0.05, kappa: 2.0e-5}
  platform2: {m: 0.3, I: 0.001, c: 0.1, a: -0.01, b: 0.05, kappa: 3.0e-5}
  h: 0.02
noise: {position: 1 mm, angle: 3 mrad}
recordings:
- {file: one.csv, gait: {amplitude: 0.5, period: 1, offset: 0}}
- {file: two.csv, gait: {amplitude: 0.5, period: 1, offset: 0}, use: holdout}
"""


@pytest.fixture
def known(write):
    def read(text: str):
        for name in ("one.csv", "two.csv"):
            write("", name)
        return read_plan(write(f"{TEXT}{text}\n", "experiment.yaml"))[0].uncertainty

    return read


def sigmas(known):
    return {name: one.sigma for name, one in known.items() if one.factor is None}


DEFAULT = {
    "m1": 0.004, "m2": 0.003, "I1": 1e-4, "I2": 5e-5, "c1": 2e-3, "c2": 2e-3,
    "a1": 2e-3, "a2": 2e-3, "b1": 2e-3, "b2": 2e-3, "h": 5e-4,
}  # fmt: skip


@pytest.mark.parametrize(
    "text",
    [
        "",
        "uncertainty: {}",
        "uncertainty: {m: 1 %, I: 5 %, c: 2 mm, a: 2 mm, b: 2 mm, h: 0.5 mm, kappa: unknown}",
        "uncertainty: {c: 0.002, m1: 4 g, m2: 0.003, kappa1: unknown, kappa2: ' unknown '}",
    ],
)
def test_the_default(known, text):
    found = known(text)
    assert sigmas(found) == pytest.approx(DEFAULT)
    assert found["kappa1"] == found["kappa2"] == Uncertainty(factor=5.0)
    assert set(found) == {*DEFAULT, "kappa1", "kappa2"}


@pytest.mark.parametrize(
    ("text", "changed"),
    [
        ("{m: 10 %}", {"m1": 0.04, "m2": 0.03}),
        ("{m: 10 %, m2: 1 g}", {"m1": 0.04, "m2": 0.001}),
        ("{a: 50%}", {"a1": 0.01, "a2": 0.005}),
        ("{I2: 1e-3}", {"I2": 1e-3}),
        ("{c: 0}", {"c1": 0.0, "c2": 0.0}),
        ("{kappa: 1e-6}", {"kappa1": 1e-6, "kappa2": 1e-6}),
        ("{kappa2: 20 %}", {"kappa2": 6e-6}),
        ("{psi_zero: 1 deg, phi_zero: 5 mrad}", {"psi_zero": math.pi / 180, "phi_zero": 5e-3}),
        ("{h: 1 %}", {"h": 2e-4}),
        ("{h: 0}", {"h": 0.0}),
    ],
)
def test_as_written(known, text, changed):
    assert sigmas(known(f"uncertainty: {text}")) == pytest.approx({**DEFAULT, **changed})


@pytest.mark.parametrize("name", ["m", "I2", "h", "b1"])
def test_unknown_is_free_within_a_factor_of_5(known, name):
    found = known(f"uncertainty: {{{name}: unknown}}")
    names = [name] if name[-1] in "12h" else [f"{name}1", f"{name}2"]
    assert all(found[one] == Uncertainty(factor=5.0) for one in names)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{m: 1 m}", "a length. Expected a number, or a number with a unit, in kg"),
        ("{m: -1 g}", "at least 0"),
        ("{m: -5 %}", "Expected a share of at least 0"),
        ("{m: known}", "A share such as `5 %`, or `unknown`, is allowed too."),
        ("{m: .inf}", "Read .inf."),
        ("{psi_zero: unknown}", "Read the text 'unknown'"),
        ("{phi_zero: 5 %}", "Expected a number, or a number with a unit, in rad"),
        ("{k: unknown}", "Read the key 'k'"),
        ("{m3: 1 %}", "Read the key 'm3'"),
        ("5 %", "Expected keys with values under it"),
    ],
)
def test_refused(known, text, message):
    with pytest.raises(InvalidFileError) as caught:
        known(f"uncertainty: {text}")
    (issue,) = caught.value.issues
    assert issue.path.startswith("uncertainty")
    assert message in issue.message
