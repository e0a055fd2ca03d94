"""What every result can do: report its status, and be printed, drawn and saved."""

from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

from rr_opt.documents.archive import folder_for_results, remove, write_json, write_text
from rr_opt.documents.document import Captions, Document, Figure, Section, captioned, versions
from rr_opt.documents.rendering import PAGE, markdown, page, terminal
from rr_opt.files.record import plain
from rr_opt.outcome import Status
from rr_opt.version import __version__

Progress = Callable[[str], None]
"""Called at every step, with text such as `start 3 of 8`."""


def quiet(_: str) -> None:
    """Progress that is not shown."""


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


def picked(source: Any, names: str) -> dict[str, Any]:
    """Attributes by name (space-separated), for a record."""
    return {name: getattr(source, name) for name in names.split()}


class Check(NamedTuple):
    """One check of a result: whether it passed, and its finding in a sentence."""

    passed: bool
    sentence: str


class Result:
    """The base of all results.

    status    how the work ended: `OPTIMAL`, `INFEASIBLE` or `NOT_CONVERGED`
    message   the outcome in a sentence or two
    checks    the independent checks, each with `passed` and a `sentence`
    warnings  sentences on what the result ignores, and other caveats
    """

    # Overridden by each kind of result as needed: the names of its record's file, of the Markdown
    # report, and of all other files; the drawing function of its figures, their captions, and
    # whether they are also written as files.
    FILE: ClassVar[str] = ""
    MARKDOWN: ClassVar[str] = ""
    OTHERS: ClassVar[tuple[str, ...]] = ()
    DRAW: ClassVar[str] = ""
    CAPTIONS: ClassVar[Captions] = {}
    SVGS: ClassVar[bool] = True

    @property
    def status(self) -> Status:
        """OPTIMAL, unless the kind of result defines another."""
        return Status.OPTIMAL

    @property
    def message(self) -> str:
        """Empty for a purely numerical result."""
        return ""

    @property
    def checks(self) -> list[Check]:
        """Empty if there is nothing to check."""
        return []

    @property
    def warnings(self) -> tuple[str, ...]:
        """Empty if there are no caveats."""
        return ()

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:
        """The result as plain data, SI: the content of its JSON file."""
        sha256 = getattr(self, "sha256", "")
        stamp = {"version": __version__, "input_sha256": sha256} if sha256 else {}
        return plain(self._record()) | stamp

    def _record(self) -> dict[str, Any]:
        return {}

    def document(self, figures: Sequence[Figure] = ()) -> Document:
        """The result as a report, from which the page and the text are made."""
        return Document("", "", "", "", ())

    def _outcome(
        self, kind: str, title: str, failure: str, *sections: Section, lead: str = ""
    ) -> Document:
        """A report under a title, or under the failure that the message then explains."""
        name, sha256 = getattr(self, "name", ""), getattr(self, "sha256", "")
        good = self.status is Status.OPTIMAL
        head = (title, lead) if good else (failure, self.message)
        return Document(name, kind, *head, sections, good=good, footer=versions(sha256))

    def _page(self, document: Document) -> Document:
        """The content of the page, if it is not the document itself."""
        return document

    def _tables(self) -> Mapping[str, str]:
        """Text files beside the record, by name."""
        return {}

    def summary(self) -> str:
        """The result as text."""
        return terminal(self.document())

    def _draw(self, what: Any) -> Mapping[str, Any]:
        """SVG texts by name, in the common style; imports matplotlib."""
        from rr_opt.results.figures.style import styled

        module, _, function = self.DRAW.rpartition(".")
        with styled():
            return getattr(import_module(module), function)(what)

    def drawn(self, progress: Progress = quiet) -> tuple[Figure, ...]:
        """The figures with their captions."""
        if not self.DRAW:
            return ()
        progress("figures")
        return captioned(self.CAPTIONS, self._draw(self))

    def plot(self) -> Plots:
        """The figures; empty if there is nothing to draw."""
        return Plots({figure.name: Svg(figure.svg) for figure in self.drawn()})

    def save(
        self, path: str | Path, *, figures: bool = True, progress: Progress = quiet
    ) -> list[Path]:
        """Write the result with its figures and page to the folder `path`; returns the files.

        Files that an earlier result left there under the same names are replaced. Raises
        InputError if the folder cannot be written to.
        """
        folder = folder_for_results(Path(path))
        svgs = (f"{name}.svg" for name in self.CAPTIONS)
        remove(folder, filter(None, (PAGE, self.FILE, self.MARKDOWN, *self.OTHERS, *svgs)))
        document = self.document(self.drawn(progress) if figures else ())
        written = [write_json(folder / self.FILE, self.record())]
        if self.MARKDOWN:
            written.append(write_text(folder / self.MARKDOWN, markdown(document)))
        written += [write_text(folder / name, text) for name, text in self._tables().items()]
        if not figures:
            return written
        drawn = document.figures if self.SVGS else ()
        svg = [write_text(folder / f"{one.name}.svg", one.svg) for one in drawn]
        return [write_text(folder / PAGE, page(self._page(document))), *written, *svg]

    def __str__(self) -> str:
        return self.summary()

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self.message or self.status.value}>"
