"""Recordings of any machine: CSV with a header row, or JSON with `entries`."""

import json
from collections.abc import Container, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from rr_opt.array import Array
from rr_opt.files.issue import Issue, refuse
from rr_opt.files.machine_file import MachinePlan, PlannedRecording
from rr_opt.files.source import LONG, read_content
from rr_opt.messages import shown
from rr_opt.model.experiment import Column
from rr_opt.model.machine import Channel, MachineExperiment, MachineRun
from rr_opt.outcome import InputError
from rr_opt.recordings.cleaning import LARGEST
from rr_opt.recordings.copies import Rows, copied, machine_rows_of
from rr_opt.recordings.readers.plain_csv import converted
from rr_opt.recordings.readers.text import decode, find_header, read_table
from rr_opt.recordings.time_axis import LATEST, longest_rising

_WILD = 8.0
"""Times the usual distance from the neighbours' median beyond which a sample is wild."""

_MANY = 100
"""Samples from which a function can be distinguished from a measurement."""

_CROSSED = 5.0
"""Largest total variation of a function of the angle along it, in units of its range."""

_STILL, _JUMP = 5, 3.0
"""Of a stuck sensor: repeated samples, and the step after them relative to usual large ones."""

_FEWEST = 50
"""Fewest values of a usable channel."""

_UPDATES = 50
"""Updates of the inputs from which their clock can be determined."""


def machine_experiment(plan: MachinePlan) -> tuple[MachineExperiment, list[Issue]]:
    """The experiment with its runs, and all issues of the recordings; nothing is raised."""
    runs, issues = [], []
    seen: list[tuple[str, Rows]] = []
    for k, one in enumerate(plan.recordings):
        try:
            run = _run(plan, one)
            rows = machine_rows_of(run)
            original = copied(rows, seen)
            if original is not None:
                raise InputError(
                    f"Read the same motion as {original}. Expected a different run: a copy is no "
                    "evidence. Remove one of the two."
                )
        except InputError as error:
            where = ("recordings", k, "file")
            issues.append(plan.document.error(where, str(error)))
            continue
        runs.append(run)
        seen.append((run.name, rows))
        issues += [Issue("warning", "", text, None, str(one.file)) for text in run.doubts]
    return replace(plan.experiment, runs=tuple(runs)), issues


def _run(plan: MachinePlan, one: PlannedRecording) -> MachineRun:
    machine, time = plan.experiment.machine, Channel("t", "s", "the time")
    where = [_where(one, channel) for channel in (time, *machine.channels)]
    named = {_plain(each.column) for each in where if isinstance(each, Column)}
    table = read_columns(one.file, named)
    t = _channel(one, table, time)
    timed = np.flatnonzero(np.abs(t) < LATEST)
    rising = timed[longest_rising(t[timed])]
    keep = rising[np.diff(t[rising], prepend=-np.inf) > 0]
    doubts = []
    if dropped := t.size - keep.size:
        why = "their times repeat, run backwards or are missing"
        doubts.append(f"Rows dropped because {why}: {dropped}.")
    data = {c.name: _channel(one, table, c)[keep] for c in machine.channels}
    t = t[keep]
    if t.size < _FEWEST:
        raise InputError(f"Read {t.size} rows. Expected {_FEWEST} or more. Record for longer.")
    t = t - t[0]
    sigma: dict[str, float] = {}
    for c in machine.channels:
        known = np.abs(data[c.name]) < LARGEST
        if known.sum() < _FEWEST:
            raise InputError(
                f"Read {known.sum()} numbers for {c.name} ({c.words}). Expected {_FEWEST} or more. "
                "Correct `columns`, or leave the recording out."
            )
        y = np.full(t.size, np.nan)
        y[known] = np.unwrap(data[c.name][known]) if c.angle else data[c.name][known]
        y, wild = _without_wild(y)
        if wild:
            doubts.append(f"{c.name}: outliers dropped: {wild}.")
        if c in machine.inputs:
            known = np.isfinite(y)
            y = np.interp(t, t[known], y[known])
        data[c.name] = y
    held = held_for([data[c.name] for c in machine.inputs])
    for c in machine.channels:
        if c.steady and (own := held_for([data[c.name]])) > 1:
            data[c.name] = between_updates(data[c.name], own)
            # Of a parabola about its chords.
            usual = float(np.sqrt(np.mean(np.diff(data[c.name][::own], 2) ** 2) / 120))
        elif c in machine.inputs:
            usual = input_noise(data[c.name], held)
        else:
            usual = noise_of(data[c.name])
        sigma[c.name] = plan.noise.get(c.name, usual)
    doubts += _impossible(machine.inputs, machine.outputs, data)
    return MachineRun(
        one.file.name,
        t,
        {c.name: data[c.name] for c in machine.inputs},
        {c.name: data[c.name] for c in machine.outputs},
        sigma,
        one.use == "holdout",
        tuple(doubts),
        held,
    )


def held_for(inputs: Sequence[Array]) -> int:
    """Samples for which inputs stand still between two updates; 1 if they follow every sample."""
    changes = np.flatnonzero(np.any([np.diff(y) != 0 for y in inputs], axis=0))
    if changes.size < _UPDATES:
        return 1
    return max(int(np.percentile(np.diff(changes), 10)), 1)


def between_updates(y: Array, held: int) -> Array:
    """A sampled and held signal, made linear from update to update."""
    changes = np.flatnonzero(np.diff(y) != 0) + 1
    still = changes[np.diff(changes, prepend=0) > 1.5 * held] - held
    knots = np.union1d(np.append(changes, 0), still[still >= 0])
    return np.interp(np.arange(y.size), knots, y[knots])


