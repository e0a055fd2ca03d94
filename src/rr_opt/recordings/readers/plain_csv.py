"""The plain CSV: a header row `t,x,y,psi,phi[,torque]`, then a row a sample, in SI units."""

from pathlib import Path
from types import MappingProxyType

import numpy as np

from rr_opt.model.experiment import CHANNELS, Flag, Recording
from rr_opt.recordings.readers.columns import column_names, guesses, read_columns
from rr_opt.recordings.readers.text import Reader, ReadOptions, Text

_NEEDED = ("t", *CHANNELS)
_KNOWN = (*_NEEDED, "torque")


def sniff(text: Text, options: ReadOptions) -> bool:
    """Whether a header row has the time, or several of the channels, if by another name."""
    names = column_names(text, options.columns, _KNOWN)
    return "t" in names or len(names & set(CHANNELS)) > 1 or len(guesses(names, _NEEDED)) > 2


def read(file: str, text: Text, options: ReadOptions) -> Recording:
    """The recording of a plain CSV; columns in any order; unknown ones are reported.

    An empty cell, NaN or infinity is flagged MISSING, a row that stood in another place than its
    time OUT_OF_ORDER, and so is the first of rows that share a time and say different things.
    """
    found = read_columns(text, _NEEDED, _KNOWN, options.columns)
    flags = np.where(np.isnan(found.values), Flag.MISSING, 0).astype(np.uint8)
    flags[found.order.moved | found.order.unsure] |= np.uint8(Flag.OUT_OF_ORDER)
    noise = options.noise
    sigma = {one: noise.of(one) if noise else np.nan for one in found.names}
    source = {**found.source, "format": "plain CSV", "clock": "the recording's own t"}
    return Recording(
        Path(file).name,
        found.t,
        MappingProxyType(dict(zip(found.names, found.values.T.copy(), strict=True))),
        MappingProxyType({one: np.full(len(found.t), size) for one, size in sigma.items()}),
        MappingProxyType(dict(zip(found.names, flags.T.copy(), strict=True))),
        MappingProxyType(source),
        found.doubts,
    )


READER = Reader("plain CSV", sniff, read)
