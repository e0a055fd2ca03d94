"""A servo with a rate limit steps towards its command, in each instant by no more than the limit.

That rule, followed in a quarter of a million steps, comes to the same angle; the rate is the
angle's slope.
"""

import numpy as np
import pytest

from rr_opt.effects import CATALOGUE
from rr_opt.mechanics.drive import Drive, commanded
from rr_opt.model.gait import SineGait

LAG, LIMIT = CATALOGUE["servo_lag"], CATALOGUE["servo_rate_limit"]
GAIT = SineGait(0.6, 0.8, 0.1)


def stepped(command: Drive, limit: float, periods: int, steps: int):
    """Times and angles by many small steps."""
    t = command.period * periods / steps * np.arange(steps + 1)
    goals, most = command.at(t)[0], limit * (t[1] - t[0])
    here = command.at(np.array([-1.0]))[0, 0] if command.rest else goals[0]
    phi = np.empty_like(t)
    for k, goal in enumerate(goals.tolist()):
        here += min(max(goal - here, -most), most)
        phi[k] = here
    return t, phi


@pytest.mark.parametrize("share", [0.97, 0.8, 0.5, 0.25])
@pytest.mark.parametrize("rest", [True, False], ids=["from rest", "running"])
@pytest.mark.parametrize("tau", [0.0, 0.05], ids=["alone", "after a lag"])
def test_against_small_steps(share, rest, tau):
    command, limit = LAG.actuate(commanded(GAIT, rest), {"tau": tau}), share * GAIT.peak_rate
    made = LIMIT.actuate(command, {"rate_limit": limit})
    t, phi = stepped(command, limit, 14, 250_000)
    if not rest:  # that way begins at its command, and forgets it
        t, phi = t[120_000:], phi[120_000:]
    found = made.at(t)
    np.testing.assert_allclose(found[0], phi, atol=1e-3)
    assert np.abs(found[1]).max() <= limit * (1 + 1e-9)
    slope = np.diff(found[0]) / np.diff(t)
    inside = np.abs(slope - found[1, :-1]) < 1e-3 * limit
    assert inside.mean() > 0.998


def test_fast_enough_is_no_limit():
    command = commanded(GAIT, True)
    assert LIMIT.actuate(command, {"rate_limit": 1.01 * GAIT.peak_rate}) is command


def test_times_are_exact():
    # Halving the change of the limit halves the change of the angle: no grid is felt.
    t, limit = np.linspace(0.0, 3.0, 400), 0.7 * GAIT.peak_rate

    def phi(more: float) -> np.ndarray:
        return LIMIT.actuate(commanded(GAIT, True), {"rate_limit": limit + more}).at(t)[0]

    wide, narrow = ((phi(step) - phi(-step)) / (2 * step) for step in (1e-4, 1e-6))
    assert np.quantile(np.abs(wide - narrow), 0.99) < 1e-3 * np.abs(narrow).max()
