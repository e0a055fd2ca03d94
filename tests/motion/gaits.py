"""Gaits of every shape that several tests drive."""

import numpy as np

from rr_opt.model.gait import FourierGait, FreeGait, SineGait


def free_gait(period, angle0, accelerations):
    """The free gait through angle0 whose accelerations, less their mean, are these."""
    u = np.asarray(accelerations, float)
    u = u - u.mean()
    h = period / len(u)
    rates = h * np.concatenate([[0.0], np.cumsum(u)])
    # The rate at the start with which phi closes: the mean of the piecewise linear rate is 0.
    rate0 = -np.mean((rates[:-1] + rates[1:]) / 2)
    return FreeGait(period, angle0, float(rate0), tuple(map(float, u)))


def free_sine(sine, intervals):
    """The free gait whose rate is the sine's at every node, so that phi differs by O(h^2)."""
    t = np.linspace(0, sine.period, intervals + 1)
    u = np.diff(sine.rate(t)) * intervals / sine.period
    return FreeGait(sine.period, float(sine.angle(0)), float(sine.rate(0)), tuple(map(float, u)))


SINE = SineGait(0.7, 1.4, 0.2)
FOURIER = FourierGait(1.4, 0.1, (0.6, -0.1, 0.05), (0.1, 0.08, 0.0))
FREE = free_gait(1.4, -0.2, np.random.default_rng(3).uniform(-20, 20, 16))
EVERY = {gait.shape: gait for gait in (SINE, FOURIER, FREE)}
