"""Recordings are predicted for as long as errors and noisy inputs allow."""

import math

import numpy as np
import pytest

from rr_opt.machines.ode import OdeModel
from rr_opt.machines.registry import machine_named
from rr_opt.model.machine import MachineExperiment, MachineRun
from rr_opt.recordings.machine_run import held_for, input_noise
from rr_opt.sysid.model import ChannelNoise

J, ML = 0.05, 0.1
RATE = math.sqrt(9.81 * ML / J)
"""1/s, by which errors grow where the pendulum stands upright."""
T = np.arange(0.0, 6.0, 0.01)


def model(about: float, noise: float = 0.0, every: int = 1) -> OdeModel:
    """With an angle in every so many samples."""
    angle, torque = about + 0.2 * np.sin(3 * T), 0.3 * np.sin(5 * T)
    angle[np.arange(T.size) % every > 0] = np.nan
    sigma = {"q": 1e-3, "u": noise}
    runs = (MachineRun("one", T, {"u": torque}, {"q": angle}, sigma),)
    nominal = {"J": J, "ml": ML, "b": 0.0}
    return OdeModel(MachineExperiment(machine_named("pendulum"), nominal, {}, runs))


def window(about: float, noise: float = 0.0) -> float:
    return model(about, noise).horizon


def test_upright_errors_grow():
    assert window(0.0) == 2.0
    upright = window(math.pi)
    # It swings by 0.2 rad, which slows the growth by 2 % at most.
    assert math.exp(0.98 * RATE * upright) <= 7.4 < math.exp(RATE * 2 * upright)


def test_noisy_inputs_move_it():
    assert window(0.0, noise=0.5) < window(0.0, noise=1e-3) == 2.0


def test_only_samples_with_data_count_in_what_noisy_inputs_cause():
    dense, sparse = (model(0.0, noise=0.05, every=every).form_error for every in (1, 5))
    assert sparse == pytest.approx(dense, rel=0.2)


def test_each_rate_of_a_car_is_as_uncertain_as_what_it_moves():
    names = ("x", "y", "psi")
    sigma = {"x": 1e-3, "y": 2e-3, "psi": 5e-3}
    inputs = {"vx": np.ones(T.size), "steering": 0.1 * np.sin(T)}
    run = MachineRun("one", T, inputs, {name: np.sin(T) for name in names}, sigma)
    car = machine_named("car")
    nominal = {one.name: 1.0 for one in car.parameters}
    one = OdeModel(MachineExperiment(car, nominal, {}, (run,)))
    add = math.sqrt(3) / one.segment_length
    assert one.state_scale(()) == pytest.approx([1e-3, 2e-3, 5e-3, 2e-3 * add, 5e-3 * add])


def test_a_rate_is_as_uncertain_as_the_window_and_the_noise_say():
    one = model(0.0, noise=1e-3)
    expected = np.array([1e-3, 1e-3 * math.sqrt(3) / one.segment_length])
    assert one.state_scale(()) == pytest.approx(expected)
    assert one.with_noise([ChannelNoise(3.0)]).state_scale(()) == pytest.approx(3 * expected)


@pytest.mark.parametrize("held", [5, 10])
def test_an_input_that_is_held_is_uncertain_by_its_steps(held):
    rng = np.random.default_rng(0)
    updates = np.cumsum(rng.standard_normal(200))
    y = np.repeat(updates, held)
    assert held_for([y]) == held
    steps = np.diff(updates)
    # Uniform between one update and the next.
    assert input_noise(y, held) == pytest.approx(np.sqrt(np.mean(steps**2) / 12), rel=1e-9)
    assert input_noise(np.sin(np.arange(2000) / 100), 1) == 0.0
