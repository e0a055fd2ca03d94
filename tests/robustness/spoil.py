"""A file that is right, spoiled: bytes, lines, cells, keys and times, by the rules of its kind."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import yaml

WORDS = (
    *("0", "-1", "1e-6", "1e308", "-1e308", "1e-320", ".nan", ".inf", "nan", "inf", "-inf", "5()"),
    *("9**9", "=1", "'=HYPERLINK(1)'", "{}", "[]", "null", "true", "~", "&a", "*a", "!!python/x"),
    *("?", "|", ">", "30rpm", "1e9s", "1 mm", "12:30", "0x10", "1_000", "/etc/passwd", "../x", "."),
    *("robot", "gait", "file", "rest", "holdout", "amplitude", "1" * 400, "\u00e9\u2028", "1,5"),
)
VALUES = (
    *(None, True, 0, -1, 0.7, 1e-6, 1e-12, 1e308, 10**30, float("nan"), float("inf")),
    *("", "x", "5 ()", "30 rpm", "3 s", "1 kg", "-2 mm", "/etc/passwd", [], {}, [0, 1], [1, 0]),
    *([[]], {"x": 1}, [None], {"from": 1, "to": 0, "count": -3}, "rest", "unknown"),
)
_BYTES = (
    b"",
    b",",
    b";",
    b"\t",
    b"\n",
    b"\r",
    b" ",
    b"\n\n",
    b"\0",
    b"\xff",
    b'"',
    b"\xef\xbb\xbf",
)


def spoiled(content: bytes, file: str, rng: np.random.Generator) -> bytes:
    """The content with one to three changes; file: its name, whose ending says what it is."""
    ending = file.rpartition(".")[2]
    ways = [_pieces, _pieces, _cut, _flipped]
    if ending in ("yaml", "json"):
        ways += [_keys] * 6
    if ending in ("csv", "tsv", "trc"):
        ways += [_cells] * 3 + [_lines] * 2 + [_columns, _encoded]
    if ending == "csv" and content.startswith(b"t,"):
        ways += [_times] * 2
    for _ in range(rng.choice([1, 1, 2, 3])):
        content = ways[rng.integers(len(ways))](content, rng)
    return content


def _word(rng: np.random.Generator) -> bytes:
    return str(rng.choice(np.array(WORDS, object))).encode()


def _pieces(content: bytes, rng: np.random.Generator) -> bytes:
    """A piece put in, taken out, moved or doubled."""
    at, length = int(rng.integers(len(content) + 1)), int(rng.choice([0, 0, 1, 4, 30, 400]))
    some = int(rng.integers(len(content) + 1))
    piece = (
        _word(rng), _BYTES[rng.integers(len(_BYTES))], rng.bytes(4), content[some : some + 40],
    )[rng.integers(4)]  # fmt: skip
    return content[:at] + piece + content[at + length :]


def _cut(content: bytes, rng: np.random.Generator) -> bytes:
    at = int(rng.integers(len(content) + 1))
    return content[at:] if rng.random() < 0.2 else content[:at]


def _flipped(content: bytes, rng: np.random.Generator) -> bytes:
    """Some bytes are others; of headers more often."""
    changed = bytearray(content)
    end = len(changed) if rng.random() < 0.5 else min(len(changed), 1200)
    for _ in range(rng.integers(1, 6)) if end else ():
        changed[rng.integers(end)] = rng.choice([0, 1, 127, 128, 255, rng.integers(256)])
    return bytes(changed)


def _keys(content: bytes, rng: np.random.Generator) -> bytes:
    """Somewhere in the tree another value, a key less, more, elsewhere or twice."""
    try:
        tree = yaml.safe_load(content)
    except (yaml.YAMLError, ValueError):
        return content
    nodes = list(_nodes(tree))
    if not nodes:
        return content
    parent, key = nodes[rng.integers(len(nodes))]
    kind = rng.integers(6)
    value = VALUES[rng.integers(len(VALUES))]
    other, place = nodes[rng.integers(len(nodes))]
    if kind == 0:
        del parent[key]
    elif kind == 1 and isinstance(parent, dict):
        parent[str(_word(rng), "utf-8")] = parent.pop(key)
    elif kind == 2:
        parent[key] = other[place]
        if _deep(tree):
            return content
    elif kind == 3 and isinstance(parent, list):
        parent[:] = parent * int(rng.choice([2, 40]))
    else:
        parent[key] = value
    if content.startswith(b"{\n"):
        return json.dumps(tree, default=str).encode()
    return yaml.dump(tree, sort_keys=False, allow_unicode=True, Dumper=_NoAlias).encode()


class _NoAlias(yaml.SafeDumper):
    """Repeats what occurs twice."""

    def ignore_aliases(self, data: Any) -> bool:
        return True


def _nodes(tree: Any):
    items = (
        tree.items()
        if isinstance(tree, dict)
        else enumerate(tree)
        if isinstance(tree, list)
        else ()
    )
    for key, value in list(items):
        yield tree, key
        yield from _nodes(value)


def _deep(tree: Any, above: tuple[int, ...] = ()) -> bool:
    """Whether a node holds itself."""
    if not isinstance(tree, dict | list):
        return False
    if id(tree) in above:
        return True
    inside = tree.values() if isinstance(tree, dict) else tree
    return any(_deep(one, (*above, id(tree))) for one in inside)


def _separator(content: bytes) -> bytes:
    return max((b",", b"\t", b";"), key=content.count)


def _cells(content: bytes, rng: np.random.Generator) -> bytes:
    """One cell, or many of one column, hold a word."""
    mark, lines = _separator(content), content.split(b"\n")
    word = _word(rng)
    column = int(rng.integers(max(lines[len(lines) // 2].count(mark), 1) + 1))
    rows = rng.integers(len(lines), size=rng.choice([1, 1, 30]))
    for row in rows.tolist():
        cells = lines[row].split(mark)
        if column < len(cells):
            cells[column] = word
            lines[row] = mark.join(cells)
    return b"\n".join(lines)


def _lines(content: bytes, rng: np.random.Generator) -> bytes:
    """Lines are lost, doubled or elsewhere."""
    lines = content.split(b"\n")
    begin, other = rng.integers(len(lines), size=2).tolist()
    end = begin + int(rng.choice([1, 2, 50]))
    taken = lines[begin:end]
    if rng.random() < 0.5:
        del lines[begin:end]
    if rng.random() < 0.7:
        lines[other:other] = taken
    return b"\n".join(lines)


def _columns(content: bytes, rng: np.random.Generator) -> bytes:
    """A column is lost, doubled or elsewhere, or the separator is another."""
    mark, lines = _separator(content), content.split(b"\n")
    if rng.random() < 0.3:
        return content.replace(mark, [b";", b"\t", b" ", b"|"][rng.integers(4)])
    column, other = rng.integers(max(lines[-2:][0].count(mark), 1) + 1, size=2).tolist()
    drop, put = rng.random() < 0.6, rng.random() < 0.6
    changed = []
    for line in lines:
        cells = line.split(mark)
        if column < len(cells):
            taken = cells.pop(column) if drop else cells[column]
            if put:
                cells.insert(other, taken)
        changed.append(mark.join(cells))
    return b"\n".join(changed)


def _encoded(content: bytes, rng: np.random.Generator) -> bytes:
    text = content.decode("utf-8", "replace")
    return (
        text.encode("utf-16"), text.encode("utf-8-sig"), text.replace("\n", "\r\n").encode(),
        text.replace("\n", "\r").encode(), text.replace(".", ",").encode(),
    )[rng.integers(5)]  # fmt: skip


def _times(content: bytes, rng: np.random.Generator) -> bytes:
    """The first column is another clock."""
    head, *rows = content.split(b"\n")
    cells = [row.split(b",") for row in rows if row]
    try:
        t = np.array([float(row[0]) for row in cells])
    except ValueError:
        return content
    n = len(t)
    if n == 0:
        return content
    odd = {
        "jitter": lambda: t + rng.normal(0, 5e-3, n),
        "close": lambda: np.where(
            rng.random(n) < 0.1, np.roll(t, 1) + 10.0 ** rng.integers(-9, -3), t
        ),
        "log": lambda: np.geomspace(1e-9, 3, n),
        "random": lambda: np.sort(rng.random(n)) ** 3,
        "reverse": lambda: t[::-1],
        "huge": lambda: np.where(rng.random(n) < 0.05, 10.0 ** rng.integers(-320, 308), t),
        "twice": lambda: np.floor(t * 30) / 30,
        "tiny": lambda: t * 10.0 ** rng.integers(-12, 12),
        "calendar": lambda: t + 1.7e9,
        "gap": lambda: np.where(t > 1, t + 10.0 ** rng.integers(0, 9), t),
    }
    found = odd[str(rng.choice(list(odd)))]()
    for row, one in zip(cells, found.tolist(), strict=True):
        row[0] = repr(one).encode()
    return b"\n".join([head, *(b",".join(row) for row in cells), b""])
