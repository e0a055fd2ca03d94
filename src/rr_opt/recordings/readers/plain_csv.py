"""Text with a header row, whatever its columns are called: the plain CSV, and the servo's log.

The first has `t,x,y,psi,phi[,torque]`, a row a sample, in SI units, the other `t,goal,present`, a
row a control step, in counts.
"""

import math
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType

import numpy as np

from rr_opt.array import Array
from rr_opt.files.issue import refuse
from rr_opt.messages import nearest, shown, unknown_word
from rr_opt.model.experiment import CHANNELS, UNITS, Column, Flag, Recording
from rr_opt.outcome import InputError
from rr_opt.recordings.readers.text import (
    Header,
    Reader,
    ReadOptions,
    Text,
    find_header,
    read_table,
)
from rr_opt.recordings.time_axis import in_order, rate_of, time_notices
from rr_opt.recordings.warnings import Notice, notice
from rr_opt.units import to_si


def read_columns(
    text: Text, needed: Sequence[str], known: Sequence[str], options: ReadOptions
) -> Recording:
    """The known channels that a text file with a header row has, over its column `t`.

    A name may have its unit in brackets. An empty cell, NaN or infinity is flagged MISSING, a row
    that stood in another place than its time OUT_OF_ORDER, and so is the first of rows that share
    a time and say different things. Raises InvalidFileError with every column that is needed and
    missing, or there twice, and for every cell that is not a number.
    """
    header = find_header(text)
    if header is None:
        expected = f"`{','.join(needed)}`"
        refuse(text.file, f"The file has no rows. Expected {expected}. Export it again.")
    header, units = _renamed(header, options.columns, known)
    _check(header, needed, known, options.columns, text.file)
    read = [name if name in known else None for name in header.names]
    table = read_table(text, header.at + 1, len(text.lines), header.separator, read)
    doubts = list(table.doubts)
    others = [one for one in header.names if one not in known]
    if others:
        doubts.append(notice("file.columns", names=shown(", ".join(others))))
    values: dict[str, Array] = {}
    for name in (one for one in known if one in header.names):
        column = options.columns.get(name, Column(name))
        if name in units and column.factor == 1:
            column = replace(column, factor=_factor(units[name], name, header, text.file))
        cells = table.values[:, header.names.index(name)]
        values[name], notices = converted(cells, column)
        doubts += notices
    t = values.pop("t")
    order = in_order(t, np.column_stack([*values.values()]), table.lines)
    t, values = t[order.rows], {name: one[order.rows] for name, one in values.items()}
    rate = rate_of(t, text.file, header.at + 1)
    apart = np.uint8(Flag.OUT_OF_ORDER) * (order.moved | order.unsure)
    noise = options.noise
    sigma = {one: noise.of(one) if noise else np.nan for one in values}
    return Recording(
        Path(text.file).name,
        t,
        MappingProxyType(values),
        MappingProxyType({one: np.full(len(t), size) for one, size in sigma.items()}),
        MappingProxyType(
            {name: np.uint8(Flag.MISSING) * np.isnan(one) | apart for name, one in values.items()}
        ),
        {"file": text.file, "encoding": text.encoding, "rate": f"{rate:.6g} Hz"},
        (*doubts, *order.doubts, *time_notices(t, rate)),
    )


def column_names(text: Text, columns: Mapping[str, Column], known: Sequence[str]) -> set[str]:
    """What the columns of a text file are called; nothing if it has no header row."""
    header = find_header(text)
    return set(_renamed(header, columns, known)[0].names) if header else set()


_WITH_UNIT = re.compile(r"(.*\S)\s*[\[(]([^\[\]()]+)[\])]")
"""A name and its unit, as in `x [mm]` or `Time (ms)`."""


def _renamed(
    header: Header, columns: Mapping[str, Column], known: Sequence[str]
) -> tuple[Header, dict[str, str]]:
    """The header with the names of the channels where other columns stand for them, and units."""
    split = [_WITH_UNIT.fullmatch(cell) for cell in header.cells]
    bare = [found[1].casefold() if found else "" for found in split]
    names = [
        short if short in known and short not in header.names else name
        for short, name in zip(bare, header.names, strict=True)
    ]
    for channel, column in columns.items():
        foreign = column.column.strip().casefold()
        there = next((row.index(foreign) for row in (header.names, bare) if foreign in row), None)
        if channel in known and there is not None:
            names = [f"{one}, as named" if one == channel else one for one in names]
            names[there] = channel
    units = {name: found[2] for name, found in zip(names, split, strict=True) if found}
    return replace(header, names=tuple(names)), units


