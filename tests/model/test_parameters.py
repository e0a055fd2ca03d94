"""The table of parameters names every value of a robot once: out and back changes nothing."""

from __future__ import annotations

from dataclasses import fields, replace

import pytest

from rr_opt.model.parameters import (
    PARAMETERS,
    PLATFORM_SYMBOLS,
    default_uncertainty,
    parameters_of,
    with_parameters,
)
from rr_opt.model.robot import Platform
from rr_opt.units import to_si
from tests.robots import BENCHMARK


def test_the_symbols_are_the_fields_of_a_platform() -> None:
    assert tuple(field.name for field in fields(Platform)) == PLATFORM_SYMBOLS


def test_values_out_and_back_are_the_same_robot() -> None:
    values = parameters_of(BENCHMARK)
    assert tuple(values) == tuple(PARAMETERS)
    assert with_parameters(BENCHMARK, values) == BENCHMARK


@pytest.mark.parametrize("name", PARAMETERS)
def test_only_the_named_parameter_changes(name: str) -> None:
    changed = with_parameters(BENCHMARK, {name: 0.125})
    assert parameters_of(changed) == parameters_of(BENCHMARK) | {name: 0.125}


def test_an_unknown_name_is_refused() -> None:
    with pytest.raises(KeyError, match="kappa3"):
        with_parameters(BENCHMARK, {"kappa3": 1.0})


def test_the_default_uncertainties_are_those_of_the_experiment_file() -> None:
    robot = replace(BENCHMARK, platform1=replace(BENCHMARK.platform1, m=0.4, I=0.004))
    found = default_uncertainty(robot)
    assert found["m1"].sigma == pytest.approx(0.004)
    assert found["I1"].sigma == pytest.approx(0.0002)
    assert [found[name].sigma for name in ("c1", "a2", "b2", "h")] == [2e-3, 2e-3, 2e-3, 5e-4]
    assert found["kappa2"].factor == 5


@pytest.mark.parametrize("name", PARAMETERS)
def test_units_and_examples_are_read(name: str) -> None:
    parameter = PARAMETERS[name]
    assert to_si(parameter.example, parameter.unit) > 0
    assert 0 < to_si(parameter.sigma_example, parameter.unit) < 1
