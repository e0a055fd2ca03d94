"""A browser shows the verdict, the strip and every figure, on a desk and on a phone, offline."""

import html
import json
import re
import shutil
import subprocess

import pytest

from rr_opt.documents.rendering import page

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
DESK, PHONE = 1200, 412
FIGURES = {"consistent": 3, "parameters": 4, "missing_physics": 5, "unexplained": 5}

# The page stands in a frame of the phone's width: no window of Chromium is that narrow.
HOLDER = """<!DOCTYPE html><html><head><meta charset="utf-8"></head>
<body style="margin:0"><iframe id="frame" style="border:0;width:{width}px;height:9000px"
 srcdoc="{page}"></iframe><pre id="reported"></pre><script>
frame.addEventListener("load", () => {{
  const inner = frame.contentDocument, view = frame.contentWindow;
  const seen = one => {{
    const box = one.getBoundingClientRect(), style = view.getComputedStyle(one);
    return box.width > 20 && box.height > 8 && style.visibility === "visible"
      && box.left >= 0 && box.right <= {width} + 0.5;
  }};
  const all = query => [...inner.querySelectorAll(query)];
  reported.textContent = JSON.stringify({{
    verdict: all("h1").filter(seen).map(one => one.textContent),
    boxes: all("ol.chain li").map(one => [seen(one), one.className, one.textContent,
      view.getComputedStyle(one).backgroundColor]),
    figures: all("figure img").map(one => seen(one) && one.complete && one.naturalWidth > 0
      && one.getBoundingClientRect().height > 60),
    readout: all("figure img").map(one => {{
      const box = one.getBoundingClientRect();
      return [0.2, 0.3, 0.4, 0.5, 0.6, 0.7].flatMap(x => [0.1, 0.2, 0.3, 0.4].map(y => {{
        one.dispatchEvent(new view.PointerEvent("pointermove",
          {{clientX: box.left + x * box.width, clientY: box.top + y * box.height}}));
        return one.nextElementSibling.hidden ? "" : one.nextElementSibling.textContent;
      }})).filter(Boolean);
    }}),
    scroll: inner.documentElement.scrollWidth,
    fetched: [...view.performance.getEntriesByType("resource"),
      ...performance.getEntriesByType("resource")].map(one => one.name)
      .filter(name => !name.startsWith("data:")),
  }});
}});
</script></body></html>"""


@pytest.fixture(scope="module")
def texts(every):
    """The page of each verdict."""
    return {verdict: page(one.document(one.drawn())) for verdict, one in every.items()}


def shown(text, width, folder):
    """What the browser measured of a page, and what it wrote to its console."""
    if CHROMIUM is None:
        pytest.skip("chromium is not installed")
    holder = folder / "holder.html"
    holder.write_text(HOLDER.format(width=width, page=html.escape(text)))
    command = [
        CHROMIUM,
        *("--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking"),
        *("--enable-logging=stderr", "--host-resolver-rules=MAP * ~NOTFOUND"),
        *("--virtual-time-budget=4000", f"--user-data-dir={folder / 'profile'}"),
        *(f"--window-size={max(width, 600)},9000", "--dump-dom", holder.as_uri()),
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
    reported = re.search(r'<pre id="reported">(.+?)</pre>', done.stdout, re.DOTALL)
    assert reported, done.stderr[-2000:]
    console = [line for line in done.stderr.splitlines() if "CONSOLE" in line]
    return json.loads(html.unescape(reported[1])), console


@pytest.mark.parametrize(
    ("verdict", "width"),
    [
        ("missing_physics", DESK),
        ("missing_physics", PHONE),
        ("consistent", PHONE),
        ("parameters", DESK),
        ("unexplained", PHONE),
    ],
)
def test_everything_is_seen(texts, verdict, width, tmp_path):
    seen, console = shown(texts[verdict], width, tmp_path)
    assert len(seen["verdict"]) == 1
    assert all(visible for visible, *_ in seen["boxes"])
    assert len(seen["boxes"]) == 5
    assert seen["figures"] == [True] * FIGURES[verdict]
    assert seen["scroll"] <= width
    assert seen["fetched"] == []
    assert console == []


def test_a_pointer_reads_values(texts, tmp_path):
    seen, _ = shown(texts["missing_physics"], DESK, tmp_path)
    read = [words for words in seen["readout"] if words]
    assert len(read) >= 3
    assert all(re.search(r"\d", word) for words in read for word in words)


def test_the_guilty_stage_alone_is_lit(texts, tmp_path):
    seen, _ = shown(texts["missing_physics"], DESK, tmp_path)
    colours = {name.split("✗")[0]: colour for _, kind, name, colour in seen["boxes"]}
    lit = [kind for _, kind, _, colour in seen["boxes"] if colour == colours["rolling"]]
    assert lit == ["fault"]
    seen, _ = shown(texts["consistent"], DESK, tmp_path)
    assert {kind for _, kind, *_ in seen["boxes"]} == {"untested"}


def test_the_browser_would_tell(texts, tmp_path):
    """What the other tests look for is seen where it is put."""
    bad = texts["missing_physics"].replace(
        "</main>",
        '<div style="width:2000px">wide</div><figure><img src="http://example.test/a.png">'
        "</figure><script>console.error('said')</script></main>",
    )
    seen, console = shown(bad, PHONE, tmp_path)
    assert seen["scroll"] > PHONE
    assert seen["figures"][-1] is False
    assert seen["fetched"] == ["http://example.test/a.png"]
    assert any("said" in line for line in console)


@pytest.mark.parametrize("verdict", FIGURES)
def test_nothing_in_the_file_points_outside(texts, verdict):
    text = texts[verdict]
    figures = "".join(re.findall(r'"data:.*?"', text))
    assert "http" not in re.sub(r'"data:.*?"', "", text)
    # The names of SVG's vocabulary, which nothing fetches.
    assert set(re.findall(r"http[^\w]*[\w.]*", figures)) <= {"http://www.w3.org"}
    assert text.count("<script") == text.count("<script>") == 1
    assert not re.search(r"\b(fetch|import|XMLHttpRequest|WebSocket|eval)\b", text)
    assert all(one.startswith("data:") for one in re.findall(r'(?:src|href)="(.*?)"', text))


def test_the_verdict_comes_before_the_figures_and_those_before_tables(texts):
    text = texts["missing_physics"]
    assert text.index("<h1>") < text.index("<ol") < text.index("<figure") < text.index("<table")
