"""How messages quote what was read, list names, and guess the known word that was meant."""

import math
from collections.abc import Iterable, Sequence
from difflib import get_close_matches

_LONGEST_SHOWN = 60
_SHORTEST_GUESSED = 3
_ALIKE = 0.72
"""Similarity threshold: twice the letters that two words share in order, over the letters of both.
`friction` and `direction` have 0.71, `gate` and `gait` 0.75."""


def shown(value: object) -> str:
    """A value as quoted in a message: on one line, without control characters, not long."""
    text = _written(value)
    return text if len(text) <= _LONGEST_SHOWN else text[: _LONGEST_SHOWN - 4] + " ..."


def _written(value: object) -> str:
    if value is None:
        return "nothing"
    if isinstance(value, dict):
        return "a mapping" if value else "an empty mapping"
    if isinstance(value, list):
        return f"[{', '.join(_written(item) for item in value)}]"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float) and not math.isfinite(value):
        return f"{value}".replace("inf", ".inf").replace("nan", ".nan")
    return repr(value) if isinstance(value, str) else str(value)


def nearest(word: str, known: Sequence[str]) -> str | None:
    """The known word that was most likely meant by `word`, if one is close.

    Close is the same word in different case; a beginning, or a part between underscores, of exactly
    one known word; or most letters in the same order. Anything less would be a guess.
    """
    meant = word.casefold()
    folded = {name.casefold(): name for name in reversed(known)}
    if meant in folded:
        return folded[meant]
    if not _SHORTEST_GUESSED <= len(meant) <= _LONGEST_SHOWN:
        return None
    near = get_close_matches(meant, list(folded), n=1, cutoff=_ALIKE)
    near = near or [one for one in folded if one.startswith(meant) or meant in one.split("_")]
    return folded[near[0]] if len(near) == 1 else None


def unknown_word(word: str, known: Sequence[str], kind: str) -> str:
    """The message for an unknown word, with the closest known one."""
    near = nearest(word, known)
    advice = f"Did you mean `{near}`?" if near else "Correct it, or delete it."
    return f"Read the {kind} {shown(word)}. Expected {one_of(known)}. {advice}"


def one_of(words: Sequence[str]) -> str:
    """The words as alternatives in a message."""
    return f"one of: {', '.join(words)}" if len(words) > 1 else f"`{words[0]}`"


def listed(names: Iterable[str], word: str = "and") -> str:
    """`rate`, `rate and torque`, `angle, rate and torque`; empty for no name."""
    *others, last = [*names] or [""]
    return f" {word} ".join(filter(None, [", ".join(others), last]))
