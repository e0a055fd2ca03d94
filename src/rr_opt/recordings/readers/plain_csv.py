"""The plain CSV: a header row `t,x,y,psi,phi[,torque]`, then a row a sample, in SI units."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from rr_opt.messages import shown
from rr_opt.model.experiment import CHANNELS, Flag, Noise, Recording
from rr_opt.recordings.readers.text import Text, check_columns, find_header, read_table, refuse
from rr_opt.recordings.time_axis import in_order, rate_of, time_doubts

_NEEDED = ("t", *CHANNELS)
_KNOWN = (*_NEEDED, "torque")


def recording_from_csv(text: Text, name: str, noise: Noise | None = None) -> Recording:
    """The recording of a plain CSV; columns in any order, others than those known are told.

    noise: standard deviations; without it they are NaN. An empty cell, NaN or infinity is flagged
    MISSING, a row that stood in another place than its time OUT_OF_ORDER, and so is the first of
    rows that share a time and say different things. Raises InvalidFileError.
    """
    header = find_header(text)
    if header is None:
        refuse(text.file, "The file holds no rows. Expected `t,x,y,psi,phi`. Export it once more.")
    columns = check_columns(header, _NEEDED, _KNOWN, text.file)
    table = read_table(text, header.at + 1, len(text.lines), header.separator, header.names)
    doubts = list(table.doubts)
    others = [one for one in header.names if one not in _KNOWN]
    if others:
        doubts.append(f"Columns that were not read: {shown(', '.join(others))}.")
    t = table.values[:, columns["t"]]
    channels = [name for name in _KNOWN[1:] if name in columns]
    values = table.values[:, [columns[name] for name in channels]]
    order = in_order(t, values, table.lines)
    t, values = t[order.rows], values[order.rows]
    rate = rate_of(t, text.file, header.at + 1)
    flags = np.where(np.isnan(values), Flag.MISSING, 0).astype(np.uint8)
    flags[order.moved | order.unsure] |= np.uint8(Flag.OUT_OF_ORDER)
    source = {
        "file": text.file,
        "format": "plain CSV",
        "encoding": text.encoding,
        "rate": f"{rate:.6g} Hz",
        "clock": "the recording's own t",
    }
    return Recording(
        name,
        t,
        _by_channel(channels, values),
        MappingProxyType(
            {one: np.full(len(t), noise.of(one) if noise else np.nan) for one in channels}
        ),
        _by_channel(channels, flags),
        MappingProxyType(source),
        (*doubts, *order.doubts, *time_doubts(t, rate)),
    )


def _by_channel(channels: list[str], values: NDArray) -> Mapping[str, NDArray]:
    return MappingProxyType(
        {name: np.ascontiguousarray(values[:, at]) for at, name in enumerate(channels)}
    )
