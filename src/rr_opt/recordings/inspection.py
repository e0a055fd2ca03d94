"""One recording, read, cleaned and looked at: everything that a page or a script shows of it."""

from __future__ import annotations

from dataclasses import dataclass, replace

from rr_opt.experiment.experiment import Start
from rr_opt.experiment.recording import Recording
from rr_opt.recordings.clean import Cleaned, clean
from rr_opt.recordings.clock_doubts import command_doubts, start_doubts
from rr_opt.recordings.clock_fit import ClockFit
from rr_opt.recordings.clocks import against_command
from rr_opt.recordings.doubts import Doubt, texts
from rr_opt.recordings.from_markers import MarkerFit, fit_markers
from rr_opt.recordings.layout import Layout
from rr_opt.recordings.markers_file import MarkerData
from rr_opt.recordings.servo_log_file import ServoLog
from rr_opt.recordings.synchrony import Synchrony, synchronised
from rr_opt.robot.gait import Gait


@dataclass(frozen=True)
class Inspection:
    """What was found of one recording.

    markers   the rigid fit, of marker files
    gait      what the servo was told, where it is known
    command   phi against it
    synchrony what the servo's log says of the clocks, where there is one
    doubts    all of them, the reader's first
    """

    cleaned: Cleaned
    markers: MarkerFit | None
    gait: Gait | None
    command: ClockFit | None
    synchrony: Synchrony | None
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
    first: list[Doubt] = []
    synchrony = None
    if told.log is not None:
        synchrony = synchronised(recording, told.log, told.gait, told.start)
        recording = synchrony.recording
        first += synchrony.doubts
        if markers is not None:
            markers = replace(markers, recording=recording)
    cleaned = clean(recording)
    doubts = [*cleaned.doubts, *first]
    command = None
    if told.gait is not None:
        rest = told.start == "rest"
        t, phi = cleaned.recording.t, cleaned.recording.data("phi")
        command = against_command(t, phi, told.gait, from_rest=rest)
        shifted = synchrony is not None and synchrony.shift is not None
        period = told.gait.period
        doubts += command_doubts(command, from_rest=rest, period=period, clock_known=shifted)
        doubts += start_doubts(float(t[0]), period) if rest else ()
    said = (*recording.doubts, *(told.log.doubts if told.log else ()), *texts(doubts))
    return Inspection(cleaned, markers, told.gait, command, synchrony, said)
