"""What every result of the library can do: be printed, drawn and saved."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from rr_opt.answers.answer import Answer
from rr_opt.report.archive import folder_for_results, write_text

Progress = Callable[[str], None]
"""Told of every step, such as `start 3 of 8`."""


def quiet(_: str) -> None:
    """Progress that nobody hears of."""


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


class Result(Answer):
    """An answer that can be shown.

    status    how the work ended: `OPTIMAL`, `INFEASIBLE` or `NOT_CONVERGED`
    message   the outcome in a sentence or two
    checks    the independent checks, each with `passed` and a `sentence`
    warnings  sentences on what the result leaves out, or what to beware of
    """

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:
        """The result as plain data, SI: what the JSON file holds."""
        raise NotImplementedError

    def summary(self, files: Sequence[Path] = ()) -> str:
        """The result as text, with the names of its files."""
        raise NotImplementedError

    def plot(self) -> Plots:
        """The figures; empty if there is nothing to draw."""
        raise NotImplementedError

    def save(
        self, path: str | Path, *, figures: bool = True, progress: Progress = quiet
    ) -> list[Path]:
        """Write the result with its figures and page to the folder `path`; returns the files.

        Files that an earlier result left there under the same names are replaced. Raises
        InputError if the folder cannot be written to.
        """
        return self._write(folder_for_results(Path(path)), figures, progress)

    def _write(self, folder: Path, figures: bool, progress: Progress) -> list[Path]:
        raise NotImplementedError

    def __str__(self) -> str:
        return self.summary()

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self.message or self.status.value}>"
