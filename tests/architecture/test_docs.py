"""What the documentation names is there: files, pages, figures, make targets."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = sorted([*(ROOT / "docs").glob("*.md"), ROOT / "README.md", ROOT / "CONTRIBUTING.md"])
NAMED = re.compile(r"`((?:src/|tests/)?[a-z_]+(?:/[a-z_0-9]+)+(?:\.py)?)`")
LINK = re.compile(r"\]\(([^)#:]+)(?:#[^)]*)?\)")


def places(text):
    """The files of the library that a text names in backticks."""
    tops = {path.name for path in (ROOT / "src" / "rr_opt").iterdir() if path.is_dir()}
    return [name for name in NAMED.findall(text) if name.split("/")[0] in {*tops, "src", "tests"}]


def absent(page):
    text = page.read_text(encoding="utf-8")
    files = [n for n in places(text) if not (ROOT / n).exists()]
    files = [n for n in files if not (ROOT / "src" / "rr_opt" / n).exists()]
    links = [n for n in LINK.findall(text) if not (page.parent / n).exists()]
    return files + links


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_what_a_page_names_is_there(page):
    assert absent(page) == []


def test_what_is_not_there_is_seen(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("`model/gone.py` and `model/robot.py`, `src/rr_opt/gone`, [figure](gone.svg)")
    assert absent(page) == ["model/gone.py", "src/rr_opt/gone", "gone.svg"]


def test_every_page_is_on_the_site():
    shown = (ROOT / "mkdocs.yml").read_text(encoding="utf-8")
    assert [page.name for page in PAGES if f"{page.name}\n" not in shown] == []
