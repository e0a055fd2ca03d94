"""What is compiled gives the sweep the speeds that NumPy and cvodes give, and is never needed."""

import shutil

import numpy as np
import pytest

from rr_opt.model.ballast import with_inertia_ratio
from rr_opt.model.robot import EffectUse, Platform, Robot
from rr_opt.motion.dynamics import dynamics_of
from rr_opt.verify.speeds import resolved
from rr_opt.verify.steady_fourier import SteadyFourier
from tests.robots import BENCHMARK, with_friction
from tests.verify.cvodes import reference

needs_compiler = pytest.mark.skipif(not shutil.which("cc"), reason="there is no C compiler")
DRY = (EffectUse("coulomb_friction", {"force1": 0.006, "force2": 0.003}),)
DRAG = (EffectUse("quadratic_drag", {"coefficient_total": 0.3}),)
MANY = 10**6


@pytest.fixture(scope="module", autouse=True)
def own_cache(tmp_path_factory):
    patch = pytest.MonkeyPatch()
    patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
    yield
    patch.undo()


def random_robot(draw, effects):
    def platform(c):
        m, I, a, b = (
            draw.uniform(*box) for box in ((0.2, 0.8), (1e-3, 8e-3), (0, 0.08), (0.02, 0.06))
        )
        return Platform(m, I, c, a, b, kappa=draw.uniform(0.02, 0.4) * 0.02**2)

    one, two = platform(draw.uniform(0.15, 0.3)), platform(draw.uniform(0.04, 0.1))
    return Robot(one, two, h=0.02, physics=effects)


def compiled(robot):
    model = SteadyFourier(dynamics_of(robot))
    assert model.compiled(MANY)
    return model


def found(model, robot, gaits, tolerance=1e-6, ratios=None):
    alpha, phi0, T = gaits
    if ratios is None:
        which, robots = None, [robot]
    else:
        which, robots = np.arange(len(ratios)), [with_inertia_ratio(robot, one) for one in ratios]
    p = np.array([dynamics_of(robot).values(one) for one in robots]).T
    return resolved(model, robot, alpha, phi0, T, which, p, tolerance)


def numpy_alone(robot):
    model = SteadyFourier(dynamics_of(robot))
    model.compiled = lambda points: None
    return model


@needs_compiler
def test_viscous_friction_as_numpy():
    reach = BENCHMARK.singular_angle
    # From small to so near the singular posture that NumPy has to go on; every second one turns.
    alpha = np.array([0.05, 0.4, 0.9, 1.3, 1.6, reach - 0.16, reach - 1e-2, reach - 1e-4])
    phi0 = np.array([0.0, 0.2, 0.0, -0.3, 0.0, 0.15, 0.0, 0.0])
    gaits = alpha, phi0, np.tile(np.geomspace(0.3, 3.0, 9), (8, 1))
    ratios = np.linspace(0.2, 0.6, 8)
    fast = found(compiled(BENCHMARK), BENCHMARK, gaits, ratios=ratios)
    slow = found(numpy_alone(BENCHMARK), BENCHMARK, gaits, ratios=ratios)
    np.testing.assert_array_equal(fast.converged, slow.converged)
    assert fast.converged[:-1].all()
    # NumPy does a row over with more samples where one of its points needs them.
    for one, other, close in zip(fast[:3], slow[:3], (1e-6, 1e-6, 1e-5), strict=True):
        np.testing.assert_allclose(one, other, rtol=close, atol=1e-9)


@needs_compiler
@pytest.mark.parametrize("effects", [DRY, DRAG], ids=lambda effects: effects[0].name)
@pytest.mark.parametrize("seed", [11, 12])
def test_other_friction_as_cvodes(effects, seed):
    draw = np.random.default_rng(seed)
    robot = random_robot(draw, effects)
    alpha = draw.uniform(0.2, 0.8, 3) * robot.singular_angle
    phi0, T = np.array([0.0, 0.15, -0.2]), draw.uniform(0.4, 2.0, (3, 1))
    seen = found(compiled(robot), robot, (alpha, phi0, T))
    assert seen.converged.all()
    for k in range(3):
        true = reference(robot, (alpha[k], T[k, 0], phi0[k]))
        assert seen.speed[k, 0] == pytest.approx(true.speed, rel=1e-6)
        assert seen.turn[k, 0] == pytest.approx(true.turn, rel=1e-6, abs=1e-9)
        assert seen.peak_torque[k, 0] == pytest.approx(true.peak_torque, rel=1e-4)


@needs_compiler
@pytest.mark.parametrize("offset", [-0.25, 0.25])
def test_a_turn_with_dry_friction_may_take_many_samples(offset):
    one = Platform(0.469, 0.00386, 0.236, 0.05, 0.05, 2e-5)
    two = Platform(0.25, 0.3 * 0.00386, 0.0941, 0.05, 0.05, 2e-5)
    dry = (EffectUse("coulomb_friction", {"force1": 0.01, "force2": 0.01}),)
    robot = with_inertia_ratio(Robot(one, two, h=0.02, physics=dry), 0.8 / 3)
    gaits = np.array([3.25 / 3]), np.array([offset]), np.array([[0.3]])
    fast = found(compiled(robot), robot, gaits, tolerance=2e-7)
    assert fast.converged.all()
    true = reference(robot, (3.25 / 3, 0.3, offset))
    assert fast.speed[0, 0] == pytest.approx(true.speed, rel=1e-6)


@needs_compiler
def test_every_point_has_its_own_place():
    # More than one piece of work, and no whole number of vectors.
    draw, count = np.random.default_rng(3), 4999
    gaits = draw.uniform(0.1, 1.5, count), np.zeros(count), draw.uniform(0.4, 2.0, (count, 1))
    model = compiled(BENCHMARK)
    whole = found(model, BENCHMARK, gaits)
    for k in draw.integers(0, count, 20):
        alone = found(model, BENCHMARK, tuple(part[[k]] for part in gaits))
        assert whole.speed[k, 0] == pytest.approx(alone.speed[0, 0], rel=1e-6)


@needs_compiler
def test_no_friction_no_steady_cycle():
    robot = with_friction(0.0)
    gaits = np.array([0.5, 0.5]), np.array([0.0, 0.2]), np.full((2, 1), 1.2)
    seen = found(compiled(robot), robot, gaits)
    assert not seen.converged.any()
    assert np.isnan(seen.speed).all()


def test_without_a_compiler(monkeypatch, tmp_path):
    monkeypatch.setenv("CC", "no-such-compiler")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    model = SteadyFourier(dynamics_of(BENCHMARK))
    assert model.compiled(MANY) is None
    gaits = np.array([0.5]), np.array([0.0]), np.array([[1.2]])
    assert found(model, BENCHMARK, gaits).converged.all()


@needs_compiler
def test_few_points_are_not_worth_compiling(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    model = SteadyFourier(dynamics_of(BENCHMARK))
    assert model.compiled(100) is None
    assert model.compiled(MANY)
    # What was compiled once is there at once.
    assert SteadyFourier(dynamics_of(BENCHMARK)).compiled(1)
