"""The fit of every frame is the least-squares fit, and its sigmas are those of its errors."""

import numpy as np
from scipy.optimize import least_squares

from rr_opt.model.experiment import Layout
from rr_opt.recordings.markers.rigid import bodies_of, fit
from tests.recordings.clean.world import LAYOUT, markers, motion

SIGMA = 5e-4


def scene(seed=0, missing=0.0):
    data = markers(motion(), SIGMA, seed)
    seen = data.positions[..., :2].copy()
    seen[np.random.default_rng(seed + 1).random(seen.shape[:2]) < missing] = np.nan
    return bodies_of(LAYOUT, data.labels), seen


def off(angle):
    return np.angle(np.exp(1j * angle))


def test_a_general_solver_finds_the_same_frame_by_frame():
    bodies, seen = scene(missing=0.1)
    fitted = fit(bodies, seen)
    for i in range(0, 3000, 500):
        used = np.isfinite(seen[i, :, 0])

        def left(p, i=i, used=used):
            heading = p[2:][bodies.platform]
            place = bodies.places @ [1, 1j] * np.exp(1j * heading) + p[0] + 1j * p[1]
            miss = (seen[i] @ [1, 1j] - place)[used]
            return np.concatenate([miss.real, miss.imag])

        start = [*fitted.joint[i], *fitted.heading[i]]
        best = least_squares(left, start, xtol=1e-14, ftol=1e-14, gtol=1e-14)
        # Rotations curve: the platforms disagree on P by some sigma, over centimetres.
        np.testing.assert_allclose(best.x, start, atol=2e-4)
        assert abs(2 * best.cost - fitted.squares[i]) < 1e-3 * SIGMA**2 * fitted.freedom[i]


def poses(seed, place=1e-3, angle=5e-3):
    """Of two bodies, as points: their origins have noise `place`, their headings `angle`."""
    rng, moved = np.random.default_rng(seed), motion()
    points = []
    for heading, sizes in ((moved.psi, (0.11, 0.03, 0.7)), (moved.psi + moved.phi, (-0.05, 0, 2))):
        at = moved.x + 1j * moved.y + complex(*sizes[:2]) * np.exp(1j * heading)
        at = at + place * (rng.normal(size=at.size) + 1j * rng.normal(size=at.size))
        ahead = 0.1 * np.exp(1j * (heading + sizes[2] + angle * rng.normal(size=at.size)))
        points += [at, at + ahead, at + 1j * ahead]
    seen = np.stack(points, 1)
    first, second = (
        {f"{name} {i}": (z.real, z.imag) for i, z in enumerate((at, at + ahead, at + 1j * ahead))}
        for name, at, ahead in (
            ("a", 0.11 + 0.03j, 0.1 * np.exp(0.7j)),
            ("b", -0.05 + 0j, 0.1 * np.exp(2j)),
        )
    )
    bodies = bodies_of(Layout(first, second), [*first, *second], place / angle)
    return bodies, np.stack([seen.real, seen.imag], -1)


def test_of_poses_it_is_that_of_places_and_headings():
    place, angle = 1e-3, 5e-3
    bodies, seen = poses(1, place, angle)
    fitted = fit(bodies, seen)
    origins = seen[:, [0, 3]] @ [1, 1j]
    measured = np.angle((seen[:, [1, 4]] - seen[:, [0, 3]]) @ [1, 1j]) - [0.7, 2]
    for i in range(0, 3000, 500):

        def left(p, i=i):
            miss = origins[i] - p[0] - 1j * p[1] - [0.11 + 0.03j, -0.05] * np.exp(1j * p[2:])
            return np.concatenate([miss.real, miss.imag, place / angle * off(measured[i] - p[2:])])

        start = [*fitted.joint[i], *fitted.heading[i]]
        best = least_squares(left, start, xtol=1e-14, ftol=1e-14, gtol=1e-14)
        np.testing.assert_allclose(best.x, start, atol=3e-4)
        assert abs(2 * best.cost - fitted.squares[i]) < 0.02 * place**2
    errors = fitted.joint[:, 0] - motion().x, off(fitted.heading[:, 0] - motion().psi)
    for error, spread in zip(errors, fitted.spread[:, [0, 2]].T, strict=True):
        assert abs((error / (place * spread)).std() - 1) < 0.05
    assert abs(np.sqrt(fitted.squares.mean() / fitted.freedom.mean()) / place - 1) < 0.03


def test_without_noise_it_is_the_motion_itself():
    data = markers(motion(), 0.0, 0)
    fitted = fit(bodies_of(LAYOUT, data.labels), data.positions[..., :2])
    np.testing.assert_allclose(fitted.joint[:, 0], motion().x, atol=1e-12)
    np.testing.assert_allclose(off(fitted.heading[:, 0] - motion().psi), 0, atol=1e-12)
    np.testing.assert_allclose(off(np.diff(fitted.heading)[:, 0] - motion().phi), 0, atol=1e-12)


def test_errors_have_the_sigmas_that_are_told():
    moved = motion()
    bodies, seen = scene(seed=5, missing=0.15)
    fitted = fit(bodies, seen)
    errors = np.stack(
        [
            fitted.joint[:, 0] - moved.x,
            fitted.joint[:, 1] - moved.y,
            off(fitted.heading[:, 0] - moved.psi),
            off(fitted.heading[:, 1] - fitted.heading[:, 0] - moved.phi),
        ],
        1,
    )
    for error, sigma in zip(errors.T, SIGMA * fitted.spread.T, strict=True):
        scaled = (error / sigma)[np.isfinite(error)]
        assert len(scaled) > 2900
        assert abs(scaled.std() - 1) < 0.05
        assert abs(scaled.mean()) < 0.08


def test_the_residuals_tell_the_noise():
    bodies, seen = scene(seed=3, missing=0.2)
    fitted = fit(bodies, seen)
    noise = np.sqrt(fitted.squares.sum() / fitted.freedom.sum())
    assert abs(noise / SIGMA - 1) < 0.02