def input_noise(y: Array, held: int) -> float:
    """One sigma of an input.

    One that is sampled and held is uniformly distributed between two updates. One that changes
    direction at most samples is noisy, by its third differences. Any other is taken as exact.
    """
    if held > 1:
        return float(np.sqrt(np.mean(np.diff(y[::held]) ** 2) / 12))
    d = np.diff(y)
    d = d[d != 0]
    noisy = d.size > 0.3 * y.size and np.mean(d[1:] * d[:-1] < 0) > 0.5
    return noise_of(y) if noisy else 0.0


def noise_of(y: Array) -> float:
    """One sigma: of a rounded signal its step over sqrt(12), or what its third differences say."""
    values = np.unique(y[np.isfinite(y)])
    if values.size < 2:
        return 1e-6
    step = float(np.median(np.diff(values))) if values.size < 0.7 * y.size else 0.0
    third = np.diff(y, 3)
    rough = float(np.nanmedian(np.abs(third))) / 0.6745 / np.sqrt(20)
    return max(step / np.sqrt(12), rough, 1e-9 * float(np.ptp(values)))


def _without_wild(y: Array) -> tuple[Array, int]:
    """NaN where a sample is far from the median of five."""
    wide = np.lib.stride_tricks.sliding_window_view(np.pad(y, 2, mode="edge"), 5)
    off = np.abs(y - np.median(wide, axis=1))
    usual = float(np.nanmedian(off[off > 0])) if (off > 0).any() else 0.0
    wild = off > max(_WILD * usual / 0.6745, 0.05 * float(np.nanstd(y)), 1e-12)
    return np.where(wild, np.nan, y), int(wild.sum())


def _impossible(
    inputs: tuple[Channel, ...], outputs: tuple[Channel, ...], data: Mapping[str, Array]
) -> list[str]:
    """What contradicts the file's statements."""
    said = []
    for c in outputs:
        y = data[c.name]
        if np.nanstd(y) < 20 * noise_of(y):
            said.append(
                f"{c.name} hardly moves ({np.nanstd(y):.3g} {c.unit} in all): it tells little."
            )
        for u in inputs:
            x = data[u.name]
            if np.ptp(x) == 0:
                continue
            # A function of the angle goes up and down a few times along it, a measurement always.
            known = np.isfinite(y)
            along = x[known][np.argsort(y[known], kind="stable")]
            crossed = float(np.abs(np.diff(along)).sum())
            if along.size > _MANY and crossed < _CROSSED * np.ptp(x) and u.unit == "N m":
                said.append(
                    f"{u.name} is a function of {c.name}: a command rather than a measurement?"
                )
        if stuck := _stuck(y):
            said.append(f"{c.name} is frozen to the last digit and then jumps, {stuck} times.")
    return said


def _stuck(y: Array) -> int:
    """How often a value repeats for long and is left by a step larger than those around it."""
    steps = np.abs(np.diff(y))
    moves = np.flatnonzero(steps > 0)
    if moves.size < _MANY // 10:
        return 0
    still = np.diff(moves) - 1
    after = steps[moves[1:]]
    return int(np.sum((still >= _STILL) & (after > _JUMP * np.percentile(steps[moves], 95))))


def read_columns(file: Path, named: Container[str]) -> dict[str, Array]:
    """Columns (n,) by name; a number in a JSON file's head is constant.

    Columns that are not named may hold anything; they are NaN. Raises InputError.
    """
    content = read_content(file, LONG)
    if content.lstrip().startswith(b"{"):
        try:
            data = json.loads(content)
            entries = data["entries"]
            names = list(entries[0])
            table = {
                k: np.array([row[k] if _plain(k) in named else np.nan for row in entries], float)
                for k in names
            }
        except (ValueError, KeyError, TypeError, IndexError, RecursionError) as error:
            refuse(str(file), f"Read JSON that does not fit: {error!r}. Expected `entries`, a list "
                   "of mappings from column to number.")  # fmt: skip
        heads = {k: v for k, v in data.items() if isinstance(v, int | float)}
        size = len(entries)
        return {**{k: np.full(size, float(v)) for k, v in heads.items()}, **table}
    text = decode(content, str(file))
    header = find_header(text)
    if header is None:
        refuse(str(file), "The file has no rows. Expected a header row and numbers.")
    names = [name if name in named else None for name in header.names]
    table = read_table(text, header.at + 1, len(text.lines), header.separator, names)
    return {name: table.values[:, k] for k, name in enumerate(header.names)}


def _where(one: PlannedRecording, channel: Channel) -> Column | float:
    return one.columns.get(channel.name, Column(channel.name))


def _plain(name: str) -> str:
    return name.strip().casefold()


def _channel(one: PlannedRecording, table: Mapping[str, Array], channel: Channel) -> Array:
    size = len(next(iter(table.values())))
    where = _where(one, channel)
    if not isinstance(where, Column):
        return np.full(size, where)
    found = {_plain(name): y for name, y in table.items()}
    name = _plain(where.column)
    if name not in found:
        if channel.default is not None and channel.name not in one.columns:
            return np.full(size, channel.default)
        raise InputError(
            f"{one.file.name}: Read the columns {shown(', '.join(table))}. Expected "
            f"`{where.column}` for {channel.name} ({channel.words}). "
            f"Write `columns: {{{channel.name}: ...}}`."
        )
    return converted(found[name], where)[0]
