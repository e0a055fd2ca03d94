"""One recording, read, cleaned and looked at: everything that a page or a script shows of it."""

from __future__ import annotations

from dataclasses import dataclass

from rr_opt.experiment.experiment import Start
from rr_opt.experiment.recording import Recording
from rr_opt.recordings.clean import Cleaned, clean
from rr_opt.recordings.clock_doubts import command_doubts, log_doubts
from rr_opt.recordings.clock_fit import ClockFit
from rr_opt.recordings.clocks import against_command, against_log
from rr_opt.recordings.doubts import Doubt, texts
from rr_opt.recordings.from_markers import MarkerFit, fit_markers
from rr_opt.recordings.layout import Layout
from rr_opt.recordings.markers_file import MarkerData
from rr_opt.recordings.servo_log_file import ServoLog
from rr_opt.robot.gait import Gait


@dataclass(frozen=True)
class Inspection:
    """What was found of one recording.

    markers   the rigid fit, of marker files
    gait      what the servo was told, where it is known
    command   phi against it
    log       phi against the servo's log
    doubts    all of them, the reader's first
    """

    cleaned: Cleaned
    markers: MarkerFit | None
    gait: Gait | None
    command: ClockFit | None
    log: ClockFit | None
    doubts: tuple[str, ...]

    @property
    def recording(self) -> Recording:
        """With all flags set."""
        return self.cleaned.recording

    @property
    def name(self) -> str:
        """Of the file."""
        return self.recording.name


@dataclass(frozen=True)
class Told:
    """What is known of a recording beside its file; all of it may be unknown.

    noise  standard deviation of a marker's coordinate, m
    """

    layout: Layout | None = None
    noise: float | None = None
    gait: Gait | None = None
    start: Start = "running"
    log: ServoLog | None = None


def inspect(read: Recording | MarkerData, told: Told) -> Inspection:
    """Clean a recording and look at it. Raises InputError if markers make no robot."""
    markers = None
    if isinstance(read, MarkerData):
        markers = fit_markers(read, told.layout, told.noise)
        recording = markers.recording
    else:
        recording = read
    cleaned = clean(recording)
    t, phi = cleaned.recording.t, cleaned.recording.data("phi")
    doubts: list[Doubt] = list(cleaned.doubts)
    command = log = None
    if told.gait is not None:
        rest = told.start == "rest"
        command = against_command(t, phi, told.gait, from_rest=rest)
        doubts += command_doubts(command, from_rest=rest)
    if told.log is not None:
        log, others = against_log(t, phi, told.log)
        period = told.gait.period if told.gait else None
        doubts += log_doubts(log, others, period)
    said = (*recording.doubts, *(told.log.doubts if told.log else ()), *texts(doubts))
    return Inspection(cleaned, markers, told.gait, command, log, said)
