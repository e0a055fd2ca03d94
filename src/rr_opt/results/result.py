"""What every result can do: say how it ended, and be printed, drawn and saved."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any, ClassVar

from rr_opt.documents.archive import write_text
from rr_opt.documents.document import Document, Figure
from rr_opt.documents.report import Progress, Report, quiet
from rr_opt.outcome import Status


class Svg(str):
    """A figure as SVG text, which a notebook shows."""

    __slots__ = ()

    def _repr_svg_(self) -> str:
        return self[self.find("<svg") :]

    def __repr__(self) -> str:
        return f"<Svg, {len(self)} characters>"


class Plots(dict[str, Svg]):
    """Figures by name. A notebook shows them all."""

    def __repr__(self) -> str:
        return f"Plots({', '.join(self)})"

    def _repr_html_(self) -> str:
        return "\n".join(f"<div>{svg._repr_svg_()}</div>" for svg in self.values())

    def save(self, folder: str | Path) -> list[Path]:
        """Write NAME.svg for each; returns the files."""
        return [write_text(Path(folder) / f"{name}.svg", svg) for name, svg in self.items()]


@dataclass(frozen=True)
class Check:
    """One check of a result: whether it passed, and its finding in a sentence."""

    passed: bool
    sentence: str


class Result:
    """What was found, with the evidence for it.

    status    how the work ended: `OPTIMAL`, `INFEASIBLE` or `NOT_CONVERGED`
    message   the outcome in a sentence or two
    checks    the independent checks, each with `passed` and a `sentence`
    warnings  sentences on what the result leaves out, or what to beware of
    """

    REPORT: ClassVar[str] = "rr_opt.documents.report"
    """The module whose REPORT shows this kind of result. It knows the result, and not the other way
    round, so it is found by its name when the result is shown."""

    @property
    def report(self) -> Report:
        """How this kind of result is shown."""
        return import_module(self.REPORT).REPORT

    @property
    def status(self) -> Status:
        """OPTIMAL, unless the kind of result has another way to end."""
        return Status.OPTIMAL

    @property
    def message(self) -> str:
        """Empty for a result that is all numbers."""
        return ""

    @property
    def checks(self) -> list[Check]:
        """Empty where there is nothing to check."""
        return []

    @property
    def warnings(self) -> tuple[str, ...]:
        """Empty where there is nothing to beware of."""
        return ()

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:
        """The result as plain data, SI: the content of its JSON file."""
        return self.report.stamped(self)

    def document(self, figures: Sequence[Figure] = ()) -> Document:
        """The result as a report, from which the page and the text are made."""
        return self.report.document(self, figures)

    def summary(self, files: Sequence[Path] = ()) -> str:
        """The result as text, with the names of its files."""
        return self.report.text(self, files)

    def plot(self) -> Plots:
        """The figures; empty if there is nothing to draw."""
        return Plots({figure.name: Svg(figure.svg) for figure in self.report.drawn(self)})

    def save(
        self, path: str | Path, *, figures: bool = True, progress: Progress = quiet
    ) -> list[Path]:
        """Write the result with its figures and page to the folder `path`; returns the files.

        Files that an earlier result left there under the same names are replaced. Raises
        InputError if the folder cannot be written to.
        """
        return self.report.save(self, path, figures=figures, progress=progress)

    def __str__(self) -> str:
        return self.summary()

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self.message or self.status.value}>"
