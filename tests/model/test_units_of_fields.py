"""Fields of the model take text with a unit, hold SI, and leave numbers as they are."""

from __future__ import annotations

import math
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from rr_opt.model.experiment import CountScale, Noise
from rr_opt.model.fields import Interval
from rr_opt.model.gait import FourierGait, SineGait
from rr_opt.model.problem import GaitBounds, Limits, Problem, RatioChoice
from rr_opt.model.robot import Platform, Servo
from rr_opt.outcome import InputError
from tests.robots import BENCHMARK


def test_text_with_a_unit_becomes_si():
    assert SineGait("30 deg", "1200 ms") == SineGait(math.radians(30), 1.2, 0.0)
    assert Servo(rate_limit="30 rpm").rate_limit == math.pi
    assert Noise("1 mm", "3 mrad") == Noise(1e-3, 3e-3)
    assert CountScale(range="-300 deg").range == -math.radians(300)
    platform = Platform(m="500 g", I=0.00386, c="0.25 m", a="25 cm", b=0.05, kappa="2e-5 N m s")
    assert platform == Platform(0.5, 0.00386, 0.25, 0.25, 0.05, 2e-5)
    assert replace(platform, c="50 cm").c == 0.5


def test_a_pair_or_one_value_becomes_an_interval():
    bounds = GaitBounds(amplitude=("5 deg", "60 deg"), period=1.2)
    assert bounds.amplitude == Interval(math.radians(5), math.radians(60))
    assert bounds.period == Interval(1.2, 1.2)
    assert RatioChoice("20 %").bounds.fixed


def test_every_number_of_a_series_may_have_its_unit():
    gait = FourierGait(1.0, 0.0, ["10 deg", 0.2], np.array([0.0, 0.1]))
    assert gait == FourierGait(1.0, 0.0, (math.radians(10), 0.2), (0.0, 0.1))


def test_numbers_are_not_touched():
    amplitude = np.float64(0.5)
    assert SineGait(amplitude, 1.0).amplitude is amplitude
    assert Limits(math.inf, math.inf, math.inf).rate == math.inf


def test_a_limit_that_is_left_out_is_the_servos():
    problem = Problem(BENCHMARK, Limits(rate="10 rpm"))
    servo = BENCHMARK.servo
    assert problem.limits == Limits(servo.angle_limit, math.pi / 3, servo.torque_limit)
    assert Problem(BENCHMARK).limits.rate == servo.rate_limit


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Limits(rate="30 Hz"), "Limits.rate: Read '30 Hz', a frequency. Expected"),
        (lambda: SineGait("0.5", "-1 s"), "SineGait.period: Read '-1 s', -1 s. Expected a number"),
        (lambda: SineGait("0.5", "1 us"), "Expected a number in s at least 0.01."),
        (lambda: GaitBounds(period=("1 us", "1 s")), "Expected a number in s at least 0.01."),
        (lambda: GaitBounds(period=(3, 1)), "GaitBounds.period: Read (3, 1), whose low end is"),
        (lambda: GaitBounds(period=(1, 2, 3)), "a list of 3. Expected one number, which fixes it"),
        (lambda: Platform("5 ()", 1, 1, 1, 1, 1), "Platform.m: Read '5 ()'. Its unit cannot be"),
        (lambda: FourierGait(1.0, 0.0, ["x"], [0.0]), "FourierGait.sines: Number 1 of the list"),
    ],
)
def test_text_that_is_no_such_quantity_is_refused(make, message):
    with pytest.raises(InputError) as caught:
        make()
    assert message in str(caught.value)


def test_numbers_alone_do_not_load_pint():
    program = "import sys, rr_opt.model.problem as p; p.Limits(1.0, 2.0, 3.0); print(sys.modules)"
    run = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True)
    assert b"'pint'" not in run.stdout
    assert b"'pydantic'" not in run.stdout
