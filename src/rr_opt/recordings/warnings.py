"""Everything a recording can be warned of: one table with code, level, sentence and remedy.

A code is a kind, a dot and what is the matter. Sentences are format strings; those who warn give
the values, and lists and sizes as text.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Level = Literal["note", "warning", "error"]


@dataclass(frozen=True)
class Entry:
    """A row of the table.

    level     note: how it was read; warning: look at it; error: nothing can be fitted like this
    sentence  what was seen, and what was made of it
    remedy    what to do
    """

    level: Level
    sentence: str
    remedy: str = ""


def _note(sentence: str, remedy: str = "") -> Entry:
    return Entry("note", sentence, remedy)


def _warning(sentence: str, remedy: str = "") -> Entry:
    return Entry("warning", sentence, remedy)


def _error(sentence: str, remedy: str = "") -> Entry:
    return Entry("error", sentence, remedy)


TABLE: dict[str, Entry] = {
    # The file.
    "file.cut": _note("The file ends within line {line}, which was left out."),
    "file.short": _note("{rows} fewer cells than the header. What they lack was taken as missing."),
    "file.infinite": _note("{rows} an infinite number, which was taken as missing."),
    "file.columns": _note("Columns that were not read: {names}."),
    "file.variables": _note("Variables that were not read: {names}."),
    "file.sections": _note("Sections that were not read: {names}."),
    "file.points": _note("{count} points are no places, and were not read."),
    "file.frames": _note("The header states {stated} frames, and there are {count}."),
    "file.markers": _note("The header states {stated} markers, and names {count}."),
    "file.counter": _note(
        "The header can count to frame {last} only; the file has {count} frames, and all were read."
    ),
    "file.unit": _warning("The file states no unit of length; millimetres were assumed."),
    "file.signed": _note(
        "{count} counts of {column} have the highest of {bits} bits, and were read as negative."
    ),
    "marker.twice": _warning("The marker {label} is there again, and called {name}."),
    "marker.infinite": _note("{count} positions are infinite, and were taken as missing."),
    "marker.origin": _note("{count} positions are exactly 0, 0, 0, and were taken as missing."),
    "marker.never": _warning("Never seen: {names}."),
    "marker.filled": _warning(
        "{count} positions have the residual 0: the capture's software made them up, and nobody "
        "measured them."
    ),
    "servo.counts": _warning(
        "{count} positions lie outside 0 to {last} counts: is the scale that of this servo?"
    ),
    # The times.
    "time.none": _note("Without a time, and so left out: {rows}."),
    "time.order": _note("Out of order, and put where the time says: {rows}."),
    "time.restart": _warning(
        "The time falls back from {before:.6g} to {after:.6g} s in line {line}: two recordings in "
        "one file, or a clock that was set?",
        "Part them.",
    ),
    "time.twice": _note("With the time of another row, and so left out: {rows}."),
    "time.conflict": _warning(
        "{count} of the times have rows that say different things; none of them was taken as data."
    ),
    "time.first": _note("The first frame is {frame}, so that t begins at {start:.6g} s."),
    "time.jump": _warning(
        "The time jumps {often} ({listed}): at {rate:.5g} Hz about {lacking} rows are missing."
    ),
    "time.uneven": _warning(
        "The rows do not come at a constant rate: {uneven} of {count} steps differ by more than "
        "{most:.0f} % from {usual:.4g} ms."
    ),
    "time.rate": _warning(
        "The header states {stated:.6g} Hz, and the times come at {rate:.6g} Hz. The times were "
        "taken."
    ),
    # Units and signs.
    "units.calendar": _error(
        "The times begin at {start:.10g}, as those of a calendar do. Expected seconds since the "
        "command began;",
        "subtract the time at which it did.",
    ),
    "units.frames": _error(
        "The times look like frame numbers: steps of 1. Expected seconds;",
        "divide by the frame rate.",
    ),
    "units.milliseconds": _error(
        "The times look like milliseconds: steps of {step:.6g}. Expected seconds;",
        "divide by 1000.",
    ),
    "units.time": _error("The times look like another unit than seconds: steps of {step:.6g}."),
    "units.place": _error(
        "The positions range over {widest:.6g}, and no unit makes that a robot's motion. Expected "
        "metres."
    ),
    "units.millimetres": _error(
        "The positions look like millimetres or centimetres: ranges of {ranges}. Expected metres;",
        "divide by 1000, or by 100.",
    ),
    "units.angle": _error(
        "phi reaches {largest:.6g}, and no unit makes that a servo's angle. Expected radians."
    ),
    "units.degrees": _error(
        "The angles look like degrees: phi reaches {largest:.4g}. Expected radians;",
        "multiply by pi/180.",
    ),
    "units.length": _error(
        "The joint moves {driven:.4g} in a period, and the robot is {length:.3g} m long. Expected "
        "metres: are these millimetres or centimetres?"
    ),
    "units.heading": _error(
        "The heading turns by {psi:.4g} in a period, and phi by {phi:.3g}. Expected radians for "
        "both: is psi in degrees?"
    ),
    "units.phi": _error(
        "phi moves {times:.3g} times as far as the gait. Expected about as far: is one of them in "
        "degrees, or did the servo not follow?"
    ),
    # The markers.
    "layout.estimated": _warning(
        "The layout was estimated from the file: {one} are on one platform, {two} on the other; P "
        "is known to {joint:.2g} mm. Which platform is the first, and the zeros of psi and phi, "
        "cannot be known without one known line on each: platform 1 is taken to be that of the "
        "first marker, and the axes to run through P and the mean of a platform's markers."
    ),
    "layout.absent": _warning("The file has no {names}, which the layout names."),
    "layout.unused": _note("Markers on neither platform, not used: {names}."),
    "layout.moved": _warning(
        "Marker {name} is {off:.1f} mm from where the layout has it, and {count} in all were "
        "moved: their places are taken from the recording, with the layout's axes and joint as a "
        "whole. If the layout is off as a whole, psi, phi and P are off with it."
    ),
    "swap.always": _warning(
        "The markers {names} are exchanged in the whole recording: in the file or in the layout. "
        "They were put right.",
        "Correct the layout.",
    ),
    "swap.frames": _note(
        "Markers {names} have each other's names in {frames} {when}: swapped labels, put right."
    ),
    "ghost.marker": _warning(
        "Marker {name} is not where its platform is in {frames} {when}{off}: a ghost, or another "
        "marker's name? It was left out there."
    ),
    "lost.frames": _warning(
        "In {frames} {when} the markers do not fit two rigid platforms, whatever is left out. All "
        "channels are flagged there."
    ),
    "tilt.platform": _warning(
        "Platform {platform} leans by up to {most:.1f} deg in {frames} {when}, against "
        "{usual:.2g} deg usually: a wheel off the floor, or a bump?"
    ),
    "noise.markers": _warning(
        "The markers keep to rigid platforms to {noise:.2g} mm. The stated noise is {stated:.2g} "
        "mm. A platform that bends, or a noise that is larger than stated."
    ),
    # The channels.
    "held.rows": _warning(
        "{count} samples repeat the last one in every channel, {times}, the longest for "
        "{longest:.3g} s from t = {start:.6g} s: a stream that stood still? Flagged."
    ),
    "turns.angle": _note("{angle} jumps by a whole turn {count} times. It was unwrapped."),
    "steps.channel": _warning(
        "{channel} comes in steps of {step}, larger than its noise: it was rounded. Its errors are "
        "then not independent;",
        "export more digits.",
    ),
    "noise.few": _warning("{channel} has too few samples in a row to tell its noise."),
    "noise.zero": _warning("{channel} has no noise at all: is it computed, or constant?"),
    "noise.large": _warning(
        "The noise of {channel} is {noise}, and {stated} {whose}. Every difference larger than "
        "what is stated counts as a mismatch.",
        "{remedy}",
    ),
    "noise.small": _warning(
        "The noise of {channel} at the highest frequencies is {noise}, less than the {stated} that "
        "{whose}. {why} What is smaller than that is not found.",
        "{remedy}",
    ),
    "colour.filtered": _warning(
        "The noise of {channel} is not white: at half the frequency it is {colour:.3g} times as "
        "large. A filter upstream, or so little noise that the motion itself shows; samples are "
        "then not independent."
    ),
    "colour.alternating": _warning(
        "The noise of {channel} is not white: at half the frequency it is only {colour:.2g} times "
        "as large. Two cameras in turn, or time stamps that jitter?"
    ),
    "outlier.channel": _note(
        "{channel} has {count} ({share:.2g} % of its samples), at t = {listed} s. Flagged, not "
        "removed."
    ),
    "jump.channels": _warning("At t = {t:.6g} s jumps {listed}: {why}"),
    "jump.more": _warning("There are {count} more jumps."),
    "gap.long": _warning(
        "{channels}: no data for {length:.3g} s after t = {start:.6g} s. The gap is not filled."
    ),
    "gap.many": _warning("{count} gaps in all are longer than {most} s, {total:.3g} s."),
    "gap.short": _note(
        "{count} of up to {longest:.0f} ms, {lost} samples: bridged in figures, not in the data."
    ),
    # The motion, and what cannot be diagnosed.
    "motion.robot": _warning(
        "This robot hardly moves: the joint never is more than {far:.2g} mm from where it began. "
        "Such a recording says little about friction or inertia."
    ),
    "useless.empty": _warning("There are no data of {channel}. Expected x, y, psi and phi."),
    "useless.short": _warning(
        "Read {seconds:.3g} s, and {count} values of {channel}: too short to tell. Expected at "
        "least {periods:g} periods of the gait and {least} values."
    ),
    "useless.gap": _warning(
        "Read no {channel} for {gap:.3g} s. Expected gaps of at most {most:g} s.",
        "Cut the recording there.",
    ),
    "useless.noisy": _warning(
        "phi moves by {moved:.3g} rad, next to nothing beside its stated noise of {sigma:.3g} rad: "
        "too noisy to tell.",
        "Correct `noise.angle` if that is not the noise.",
    ),
    "useless.servo": _warning(
        "phi does not move: it stays within {moved:.2g} rad, too still to tell. Expected the servo "
        "to follow its command."
    ),
    "useless.robot": _warning("The robot does not move: too still to tell. Expected it to drive."),
    "useless.copy": _warning(
        "Read the same motion as {other}, which is to be fitted. Expected another run: a copy is "
        "no evidence.",
        "Record one to hold out.",
    ),
    # Nuisances.
    "frame.wrong": _error(
        "Place and angles contradict wheels that roll: by {left:.3g} times their noise as they "
        "are, and by {best:.3g} times if {meant}. Expected one floor frame, psi the heading from P "
        "towards axle 1, and all angles counter-clockwise seen from above.",
        "Correct the columns.",
    ),
    "late.phi": _warning(
        "Some channels are late against the others: {told}. Wheels that roll tie them together at "
        "every instant. Expected all channels of a row to be of one instant.",
        "Shift them, if the capture is to blame, or export them anew.",
    ),
    "late.place": _warning(
        "Some channels are late against the others: {told}. Wheels that roll tie them together at "
        "every instant; wheels that creep sideways do so less. Expected all channels of a row to "
        "be of one instant.",
        "Shift them, if the capture is to blame.",
    ),
    "clock.change": _error(
        "The clock changes at t = {t:.4g} s: phi repeats every {before:.3g} s before, and every "
        "{after:.3g} s after. Expected seconds throughout.",
        "Cut the recording there, or correct its times.",
    ),
    "push.robot": _warning(
        "The robot was pushed, or lifted, at t = {t:.4g} s, where x = {x:.3g} m and y = {y:.3g} m: "
        "it moved {far:.2g} mm as its wheels do not roll.",
        "Cut the recording there.",
    ),
    "push.surge": _warning(
        "The robot was pushed, or held, at t = {t:.4g} s, where x = {x:.3g} m and y = {y:.3g} m: "
        "it drove {far:.2g} mm more or less than in the periods before and after.",
        "Cut the recording there.",
    ),
    "start.running": _warning(
        "The robot is said to start from rest, and it drives from the first row on as it does "
        "later, when its periods begin with {later:.3g} mm/s. Expected it to stand at t = 0.",
        "Write `start: running`, or cut the recording where the command begins.",
    ),
    # The command and the clocks.
    "command.still": _warning("phi cannot be matched with its command: it does not move."),
    "command.other": _warning(
        "phi does not follow its command: {scale:.2g} of its amplitude. Another gait, degrees, or "
        "the wrong file?"
    ),
    "command.scale": _warning(
        "phi moves {scale:.4g} +- {half:.1g} times as far as commanded: {why}"
    ),
    "command.bias": _warning(
        "phi is {bias:+.3g} mrad ({degrees:+.2g} deg) off its command on average: a servo mounted "
        "askew, or phi's zero."
    ),
    "command.period": _error(
        "phi repeats every {period:.3g} s, and the gait every {commanded:.3g} s. Expected the gait "
        "that was driven.",
        "Correct `gait`, or name the right file.",
    ),
    "command.half": _warning(
        "phi is half a period off its command, {late:.2g} s of {period:.3g} s. Is t = 0 where the "
        "command begins, and is phi positive to the left?"
    ),
    "command.signs": _error(
        "phi is half a period off its command in every recording. Expected phi positive where "
        "platform 2 turns counter-clockwise against platform 1, and psi counter-clockwise too, "
        "seen from above.",
        "Correct the sign of both, or of phi alone if psi is right.",
    ),
    "clock.start": _warning(
        "The robot is said to start from rest at t = 0, and the recording begins at t = "
        "{first:.6g} s. Is its clock the command's?"
    ),
    "clock.offset": _warning(
        "phi {way} its command by {size:.3g} ms (95 %: {low:.3g} to {high:.3g} ms): {why}."
    ),
    "clock.drift": _warning(
        "The command's clock gains {drift:.3g} us a second on the recording's (95 %: {low:.3g} to "
        "{high:.3g})."
    ),
    "clock.rate": _warning(
        "phi's period differs from its command's by {drift:+.3g} %, as where the recorder's clock "
        "runs wrong. Times are corrected by that."
    ),
    "clock.shifted": _note(
        "By the servo's log the command's clock is ahead of the recording's by {shift}, and gains "
        "{drift:+.3g} +- {half:.2g} us a second. The recording was put on the command's clock; "
        "what was told of reading it has the file's.{play}"
    ),
    "clock.play": _warning(
        "By the servo's log the command's clock is ahead of the recording's by {shift}.{play} "
        "Nothing was shifted."
    ),
    "log.other": _warning(
        "phi and the servo's log share no motion: another run's log? It was not used."
    ),
    "log.clock": _warning(
        "The servo's clock is {offset:+.4f} s against the capture's (95 %: {low:+.4f} to "
        "{high:+.4f} s), and gains {drift:+.3g} +- {half:.2g} us a second. Nothing was shifted: "
        "that takes `goal` and `present` in the log, and the gait."
    ),
    "log.goal": _warning(
        "The log's goal moves {scale:.4g} times as far as the gait that is written: another gait, "
        "another run's log, or another count scale?"
    ),
    "log.offsets": _warning(
        "The motion repeats itself, and offsets of {others} s fit about as well. The one {taken} "
        "was taken.",
        "Start both recordings before the command.",
    ),
    "log.scale": _warning(
        "phi moves {scale:.4g} times as far as the servo's log has it: its count scale, or play "
        "between servo and platform?"
    ),
}


class Notice(str):
    """What a recording is warned of: the sentences, and the code of their entry in the table."""

    code: str

    def __new__(cls, text: str, code: str) -> Notice:
        """The sentences with their code."""
        made = super().__new__(cls, text)
        made.code = code
        return made

    def __reduce__(self) -> tuple[type[Notice], tuple[str, str]]:
        return Notice, (str(self), self.code)

    @property
    def kind(self) -> str:
        """The part of the code before its dot."""
        return self.code.partition(".")[0]

    @property
    def level(self) -> Level:
        """Of its entry."""
        return TABLE[self.code].level


def notice(code: str, **values: Any) -> Notice:
    """The notice with this code, its sentences filled with values."""
    entry = TABLE[code]
    return Notice(f"{entry.sentence} {entry.remedy}".strip().format(**values), code)


_UNITS = {
    "x": (1e3, "mm"),
    "y": (1e3, "mm"),
    "psi": (1e3, "mrad"),
    "phi": (1e3, "mrad"),
    "torque": (1e3, "mN m"),
}


def size_text(channel: str, size: float) -> str:
    """A size of a channel, from SI, to three digits: `1.2 mm`, `1230 mm`."""
    factor, unit = _UNITS.get(channel, (1.0, ""))
    return f"{float(f'{factor * size:.3g}'):g} {unit}".strip()


def counted(count: int, what: str) -> str:
    """`1 frame`, `312 frames`."""
    return f"{count} {what}" + ("" if count == 1 else "s")


def when(t: NDArray[np.float64], rows: Sequence[int] | NDArray[np.int_]) -> str:
    """`at t = 3.21 s`, or `between t = 3.21 s and 4.5 s`, of rows in order."""
    first, last = float(t[rows[0]]), float(t[rows[-1]])
    if len(rows) == 1:
        return f"at t = {first:.6g} s"
    return f"between t = {first:.6g} s and {last:.6g} s"
