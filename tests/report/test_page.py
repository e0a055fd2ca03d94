"""The page is one file that opens anywhere, says the verdict first, and escapes what it shows."""

import re
from dataclasses import replace
from html.parser import HTMLParser

from rr_opt.documents.document import Document, Figure, Section, Table
from rr_opt.documents.rendering import page as page_of

FIGURE = Figure("path", "Path", "<svg/>", "the path")


def page(answer):
    return page_of(answer.document([FIGURE]))


def test_the_verdict_comes_first(answer):
    text = page(answer)
    title = re.search("<h1>(.*?)</h1>", text)
    assert title
    assert "mm/s" in title[1]
    assert text.index("<h1>") < text.index("<figure") < text.index("<table")


def test_nothing_is_fetched(answer):
    text = page(answer)
    assert "http" not in text
    assert all(source.startswith("data:") for source in re.findall('src="(.*?)"', text))


def test_every_tag_is_closed(answer):
    open_tags = []

    class Closing(HTMLParser):
        def handle_starttag(self, tag, attrs):
            if tag not in ("meta", "img"):
                open_tags.append(tag)

        def handle_endtag(self, tag):
            assert open_tags.pop() == tag

    Closing().feed(page(answer))
    assert open_tags == []


def test_a_failed_check_is_the_headline(answer):
    doubtful = replace(answer, sweep=replace(answer.sweep, gap=-0.1))
    text = page(doubtful)
    assert "<h1>No confirmed optimum</h1>" in text
    assert 'class="bad"' in text


def test_names_are_escaped(answer):
    assert page(replace(answer, name="<script>")).count("<script>") == 1


def test_provenance_is_shown(answer):
    text = page(answer)
    assert 'badge good">measured' in text
    assert 'badge warn">assumed' in text


def test_signs_are_those_of_print():
    shown = page_of(Document("n", "k", "t", "1 -> 2 +- 3", ()))
    assert "1 → 2 ± 3" in shown


def test_a_phone_names_the_number_that_leads_a_row_and_leaves_out_empty_cells():
    table = Table(("rpm",), (("5",), ("",)))
    shown = page_of(Document("n", "k", "t", "", (Section("s", (table,)),)))
    assert '<td data-label="rpm" class="count"><span>5</span></td>' in shown
    assert '<td data-label="rpm"><span></span></td>' in shown
    assert "td:has(> span:empty) { display: none; }" in shown


def test_no_line_breaks_within_a_number(answer):
    text = page(answer)
    assert "tolerance 1e\N{NON-BREAKING HYPHEN}06" in text
    assert not re.search(r"\de-\d", text.partition("<figure")[0])
