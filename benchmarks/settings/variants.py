"""A case diagnosed with other settings, one after another, in one process.

What a setting does not enter is computed once: functions that take the time are remembered, and the
settings that are read in them are noted.
"""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np

from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.recordings.clock_fit import at_commanded_rate
from rr_opt.recordings.experiment import read_experiment, usable
from rr_opt.sysid import diagnose, estimation, selection
from rr_opt.sysid.diagnosis import groups
from rr_opt.sysid.model import ChannelNoise, Choice, Segment
from rr_opt.sysid.settings import SETTINGS, Settings
from rr_opt.sysid.verdict import named, ties, verdict_of

AS_CHOSEN = "as chosen"
OTHER_MACHINES = ("growth", "input_share", "input_noise", "modes", "windows")
"""Enter no diagnosis of a Roller Racer."""

COMPUTED = (
    (estimation, ("whole_runs",)),
    (selection, ("first", "fitted", "predicted", "scores")),
    (diagnose, ("dependences", "evaluation", "first", "noise_in", "refitted")),
    (RollerRacer, ("proposals", "unknown_inputs", "upstream", "with_noise")),
)
"""Where the time goes."""


class Watched(Settings):
    """Settings that tell which of them were read."""

    read: set[str] | None = None

    def __getattribute__(self, name: str) -> Any:
        """The value, noted while `read` is a set."""
        if Watched.read is not None:
            Watched.read.add(name)
        return super().__getattribute__(name)


@dataclass
class Memory:
    """What functions returned, by their arguments, and the settings that were read in them."""

    kept: dict[Any, Any] = field(default_factory=dict)
    alive: list[Any] = field(default_factory=list)
    read: set[str] = field(default_factory=set)

    def remembering(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """The function, computed once for the same arguments."""

        def once(*given: Any, **named: Any) -> Any:
            key = (function.__qualname__, self._key(given), self._key(named))
            if key not in self.kept:
                with self.watching():
                    self.kept[key] = function(*given, **named)
            return self.kept[key]

        return once

    @contextmanager
    def watching(self) -> Iterator[None]:
        """Note the settings that are read."""
        outer, Watched.read = Watched.read, self.read
        try:
            yield
        finally:
            Watched.read = outer

    def _key(self, given: Any) -> Any:
        """Values by what they are, everything else by which object it is."""
        if given is None or isinstance(given, str | float | Choice | ChannelNoise | Segment):
            return given
        if isinstance(given, int | range):
            return given
        if isinstance(given, np.ndarray):
            return given.shape, given.tobytes()
        if isinstance(given, Mapping) and all(isinstance(k, str | int) for k in given):
            return tuple((self._key(k), self._key(v)) for k, v in sorted(given.items()))
        if isinstance(given, Sequence):
            return tuple(map(self._key, given))
        self.alive.append(given)
        return id(given)

    @contextmanager
    def used(self) -> Iterator[None]:
        """Remember in what the diagnosis calls."""
        patches = [
            patch.object(place, name, self.remembering(getattr(place, name)))
            for place, names in COMPUTED
            for name in names
        ]
        for one in patches:
            one.start()
        try:
            yield
        finally:
            for one in patches:
                one.stop()


@contextmanager
def changed(changes: Mapping[str, Any]) -> Iterator[None]:
    """Other settings, for a while."""
    before = {name: getattr(SETTINGS, name) for name in changes}
    for name, value in changes.items():
        object.__setattr__(SETTINGS, name, value)
    try:
        yield
    finally:
        for name, value in before.items():
            object.__setattr__(SETTINGS, name, value)


def varied(value: Any, factor: float) -> Any:
    """A setting times a factor: a count stays one, a share near 1 has its odds multiplied."""
    if isinstance(value, tuple):
        return tuple(varied(one, factor) for one in value)
    if isinstance(value, int):
        return max(round(value * factor), 1)
    if 0.5 <= value < 1:
        odds = factor * value / (1 - value)
        return odds / (1 + odds)
    return value * factor


def variants(only: Sequence[str]) -> dict[str, dict[str, Any]]:
    """What is changed, by the variant's name."""
    out: dict[str, dict[str, Any]] = {AS_CHOSEN: {}}
    for one in fields(Settings):
        value = getattr(SETTINGS, one.name)
        for word, factor in (("halved", 0.5), ("doubled", 2.0)):
            other = varied(value, factor)
            wanted = one.name in only if only else one.name not in OTHER_MACHINES
            if other != value and wanted:
                out[f"{one.name} {word}"] = {one.name: other}
    return out


def said(model: RollerRacer) -> dict[str, Any]:
    """The diagnosis, as far as it is scored."""
    began = time.process_time()
    result = diagnose.identified(model, diagnose.Stopwatch())
    verdict = verdict_of(result)
    return {
        "verdict": verdict,
        "named": {one.name: one.confidence for one in named(result, verdict)},
        "groups": groups(ties(result, verdict)),
        "cpu": round(time.process_time() - began, 2),
    }


def every_variant(folder: Path, wanted: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """What each variant says of a case."""
    object.__setattr__(SETTINGS, "__class__", Watched)
    experiment, _ = usable(read_experiment(folder))
    model = RollerRacer(at_commanded_rate(experiment))
    as_chosen, out = Memory(), {}
    with as_chosen.watching():
        _ = model.runs, model.form_error, model.catalogue
    for name, changes in wanted.items():
        with changed(changes):
            if not changes.keys() & as_chosen.read:
                with as_chosen.used():
                    out[name] = said(model)
            # It may have been read only now.
            if changes.keys() & as_chosen.read:
                out[name] = said(RollerRacer(model.experiment))
    return out
