"""An experiment: a robot as its builder believes it to be, and the recordings made of it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import IntFlag
from types import MappingProxyType
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rr_opt.array import Array
from rr_opt.messages import shown
from rr_opt.model.fields import SI, Count, data, declared
from rr_opt.model.gait import Gait
from rr_opt.model.parameters import Uncertainty, default_uncertainty
from rr_opt.model.robot import Robot
from rr_opt.outcome import InputError
from rr_opt.units import Number


@data
class CountScale:
    """What the counts of a servo's log mean; the defaults are those of the servo CDS5516."""

    counts: int = declared(Count(2, 1_000_000), "How many counts there are.", default=1024)
    range: SI = declared(
        Number("rad", "300 deg"),
        "The angle they cover, rad; negative where phi falls as they rise.",
        default=math.radians(300),
    )
    zero: SI = declared(Number("", "512"), "The count at which phi = 0.", default=512.0)

    @property
    def each(self) -> float:
        """By how much phi rises per count, rad."""
        return self.range / self.counts


@dataclass(frozen=True)
class Column:
    """Where a channel is in a text file, and what its numbers mean.

    column  its name there
    factor  SI per number
    unit    what the factor was given as, such as deg; empty: as a number
    bits    numbers are signed counts of this many bits; None: as written
    """

    column: str
    factor: float = 1.0
    bits: int | None = None
    unit: str = ""


@dataclass(frozen=True)
class Layout:
    """The markers of both platforms, by name as in the marker file, m.

    platform1, platform2  a marker's place (forward, left) or (forward, left, up) in its platform's
        own axes. Both have their origin at the joint P, and `left` is +90 degrees from `forward`.
        Platform 1's forward axis is the one whose heading is psi: from P TOWARDS its axle.
        Platform 2's is the one that psi + phi turns to: from its axle towards P, so a marker over
        axle 2 stands at (-c2, 0)
    up  the capture frame's axis that points up from the floor: `x`, `y` or `z`, or its opposite.
        x and y of the recording are then the two others in cyclic order
    """

    platform1: Mapping[str, tuple[float, ...]]
    platform2: Mapping[str, tuple[float, ...]]
    up: str = "z"


UNITS = {"t": "s", "x": "m", "y": "m", "psi": "rad", "phi": "rad", "torque": "N m"}
"""Of what text files of recordings hold."""

CHANNELS = ("x", "y", "psi", "phi")
"""What every recording has, in this order; `torque` may come beside them."""


class Flag(IntFlag):
    """Why a value is not taken as data; 0 is a good one."""

    MISSING = 1
    OUTLIER = 2
    OUT_OF_ORDER = 8


@dataclass(frozen=True)
class Recording:
    """One run, sampled at the times t (n,) of the command's clock, s.

    values  by channel (n,): x, y the joint P, m; psi the heading of platform 1 and phi the angle of
            platform 2's axis against platform 1's, unwrapped, rad; torque of the servo, N m, if it
            was recorded. A value that is flagged stays as it was read; where there was none, NaN
    sigma   by channel (n,), the noise's standard deviation, same units; may differ by sample; NaN
            where nobody said
    flags   by channel (n,), `Flag`
    source  where it came from: file, format, rate, clock, what was done to it; plain text by name
    doubts  sentences on what looked wrong in it and what was made of it
    """

    name: str
    t: Array
    values: Mapping[str, Array]
    sigma: Mapping[str, Array]
    flags: Mapping[str, NDArray[np.uint8]]
    source: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))
    doubts: tuple[str, ...] = ()

    @classmethod
    def of(
        cls,
        t: ArrayLike,
        *,
        x: ArrayLike,
        y: ArrayLike,
        psi: ArrayLike,
        phi: ArrayLike,
        torque: ArrayLike | None = None,
        name: str = "recording",
    ) -> Recording:
        """A recording from arrays (n,), in SI; NaN is a missing value.

        Raises InputError for times that do not rise, and arrays that are not as long as they are.
        """
        given = {"x": x, "y": y, "psi": psi, "phi": phi, "torque": torque}
        times = np.array(t, float)
        values = {one: np.array(y, float) for one, y in given.items() if y is not None}
        shapes = {one: y.shape for one, y in {"t": times, **values}.items()}
        if times.ndim != 1 or len(set(shapes.values())) > 1 or not (np.diff(times) > 0).all():
            read = ", ".join(f"{one} {shape}" for one, shape in shapes.items())
            raise InputError(
                f"{name}: Read arrays of the shapes {read}. Expected arrays (n,) of one length, "
                "and times that rise."
            )
        return cls(
            name,
            times,
            MappingProxyType(values),
            MappingProxyType({one: np.full(len(times), np.nan) for one in values}),
            MappingProxyType(
                {one: np.uint8(Flag.MISSING) * ~np.isfinite(y) for one, y in values.items()}
            ),
        )

    def __len__(self) -> int:
        return len(self.t)

    @property
    def channels(self) -> tuple[str, ...]:
        """The channels that it has."""
        return tuple(self.values)

    def data(self, channel: str) -> Array:
        """The values (n,) of a channel that are taken as data; NaN elsewhere."""
        return np.where(self.flags[channel] == 0, self.values[channel], np.nan)


