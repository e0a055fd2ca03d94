"""Input files: what is wrong in them, and their schemas."""

from __future__ import annotations

from pathlib import Path

from rr_opt.files.issue import Issue
from rr_opt.files.lint import experiment_file, lint_file


def lint(path: str | Path) -> list[Issue]:
    """Everything that is wrong or looks wrong in an input file and the files that it names.

    A robot, problem, study or experiment file, or the folder of a problem or an experiment, whose
    recordings are read too. An Issue has `level` (`error` or `warning`), `message`, `file`, `line`
    and `path`, the key. Nothing is raised.
    """
    experiment = experiment_file(path)
    if experiment is None:
        return lint_file(path)
    from rr_opt.recordings.experiment import experiment_of
    from rr_opt.recordings.usable import checked

    read, issues = experiment_of(experiment)
    if read is not None:
        found, place = checked(read), str(experiment)
        issues += [Issue("error", "", text, file=place) for text in found.wrong]
        issues += [Issue("warning", "", text, file=place) for text in found.left_out.values()]
    return issues