def _factor(unit: str, channel: str, header: Header, file: str) -> float:
    """What 1 of the unit in a header is, SI. Raises InvalidFileError."""
    si = UNITS.get(channel, "")
    if unit == si:
        return 1.0
    try:
        return to_si(f"1 {unit}", si)
    except InputError as error:
        refuse(file, f"The unit of `{channel}`: {error}", header.at + 1)


def converted(values: Array, column: Column) -> tuple[Array, list[Notice]]:
    """Counts with their sign, and in SI."""
    notices = []
    if column.bits:
        negative = values >= 2 ** (column.bits - 1)
        values = np.where(negative, values - 2**column.bits, values)
        if negative.any():
            notices.append(
                notice("file.signed", count=negative.sum(), column=column.column, bits=column.bits)
            )
    return values * column.factor, notices


def _check(
    header: Header,
    needed: Sequence[str],
    known: Sequence[str],
    columns: Mapping[str, Column],
    file: str,
) -> None:
    line = header.at + 1
    if header.names and all(_is_number(name) for name in header.names):
        refuse(
            file,
            f"Read numbers in the first row. Expected a header row, `{','.join(needed)}`. "
            "Write it above the numbers.",
            line,
        )
    twice = [name for name in known if header.names.count(name) > 1]
    missing = [name for name in needed if name not in header.names]
    wrong = []
    if twice:
        wrong.append(f"Read the column `{twice[0]}` twice. Expected it once. Delete one of them.")
    if missing:
        others = [_WITH_UNIT.sub(r"\1", name) for name in header.names if name not in known]
        advice = "Add what is missing."
        if guessed := guesses(others, missing):
            meant = {name: Column(one, unit=_unit_in(one, name)) for name, one in guessed.items()}
            meant |= {name: one for name, one in columns.items() if name in header.names}
            named = [(name, meant[name]) for name in known if name in meant]
            entries = ", ".join(f"{name}: {_entry(one)}" for name, one in named)
            advice = f"Rename them, or write `columns: {{{entries}}}` in the experiment file"
            if all(one.unit or (one.factor == 1 and not one.bits) for _, one in named):
                options = ",".join(
                    f"{name}={one.column}" + (f" [{one.unit}]" if one.unit else "")
                    for name, one in named
                )
                advice += f', or --columns "{options}" for one recording'
            advice += "."
        # A letter alone is like no other: the columns that there are say more.
        wrong.append(
            f"Read the columns {shown(', '.join(header.names))}. Expected also "
            f"{', '.join(f'`{name}`' for name in missing)}. {advice}"
        )
    if wrong:
        refuse(file, " ".join(wrong), line)


def _entry(column: Column) -> str:
    """A column as an experiment file has it."""
    factor = f"1 {column.unit}" if column.unit else f"{column.factor:.9g}"
    parts = [f"column: {column.column}"]
    parts += [f"factor: {factor}"] if factor != "1" else []
    parts += [f"bits: {column.bits}"] if column.bits else []
    return f"{{{', '.join(parts)}}}" if len(parts) > 1 else column.column


def _unit_in(name: str, channel: str) -> str:
    """The unit at the end of a name, as in `x_mm`; empty if there is none or it is SI."""
    unit = name.rpartition("_")[2]
    try:
        return "" if to_si(f"1 {unit}", UNITS.get(channel, "")) == 1.0 else unit
    except InputError:
        return ""


def _is_number(cell: str) -> bool:
    try:
        float(cell.replace(",", "."))
    except ValueError:
        return False
    return True


_CHANNELS = (*UNITS, "goal", "present")


def columns_from(given: Mapping[str, str]) -> dict[str, Column]:
    """Columns by channel, of names such as `yaw [deg]`. Raises InputError for another channel."""
    found = {}
    for channel, name in given.items():
        if channel not in _CHANNELS:
            raise InputError(unknown_word(channel, _CHANNELS, "channel"))
        split = _WITH_UNIT.fullmatch(name.strip())
        column, unit = (split[1], split[2]) if split else (name.strip(), "")
        factor = to_si(f"1 {unit}", UNITS.get(channel, "")) if unit else 1.0
        found[channel] = Column(column, factor, unit=unit)
    return found


