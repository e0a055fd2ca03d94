"""The motion of P and both angles from the markers of a file, and what is odd about them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.formatting import counted
from rr_opt.messages import listed
from rr_opt.model.experiment import CHANNELS, Flag, Layout, Recording
from rr_opt.recordings.cleaning import unwrapped
from rr_opt.recordings.markers.calibration import Calibration, calibration
from rr_opt.recordings.markers.rigid import (
    Bodies,
    Complex,
    RigidFit,
    bodies_of,
    check_scale,
    fit,
    marker_noise,
    places_of,
    refined,
    seen_from_above,
)
from rr_opt.recordings.markers.swaps import (
    Ghosts,
    Order,
    Swap,
    members,
    put_right,
    swapped_throughout,
    without_ghosts,
)
from rr_opt.recordings.readers.marker_rows import MarkerData, carriers
from rr_opt.recordings.warnings import Notice, notice, when

_FEWEST = 3
"""Markers of a platform that show its tilt."""


def tilt(bodies: Bodies, height: Array) -> Array:
    """How steeply each platform leans against its own mean over the recording (n, 2), rad.

    height: (n, k), m. The largest slope of the plane through a platform's markers; NaN for frames
    and platforms with fewer than three, or with all in a line.
    """
    found = np.full((len(height), 2), np.nan)
    for one in (0, 1):
        mine = bodies.of(one)
        if len(mine) < _FEWEST:
            continue
        flat = np.column_stack([np.ones(len(mine)), bodies.places[mine]])
        whole = np.isfinite(height[:, mine]).all(axis=1)
        if np.linalg.matrix_rank(flat, tol=5e-3) < _FEWEST or not whole.any():
            continue
        own = height[whole][:, mine]
        slopes = (own - np.median(own, axis=0)) @ np.linalg.pinv(flat).T
        found[whole, one] = np.hypot(slopes[:, 1], slopes[:, 2])
    return found


_SAMPLE = 6000
"""Frames from which the noise is estimated, spread over the recording."""
LEAST_NOISE = 1e-6
"""Least noise of any capture system, m; assumed for noise-free data."""


def robot_of(
    bodies: Bodies, seen: Array, noise_sigma: float | None
) -> tuple[Bodies, Array, Array, list[Swap], Ghosts]:
    """Shapes first, as they decide what fits; then swapped names; if there were any, both again.

    The second round uses the noise without swaps. Ghosts come last.
    """
    swaps: list[Swap] = []
    while True:
        new, shift = refined(bodies, seen)
        found = marker_noise(fit(new, seen[:: max(1, len(seen) // _SAMPLE)]))
        sigma = max(np.nan_to_num(found), noise_sigma or 0.0, LEAST_NOISE)
        if bodies.lever is not None:  # points of a pose are those of one body
            return new, shift, seen, swaps, without_ghosts(new, seen, sigma, most=0)
        seen, more = put_right(new, seen, sigma)
        again = bool(more) and not swaps
        swaps += more
        if not again:
            return new, shift, seen, swaps, without_ghosts(new, seen, sigma)


@dataclass(frozen=True)
class MarkerFit:
    """The result of fitting a marker file.

    recording  the motion of P and both angles
    bodies     the markers, at their places in the recording
    shift      (k, 2), their distances from the layout's places, m
    noise      of a marker's coordinate from the residuals, m; NaN if they do not determine it
    residual   (n,), root mean square of a frame's residuals per coordinate, corrected for the
               unknowns, m
    whose      (k,), the same for each marker over all frames in which it was used, m
    tilt       (n, 2), of each platform against its own mean, rad
    """

    recording: Recording
    bodies: Bodies
    shift: Array
    noise: float
    residual: Array
    whose: Array
    tilt: Array
    swaps: tuple[Swap, ...]
    ghosts: Ghosts
    doubts: tuple[Notice, ...]


def fit_markers(
    data: MarkerData, known: Layout | Calibration | None, noise_sigma: float | None = None
) -> MarkerFit:
    """The motion in a marker file, and all that was detected, corrected and left out.

    known: the layout, or where it was learnt; None: from the file itself.
    noise_sigma: standard deviation of one coordinate of a marker, m; None takes the residuals'.
    Raises InputError if the markers cannot be matched with two platforms.
    """
    if known is None:
        known = calibration([data])
    learnt = known if isinstance(known, Calibration) else None
    layout = known.layout if isinstance(known, Calibration) else known
    bodies = bodies_of(layout, data.labels, data.lever)
    seen, height = seen_from_above(places_of(data)[:, bodies.columns], layout.up)
    always = swapped_throughout(bodies, seen) if data.lever is None else None
    if always:
        bodies = _renamed(bodies, always)
    check_scale(bodies, seen, layout.up)
    bodies, shift, seen, swaps, ghosts = robot_of(bodies, seen, noise_sigma)
    fitted = fit(bodies, ghosts.seen)
    noise = marker_noise(fitted)
    sigma = max(noise_sigma or (noise if np.isfinite(noise) else LEAST_NOISE), LEAST_NOISE)
    made = MarkerFit(
        _recording(data, fitted, sigma, ghosts.lost),
        bodies, shift, noise,
        np.sqrt(fitted.squares / np.where(fitted.freedom > 0, fitted.freedom, np.nan)),
        _rms(fitted.residual),
        tilt(bodies, height), tuple(swaps), ghosts, (),
    )  # fmt: skip
    doubts = (
        *_of_layout(data, layout, made, learnt),
        *_of_names(data, made, always),
        *_of_ghosts(data, made),
        *_of_noise(made, noise_sigma),
        *_of_tilt(data, made),
    )
    source = {**data.source, "motion": "a rigid fit of both platforms to the markers, by frame"}
    recording = replace(
        made.recording, source=MappingProxyType(source), doubts=(*data.doubts, *doubts)
    )
    return replace(made, doubts=doubts, recording=recording)


def _renamed(bodies: Bodies, order: Order) -> Bodies:
    """The columns keep their names, and get the places of the markers that they hold."""
    of = np.argsort(order)
    return replace(
        bodies, places=bodies.places[of], platform=bodies.platform[of], heights=bodies.heights[of]
    )


def _rms(residual: Complex) -> Array:
    """Of a marker's coordinates, over the frames of (n, k); NaN of one that was never used."""
    count = 2 * np.isfinite(residual).sum(axis=0)
    return np.sqrt(np.nansum(np.abs(residual) ** 2, axis=0) / np.where(count > 0, count, np.nan))


