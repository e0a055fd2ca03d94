"""An experiment as its file says it was made, checked, with no recording read yet."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from rr_opt.experiment.count_scale import CountScale
from rr_opt.experiment.experiment import Noise, Start, Uncertainty, Use
from rr_opt.files.document import Document
from rr_opt.robot.gait import Gait
from rr_opt.robot.parameters import Robot


@dataclass(frozen=True)
class MarkerPlaces:
    """Of each platform's markers, by name, (forward, left[, up]) from P, m; and what axis is up."""

    platform1: Mapping[str, tuple[float, ...]]
    platform2: Mapping[str, tuple[float, ...]]
    up: str


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
    markers: MarkerPlaces | None
    counts: CountScale
    paths: tuple[Path, ...]

    @property
    def sha256(self) -> str:
        """Over the bytes of every file, each preceded by its length, in hex."""
        digest = hashlib.sha256()
        for path in self.paths:
            content = path.read_bytes()
            digest.update(f"{len(content)}\n".encode())
            digest.update(content)
        return digest.hexdigest()
