"""Everything that can be odd about a recording: one table of code, level, sentence and remedy.

A code is a kind, a dot and what is the matter. Sentences are format strings; the caller gives the
values, with lists and sizes as text.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, cast

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


def _read(table: str) -> dict[str, Entry]:
    """Rows of code, level, sentence and, after `=>`, remedy; an indented line continues a row."""
    found: dict[str, Entry] = {}
    for row in table.strip().replace("\n    ", " ").splitlines():
        code, level, text = row.split(None, 2)
        found[code] = Entry(cast(Level, level), *text.split(" => "))
    return found


TABLE = _read("""
file.cut             note     The file ends within line {line}, which was left out.
file.short           note     {rows} fewer cells than the header. The others were taken as empty.
file.infinite        note     {rows} an infinite number, which was taken as missing.
file.columns         note     Columns that were not read: {names}.
file.variables       note     Variables that were not read: {names}.
file.sections        note     Sections that were not read: {names}.
file.points          note     {count} points are not positions, and were not read.
file.frames          note     The header states {stated} frames; the file has {count}.
file.markers         note     The header states {stated} markers, but names {count}.
file.counter         note     The header cannot count beyond frame {last}; all {count} frames of the
    file were read.
file.unit            warning  The file states no unit of length; millimetres were assumed.
file.signed          note     {count} counts of {column} have the highest of {bits} bits set, and
    were read as negative.
marker.twice         warning  The marker {label} occurs again; it was renamed {name}.
marker.infinite      note     {count} positions are infinite, and were taken as missing.
marker.origin        note     {count} positions are exactly 0, 0, 0, and were taken as missing.
marker.never         warning  Never seen: {names}.
marker.filled        warning  {count} positions have the residual 0: the capture software filled
    them in; they were not measured.
servo.counts         warning  {count} positions lie outside 0 to {last} counts. Is this the scale of
    that servo?
time.none            note     Left out, without a time: {rows}.
time.order           note     Out of order, and sorted by time: {rows}.
time.restart         warning  The time falls back from {before:.6g} to {after:.6g} s in line {line}:
    two recordings in one file, or a clock that was set? => Split the file.
time.twice           note     Left out, with the time of another row: {rows}.
time.conflict        warning  {count} times have several rows with different values; none of these
    was taken as data.
time.first           note     The first frame is {frame}, so t begins at {start:.6g} s.
time.jump            warning  The time jumps {often} ({listed}): at {rate:.5g} Hz about {lacking}
    rows are missing.
time.uneven          warning  The rows do not come at a constant rate: {uneven} of {count} steps
    differ by more than {most:.0f} % from {usual:.4g} ms.
time.rate            warning  The header states {stated:.6g} Hz, but the times come at {rate:.6g}
    Hz. The times were used.
units.calendar       error    The times begin at {start:.10g}, like calendar time. Expected seconds
    since the command began; => subtract the time at which it did.
units.frames         error    The times look like frame numbers: steps of 1. Expected seconds; =>
    divide by the frame rate.
units.milliseconds   error    The times look like milliseconds: steps of {step:.6g}. Expected
    seconds; => divide by 1000.
units.time           error    The times do not look like seconds: steps of {step:.6g}. Expected
    seconds; => export the times in seconds.
units.place          error    The positions range over {widest:.6g}, which is no robot's motion in
    any unit. Expected metres.
units.millimetres    error    The positions look like millimetres or centimetres: ranges of
    {ranges}. Expected metres; => divide by 1000, or by 100.
units.angle          error    phi reaches {largest:.6g}, which is no servo's angle in any unit.
    Expected radians.
units.degrees        error    The angles look like degrees: phi reaches {largest:.4g}. Expected
    radians; => multiply by pi/180.
units.length         error    The joint moves {driven:.4g} in a period, and the robot is
    {length:.3g} m long. Expected metres: are these millimetres or centimetres?
units.heading        error    The heading turns by {psi:.4g} in a period, and phi by {phi:.3g}.
    Expected radians for both: is psi in degrees?
units.phi            error    phi moves {times:.3g} times as far as the gait. Expected about as far:
    is one of them in degrees, or did the servo not follow?
bodies.apart         note     Not stamped together with the first body, and put on its times:
    {names}.
layout.calibrated    warning  The layout was learnt from the recordings: platform 1 carries {one},
    platform 2 {two}; P is known to {joint:.2g} mm. The wheels roll about axles {c1:.1f} and
    {c2:.1f} mm from P, and along axes that are known to {angle:.2g} mrad: these are the zeros of
    psi and phi, so that an axle that toes in does not show.
layout.rolling       warning  The layout was learnt from the recording: one platform carries {one},
    the other {two}; P is known to {joint:.2g} mm. The wheels roll about axles {c1:.1f} and
    {c2:.1f} mm from P, and along axes that are known to {angle:.2g} mrad. Which platform is the
    first cannot be known: that of the first marker was taken.
