"""Titles, alternative texts and captions of figures, which are kept in a text file."""

from __future__ import annotations

from importlib.resources import files

from rr_opt.documents.document import Captions


def captions(kind: str) -> Captions:
    """Of the figures of a kind of result, by name; see the head of texts/figures.md."""
    text = (files("rr_opt.report") / "texts" / "figures.md").read_text(encoding="utf-8")
    own = text.partition(f"\n# {kind}\n")[2].partition("\n# ")[0]
    found = {}
    for part in own.split("\n## ")[1:]:
        head, alt, *caption = (" ".join(one.split()) for one in part.strip().split("\n\n"))
        name, _, title = head.partition(": ")
        found[name] = (title, alt, " ".join(caption))
    return found
