"""A lagging servo obeys tau dphi/dt = command - phi, from rest and after having run for ever."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rr_opt.effects import CATALOGUE
from rr_opt.mechanics.drive import commanded
from rr_opt.model.gait import SineGait

GAIT = SineGait(0.6, 0.8, 0.1)
TIMES = np.linspace(0.0, 3.0, 151)


@pytest.mark.parametrize("tau", [0.005, 0.03, 0.2])
@pytest.mark.parametrize("rest", [True, False], ids=["from rest", "running"])
def test_against_the_equation(tau, rest):
    begin = 0.0 if rest else -30.0 * GAIT.period

    def slope(t: float, phi: np.ndarray) -> np.ndarray:
        return (GAIT.angle(np.array([t])) - phi) / tau

    ends = (begin, TIMES[-1])
    accurate = {"rtol": 1e-9, "atol": 1e-11, "max_step": 0.05}
    phi = solve_ivp(slope, ends, [GAIT.offset], t_eval=TIMES, **accurate).y[0]
    made = CATALOGUE["servo_lag"].actuate(commanded(GAIT, rest), {"tau": tau}).at(TIMES)
    np.testing.assert_allclose(made[0], phi, atol=1e-7)
    np.testing.assert_allclose(made[1], (GAIT.angle(TIMES) - phi) / tau, atol=1e-7 / tau)
    np.testing.assert_allclose(made[2], (GAIT.rate(TIMES) - made[1]) / tau, atol=1e-6 / tau)


@pytest.mark.parametrize(
    ("tau", "beta"), [(0.03, 2.25e-4), (0.03, 1e-5), (0.04, 1e-3), (0.2, 0.02)]
)
@pytest.mark.parametrize("rest", [True, False], ids=["from rest", "running"])
def test_against_the_equation_of_second_order(tau, beta, rest):
    """Both fade alike; one fades at once; it swings."""
    begin = 0.0 if rest else -30.0 * GAIT.period

    def slope(t: float, state: np.ndarray) -> list[float]:
        phi, rate = state
        return [rate, (GAIT.angle(np.array([t]))[0] - phi - tau * rate) / beta]

    ends = (begin, TIMES[-1])
    accurate = {"rtol": 1e-9, "atol": 1e-11, "max_step": 0.05, "method": "LSODA"}
    phi, rate = solve_ivp(slope, ends, [GAIT.offset, 0.0], t_eval=TIMES, **accurate).y
    values = {"tau": tau, "beta": beta}
    made = CATALOGUE["servo_lag"].actuate(commanded(GAIT, rest), values).at(TIMES)
    np.testing.assert_allclose(made[0], phi, atol=2e-7)
    np.testing.assert_allclose(made[1], rate, atol=2e-6 + 1e-8 / beta)
    np.testing.assert_allclose(
        made[2], (GAIT.angle(TIMES) - made[0] - tau * made[1]) / beta, atol=1e-8 / beta
    )
