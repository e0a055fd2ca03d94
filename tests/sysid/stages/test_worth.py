"""A block is worth what plain least squares gains by it, and chi-square where there is nothing."""

import numpy as np
from scipy.stats import kstest

from rr_opt.machines.racer.stages.gram import Gram, products

RNG = np.random.default_rng(3)
LOCAL, ALWAYS, BLOCK = (
    RNG.normal(size=(400, 5)),
    RNG.normal(size=(400, 3)),
    RNG.normal(size=(400, 4)),
)
BLOCK[:, 3] = BLOCK[:, 0] + ALWAYS[:, 1]


def gram(r: np.ndarray) -> Gram:
    S = products(LOCAL, np.column_stack([ALWAYS, BLOCK, r]))
    return Gram(S, {"always": slice(0, 3), "block": slice(3, 7)}, ("always",), r.size)


def left(columns: list[np.ndarray], r: np.ndarray) -> float:
    A = np.column_stack(columns)
    return float(np.sum((r - A @ np.linalg.lstsq(A, r, rcond=None)[0]) ** 2))


def test_the_gain_and_the_rank_are_those_of_least_squares():
    r = RNG.normal(size=400) + BLOCK[:, 1]
    worth = gram(r).worth("block")
    assert np.isclose(worth.chi2, left([LOCAL, ALWAYS], r) - left([LOCAL, ALWAYS, BLOCK], r))
    assert worth.dof == 3


def test_chances_are_uniform_where_there_is_noise_alone():
    chances = [gram(RNG.normal(size=400)).worth("block").p for _ in range(400)]
    assert kstest(chances, "uniform").pvalue > 0.01


def test_coefficients_and_their_spread_are_those_of_least_squares():
    r = RNG.normal(size=400)
    own = Gram(
        products(LOCAL, np.column_stack([ALWAYS, BLOCK[:, :3], r])),
        {"always": slice(0, 3), "block": slice(3, 6)},
        ("always",),
        400,
    )
    A = np.column_stack([BLOCK[:, :3], LOCAL, ALWAYS])
    theta, spread = own.fitted(("block",))
    assert np.allclose(theta, np.linalg.lstsq(A, r, rcond=None)[0][:3])
    assert np.allclose(spread, np.linalg.inv(A.T @ A)[:3, :3])
