"""The keys that a study may vary: what each is and its unit, and the problem with others set."""

import copy
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from rr_opt.files.issue import Issue
from rr_opt.files.problem_file import Sources, with_robot
from rr_opt.files.schemas import schema
from rr_opt.files.yaml_text import KeyPath, path_text
from rr_opt.messages import shown, unknown_word
from rr_opt.outcome import InputError

_STEP = re.compile(r"(?:^|\.)([A-Za-z_][A-Za-z0-9_-]*)|\[([0-9]{1,3})\]")


@dataclass(frozen=True)
class ProblemKey:
    """A key of a problem file.

    unit   SI unit of a quantity, "" of a plain number, None of anything else
    """

    name: str
    path: KeyPath
    unit: str | None


def key_of(name: str) -> ProblemKey:
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
    return ProblemKey(name, path, "" if unit == "dimensionless" else unit)


@lru_cache
def problem_schema() -> dict[str, Any]:
    """The JSON Schema of problem files, read once."""
    return schema("problem")


def _split(name: str) -> KeyPath:
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


def _unknown(before: KeyPath, part: str | int, known: list[str]) -> str:
    place = f"`{path_text(before)}`" if before else "a problem"
    if isinstance(part, int):
        return f"Read the index [{part}]. Expected a key: {place} is no list. Delete the index."
    if not known:
        return f"Read `{part}` below {place}. Expected nothing: it has no keys. Delete `.{part}`."
    return unknown_word(part, list(dict.fromkeys(known)), f"key below {place},")


Setting = tuple[KeyPath, Any]
"""Where a value goes in the problem, and the value as a file would hold it."""


class _CannotSetError(Exception):
    """A value has no place in the problem; says why."""


def with_values(
    base: Sources, settings: Sequence[Setting], file: Path
) -> tuple[Sources, list[Issue]]:
    """The problem with values set in it, and an issue for each that has no place in it.

    Robots are named relative to `file`.
    """
    problem, robot = base.problem, base.robot
    problem = replace(problem, data=copy.deepcopy(problem.data))
    paths, issues = base.paths, base.issues
    misplaced: list[Issue] = []
    # A robot that is named goes first: other settings may change it.
    for keys, value in sorted(settings, key=lambda setting: len(setting[0])):
        if keys == ("robot",):
            changed = replace(problem, data={**problem.data, "robot": value})
            sources = with_robot(changed, file)
            problem, robot, issues = changed, sources.robot, sources.issues
            paths = (*paths, *sources.paths)
            continue
        target, below = problem, keys
        if keys[0] == "robot":
            if robot is None:
                continue
            target = robot = replace(robot, data=copy.deepcopy(robot.data))
            below = keys[1:]
        try:
            _set(target.data, below, value)
        except _CannotSetError as error:
            misplaced.append(Issue("error", path_text(keys), str(error)))
    return Sources(paths, problem, robot, issues), misplaced


def _set(data: Any, keys: KeyPath, value: Any) -> None:
    """Set a value in nested data; sections that are missing are made."""
    for depth, key in enumerate(keys[:-1]):
        if isinstance(key, str) and isinstance(data, dict):
            missing: Any = {} if isinstance(keys[depth + 1], str) else []
            data = data.setdefault(key, missing)
        else:
            data = _entry(data, keys[: depth + 1])
    last = keys[-1]
    if isinstance(last, str) and isinstance(data, dict):
        data[last] = value
        return
    _entry(data, keys)
    data[last] = value


def _entry(data: Any, keys: KeyPath) -> Any:
    """What stands at an index that exists."""
    at = keys[-1]
    if isinstance(at, int) and isinstance(data, list) and at < len(data):
        return data[at]
    held = f"a list of {len(data)}" if isinstance(data, list) else shown(data)
    wanted = "an entry of that number" if isinstance(at, int) else "keys with values under it"
    raise _CannotSetError(
        f"The problem has {held} at `{path_text(keys[:-1])}`. Expected {wanted}, to set "
        f"`{path_text(keys)}`. Write it in the problem first."
    )
