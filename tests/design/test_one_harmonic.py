"""A Fourier gait of one harmonic is the sine, and so is its optimum."""

from __future__ import annotations

from dataclasses import replace

import pytest

from benchmarks.optimise.problems import PROBLEMS
from rr_opt.design.maximize_speed import maximize_speed


@pytest.mark.parametrize("name", ["paper_forward", "turn_fixed"])
def test_one_harmonic(name: str) -> None:
    problem = PROBLEMS[name]
    one = replace(problem, gait=replace(problem.gait, shape="fourier", harmonics=1))
    sine, same = maximize_speed(problem).best, maximize_speed(one).best
    assert sine is not None
    assert same is not None
    assert same.speed == pytest.approx(sine.speed, rel=3e-5)
    assert same.gait.amplitude == pytest.approx(sine.gait.amplitude, rel=1e-3)
    assert same.prices["rate"] == pytest.approx(sine.prices["rate"], rel=1e-3)