_FOREIGN = {
    "t": ("time", "timestamp", "seconds", "sec"),
    "psi": ("yaw", "heading", "theta", "orientation"),
    "phi": ("joint", "steering", "servo", "angle", "alpha", "theta"),
    "torque": ("load", "moment", "tau"),
}
"""What others call the channels, the likeliest first."""


def guesses(names: Collection[str], missing: Sequence[str]) -> dict[str, str]:
    """By channel, the columns that may be the missing ones, by the beginning of their names."""
    found: dict[str, str] = {}
    for channel in missing:
        free = [name for name in names if name not in found.values()]
        meant = [
            name
            for word in (channel, *_FOREIGN.get(channel, ()))
            for name in free
            if re.split(r"[^a-z]", name)[0] == word
        ]
        meant += [name for name in free if nearest(name, [channel]) == channel]
        if meant:
            found[channel] = meant[0]
    return found


_NEEDED = ("t", *CHANNELS)
_KNOWN = (*_NEEDED, "torque")


def is_motion(text: Text, options: ReadOptions) -> bool:
    """Whether a header row has the time, or several of the channels, if by another name."""
    names = column_names(text, options.columns, _KNOWN)
    return "t" in names or len(names & set(CHANNELS)) > 1 or len(guesses(names, _NEEDED)) > 2


def read_motion(_: str, text: Text, options: ReadOptions) -> Recording:
    """The recording of a plain CSV; columns in any order; unknown ones are reported."""
    found = read_columns(text, _NEEDED, _KNOWN, options)
    source = {**found.source, "format": "plain CSV", "clock": "the recording's own t"}
    return replace(found, source=MappingProxyType(source))


MOTION = Reader("plain CSV", is_motion, read_motion)


@dataclass(frozen=True)
class ServoLog:
    """A servo's log of n rows, on the servo's own clock.

    name            of the file
    t               (n,), s, increasing, on the servo's clock, which is not the capture's
    goal, present   (n,), counts as in the file, NaN where empty; None: the file has no such column
    goal_angle      (n,), rad, phi as commanded: (goal - zero) times the angle of a count; or None
    present_angle   (n,), rad, phi as the servo's own encoder had it; or None
    resolution      the angle of one count, rad
    rate            rows per second, Hz, as the times have it
    source          where it came from, plain text by name
    doubts          sentences on what looked wrong and what was made of it
    """

    name: str
    t: Array
    goal: Array | None
    present: Array | None
    goal_angle: Array | None
    present_angle: Array | None
    resolution: float
    rate: float
    source: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))
    doubts: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.t)


_POSITIONS = ("goal", "present")


def is_log(text: Text, options: ReadOptions) -> bool:
    """Whether a header row has one of the positions and none of a recording's channels."""
    names = column_names(text, options.columns, ("t", *CHANNELS, *_POSITIONS))
    return bool(names & set(_POSITIONS)) and not names & set(CHANNELS)


def read_log(file: str, text: Text, options: ReadOptions) -> ServoLog:
    """The log of a CSV with a column `t` (s) and at least one of `goal` and `present` (counts).

    Positions of rows that stood in another place than their time, or share it with a row that
    says something else, are NaN.
    """
    scale = options.counts
    known = ("t", *_POSITIONS)
    names = column_names(text, options.columns, known)
    needed = ("t", *([one for one in _POSITIONS if one in names] or _POSITIONS))
    found = read_columns(text, needed, known, replace(options, noise=None))
    counts = {one: found.data(one) for one in found.channels}
    doubts = found.doubts
    outside = sum(((one < 0) | (one >= scale.counts)).sum() for one in counts.values())
    if outside:
        doubts += (notice("servo.counts", count=outside, last=scale.counts - 1),)
    angles = {one: (read - scale.zero) * scale.each for one, read in counts.items()}
    source = {
        **found.source,
        "format": "servo log CSV",
        "clock": "the servo's own t",
        "scale": f"{scale.counts} counts over {math.degrees(scale.range):.6g} degrees, "
        f"phi = 0 at {scale.zero:g}",
    }
    return ServoLog(
        name=found.name,
        t=found.t,
        goal=counts.get("goal"),
        present=counts.get("present"),
        goal_angle=angles.get("goal"),
        present_angle=angles.get("present"),
        resolution=abs(scale.each),
        rate=rate_of(found.t, file),
        source=MappingProxyType(source),
        doubts=doubts,
    )


LOG = Reader("servo log CSV", is_log, read_log)