layout.estimated     warning  The layout was learnt from the recording: one platform carries {one},
    the other {two}; P is known to {joint:.2g} mm. The robot drives too little to show which
    platform is the first, or the zeros of psi and phi: the first marker is taken to be on
    platform 1, and the axes to run through P and the mean of a platform's markers.
layout.absent        warning  The file has no {names}, which the layout names.
layout.unused        note     On neither platform, and not used: {names}.
layout.moved         warning  Marker {name} is {off:.1f} mm from where the layout has it, and
    {count} in all were moved: their positions were taken from the recording, the axes and the joint
    from the layout. If the layout is off as a whole, psi, phi and P are off with it.
swap.always          warning  The markers {names} are swapped in the whole recording: in the file or
    in the layout. They were swapped back. => Correct the layout.
swap.frames          note     Markers {names} have each other's names in {frames} {when}: swapped
    labels, put right.
ghost.marker         warning  Marker {name} is not where its platform is in {frames} {when}{off}: a
    ghost, or another marker's name? It was left out there.
lost.frames          warning  In {frames} {when} the markers do not fit two rigid platforms,
    whatever is left out. All channels are flagged there.
tilt.platform        warning  Platform {platform} leans by up to {most:.1f} deg in {frames} {when};
    usually by {usual:.2g} deg. A wheel off the floor, or a bump?
noise.markers        warning  The markers keep to rigid platforms to {noise:.2g} mm; the stated
    noise is {stated:.2g} mm. A platform that bends, or more noise than stated?
held.rows            warning  {count} samples repeat the previous one in every channel, {times}; the
    longest stretch lasts {longest:.3g} s, from t = {start:.6g} s. A frozen stream? Flagged.
filled.rows          warning  {count} samples follow a smooth curve in every channel, {times}; the
    longest stretch lasts {longest:.3g} s, from t = {start:.6g} s. Gaps that were filled? Flagged.
turns.angle          note     {angle} jumps by a whole turn {count} times. It was unwrapped.
steps.channel        warning  {channel} comes in steps of {step}, larger than its noise: it was
    rounded. Its errors are then not independent; => export more digits.
noise.few            warning  {channel} has too few consecutive samples to estimate its noise.
noise.zero           warning  {channel} has no noise at all: is it computed, or constant?
noise.large          warning  The noise of {channel} is {noise}, and {stated} {whose}. Every
    difference beyond that counts as a mismatch. => {remedy}
noise.small          warning  The noise of {channel} at the highest frequencies is {noise}, less
    than the {stated} that {whose}. {why} Smaller effects will not be found. => {remedy}
colour.filtered      warning  The noise of {channel} is not white: at half the frequency it is
    {colour:.3g} times as large. A filter upstream, or so little noise that the motion shows
    through; samples are then not independent.
colour.alternating   warning  The noise of {channel} is not white: at half the frequency it is only
    {colour:.2g} times as large. Two cameras in turn, or time stamps that jitter?
outlier.channel      note     {channel} has {count} ({share:.2g} % of its samples), at t = {listed}
    s. Flagged, not removed.
jump.channels        warning  Jumps at t = {t:.6g} s: {listed}. {why}
jump.more            warning  There are {count} more jumps.
gap.long             warning  {channels}: no data for {length:.3g} s after t = {start:.6g} s. The
    gap is not filled.
gap.many             warning  {count} gaps are longer than {most} s, {total:.3g} s in all.
gap.short            note     {count} of up to {longest:.0f} ms, {lost} samples: bridged in figures,
    not in the data.
motion.robot         warning  The robot hardly moves: the joint is never more than {far:.2g} mm from
    where it began. Such a recording says little about friction or inertia.
useless.empty        warning  There are no data of {channel}. Expected x, y, psi and phi.
useless.short        warning  Read {seconds:.3g} s, and {count} values of {channel}: too short.
    Expected at least {periods:g} periods of the gait and {least} values.
useless.gap          warning  Read no {channel} for {gap:.3g} s. Expected gaps of at most {most:g}
    s. => Cut the recording there.
useless.noisy        warning  phi moves by {moved:.3g} rad, next to nothing against its stated noise
    of {sigma:.3g} rad: too noisy. => Correct `noise.angle` if the noise is smaller.
useless.servo        warning  phi does not move: it stays within {moved:.2g} rad.
    Expected the servo to follow its command.
useless.robot        warning  The robot does not move. Expected it to drive.
useless.copy         warning  Read the same motion as {other}, which is to be fitted. Expected
    another run: a copy is no evidence. => Record one to hold out.
