"""The parameters of a C3D file: groups of named numbers and texts (c3d.org, user guide).

A chain of entries, each with the distance to the next. Nothing in a damaged chain is followed out
of the file or backwards.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import prod

import numpy as np
from numpy.typing import NDArray

INTEL, DEC, MIPS = 84, 85, 86
"""The processors whose numbers a file may hold, as byte 4 of the parameters names them."""

_TYPES = {-1: "S1", 1: "i1", 2: "i2", 4: "f4"}
_MOST_ENTRIES = 5000

Values = tuple[float, ...] | tuple[str, ...]


def numbers(content: bytes, kind: str, count: int, start: int, processor: int) -> NDArray:
    """`count` numbers of a numpy kind (`i2`, `u2`, `f4`, ...) in a processor's form, from a byte.

    Raises ValueError if the content ends before.
    """
    if start < 0 or count < 0 or start + count * np.dtype(kind).itemsize > len(content):
        raise ValueError("it ends before its parameters do")
    if kind == "f4" and processor == DEC:
        # A VAX float is an IEEE float times four, its 16-bit halves the other way round.
        halves = np.frombuffer(content, "<u2", 2 * count, start).reshape(-1, 2)
        return np.ascontiguousarray(halves[:, ::-1]).view("<f4")[:, 0] / np.float32(4)
    order = ">" if processor == MIPS else "<"
    return np.frombuffer(content, f"{order}{kind}", count, start)


def read_parameters(content: bytes, start: int, processor: int) -> Mapping[str, Values]:
    """All parameters, by `GROUP:NAME`, of the section that starts at a byte.

    Raises ValueError for a chain that leaves the file.
    """
    groups: dict[int, str] = {}
    found: list[tuple[int, str, Values]] = []
    at = start + 4
    for _ in range(_MOST_ENTRIES):
        length, group = (int(one) for one in numbers(content, "i1", 2, at, processor))
        name_end = at + 2 + abs(length)
        if length == 0 or group == 0:
            break
        name = content[at + 2 : name_end].decode("latin-1").strip().upper()
        step = int(numbers(content, "i2", 1, name_end, processor)[0])
        if group < 0:
            groups[-group] = name
        else:
            found.append((group, name, _values(content, name_end + 2, processor)))
        if step <= 0:
            break
        at = name_end + step
    return {f"{groups.get(group, '')}:{name}": values for group, name, values in found}


def _values(content: bytes, at: int, processor: int) -> Values:
    """What a parameter holds: numbers, or texts along its first dimension."""
    kind, dimensions = (int(one) for one in numbers(content, "i1", 2, at, processor))
    sizes = [int(one) for one in numbers(content, "u1", max(dimensions, 0), at + 2, processor)]
    first = at + 2 + len(sizes)
    if kind not in _TYPES:
        raise ValueError(f"a parameter of the type {kind}")
    if kind != -1:
        return tuple(
            float(one) for one in numbers(content, _TYPES[kind], prod(sizes), first, processor)
        )
    width = sizes[0] if sizes else 1
    count = prod(sizes[1:])
    if first + width * count > len(content):
        raise ValueError("a text beyond its end")
    return tuple(
        content[first + width * n : first + width * (n + 1)].decode("latin-1").strip(" \0")
        for n in range(count)
    )
