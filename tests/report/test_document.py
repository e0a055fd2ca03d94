"""One document is rendered as text, Markdown, an escaped page and CSV, with the same content."""

import csv
import io
import math
import re
from html.parser import HTMLParser
from importlib import resources

import pytest

from rr_opt.documents.document import (
    Badge,
    Chain,
    Document,
    Fact,
    Facts,
    Figure,
    Gallery,
    Link,
    Section,
    Step,
    Table,
    checks,
    csv_text,
    warnings,
)
from rr_opt.documents.rendering import markdown, page, terminal
from rr_opt.results.result import Result

EVIL = '<script>alert("&")</script>'
CASES = Table(("speed", "name"), ((0.12344, "a"), (None, Badge("b", "good"))))


def document(text="words"):
    chain = Chain((Step(text, "fault", text, text),))
    figure = Figure("drawn", text, "<svg xmlns='http://www.w3.org/2000/svg'/>", text, text)
    rows = ((1.0, text), (2.0, Badge(text)), (3.0, Link(text, "a/b.html")))
    return Document(
        text,
        text,
        text,
        text,
        (
            Section("", (Facts((Fact(text, text, text),), key=True),)),
            Section(text, (text, Facts((Fact(text, text, f"({text})"),)), chain)),
            Section(text, (checks([(True, text), (False, text)]), warnings([text]))),
            Section("", (Gallery((figure,)),)),
            Section(text, (Table(("speed", text), rows, text),)),
            Section("nothing here", (Table(("speed",), ()), Facts(()), "")),
        ),
        footer=(text,),
    )


SCRIPT = (resources.files("rr_opt.documents") / "templates" / "readout.js").read_text().strip()


def written(shown):
    """The page without the script that it has for its figures."""
    text = page(shown)
    assert text.count(SCRIPT) == 1
    return re.sub(r"<script>\s*</script>", "", text.replace(SCRIPT, ""))


def test_every_text_is_escaped():
    text = written(document(EVIL))
    assert EVIL not in text
    assert "<script" not in text
    places = written(document()).count("words")
    assert places > 20
    assert len(re.findall("&lt;script&gt;", text)) == places


def test_every_tag_is_closed_and_nothing_is_fetched():
    open_tags, sources = [], []

    class Closing(HTMLParser):
        def handle_starttag(self, tag, attrs):
            sources.extend(value for name, value in attrs if name in ("src", "href"))
            if tag not in ("meta", "img"):
                open_tags.append(tag)

        def handle_endtag(self, tag):
            assert open_tags.pop() == tag

    text = page(document())
    Closing().feed(text)
    assert open_tags == []
    assert "http" not in re.sub(r'"data:.*?"', "", text)
    assert [source.split(":")[0] for source in sources] == ["data", "a/b.html"]


def test_backticks_are_code_on_the_page():
    text = written(document("set `use: <holdout>`"))
    assert "`" not in re.sub(r"<title>.*?</title>|(?:alt|href|data-label)=\".*?\"", "", text)
    assert "set <code>use: &lt;holdout&gt;</code>" in text


def test_a_section_without_content_is_left_out():
    for text in (page(document()), markdown(document()), terminal(document())):
        assert "nothing here" not in text


def test_a_table_for_people_and_for_scripts():
    for render in (page, markdown, terminal):
        text = render(Document("", "", "", "", (Section("Cases", (CASES,)),)))
        assert "speed" in text
        assert "0.1234" in text
        assert "0.12344" not in text
        assert "–" in text
    assert CASES.csv() == "speed,name\n0.12344,a\n,b\n"
    assert CASES.records[1]["speed"] is None


def test_the_terminal_gets_the_brief_sections():
    parts = Section("Shown", ("long words " * 20,)), Section("Hidden", ("x",), brief=False)
    text = terminal(Document("name", "kind", "Title", "Lead.", parts))
    assert text.startswith("name: Title. Lead.\n\nShown\n  long words")
    assert "Hidden" not in text
    assert max(len(line) for line in text.splitlines() if "long" in line) <= 102


def test_the_page_leads_the_files_and_the_figures_end_them(tmp_path):
    class Drawn(Result):
        FILE = "record.json"

        def document(self, figures=()):
            return document()

    written = Drawn().save(tmp_path)
    assert [path.name for path in written] == ["report.html", "record.json", "drawn.svg"]


@pytest.mark.parametrize("sign", ["=", "+", "-", "@", "\t", "\n", "＝"])
def test_a_text_is_no_formula_in_a_spreadsheet(sign):
    text = csv_text(["a", "b"], [(f'{sign}HYPERLINK("x")', -1.5), ("a=b", -1)])
    rows = list(csv.reader(io.StringIO(text, newline="")))
    assert rows == [["a", "b"], [f'\'{sign}HYPERLINK("x")', "-1.5"], ["a=b", "-1"]]


@pytest.mark.parametrize("end", ["\n", "\r", "\r\n"])
def test_a_line_that_ends_in_a_text_ends_no_row(end):
    text = csv_text(["a", "b"], [(f"name{end}=1+1", 1)])
    assert text == 'a,b\n"name\n=1+1",1\n'


def test_csv_leaves_empty_what_is_not_there():
    text = csv_text(["a"], [(None,), (math.nan,), (math.inf,), (True,), (1 / 3,)], 3)
    assert text.split("\n") == ["a", '""', '""', "inf", "yes", "0.333", ""]
