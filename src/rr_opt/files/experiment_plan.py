"""An experiment as its file says it was made, checked, with no recording read yet."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from rr_opt.files.experiment_model import MarkersModel
from rr_opt.files.fields import validate
from rr_opt.files.issue import Issue
from rr_opt.files.source import fingerprint
from rr_opt.files.yaml_text import Document
from rr_opt.messages import shown
from rr_opt.model.experiment import Column, CountScale, Layout, Noise, Start, Uncertainty, Use
from rr_opt.model.gait import Gait
from rr_opt.model.robot import Robot


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


def layout_from(document: Document) -> tuple[Layout | None, list[Issue]]:
    """The places that the section `markers` gives (None if there are issues), and all issues."""
    model, issues = validate(MarkersModel, document)
    given = [document.data.get(name) for name in ("platform1", "platform2")]
    first, second = (one if isinstance(one, dict) else {} for one in given)
    for name in second:
        if name in first:
            message = f"Read the marker {shown(name)} on both platforms. Keep it on one of them."
            issues.append(document.error(("platform2", name), message))
    if model is None:
        return None, issues
    for platform in ("platform1", "platform2"):
        taken: dict[tuple[float, ...], str] = {}
        for name, place in getattr(model, platform).items():
            other = taken.setdefault(place[:2], name)
            if other != name and len(place) == 2:
                message = (
                    f"Read the place of {shown(other)} again. Expected another one. Measure it."
                )
                issues.append(document.error((platform, name), message))
    if issues:
        return None, issues
    return Layout(
        MappingProxyType(model.platform1), MappingProxyType(model.platform2), model.up
    ), []
