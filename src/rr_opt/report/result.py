"""What every result can do: say how it ended, and be printed, drawn and saved."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

from rr_opt.outcome import Status
from rr_opt.report.archive import folder_for_results, remove, write_json, write_text
from rr_opt.report.document import Captions, Document, Figure, captioned
from rr_opt.report.text import markdown, terminal
from rr_opt.report.webpage import PAGE, write_page

Progress = Callable[[str], None]
"""Called with every step, such as `start 3 of 8`."""


def quiet(_: str) -> None:
    """Progress that is not shown."""


class Svg(str):
    """A figure as SVG text, which a notebook shows."""

    __slots__ = ()

    def _repr_svg_(self) -> str:
        return self[self.find("<svg") :]

    def __repr__(self) -> str:
        return f"<Svg, {len(self)} characters>"


class Plots(Mapping[str, Svg]):
    """Figures by name. A notebook shows them all."""

    def __init__(self, figures: Mapping[str, str]):
        self._figures = {name: Svg(svg) for name, svg in figures.items()}

    def __getitem__(self, name: str) -> Svg:
        return self._figures[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._figures)

    def __len__(self) -> int:
        return len(self._figures)

    def __repr__(self) -> str:
        return f"Plots({', '.join(self._figures)})"

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

    RECORD: ClassVar[str] = ""
    OTHERS: ClassVar[tuple[str, ...]] = ()
    MARKDOWN: ClassVar[str] = ""
    CAPTIONS: ClassVar[Captions] = {}
    # Names of files: the record, other data, and the report as Markdown, where there is one. The
    # figures have captions by name.

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
        """The result as plain data, SI: the content of the JSON file."""
        raise NotImplementedError

    def document(self, figures: Sequence[Figure] = ()) -> Document:
        """The result as a report, from which the page and the text are made."""
        raise NotImplementedError

    def summary(self, files: Sequence[Path] = ()) -> str:
        """The result as text, with the names of its files."""
        return terminal(self.document(), files)

    def plot(self) -> Plots:
        """The figures; empty if there is nothing to draw."""
        return Plots({figure.name: figure.svg for figure in self._figures()})

    def save(
        self, path: str | Path, *, figures: bool = True, progress: Progress = quiet
    ) -> list[Path]:
        """Write the result with its figures and page to the folder `path`; returns the files.

        Files that an earlier result left there under the same names are replaced. Raises
        InputError if the folder cannot be written to.
        """
        folder = folder_for_results(Path(path))
        names = (
            PAGE,
            self.RECORD,
            self.MARKDOWN,
            *self.OTHERS,
            *map("{}.svg".format, self.CAPTIONS),
        )
        remove(folder, filter(None, names))
        if figures:
            progress("figures")
        document = self.document(self._figures(progress) if figures else ())
        written = [write_json(folder / self.RECORD, self.record())]
        if self.MARKDOWN:
            written.append(write_text(folder / self.MARKDOWN, markdown(document)))
        written += [write_text(folder / name, text) for name, text in self._tables().items()]
        return self._write_page(folder, document, written) if figures else written

    def _tables(self) -> Mapping[str, str]:
        """The text files beside the record, by name."""
        return {}

    def _drawn(self) -> Mapping[str, str]:
        """The figures as SVG texts by name."""
        return {}

    def _figures(self, progress: Progress = quiet) -> tuple[Figure, ...]:
        """The figures with their captions."""
        return captioned(self.CAPTIONS, self._drawn())

    def _write_page(self, folder: Path, document: Document, written: Sequence[Path]) -> list[Path]:
        """Write the page and the figures; returns these and what was `written` before."""
        return write_page(folder, document, written)

    def __str__(self) -> str:
        return self.summary()

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self.message or self.status.value}>"
