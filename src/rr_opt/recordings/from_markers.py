"""From markers to motion: where the joint P was, and the angles psi and phi, frame by frame."""

from __future__ import annotations

from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from rr_opt.experiment.recording import CHANNELS, Flag, Recording
from rr_opt.recordings.bodies import Bodies, bodies_of
from rr_opt.recordings.doubts import Doubt, texts
from rr_opt.recordings.exchanges import Order
from rr_opt.recordings.fit_noise import marker_noise
from rr_opt.recordings.floor_frame import seen_from_above, tilt
from rr_opt.recordings.ghosts import Ghosts
from rr_opt.recordings.layout import Layout
from rr_opt.recordings.layout_scale import check_scale
from rr_opt.recordings.marker_doubts import marker_doubts
from rr_opt.recordings.markers_file import MarkerData
from rr_opt.recordings.rigid import Fit, fit
from rr_opt.recordings.robot_markers import LEAST_NOISE, robot_of
from rr_opt.recordings.swaps import Swap, swapped_throughout
from rr_opt.recordings.unknown_layout import guessed_layout
from rr_opt.recordings.wrapping import unwrapped

Array = NDArray[np.float64]

_FARTHEST = 1e12
"""Places beyond this, m, are no places, and would overflow where they are squared."""


@dataclass(frozen=True)
class MarkerFit:
    """What was made of a marker file.

    recording  the motion of P and both angles
    bodies     the markers, where the recording has them
    shift      (k, 2), by how much they are from where the layout has them, m
    noise      of a marker's coordinate as the residuals have it, m; NaN if they cannot tell
    residual   (n,), root mean square of a frame's residuals per coordinate, corrected for the
               unknowns, m
    whose      (k,), the same of a marker over all frames in which it was used, m
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
    doubts: tuple[Doubt, ...]


def recording_from_markers(
    data: MarkerData, layout: Layout | None, noise_sigma: float | None = None
) -> Recording:
    """The recording that a marker file holds; its doubts tell what was put right or left out.

    layout: None has it estimated from the file itself; psi's and phi's zeros are then unknown.
    noise_sigma: standard deviation of one coordinate of a marker, m; None takes the residuals'.
    Raises InputError if the markers cannot be matched with two platforms.
    """
    return fit_markers(data, layout, noise_sigma).recording


def fit_markers(
    data: MarkerData, layout: Layout | None, noise_sigma: float | None = None
) -> MarkerFit:
    """The same, with all that was found on the way. Raises InputError as above."""
    guess = None
    if layout is None:
        above = seen_from_above(_places(data), "z")[0]
        guess = guessed_layout(data.labels, above)
        layout = guess.layout
    bodies = bodies_of(layout, data.labels)
    seen, height = seen_from_above(_places(data)[:, bodies.columns], layout.up)
    always = swapped_throughout(bodies, seen)
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
        np.sqrt(_mean(fitted.residual**2)),
        tilt(bodies, height), tuple(swaps), ghosts, (),
    )  # fmt: skip
    doubts = marker_doubts(data, layout, made, guess, always, noise_sigma)
    return replace(made, doubts=doubts, recording=_told(made.recording, data, doubts))


def _places(data: MarkerData) -> Array:
    """The positions (n, k, 3), without those that are none."""
    return np.where(np.abs(data.positions) < _FARTHEST, data.positions, np.nan)


def _renamed(bodies: Bodies, order: Order) -> Bodies:
    """The columns keep their names, and get the places of the markers that are in them."""
    places, platform, heights = (
        np.empty_like(one) for one in (bodies.places, bodies.platform, bodies.heights)
    )
    columns = list(order)
    places[columns], platform[columns] = bodies.places, bodies.platform
    heights[columns] = bodies.heights
    return replace(bodies, places=places, platform=platform, heights=heights)


def _mean(squares: Array) -> Array:
    """Over frames and both axes of (n, k, 2); NaN of a marker that was never used."""
    count = np.isfinite(squares).sum(axis=(0, 2))
    return np.nansum(squares, axis=(0, 2)) / np.where(count > 0, count, np.nan)


def _recording(data: MarkerData, fitted: Fit, sigma: float, lost: NDArray[np.int_]) -> Recording:
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


def _told(recording: Recording, data: MarkerData, doubts: tuple[Doubt, ...]) -> Recording:
    source = {**data.source, "motion": "a rigid fit of both platforms to the markers, by frame"}
    return replace(
        recording, source=MappingProxyType(source), doubts=(*data.doubts, *texts(doubts))
    )
