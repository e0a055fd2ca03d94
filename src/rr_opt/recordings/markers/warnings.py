"""What the rigid fit says about a marker file, in sentences."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from rr_opt.recordings.markers.layout import Layout
from rr_opt.recordings.markers.swaps import Order, members
from rr_opt.recordings.markers.unknown_layout import Guessed
from rr_opt.recordings.readers.marker_rows import MarkerData
from rr_opt.recordings.warnings import Doubt, frames_text, when

if TYPE_CHECKING:
    from rr_opt.recordings.markers.pose import MarkerFit


_TILTS = 6.0
"""Times the typical tilt from which on a frame's is told."""


def tilt_doubts(data: MarkerData, made: MarkerFit) -> Iterator[Doubt]:
    """Of frames in which a platform leans more than it usually does."""
    for one in (0, 1):
        lean = made.tilt[:, one]
        known = np.isfinite(lean)
        if known.sum() < 20:
            continue
        usual = float(np.median(lean[known]))
        rows = np.flatnonzero(known & (lean > max(_TILTS * usual, 0.01)))
        if len(rows):
            yield Doubt(
                "tilt",
                f"Platform {one + 1} leans by up to {np.degrees(np.nanmax(lean)):.1f} deg in "
                f"{frames_text(len(rows))} {when(data.t, rows)}, against "
                f"{np.degrees(usual):.2g} deg usually: a wheel off the floor, or a bump?",
            )


_MATTERS = 0.5
"""Times the noise by which a marker must be off its place to be told."""
_STATED = 1.5
"""Times the stated noise from which on the residuals contradict it."""


def marker_doubts(
    data: MarkerData,
    layout: Layout,
    made: MarkerFit,
    guess: Guessed | None,
    always: Order | None,
    noise_sigma: float | None,
) -> tuple[Doubt, ...]:
    """All of them, the gravest first."""
    return (
        *_of_layout(data, layout, made, guess),
        *_of_names(data, made, always),
        *_of_ghosts(data, made),
        *_of_noise(made, noise_sigma),
        *tilt_doubts(data, made),
    )


def _of_layout(
    data: MarkerData, layout: Layout, made: MarkerFit, guess: Guessed | None
) -> Iterator[Doubt]:
    if guess is not None:
        one, two = (", ".join(names) for names in (guess.layout.platform1, guess.layout.platform2))
        yield Doubt(
            "layout",
            f"The layout was estimated from the file: {one} are on one platform, {two} on the "
            f"other; P is known to {1e3 * guess.joint:.2g} mm. Which platform is the first, and "
            "the zeros of psi and phi, cannot be known without one known line on each: platform 1 "
            "is taken to be that of the first marker, and the axes to run through P and the mean "
            "of a platform's markers.",
        )
    used = set(made.bodies.labels)
    asked = [*layout.platform1, *layout.platform2]
    absent = [name for name in asked if name not in used]
    if absent:
        yield Doubt("layout", f"The file has no {', '.join(absent)}, which the layout names.")
    extra = [name for name in data.labels if name not in used]
    if extra:
        yield Doubt("layout", f"Markers on neither platform, not used: {', '.join(extra)}.")
    size = np.hypot(*made.shift.T)
    if guess is None and size.max() > _MATTERS * np.nan_to_num(made.noise):
        worst = int(size.argmax())
        yield Doubt(
            "layout",
            f"Marker {made.bodies.labels[worst]} is {1e3 * size[worst]:.1f} mm from where the "
            f"layout has it, and {int((size > 0).sum())} in all were moved: their places are taken "
            "from the recording, with the layout's axes and joint as a whole. If the layout is "
            "off as a whole, psi, phi and P are off with it.",
        )


def _of_names(data: MarkerData, made: MarkerFit, always: Order | None) -> Iterator[Doubt]:
    names = made.bodies.labels
    if always:
        yield Doubt(
            "swap",
            f"The markers {_and(names[i] for i in members(always))} are exchanged in the whole "
            "recording: in the file or in the layout. They were put right. Correct the layout.",
        )
    together: dict[tuple[int, ...], list[int]] = {}
    for swap in made.swaps:
        together.setdefault(swap.members, []).extend(swap.frames.tolist())
    for several, frames in together.items():
        rows = sorted(frames)
        yield Doubt(
            "swap",
            f"Markers {_and(names[i] for i in several)} have each other's names in "
            f"{frames_text(len(rows))} {when(data.t, rows)}: swapped labels, put right.",
        )


def _and(names: Iterable[str]) -> str:
    *others, last = names
    return f"{', '.join(others)} and {last}"


def _of_ghosts(data: MarkerData, made: MarkerFit) -> Iterator[Doubt]:
    for i, name in enumerate(made.bodies.labels):
        rows = np.flatnonzero(made.ghosts.out[:, i])
        if len(rows):
            yield Doubt(
                "ghost",
                f"Marker {name} is not where its platform is in {frames_text(len(rows))} "
                f"{when(data.t, rows)}{_jump(made, i, rows)}: a ghost, or another marker's name? "
                "It was left out there.",
            )
    if len(made.ghosts.lost):
        yield Doubt(
            "lost",
            f"In {frames_text(len(made.ghosts.lost))} {when(data.t, made.ghosts.lost)} the markers "
            "do not fit two rigid platforms, whatever is left out. All channels are flagged "
            "there.",
        )


def _jump(made: MarkerFit, i: int, rows: np.ndarray) -> str:
    """By how much the marker is off, as a part of a sentence."""
    where, values = made.bodies.platform[i], made.recording.values
    heading = values["psi"] + (values["phi"] if where else 0.0)
    forward, left = made.bodies.places[i]
    fitted = values["x"] + 1j * values["y"] + (forward + 1j * left) * np.exp(1j * heading)
    seen = made.ghosts.left_out[:, i]
    off = np.abs(seen[rows] - fitted[rows])
    off = off[np.isfinite(off)]
    return f" (off by up to {1e3 * off.max():.0f} mm)" if len(off) else ""


def _of_noise(made: MarkerFit, noise_sigma: float | None) -> Iterator[Doubt]:
    if noise_sigma and made.noise > _STATED * noise_sigma:
        yield Doubt(
            "noise",
            f"The markers keep to rigid platforms to {1e3 * made.noise:.2g} mm. The stated noise "
            f"is {1e3 * noise_sigma:.2g} mm. A platform that bends, or a noise that is larger than "
            "stated.",
        )
