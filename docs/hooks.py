"""The site shows the repository's own pages: README, docs and the results they link to.

Every file keeps its path from the root, so that links work on the site as they do in the tree.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from mkdocs.structure.files import File, Files  # pyright: ignore[reportMissingImports]

ROOT = Path(__file__).parents[1]
PAGES = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")
OTHERS = (
    "docs/pages/*.png",
    "docs/notebooks/*.ipynb",
    "LICENSE",
    "CITATION.cff",
    "problems/**/*.yaml",
)
RESULTS = ("*.md", "*.svg", "*.csv", "*.json")


def on_files(files: Files, config: Any) -> Files:
    """The files of the site by their paths in the repository."""
    paths = [ROOT / name for name in PAGES]
    paths += sorted((ROOT / "docs").glob("*.md"))
    for ending in RESULTS:
        paths += sorted((ROOT / "results").rglob(ending))
    for pattern in OTHERS:
        paths += sorted(ROOT.glob(pattern))
    ours = [
        File.generated(config, path.relative_to(ROOT).as_posix(), abs_src_path=str(path))
        for path in paths
        if "said" not in path.parts
    ]
    theirs = [
        one
        for one in files
        if one.generated_by or not one.src_uri.endswith((".md", ".py", ".ipynb"))
    ]
    return Files([*ours, *theirs])
