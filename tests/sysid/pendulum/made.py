"""Pendulums by SciPy's solve_ivp: dry friction with a true sign, its sticking found as events."""

import numpy as np
from scipy.integrate import solve_ivp

from rr_opt.machines.pendulum.pendulum import Pendulum, Swing
from rr_opt.model.experiment import Uncertainty

J, ML, B = 0.05, 0.1, 0.02
NOISE = 3e-3
KNOWN = {"J": Uncertainty(0.05 * J), "ml": Uncertainty(0.01 * ML), "b": Uncertainty(factor=5.0)}


def torque_of(rng):
    """A sum of three sines, (t) -> N m."""
    parts = [
        (rng.uniform(0.08, 0.2), rng.uniform(0.3, 1.2), rng.uniform(0, 2 * np.pi)) for _ in range(3)
    ]
    return lambda t: sum(a * np.sin(2 * np.pi * f * t + phase) for a, f, phase in parts)


def swing(torque, t, dry=0.0, drag=0.0, offset=0.0, J=J, ml=ML, b=B, start=(0.3, 0.0)):
    """The angle (n,) at t, starting at rest or moving."""
    out, now, state = np.empty(t.size), t[0], np.array(start, float)
    out[0] = state[0]

    def push(at, angle):
        return torque(at) + offset - ml * 9.81 * np.sin(angle)

    def slip(way):
        def rate(at, y):
            loss = b * y[1] + drag * y[1] * abs(y[1]) + dry * way
            return [y[1], (push(at, y[0]) - loss) / J]

        return rate

    while now < t[-1]:
        if abs(state[1]) > 1e-9:
            way = np.sign(state[1])
        else:
            force = push(now, state[0])
            way = np.sign(force) if abs(force) >= dry * (1 - 1e-12) else 0.0
        event = (lambda at, y: y[1]) if way else (lambda at, y: abs(push(at, y[0])) - dry)
        event.terminal, event.direction = True, -way if way else 1.0
        rate = slip(way) if way else (lambda at, y: [0.0, 0.0])
        ran = solve_ivp(
            rate,
            (now, t[-1]),
            state,
            events=event,
            dense_output=True,
            rtol=1e-9,
            atol=1e-11,
            max_step=0.05,
        )
        here = (t > now) & (t <= ran.t[-1])
        if here.any():
            out[here] = ran.sol(t[here])[0]
        now, state = ran.t[-1], ran.y[:, -1].copy()
        if ran.status == 1:
            state[1] = 0.0
            if way == 0.0:
                state[1] = 1e-8 * np.sign(push(now, state[0]))
    return out


def recorded(seed, runs=4, seconds=5.0, rate=100.0, known=KNOWN, **truth):
    """A pendulum that is believed to have viscous friction only; its last run is held out."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, seconds, 1 / rate)
    swings = []
    for k in range(runs):
        torque = torque_of(rng)
        start = (rng.uniform(-0.5, 0.5), rng.uniform(-1.0, 1.0))
        angle = swing(torque, t, start=start, **truth) + NOISE * rng.standard_normal(t.size)
        swings.append(Swing(f"run{k}", t, angle, torque(t), NOISE, held_out=k == runs - 1))
    return Pendulum(swings, {"J": J, "ml": ML, "b": B}, known)
