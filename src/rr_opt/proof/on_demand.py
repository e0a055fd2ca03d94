"""A mapping whose values are made when they are asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any


class OnDemand(Mapping[int, Any]):
    """value(key) for each of the keys, in their order; nothing is kept."""

    def __init__(self, keys: Iterable[int], value: Callable[[int], Any]):
        self._keys = dict.fromkeys(keys)
        self._value = value

    def __getitem__(self, key: int) -> Any:
        if key not in self._keys:
            raise KeyError(key)
        return self._value(key)

    def __iter__(self) -> Iterator[int]:
        return iter(self._keys)

    def __len__(self) -> int:
        return len(self._keys)