Use = Literal["fit", "holdout"]
Start = Literal["rest", "running"]


@data
class Noise:
    """One standard deviation of the capture system: position (m), angle (rad), torque (N m)."""

    position: SI = declared(Number("m", "1 mm", above=0), "Of x and y, m.")
    angle: SI = declared(Number("rad", "3 mrad", above=0), "Of psi and phi, rad.")
    torque: SI = declared(Number("N m", "3 mN*m", above=0), "Of the torque, N m.", default=0.003)

    def of(self, channel: str) -> float:
        """That of x, y, psi, phi or torque."""
        if channel == "torque":
            return self.torque
        return self.position if channel in ("x", "y") else self.angle


@dataclass(frozen=True)
class Run:
    """One recording and how it was made.

    gait   the command, its clock starting at the recording's t = 0
    start  `rest`: the robot stood still until t = 0 and the command began there; `running`: the
           command began a whole number of periods earlier
    use    `fit` or `holdout`
    """

    recording: Recording
    gait: Gait
    use: Use = "fit"
    start: Start = "running"

    @property
    def name(self) -> str:
        """The name of its file."""
        return self.recording.name

    @property
    def doubts(self) -> tuple[str, ...]:
        """Those of its recording."""
        return self.recording.doubts


@dataclass(frozen=True)
class Experiment:
    """The nominal robot, how well it is known, and the runs, all in one floor frame.

    uncertainty  by parameter: the names of `PARAMETERS`, psi_zero and phi_zero. What is not named
                 is exact
    sha256       fingerprint of the files it was read from; empty if it was made in Python
    """

    robot: Robot
    noise: Noise
    uncertainty: Mapping[str, Uncertainty]
    runs: tuple[Run, ...]
    name: str = ""
    sha256: str = ""

    @classmethod
    def of(
        cls,
        robot: Robot,
        runs: Iterable[Run],
        noise: Noise | None = None,
        *,
        uncertainty: Mapping[str, Uncertainty | float] | None = None,
        name: str = "experiment",
    ) -> Experiment:
        """An experiment in Python, with the same defaults as an experiment file.

        noise        1 mm and 3 mrad unless given
        uncertainty  of some parameters, a number being one sigma in SI; the others' are the default

        Raises InputError for the name of an uncertainty that is not known.
        """
        known = default_uncertainty(robot)
        given = {
            key: one if isinstance(one, Uncertainty) else Uncertainty(float(one))
            for key, one in (uncertainty or {}).items()
        }
        names = [*known, "psi_zero", "phi_zero"]
        for key in given:
            if key not in names:
                raise InputError(
                    f"Read the uncertainty of {shown(key)}. Expected that of {', '.join(names)}."
                )
        return cls(robot, noise or Noise(1e-3, 3e-3), {**known, **given}, tuple(runs), name)