def _recording(
    data: MarkerData, fitted: RigidFit, sigma: float, lost: NDArray[np.int_]
) -> Recording:
    turned = fitted.heading[:, 1] - fitted.heading[:, 0]
    values = {
        "x": fitted.joint[:, 0],
        "y": fitted.joint[:, 1],
        "psi": unwrapped(fitted.heading[:, 0]),
        "phi": unwrapped((turned + np.pi) % (2 * np.pi) - np.pi),
    }
    sigmas, flags = {}, {}
    for i, channel in enumerate(CHANNELS):
        missing = ~np.isfinite(values[channel])
        values[channel] = np.where(missing, np.nan, values[channel])
        flag = np.where(missing, Flag.MISSING, 0).astype(np.uint8)
        flag[lost] |= np.uint8(Flag.OUTLIER)
        spread = sigma * fitted.spread[:, i]
        known = np.isfinite(spread) & ~missing
        # What is not there has the typical sigma, so that nobody divides by NaN.
        usual = float(np.median(spread[known])) if known.any() else sigma
        sigmas[channel], flags[channel] = np.where(known, spread, usual), flag
    return Recording(data.name, data.t, values, sigmas, flags)


_MATTERS = 0.5
"""Least displacement of a marker that is reported, relative to the noise."""
_STATED = 1.5
"""Ratio of the residuals to the stated noise from which they contradict it."""
_TILTS = 6.0
"""Ratio to the typical tilt from which a frame's tilt is reported."""


