"""A synthetic path about a known circle gives back its speed, radius and direction."""

import numpy as np
import pytest

from rr_opt.motion.steady_cycle import cycle_of


@pytest.mark.parametrize("dpsi", [1e-12, -1e-6, 0.3, -0.3, 2.0, -4.0])
@pytest.mark.parametrize("heading", [0.2, np.pi + 0.2], ids=["forward", "backward"])
def test_known_circle(dpsi, heading):
    period, speed, n = 1.3, 0.2, 400
    t = np.linspace(0, period, n + 1)
    omega = dpsi / period
    radius = speed / abs(omega)
    wobble = 0.02 * np.sin(2 * np.pi * t / period + 0.7) + 0.01j * np.cos(2 * np.pi * t / period)
    start = -1j * speed / omega
    path = np.exp(1j * omega * t) * (start + wobble) - start
    psi = omega * t + heading + 0.3 * np.sin(2 * np.pi * t / period)
    cycle = cycle_of(period, path.real, path.imag, psi)
    assert cycle.speed == pytest.approx(np.copysign(speed, np.cos(heading)), rel=1e-9)
    assert cycle.radius == pytest.approx(radius, rel=1e-4 if abs(dpsi) < 1e-9 else 1e-9)
    assert cycle.dpsi == pytest.approx(dpsi, rel=1e-3)
