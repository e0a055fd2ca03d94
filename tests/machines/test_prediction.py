"""Each machine moves as SciPy says, and its linearisation is that of differences."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rr_opt.machines.ode import OdeModel
from rr_opt.machines.registry import machine_named
from rr_opt.model.machine import MachineExperiment, MachineRun
from rr_opt.sysid.model import Request, Segment

T = np.arange(0.0, 1.0, 0.005)
G = 9.81
PENDULUM = {"J": 0.05, "ml": 0.1, "b": 0.02}
SERVO = {"kt": 0.4, "R": 4.0, "armature": 0.002, "b": 0.004, "fc": 0.013}
CAR = {"L": 0.1735, "mf": 0.847, "mr": 0.733, "gain": 0.35, "zero": 0.02, "ahead": 0.115,
       "left": -0.01}  # fmt: skip


def push(t):
    return 0.5 * np.sin(2 * np.pi * 1.1 * t + 1.0)


def pendulum(t, y):
    return [y[1], (push(t) - 0.02 * y[1] - 0.1 * G * np.sin(y[0])) / 0.05]


def servo(t, y):
    kp, volts, mass, arm, kt, R = 100.0, 7.4, 0.49, 0.1, 0.4, 4.0
    duty = np.clip(kp * (push(t) - y[0]) * (4096 / (2 * np.pi)) / (256 * 885), -1, 1)
    torque = kt * volts * duty / R - kt**2 * y[1] / R - 0.004 * y[1]
    torque -= 0.013 * np.tanh(y[1] / 0.005) + mass * G * arm * np.sin(y[0])
    return [y[1], torque / (mass * arm**2 + 0.002)]


def rolling(t, y):
    """The recorded point of a car whose wheels do not slip at all."""
    delta, speed = 0.35 * push(t) + 0.02, 1.5 + 0.2 * np.sin(3 * t)
    rate = speed * np.tan(delta) / 0.1735
    c, s = np.cos(y[2]), np.sin(y[2])
    along, across = speed + 0.01 * rate, 0.115 * rate
    return [along * c - across * s, along * s + across * c, rate]


def steady(seen):
    delta, speed, rear = 0.35 * push(0.0) + 0.02, 1.5, 0.1735 * (1 - 0.733 / 1.58)
    rate = speed * np.tan(delta) / 0.1735
    return np.array([*seen, rate * rear, rate])


def model(name, nominal, inputs):
    machine = machine_named(name)
    sigma = {c.name: 1e-3 for c in machine.outputs}
    outputs = {c.name: np.zeros(T.size) for c in machine.outputs}
    runs = (MachineRun("one", T, inputs, outputs, sigma),)
    return OdeModel(MachineExperiment(machine, nominal, {}, runs), parted=True)


SERVO_INPUTS = {
    "goal": push(T), "volts": 0 * T + 7.4, "on": 0 * T + 1.0, "kp": 0 * T + 100.0,
    "m": 0 * T + 0.49, "l": 0 * T + 0.1,
}  # fmt: skip
CAR_INPUTS = {"vx": 1.5 + 0.2 * np.sin(3 * T), "steering": push(T)}
CASES = {
    "pendulum": (PENDULUM, {"u": push(T)}, np.array([0.4, -0.5]), pendulum, 2e-4),
    "servo": (SERVO, SERVO_INPUTS, np.array([0.4, -0.5]), servo, 2e-4),
    "car": (CAR, CAR_INPUTS, steady([0.1, 0.2, 0.3]), rolling, 0.02),
}


@pytest.mark.parametrize("name", CASES)
def test_motion(name):
    nominal, inputs, start, rates, close = CASES[name]
    one = model(name, nominal, inputs)
    whole = Segment(0, 0, T.size, T.size - 1)
    made = one.predicted(Request(whole, {}, start), ())
    size = 3 if name == "car" else 2
    ran = solve_ivp(rates, (0, T[-1]), start[:size], "LSODA", T, rtol=1e-9, atol=1e-11)
    seen = ran.y.T if name == "car" else ran.y[:1].T
    assert np.ptp(seen, axis=0).max() > 0.3
    assert np.abs(made - seen).max() < close


@pytest.mark.parametrize("name", CASES)
def test_linearisation(name):
    nominal, inputs, start, _, _ = CASES[name]
    one = model(name, nominal, inputs)
    request = Request(Segment(0, 0, 60, 60), dict(nominal), start)
    wanted = tuple(key for key, value in nominal.items() if value)
    (found,) = one.linearise([request], (), wanted)

    def ran(changed):
        (made,) = one.simulate([changed], ())
        return made

    columns, ends = [], []
    for k in range(start.size):
        by = 1e-5 * np.eye(start.size)[k]
        up, down = (ran(replace(request, state=start + way * by)) for way in (1, -1))
        columns.append((up.residuals - down.residuals).ravel() / 2e-5)
        ends.append((up.end - down.end) / 2e-5)
    for key in wanted:
        by = 1e-4 * nominal[key]
        up, down = (
            ran(replace(request, values={**nominal, key: nominal[key] + way * by}))
            for way in (1, -1)
        )
        columns.append((up.residuals - down.residuals).ravel() / (2 * by))
        ends.append((up.end - down.end) / (2 * by))
    jacobian = np.column_stack([*columns, ran(request).residuals.ravel()])
    size = np.linalg.norm(jacobian, axis=0)
    size = np.maximum(size, 0.02 * size.max())  # what settles within a step is hardly seen
    error = np.abs(found.gram - jacobian.T @ jacobian) / np.outer(size, size)
    assert error.max() < 0.03
    end = np.column_stack(ends)
    assert found.end == pytest.approx(end, abs=0.02 * np.abs(end).max())
