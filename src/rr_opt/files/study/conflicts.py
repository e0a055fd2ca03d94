"""What is varied twice: a key, a key and what holds it, a value."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from rr_opt.files.document import Path
from rr_opt.files.issue import shown
from rr_opt.files.study.units import Key
from rr_opt.outcome import InputError


def refuse_conflict(key: Key, values: object, seen: Mapping[Path, tuple[Key, object]]) -> None:
    """Raise InputError if one of the keys before is this one, holds it, or is held by it.

    seen: each key before and its values, by its path. Robots that are named by their files may be
    varied together with what is within a robot.
    """
    for path, (other, others) in seen.items():
        if path == key.path:
            raise InputError(
                f"Read `{key.name}` twice. Expected a key to be varied once. Keep one of them."
            )
        short = min(len(path), len(key.path))
        if path[:short] != key.path[:short]:
            continue
        outer, inner, written = (other, key, others) if len(path) == short else (key, other, values)
        if outer.path == ("robot",) and _names(written):
            continue
        raise InputError(
            f"Read `{outer.name}` and `{inner.name}`, which is a part of it. Expected one of them "
            f"to be varied. Delete `{inner.name}` and write its values into those of "
            f"`{outer.name}`, or vary only parts."
        )


def refuse_repeats(steps: Sequence[tuple[Any, ...]], written: Sequence[tuple[Any, ...]]) -> None:
    """Raise InputError if two steps of an axis are the same.

    A step has a value for each key of the axis: in SI if it is a number, and as written.
    """
    first: dict[str, int] = {}
    for number, step in enumerate(steps, 1):
        same = first.setdefault("\n".join(_digits(value) for value in step), number)
        if same != number:
            told = ", ".join(shown(value) for value in written[number - 1])
            raise InputError(
                f"Read {told} as value {number}, which is value {same} again. Expected each value "
                "once. Delete one of them."
            )


def _names(values: object) -> bool:
    return isinstance(values, list) and all(isinstance(value, str) for value in values)


def _digits(value: Any) -> str:
    """A value as text, the same for numbers that differ by rounding."""
    return f"{value:.11e}" if isinstance(value, float) else repr(value)
