"""YAML text to plain data, rejecting whatever could mean something other than it says.

Rejected: repeated keys, anchors and aliases (a few lines can expand to gigabytes), tags,
several documents, deep nesting, encodings other than UTF-8. Plain words follow YAML 1.2:
`1e-5` is a number, `on` and `12:30` are texts.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NoReturn

import yaml

from rr_opt.files.issue import InvalidFileError, Issue, Level, refuse
from rr_opt.messages import shown

KeyPath = tuple[str | int, ...]
"""The keys and list indices that lead to a value."""

_TABLES = {".csv", ".tsv", ".trc", ".c3d", ".txt"}
"""Suffixes of recordings."""

_WORD = re.compile(r"[A-Za-z_][A-Za-z0-9_-]{0,59}")


def path_text(path: KeyPath) -> str:
    """A path as messages write it: `physics[0].force1`."""
    text = ""
    for part in path:
        if isinstance(part, int):
            text += f"[{part}]"
        else:
            text += "." * bool(text) + (part if _WORD.fullmatch(part) else shown(part))
    return text


@dataclass(frozen=True)
class FileData:
    """A mapping of a file: the whole of it, or the section at `prefix`.

    file   the file as the user named it
    data   the mapping
    lines  line of each key, by its path in the file
    """

    file: str
    data: dict[str, Any]
    lines: Mapping[KeyPath, int]
    prefix: KeyPath = ()

    def section(self, key: str) -> FileData:
        """The mapping under a key, which keeps its place in the file."""
        return replace(self, data=self.data[key], prefix=(*self.prefix, key))

    def entries(self, key: str, whole: str, each: str) -> tuple[list[FileData], list[Issue]]:
        """The mappings of a non-empty list, and an issue for every other entry.

        whole, each  what the list and an entry should be, for the messages
        """
        given = self.data.get(key)
        if not isinstance(given, list) or not given:
            return [], [self.error((key,), f"Read {shown(given)}. Expected {whole}.")]
        sections, issues = list[FileData](), list[Issue]()
        for index, entry in enumerate(given):
            if isinstance(entry, dict):
                sections.append(replace(self, data=entry, prefix=(*self.prefix, key, index)))
            else:
                message = f"Read {shown(entry)}. Expected {each}. Write it so."
                issues.append(self.error((key, index), message))
        return sections, issues

    def without(self, *keys: str) -> FileData:
        """The same mapping without some keys."""
        return replace(self, data={k: v for k, v in self.data.items() if k not in keys})

    def issue(self, level: Level, path: KeyPath, message: str) -> Issue:
        """An issue at a path below this mapping, with the line of the nearest key written.

        It has no line if none are known.
        """
        whole = (*self.prefix, *path)
        steps = (whole[:n] for n in range(len(whole), 0, -1))
        line = next(
            (self.lines[step] for step in steps if step in self.lines), 1 if self.lines else None
        )
        return Issue(level, path_text(whole), message, line, self.file)

    def error(self, path: KeyPath, message: str) -> Issue:
        """An issue that is an error."""
        return self.issue("error", path, message)

    def warning(self, path: KeyPath, message: str) -> Issue:
        """An issue that is a warning."""
        return self.issue("warning", path, message)


DEEPEST = 20
MOST_VALUES = 10_000

_NUMBER = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_WORDS: dict[str, Any] = {"": None, "~": None}
_WORDS |= {spell("null"): None for spell in (str, str.title, str.upper)}
_WORDS |= {spell("true"): True for spell in (str, str.title, str.upper)}
_WORDS |= {spell("false"): False for spell in (str, str.title, str.upper)}
_WORDS |= {sign + ".inf": float(sign + "inf") for sign in ("", "+", "-")}
_WORDS |= {".nan": float("nan"), ".NaN": float("nan"), ".Inf": float("inf")}


def parse_yaml(content: bytes, file: str) -> FileData:
    """The data of a YAML file whose content is one mapping.

    Raises InvalidFileError, naming `file`, with everything that was found wrong.
    """
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        refuse(file, "The text is not UTF-8. Save the file with the encoding UTF-8.", line)
    return _Reading(text, file).document()


class _Reading:
    """One pass over the events of a text; `issues` collects non-fatal ones."""

    def __init__(self, text: str, file: str):
        self.file = file
        self.events: Iterator[Any] = yaml.parse(text, Loader=yaml.SafeLoader)
        self.lines: dict[KeyPath, int] = {}
        self.issues: list[Issue] = []
        self.values = 0

    def document(self) -> FileData:
        try:
            data, line = self._only_document()
        except yaml.MarkedYAMLError as error:
            mark = error.problem_mark or error.context_mark
            why = ": ".join(part for part in (error.context, error.problem) if part)
            self._stop(
                f"The text is not YAML: {why}. Correct the text there.",
                mark.line + 1 if mark else None,
            )
        except yaml.reader.ReaderError as error:
            code = error.character if isinstance(error.character, int) else ord(error.character)
            self._stop(
                f"The text has a character (code {code}) that YAML does not allow. Delete it."
            )
        except (yaml.YAMLError, ValueError, OverflowError) as error:
            self._stop(f"The text is not YAML: {shown(str(error))}. Correct it.")
        if not isinstance(data, dict) or not data:
            # Its content is not quoted: it may be any file.
            kind = (
                "text" if isinstance(data, str) else "list" if isinstance(data, list) else "value"
            )
            read = "The file is empty" if data in (None, {}) else f"Read a {kind} without keys"
            table = Path(self.file).suffix.lower() in _TABLES
            hint = " `rr-opt inspect` reads recordings." if table else ""
            self._stop(f"{read}. Expected keys with values, such as `h: 0.020`.{hint}", line)
        if self.issues:
            raise InvalidFileError(self.issues)
        return FileData(self.file, data, self.lines)

    def _only_document(self) -> tuple[Any, int | None]:
        next(self.events)
        if isinstance(next(self.events), yaml.StreamEndEvent):
            return None, None
        first = next(self.events)
        data = self._value(first, ())
        next(self.events)
        after = next(self.events)
        if not isinstance(after, yaml.StreamEndEvent):
            line = after.start_mark.line + 1
            self._stop("A second document begins here. Expected one document per file.", line)
        return data, first.start_mark.line + 1

    def _stop(self, message: str, line: int | None = None, path: KeyPath = ()) -> NoReturn:
        self._note(message, line, path)
        raise InvalidFileError(self.issues)

    def _note(self, message: str, line: int | None, path: KeyPath) -> None:
        self.issues.append(Issue("error", path_text(path), message, line, self.file))

    def _value(self, event: Any, path: KeyPath) -> Any:
        line = event.start_mark.line + 1
        self.values += 1
        if self.values > MOST_VALUES or len(path) > DEEPEST:
            most = f"{MOST_VALUES} values in {DEEPEST} levels"
            self._stop(f"The file is too large. Expected at most {most}.", line)
        if isinstance(event, yaml.AliasEvent):
            self._note(f"Read the alias `*{event.anchor}`. Write the value itself.", line, path)
            return None
        if event.anchor is not None:
            self._note(f"Read the anchor `&{event.anchor}`. Delete it.", line, path)
        if event.tag is not None:
            self._note(f"Read the tag {shown(event.tag)}. Delete it.", line, path)
        if isinstance(event, yaml.SequenceStartEvent):
            return self._sequence(path)
        if isinstance(event, yaml.MappingStartEvent):
            return self._mapping(path)
        return self._scalar(event, path)

    def _scalar(self, event: Any, path: KeyPath) -> Any:
        text: str = event.value
        if any("\ud800" <= letter <= "\udfff" for letter in text):
            self._note(
                "The text contains half a character. Retype it.", event.start_mark.line + 1, path
            )
            return None
        if event.style is not None:
            return text
        if text in _WORDS:
            return _WORDS[text]
        if _NUMBER.fullmatch(text):
            small = len(text) <= 15 and text.lstrip("+-").isdecimal()
            return int(text) if small else float(text)
        return text

    def _sequence(self, path: KeyPath) -> list[Any]:
        items: list[Any] = []
        while not isinstance(event := next(self.events), yaml.SequenceEndEvent):
            here = (*path, len(items))
            self.lines[here] = event.start_mark.line + 1
            items.append(self._value(event, here))
        return items

    def _mapping(self, path: KeyPath) -> dict[str, Any]:
        data: dict[str, Any] = {}
        while not isinstance(event := next(self.events), yaml.MappingEndEvent):
            line = event.start_mark.line + 1
            if not isinstance(event, yaml.ScalarEvent):
                self._stop("A key is a list or a mapping. Expected a word.", line, path)
            self._value(event, path)
            key: str = event.value
            here = (*path, key)
            value = self._value(next(self.events), here)
            if key in data:
                first = self.lines[here]
                self._note(f"Read this key again; it is on line {first}. Keep one.", line, here)
                continue
            self.lines[here] = line
            data[key] = value
        return data
