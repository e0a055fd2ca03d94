"""An experiment as its file says it was made, checked, with no recording read yet."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from rr_opt.files.experiment_model import PLACE, MarkersModel
from rr_opt.files.fields import validate
from rr_opt.files.issue import Issue, has_errors
from rr_opt.files.source import fingerprint
from rr_opt.files.yaml_text import Document
from rr_opt.messages import shown
from rr_opt.model.experiment import Column, CountScale, Layout, Noise, Start, Uncertainty, Use
from rr_opt.model.gait import Gait
from rr_opt.model.robot import Robot
from rr_opt.outcome import InputError


@dataclass(frozen=True)
class PlannedRun:
    """An entry of `recordings`, as Run has it; servo_log: the file of the servo's log."""

    file: Path
    gait: Gait
    use: Use
    start: Start
    servo_log: Path | None


@dataclass(frozen=True)
class ExperimentPlan:
    """What an experiment file says.

    document  the file, for issues that only show when a recording is read
    paths     every file that makes up the experiment
    """

    name: str
    document: Document
    robot: Robot
    noise: Noise
    uncertainty: Mapping[str, Uncertainty]
    runs: tuple[PlannedRun, ...]
    markers: Layout | None
    counts: CountScale
    columns: Mapping[str, Column]
    paths: tuple[Path, ...]

    @property
    def sha256(self) -> str:
        """The fingerprint of every file."""
        return fingerprint(self.paths)


_PLATFORMS = ("platform1", "platform2")
_FEWEST = 2


def layout_from(document: Document) -> tuple[Layout | None, list[Issue]]:
    """The places that the section `markers` gives (None if there are issues), and all issues."""
    model, issues = validate(MarkersModel, document)
    places: dict[str, dict[str, tuple[float, ...]]] = {}
    for platform in _PLATFORMS:
        if platform not in document.data:
            continue
        places[platform], found = _places(document, platform)
        issues += found
    for name in places.get("platform1", {}):
        if name in places.get("platform2", {}):
            message = f"Read the marker {shown(name)} on both platforms. Keep it on one of them."
            issues.append(document.issue("error", ("platform2", name), message))
    if model is None or has_errors(issues):
        return None, issues
    first, second = (MappingProxyType(places[platform]) for platform in _PLATFORMS)
    return Layout(first, second, model.up), issues


def _places(document: Document, platform: str) -> tuple[dict[str, tuple[float, ...]], list[Issue]]:
    given: Any = document.data[platform]
    example = "{RR1: [40 mm, 0], RR2: [180 mm, 30 mm]}"
    if not isinstance(given, dict) or len(given) < _FEWEST:
        message = (
            f"Read {shown(given)}. Expected at least {_FEWEST} markers by name: one alone has no "
            f"heading. Write for example `{example}`."
        )
        return {}, [document.issue("error", (platform,), message)]
    issues: list[Issue] = []
    places: dict[str, tuple[float, ...]] = {}
    for name, place in given.items():
        try:
            places[name] = _place(place)
        except InputError as error:
            issues.append(document.issue("error", (platform, name), str(error)))
    taken: dict[tuple[float, ...], str] = {}
    for name, place in places.items():
        other = taken.setdefault(place[:2], name)
        if other != name and len(place) == 2:
            message = f"Read the place of {shown(other)} again. Expected another one. Measure it."
            issues.append(document.issue("error", (platform, name), message))
    return places, issues


def _place(value: object) -> tuple[float, ...]:
    if not isinstance(value, list) or len(value) not in (2, 3):
        raise InputError(
            f"Read {shown(value)}. Expected [forward, left] or [forward, left, up] from the joint "
            "P, in m. Write for example `[40 mm, 0]`."
        )
    return tuple(PLACE.read(item) for item in value)
