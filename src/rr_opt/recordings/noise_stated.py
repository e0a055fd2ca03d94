"""Stated noise that the recording itself contradicts by far."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rr_opt.experiment.recording import Recording
from rr_opt.recordings.doubts import Doubt
from rr_opt.recordings.noise import noise_of
from rr_opt.recordings.sizes import size_text

_KEYS = {"noise.position": ("x", "y"), "noise.angle": ("psi", "phi")}

_FAR = 5.0
"""Times the scatter, or the other way round, that are far.

A capture that was smoothed scatters a few times less at the highest frequencies than it errs.
"""


def noise_stated_doubts(recording: Recording) -> tuple[Doubt, ...]:
    """One for each noise of the experiment file that is far from what its channels scatter by.

    Too large, it hides what is missing; too small, it makes every difference one that matters. The
    noise of a motion that was fitted to markers is not stated.
    """
    if "motion" in recording.source:
        return ()
    return tuple(doubt for key, names in _KEYS.items() for doubt in _of(recording, key, names))


def _of(recording: Recording, key: str, names: tuple[str, ...]) -> Iterator[Doubt]:
    for name in names:
        seen = noise_of(recording.data(name))
        said = float(np.nanmedian(recording.sigma[name]))
        times = seen.times(said)
        if times < 1 / _FAR:
            more = "What is smaller than that is not found."
        elif times > _FAR:
            more = "Every difference larger than that counts as a mismatch."
        else:
            continue
        yield Doubt(
            "noise",
            f"The noise of {name} is stated as {size_text(name, said)}, and its values scatter by "
            f"{size_text(name, seen.sigma)} from one to the next. {more} Correct `{key}` if it is "
            "not meant so.",
        )
        return
