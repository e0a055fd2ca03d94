"""T is chi-square where runs share their values, and large where they do not."""

from dataclasses import dataclass, field
from types import SimpleNamespace

import numpy as np
import pytest

from rr_opt.sysid.constancy import constancy

RUNS, VALUES, SAMPLES = 7, 4, 60
NAMES = ("a", "b", "drag.k", "drag.n")
FORM = 0.5
"""By which machines differ from any model, RMS in sigma."""


@dataclass
class LinearFit:
    """y = X (value/scale) + noise in every run, solved with a wide prior."""

    J: list
    y: list
    problem: SimpleNamespace = field(init=False)

    def __post_init__(self):
        self.prior = np.full(VALUES, 1e-6)
        H = np.diag(self.prior) + sum(J.T @ J for J in self.J)
        self.u = np.linalg.solve(H, sum(J.T @ y for J, y in zip(self.J, self.y, strict=True)))
        self.evidences = {
            k: SimpleNamespace(H=J.T @ J, g=J.T @ (J @ self.u - y), value=0.0, log=0.0)
            for k, (J, y) in enumerate(zip(self.J, self.y, strict=True))
        }
        self.problem = SimpleNamespace(
            names=NAMES,
            box=(np.full(VALUES, -np.inf), np.full(VALUES, np.inf)),
            prior=self.prior,
            centre=np.zeros(VALUES),
            scale=np.ones(VALUES),
            samples=dict.fromkeys(range(RUNS), float(SAMPLES)),
            correlation_times=lambda _: 10.0,
            model=SimpleNamespace(form_error=FORM),
        )


def drawn(rng, spread=0.0):
    """Runs with the values 1, each changed by a relative spread of its own."""
    J = [rng.normal(size=(SAMPLES, VALUES)) * [1, 30, 0.3, 5] for _ in range(RUNS)]
    y = [one @ (1 + spread * rng.normal(size=VALUES)) + rng.normal(size=SAMPLES) for one in J]
    return LinearFit(J, y)


def constancy_of(fit, explained=0.0, form=0.0, left=0.0):
    return constancy(fit, left, dict.fromkeys(range(RUNS), explained), {"drag": form})


def test_as_large_as_expected_where_values_are_constant():
    found = [constancy_of(drawn(np.random.default_rng(k))) for k in range(300)]
    ratios = [one.statistic / one.degrees for one in found]
    assert found[0].degrees == RUNS * VALUES
    assert np.mean(ratios) == pytest.approx(1.0, abs=0.05)
    assert np.mean([one.probability > 0.5 for one in found]) > 0.95


def test_the_same_by_the_runs_own_optima():
    fit = drawn(np.random.default_rng(1), 0.1)
    total = 0.0
    for k in range(RUNS):
        others = [j for j in range(RUNS) if j != k]
        A = np.diag(fit.prior) + sum(fit.J[j].T @ fit.J[j] for j in others)
        rest = np.linalg.solve(A, sum(fit.J[j].T @ fit.y[j] for j in others))
        B = fit.J[k].T @ fit.J[k]
        own = np.linalg.solve(B, fit.J[k].T @ fit.y[k])
        off = own - rest
        total += off @ np.linalg.solve(np.linalg.inv(A) + np.linalg.inv(B), off)
    assert constancy_of(fit).statistic == pytest.approx(total, rel=1e-6)


def test_values_that_differ_from_run_to_run_are_seen():
    for seed in range(20):
        assert constancy_of(drawn(np.random.default_rng(seed), 0.1)).probability < 0.01


def test_machines_may_differ_from_models():
    rng = np.random.default_rng(2)
    J = [rng.normal(size=(SAMPLES, VALUES)) * 30 for _ in range(RUNS)]
    values = [np.append(np.ones(2), 1 + 0.05 * rng.normal(size=2)) for _ in J]
    y = [one @ v + rng.normal(size=SAMPLES) for one, v in zip(J, values, strict=True)]
    fit = LinearFit(J, y)
    assert constancy_of(fit).probability < 0.01
    assert constancy_of(fit, form=0.05).probability > 0.5
    assert (
        constancy_of(fit, explained=30.0**2, form=0.05).statistic
        < constancy_of(fit, form=0.05).statistic
    )


def test_a_run_that_differs_more_from_its_model_spoils_no_other():
    """The others' values are as uncertain as the worst of their models makes them."""
    ratios = []
    explained = {0: 20.0**2}
    for seed in range(200):
        rng = np.random.default_rng(seed)
        J = [np.repeat(rng.normal(size=(10, VALUES)), 6, axis=0) * 30 for _ in range(RUNS)]
        J[0] *= 5
        J[1] *= 5
        y = [one @ np.ones(VALUES) + rng.normal(size=SAMPLES) for one in J]
        y[0] += 0.05 * 20.0 * np.repeat(rng.normal(size=10), 6)
        found = constancy(LinearFit(J, y), 0.0, explained, {"none": 0.05})
        ratios.append(found.statistic / found.degrees)
    assert np.mean(ratios) == pytest.approx(1.0, rel=0.1)


def test_a_value_at_a_bound_is_known():
    """Runs pull it beyond, each as far as its noise; without it they agree."""
    rng = np.random.default_rng(3)
    J = [rng.normal(size=(SAMPLES, VALUES)) * 30 for _ in range(RUNS)]
    values = [np.append(1 + 0.1 * rng.normal(), np.ones(VALUES - 1)) for _ in J]
    y = [one @ v + rng.normal(size=SAMPLES) for one, v in zip(J, values, strict=True)]
    fit = LinearFit(J, y)
    assert constancy_of(fit).probability < 0.01
    fit.problem.box[0][0] = fit.u[0]
    assert constancy_of(fit).degrees == RUNS * (VALUES - 1)


def test_what_machines_differ_by_from_any_model_is_slow():
    """Noise, and an error of the model that lasts for a correlation time, six samples."""
    ratios = []
    for seed in range(200):
        rng = np.random.default_rng(seed)
        # Slow motion, as only that makes slow errors count.
        J = [np.repeat(rng.normal(size=(10, VALUES)), 6, axis=0) * 30 for _ in range(RUNS)]
        slow = [FORM * np.repeat(rng.normal(size=10), 6) for _ in J]
        y = [
            a @ np.ones(VALUES) + b + rng.normal(size=SAMPLES) for a, b in zip(J, slow, strict=True)
        ]
        fit = LinearFit(J, y)
        plain, allowed = constancy_of(fit), constancy_of(fit, left=3.0)
        ratios.append((plain.statistic / plain.degrees, allowed.statistic / allowed.degrees))
    assert np.mean(ratios, axis=0) == pytest.approx([1 + FORM**2 * 6, 1.0], rel=0.1)
    # No more is allowed for than is left.
    assert constancy_of(fit, left=0.1).statistic == pytest.approx(plain.statistic / 1.06)


def test_nothing_is_known_without_values():
    fit = SimpleNamespace(problem=SimpleNamespace(names=()))
    assert constancy(fit, 0.0).probability == 0.5
