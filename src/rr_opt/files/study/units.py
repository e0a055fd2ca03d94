"""What a key of a problem is, told from its path: a quantity and its unit, or something else."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from rr_opt.files.document import Path, path_text
from rr_opt.files.issue import unknown_word
from rr_opt.files.schemas import schema
from rr_opt.outcome import InputError

_STEP = re.compile(r"(?:^|\.)([A-Za-z_][A-Za-z0-9_-]*)|\[([0-9]{1,3})\]")


@dataclass(frozen=True)
class Key:
    """A key of a problem file.

    unit   SI unit of a quantity, "" of a plain number, None of anything else
    """

    name: str
    path: Path
    unit: str | None


def key_of(name: str) -> Key:
    """The key of this name. Raises InputError if no problem file has such a key."""
    path = _split(name)
    whole = problem_schema()
    nodes = [whole]
    unit = None
    for depth, part in enumerate(path):
        below, known = [], []
        for node in nodes:
            found, offered = _below(node, part, whole)
            below += found
            known += offered
        if not below:
            raise InputError(_unknown(path[:depth], part, known))
        nodes = below
        # An end of a pair has the unit of the pair.
        units = [node["x-unit"] for node in _unfolded(nodes, whole) if "x-unit" in node]
        unit = units[0] if units else unit if isinstance(part, int) else None
    return Key(name, path, "" if unit == "dimensionless" else unit)


@lru_cache
def problem_schema() -> dict[str, Any]:
    """The JSON Schema of problem files, read once."""
    return schema("problem")


def _split(name: str) -> Path:
    path: list[str | int] = []
    place = 0
    while place < len(name):
        step = _STEP.match(name, place)
        if step is None:
            break
        path.append(step[1] if step[1] else int(step[2]))
        place = step.end()
    if place < len(name) or not path:
        raise InputError(
            f"Read the key {name!r}. Expected the path of a key in a problem file. "
            "Write for example `limits.rate` or `robot.physics[0].force1`."
        )
    return tuple(path)


def _unfolded(nodes: list[dict[str, Any]], whole: dict[str, Any]) -> list[dict[str, Any]]:
    """The nodes, with references followed and every alternative beside them."""
    seen: list[dict[str, Any]] = []
    todo = list(nodes)
    while todo:
        node = todo.pop()
        if "$ref" in node:
            todo.append(whole["$defs"][node["$ref"].removeprefix("#/$defs/")])
        todo += [*node.get("anyOf", []), *node.get("oneOf", [])]
        seen.append(node)
    return seen


def _below(
    node: dict[str, Any], part: str | int, whole: dict[str, Any]
) -> tuple[list[dict[str, Any]], list[str]]:
    """What stands under a key or an index of a node, and the keys that could."""
    found: list[dict[str, Any]] = []
    known: list[str] = []
    for one in _unfolded([node], whole):
        known += one.get("properties", {})
        if isinstance(part, int) and "items" in one:
            found.append(one["items"])
        elif part in one.get("properties", {}):
            found.append(one["properties"][part])
    return found, known


def _unknown(before: Path, part: str | int, known: list[str]) -> str:
    place = f"`{path_text(before)}`" if before else "a problem"
    if isinstance(part, int):
        return f"Read the index [{part}]. Expected a key: {place} is no list. Delete the index."
    if not known:
        return f"Read `{part}` below {place}. Expected nothing: it has no keys. Delete `.{part}`."
    return unknown_word(part, list(dict.fromkeys(known)), f"key below {place},")
