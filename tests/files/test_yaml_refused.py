"""YAML that could mean something else than it says is refused, with its line."""

from __future__ import annotations

import pytest

from rr_opt.files.issue import InvalidFileError
from rr_opt.files.source import read_document
from rr_opt.files.yaml_text import parse_yaml

REFUSED = {
    "h: 1\nh: 2\n": "f:2: h: Read this key again; it is on line 1. Keep one.",
    "a:\n  b: 1\n  b: 2\n": "f:3: a.b: Read this key again; it is on line 2. Keep one.",
    "a: &x 1\nb: 2\n": "f:1: a: Read the anchor `&x`. Delete it.",
    "a: 1\nb: *x\n": "f:2: b: Read the alias `*x`. Write the value itself.",
    "a: !!python/name:os.system x\n": "f:1: a: Read the tag",
    "!a b: 1\n": "f:1: Read the tag '!a'. Delete it.",
    "": "f: The file is empty. Expected keys with values, such as `h: 0.020`.",
    "# only a comment\n": "f: The file is empty.",
    "{}\n": "f:1: The file is empty.",
    "- 1\n": "f:1: Read a list without keys. Expected keys with values",
    "just text": "f:1: Read a text without keys. Expected keys with values",
    "a: 1\n---\nb: 2\n": "f:2: A second document begins here. Expected one document per file.",
    "a: [1, 2\nb: 3\n": "f:2: The text is not YAML: while parsing a flow sequence",
    "a: 1\n\tb: 2\n": "f:2: The text is not YAML",
    "? [1]\n: 2\n": "f:1: A key is a list or a mapping. Expected a word.",
    "a: \x00": "f: The text has a character (code 0) that YAML does not allow.",
    'a: "\\UFFFFFFFF"': "f: The text is not YAML",
    'a: "\\ud800"': "f:1: a: The text contains half a character.",
    "[" * 3000: "The file is too large. Expected at most 10000 values in 20 levels.",
    "[" + "0," * 11000 + "]": "The file is too large.",
}


@pytest.mark.parametrize(("text", "message"), REFUSED.items(), ids=range(len(REFUSED)))
def test_refused(text: str, message: str):
    with pytest.raises(InvalidFileError) as caught:
        parse_yaml(text.encode(), "f")
    assert message in str(caught.value)


def test_other_encodings_are_refused_with_the_line():
    with pytest.raises(InvalidFileError, match="f:2: The text is not UTF-8"):
        parse_yaml("a: 1\nb: µ".encode("latin-1"), "f")
    with pytest.raises(InvalidFileError, match="not UTF-8"):
        parse_yaml("a: 1".encode("utf-16"), "f")


def test_a_large_file_is_refused(tmp_path):
    (tmp_path / "f").write_bytes(b"#" * 1_000_001)
    with pytest.raises(InvalidFileError, match="larger than 1 MB"):
        read_document(tmp_path / "f")


def test_nested_aliases_do_not_expand():
    bomb = "a0: &a0 [1, 1]\n" + "".join(
        f"a{n}: &a{n} [*a{n - 1}, *a{n - 1}]\n" for n in range(1, 40)
    )
    with pytest.raises(InvalidFileError) as caught:
        parse_yaml(bomb.encode(), "f")
    assert len(caught.value.issues) == 40 + 2 * 39
