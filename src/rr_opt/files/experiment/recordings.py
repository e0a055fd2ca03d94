"""The experiment file's `recordings`: which files there are, and what was commanded in each."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from rr_opt.files.document import Document
from rr_opt.files.experiment.model import RecordingModel
from rr_opt.files.experiment.plan import PlannedRun
from rr_opt.files.gait_record import gait_from
from rr_opt.files.issue import InvalidFileError, Issue, shown
from rr_opt.files.model_issues import validate
from rr_opt.files.result_text import is_result
from rr_opt.files.source import read_document
from rr_opt.robot.gait import Gait


def runs_from(document: Document, file: Path) -> tuple[tuple[PlannedRun, ...], list[Issue]]:
    """The runs that could be read, and all issues; files are named relative to `file`."""
    entries = document.data.get("recordings")
    if not isinstance(entries, list) or not entries:
        message = (
            f"Read {shown(entries)}. Expected a list of recordings. Write for example "
            "`- {file: run01.csv, gait: {amplitude: 0.5, period: 1 s, offset: 0}}`."
        )
        return (), [document.issue("error", ("recordings",), message)]
    runs: list[PlannedRun] = []
    issues: list[Issue] = []
    for index, entry in enumerate(entries):
        if not isinstance(entry, dict):
            message = f"Read {shown(entry)}. Expected {{file: ..., gait: ...}}. Write it so."
            issues.append(document.issue("error", ("recordings", index), message))
            continue
        prefix = (*document.prefix, "recordings", index)
        run, found = _run(replace(document, data=entry, prefix=prefix), file)
        issues += found
        if run is not None:
            runs.append(run)
    issues += _twice(document, entries)
    return tuple(runs), issues or _uses(document, runs)


def _run(document: Document, file: Path) -> tuple[PlannedRun | None, list[Issue]]:
    model, issues = validate(RecordingModel, document)
    gait, found = _gait(document, file) if "gait" in document.data else (None, [])
    issues += found
    for key in ("file", "servo_log"):
        name = document.data.get(key)
        why = _unusable(file.parent / name) if isinstance(name, str) else ""
        if why:
            issues.append(document.issue("error", (key,), f"Read {shown(name)}. {why}"))
    if model is None or gait is None or issues:
        return None, issues
    log = None if model.servo_log is None else file.parent / model.servo_log
    return PlannedRun(file.parent / model.file, gait, model.use, model.start, log), issues


def usable(file: Path, name: str) -> bool:
    """Whether a name, relative to an experiment file, is that of a file."""
    return not _unusable(file.parent / name)


def _unusable(path: Path) -> str:
    try:
        if path.is_file():
            return ""
        return "This is a folder. Expected a file." if path.is_dir() else _MISSING
    except (OSError, ValueError):
        return _MISSING


_MISSING = "There is no such file. Check its name and folder."


def _gait(document: Document, file: Path) -> tuple[Gait | None, list[Issue]]:
    """The gait written in the entry, or that of the result that it names."""
    given = document.data["gait"]
    if isinstance(given, dict):
        return gait_from(document.section("gait"))
    if not isinstance(given, str):
        message = (
            f"Read {shown(given)}. Expected the gait, or the name of a result that holds it. "
            "Write for example `{amplitude: 0.5, period: 1 s, offset: 0}`."
        )
        return None, [document.issue("error", ("gait",), message)]
    try:
        result = read_document(file.parent / given)
    except InvalidFileError as error:
        why = error.issues[0].message
        return None, [document.issue("error", ("gait",), f"Read {shown(given)}. {why}")]
    if not is_result(result.data) or not isinstance(result.data.get("gait"), dict):
        message = f"Read {shown(given)}, which holds no gait. Expected a result of rr-opt."
        return None, [document.issue("error", ("gait",), message)]
    return gait_from(result.section("gait"))


def _twice(document: Document, entries: list[object]) -> list[Issue]:
    """A recording that is there twice would be fitted and held out, or count double."""
    issues: list[Issue] = []
    seen: dict[str, int] = {}
    for index, entry in enumerate(entries):
        name = entry.get("file") if isinstance(entry, dict) else None
        if not isinstance(name, str):
            continue
        first = seen.setdefault(str(Path(name)), index)
        if first != index:
            message = f"Read {shown(name)}, which is recordings[{first}] too. Keep one of them."
            issues.append(document.issue("error", ("recordings", index, "file"), message))
    return issues


def _uses(document: Document, runs: list[PlannedRun]) -> list[Issue]:
    """What cannot be done with the recordings there are."""
    uses = [run.use for run in runs]
    if "fit" not in uses:
        message = "No recording is to be fitted. Give at least one `use: fit`."
    elif "holdout" not in uses:
        message = "No recording is kept back to check a fit on. Give one of them `use: holdout`."
    else:
        return []
    return [document.issue("warning", ("recordings",), message)]