frame.wrong          error    Position and angles contradict rolling wheels: by {left:.3g} times
    their noise as they are, and by {best:.3g} times if {meant}. Expected one floor frame, psi the
    heading from P towards axle 1, and all angles counter-clockwise seen from above. => Correct the
    columns.
late.phi             warning  Some channels are late relative to the others: {late}. Rolling wheels
    couple them at every instant. Expected all channels of a row to be of one instant. => Shift
    them, if the capture is to blame, or export them anew.
late.place           warning  Some channels are late relative to the others: {late}. Rolling wheels
    couple them at every instant; wheels that creep sideways do so less. Expected all channels of a
    row to be of one instant. => Shift them, if the capture is to blame.
clock.change         error    The clock changes at t = {t:.4g} s: phi repeats every {before:.3g} s
    before, and every {after:.3g} s after. Expected seconds throughout. => Cut the recording there,
    or correct its times.
push.robot           warning  The robot was pushed, or lifted, at t = {t:.4g} s, where x = {x:.3g} m
    and y = {y:.3g} m: it moved {far:.3g} mm in a way that its wheels do not roll. => Cut the
    recording there.
push.surge           warning  The robot was pushed, or held, at t = {t:.4g} s, where x = {x:.3g} m
    and y = {y:.3g} m: it drove {far:.3g} mm more or less than in the periods before and after. =>
    Cut the recording there.
start.running        warning  The recording is said to start from rest, but at t = 0 the robot
    drives already, at about {speed:.3g} mm/s. Expected it to stand still at t = 0. => Write `start:
    running`, or cut the recording where the command begins.
command.still        warning  phi cannot be matched with its command: it does not move.
command.other        warning  phi does not follow its command: {scale:.2g} of its amplitude. Another
    gait, degrees, or the wrong file?
command.scale        warning  phi moves {scale:.4g} +- {half:.1g} times as far as commanded: {why}
command.bias         warning  phi is {bias:+.3g} mrad ({degrees:+.2g} deg) off its command on
    average: a servo mounted askew, or the zero of phi.
command.period       error    phi repeats every {period:.3g} s, and the gait every {commanded:.3g}
    s. Expected the gait that was driven. => Correct `gait`, or name the right file.
command.half         warning  phi is half a period off its command, {late:.2g} s of {period:.3g} s.
    Is t = 0 where the command begins, and is phi positive to the left?
command.signs        error    phi is half a period off its command in every recording. Expected phi
    positive where platform 2 turns counter-clockwise relative to platform 1, and psi
    counter-clockwise too, seen from above. => Correct the sign of both, or of phi alone if psi is
    right.
clock.start          warning  The recording is said to start from rest at t = 0, but it begins at t
    = {first:.6g} s. Is its clock the command's?
clock.offset         warning  phi {way} its command by {size:.3g} ms (95 %: {low:.3g} to {high:.3g}
    ms): {why}.
clock.drift          warning  The command's clock gains {drift:.3g} us/s on the recording's (95 %:
    {low:.3g} to {high:.3g}).
clock.rate           warning  The period of phi differs from its command's by {drift:+.3g} %: the
    recorder's clock runs fast or slow. The times were corrected by that.
clock.shifted        note     By the servo's log the command's clock is ahead of the recording's by
    {shift}, and gains {drift:+.3g} +- {half:.2g} us/s. The recording was put on the command's
    clock; times in warnings of reading it are the file's.{play}
clock.play           warning  By the servo's log the command's clock is ahead of the recording's by
    {shift}.{play} Nothing was shifted.
log.other            warning  phi and the servo's log share no motion: another run's log? It was not
    used.
log.clock            warning  The servo's clock is {offset:+.4f} s from the capture's (95 %:
    {low:+.4f} to {high:+.4f} s), and gains {drift:+.3g} +- {half:.2g} us/s. Nothing was shifted:
    that takes `goal` and `present` in the log, and the gait.
log.goal             warning  The goal in the log moves {scale:.4g} times as far as the stated gait:
    another gait, another run's log, or another count scale?
log.offsets          warning  The motion is periodic, and offsets of {others} s fit about as well.
    The one {taken} was taken. => Start both recordings before the command.
log.scale            warning  phi moves {scale:.4g} times as far as in the servo's log: its count
    scale, or play between servo and platform?
""")


class Notice(str):
    """A warning about a recording: the sentences, and the code of their entry in the table."""

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
    return Notice(f"{entry.sentence} {entry.remedy}".format(**values).strip(), code)


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


def when(t: NDArray[np.float64], rows: Sequence[int] | NDArray[np.int_]) -> str:
    """`at t = 3.21 s`, or `between t = 3.21 s and 4.5 s`, of rows in order."""
    first, last = float(t[rows[0]]), float(t[rows[-1]])
    if len(rows) == 1:
        return f"at t = {first:.6g} s"
    return f"between t = {first:.6g} s and {last:.6g} s"
