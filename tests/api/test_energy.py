"""A fastest gait says what it costs: the net work of the servo is what friction takes."""

import numpy as np
import pytest

import rr_opt as rr
from rr_opt.model.problem import GaitBounds, Interval, Problem
from rr_opt.motion.dynamics import dynamics_of
from tests.robots import BENCHMARK


def test_the_net_work_is_what_friction_takes():
    found = rr.maximize_speed(Problem(BENCHMARK, gait=GaitBounds(period=Interval(1.0, 2.0))))
    steady, model = found.replay.steady, dynamics_of(BENCHMARK)
    gait, p = steady.gait, model.values(BENCHMARK)
    lost = [
        float(model.energy(v, phi, rate, p)[1])
        for v, phi, rate in zip(steady.v, steady.phi, gait.rate(steady.t), strict=True)
    ]
    path = abs(found.speed) * gait.period
    net = float(np.mean(lost[:-1])) * gait.period / path
    assert found.energy.net == pytest.approx(net, rel=1e-5)
    assert found.energy.gross > found.energy.net
    weight = 9.80665 * (BENCHMARK.platform1.m + BENCHMARK.platform2.m)
    record = found.record()["energy"]
    assert record["cost_of_transport"] == pytest.approx(record["gross"] / weight)