def _of_layout(
    data: MarkerData, layout: Layout, made: MarkerFit, learnt: Calibration | None
) -> Iterator[Notice]:
    if learnt is not None:
        yield learnt.notice
    used = set(made.bodies.labels)
    absent = [name for name in [*layout.platform1, *layout.platform2] if name not in used]
    if absent:
        yield notice("layout.absent", names=", ".join(carriers(absent)))
    extra = [name for name in data.labels if name not in used]
    if extra:
        yield notice("layout.unused", names=", ".join(carriers(extra)))
    off = np.hypot(*made.shift.T)
    if learnt is None and off.max() > _MATTERS * np.nan_to_num(made.noise):
        worst, count = int(off.argmax()), int((off > 0).sum())
        name = made.bodies.labels[worst]
        yield notice("layout.moved", name=name, off=1e3 * off[worst], count=count)


def _of_names(data: MarkerData, made: MarkerFit, always: Order | None) -> Iterator[Notice]:
    names = made.bodies.labels
    if always:
        yield notice("swap.always", names=listed(names[i] for i in members(always)))
    together: dict[tuple[int, ...], list[int]] = {}
    for swap in made.swaps:
        together.setdefault(swap.members, []).extend(swap.frames.tolist())
    for several, frames in together.items():
        both = listed(names[i] for i in several)
        yield notice("swap.frames", names=both, **_frames(data, sorted(frames)))


def _frames(data: MarkerData, rows: Sequence[int] | NDArray[np.int_]) -> dict[str, str]:
    return {"frames": counted(len(rows), "frame"), "when": when(data.t, rows)}


def _of_ghosts(data: MarkerData, made: MarkerFit) -> Iterator[Notice]:
    for i, name in enumerate(made.bodies.labels):
        rows = np.flatnonzero(made.ghosts.out[:, i])
        if len(rows):
            off = _off(made, i, rows)
            yield notice("ghost.marker", name=name, off=off, **_frames(data, rows))
    if len(made.ghosts.lost):
        yield notice("lost.frames", **_frames(data, made.ghosts.lost))


def _off(made: MarkerFit, i: int, rows: NDArray[np.int_]) -> str:
    """The marker's displacement, as part of a sentence."""
    where, values = made.bodies.platform[i], made.recording.values
    heading = values["psi"] + (values["phi"] if where else 0.0)
    forward, left = made.bodies.places[i]
    fitted = values["x"] + 1j * values["y"] + (forward + 1j * left) * np.exp(1j * heading)
    off = np.abs(made.ghosts.left_out[rows, i] - fitted[rows])
    off = off[np.isfinite(off)]
    return f" (off by up to {1e3 * off.max():.0f} mm)" if len(off) else ""


def _of_noise(made: MarkerFit, noise_sigma: float | None) -> Iterator[Notice]:
    if noise_sigma and made.noise > _STATED * noise_sigma:
        yield notice("noise.markers", noise=1e3 * made.noise, stated=1e3 * noise_sigma)


def _of_tilt(data: MarkerData, made: MarkerFit) -> Iterator[Notice]:
    """A notice on frames in which a platform leans more than it usually does."""
    for one in (0, 1):
        lean = np.degrees(made.tilt[:, one])
        known = np.isfinite(lean)
        if known.sum() < 20:
            continue
        usual = float(np.median(lean[known]))
        rows = np.flatnonzero(known & (lean > max(_TILTS * usual, np.degrees(0.01))))
        if len(rows):
            most = np.nanmax(lean)
            yield notice(
                "tilt.platform", platform=one + 1, most=most, usual=usual, **_frames(data, rows)
            )
