"""Speed, heading per cycle and radius do not depend on the phase at which a period is cut."""

import numpy as np
import pytest

from rr_opt.model.gait import SineGait
from rr_opt.motion.steady_cycle import cycle_of, reference_cycle, steady_cycle
from tests.robots import BENCHMARK

GAIT = SineGait(1.2, 2.4, 0.4)


@pytest.fixture(scope="module")
def steady():
    return reference_cycle(BENCHMARK, GAIT, samples=512)


def cut_at(steady, k):
    """The period from sample k on, the rest of it moved on by one cycle."""
    dpsi = steady.cycle.dpsi
    moved = np.exp(1j * dpsi) * (steady.x + 1j * steady.y) + steady.x[-1] + 1j * steady.y[-1]
    path = np.concatenate([(steady.x + 1j * steady.y)[k:-1], moved[: k + 1]])
    psi = np.concatenate([steady.psi[k:-1], steady.psi[: k + 1] + dpsi])
    return path.real, path.imag, psi


@pytest.mark.parametrize("k", [1, 100, 256, 411])
def test_any_cut(steady, k):
    x, y, psi = cut_at(steady, k)
    other = cycle_of(GAIT.period, x, y, psi)
    assert other.speed == pytest.approx(steady.speed, rel=1e-10)
    assert other.dpsi == pytest.approx(steady.cycle.dpsi, rel=1e-10)
    assert other.radius == pytest.approx(steady.cycle.radius, rel=1e-10)


def test_the_chord_does_depend_on_the_cut(steady):
    chords = [
        np.hypot(x[-1] - x[0], y[-1] - y[0]) for x, y, _ in (cut_at(steady, k) for k in (0, 256))
    ]
    assert max(chords) > 1.1 * min(chords)


def test_mirror_image(steady):
    other = reference_cycle(BENCHMARK, SineGait(1.2, 2.4, -0.4), samples=512)
    assert other.speed == pytest.approx(steady.speed, rel=1e-8)
    assert other.cycle.dpsi == pytest.approx(-steady.cycle.dpsi, rel=1e-8)
    assert other.cycle.radius == pytest.approx(steady.cycle.radius, rel=1e-8)


def test_no_jump_towards_straight():
    offsets = np.logspace(-9, 0, 37)
    straight = steady_cycle(BENCHMARK, SineGait(0.7, 1.4, 0.0))
    cycles = [steady_cycle(BENCHMARK, SineGait(0.7, 1.4, offset)).cycle for offset in offsets]
    speeds = np.array([cycle.speed for cycle in cycles])
    # dspeed/dphi0 vanishes at 0 by symmetry, so neighbours differ by less than the offset squared.
    assert np.all(np.abs(speeds - straight.speed) <= 2 * offsets**2 + 1e-12)
    curvature = np.array([cycle.dpsi for cycle in cycles]) / offsets
    assert np.all(np.abs(np.diff(curvature[offsets < 1e-2])) < 1e-3 * np.abs(curvature[0]))
    assert straight.cycle.speed == pytest.approx(
        np.hypot(straight.cycle.dx, straight.cycle.dy) / 1.4, rel=1e-10
    )
