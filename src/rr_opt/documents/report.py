"""How a kind of result is shown: its record, its document, its figures, and the files of all."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import Any

from rr_opt.documents import document as doc
from rr_opt.documents.archive import folder_for_results, remove, write_json, write_text
from rr_opt.documents.rendering import PAGE, markdown, page, terminal
from rr_opt.files.record import plain
from rr_opt.version import __version__

Progress = Callable[[str], None]
"""Called with every step, such as `start 3 of 8`."""


def quiet(_: str) -> None:
    """Progress that is not shown."""


def _no_files(_: Any) -> Mapping[str, str]:
    return {}


@dataclass(frozen=True)
class Report:
    """How results of one kind are shown.

    record    what its JSON file holds, SI
    document  the result as a report with some figures
    file      name of the record's file; markdown: of the report as Markdown, if it has one
    tables    text files beside the record, by name; others: names of all files beside it
    figures   module whose `draw` makes SVG texts by name; captions: of these figures
    svgs      whether the figures are files too, beside the page
    """

    record: Callable[[Any], dict[str, Any]]
    document: Callable[[Any, Sequence[doc.Figure]], doc.Document]
    file: str = ""
    markdown: str = ""
    tables: Callable[[Any], Mapping[str, str]] = _no_files
    others: tuple[str, ...] = ()
    figures: str = ""
    captions: doc.Captions = field(default_factory=dict)
    svgs: bool = True

    def drawn(self, result: Any, progress: Progress = quiet) -> tuple[doc.Figure, ...]:
        """The figures with their captions."""
        if not self.figures:
            return ()
        progress("figures")
        return doc.captioned(self.captions, self.draw(result))

    def draw(self, result: Any) -> Any:
        """What the module of the figures draws; it loads matplotlib, so it is loaded only now."""
        return import_module(self.figures).draw(result)

    def stamped(self, result: Any) -> dict[str, Any]:
        """The record as JSON has it, with the version and the fingerprint of the input."""
        sha256 = getattr(result, "sha256", "")
        stamp = {"version": __version__, "input_sha256": sha256} if sha256 else {}
        return plain(self.record(result)) | stamp

    def text(self, result: Any, files: Sequence[Path]) -> str:
        """The result as text, with the names of its files."""
        return terminal(self.document(result, ()), files)

    def save(
        self,
        result: Any,
        path: str | Path,
        *,
        figures: bool = True,
        progress: Progress = quiet,
        **options: Any,
    ) -> list[Path]:
        """Write record, tables and, with `figures`, the page; returns the files, page first.

        Files that an earlier result left there under the same names are replaced. Some kinds of
        result have more options.
        """
        folder = folder_for_results(Path(path))
        svgs = (f"{name}.svg" for name in self.captions)
        remove(folder, filter(None, (PAGE, self.file, self.markdown, *self.others, *svgs)))
        document = self.document(result, self.drawn(result, progress) if figures else ())
        written = [write_json(folder / self.file, self.stamped(result))]
        if self.markdown:
            written.append(write_text(folder / self.markdown, markdown(document)))
        written += [write_text(folder / name, text) for name, text in self.tables(result).items()]
        if not figures:
            return written
        drawn = document.figures if self.svgs else ()
        svg = [write_text(folder / f"{one.name}.svg", one.svg) for one in drawn]
        return [write_text(folder / PAGE, page(self.page_of(result, document))), *written, *svg]

    def page_of(self, result: Any, document: doc.Document) -> doc.Document:
        """What the page shows, if it is not the document itself."""
        return document


REPORT = Report(lambda _: {}, lambda *_: doc.Document("", "", "", "", ()))
"""Of a result that has nothing to draw, and no document."""
