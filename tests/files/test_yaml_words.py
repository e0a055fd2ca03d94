"""Plain words follow YAML 1.2, and every key keeps its line."""

from __future__ import annotations

import math

import pytest

from rr_opt.files.yaml_text import parse_yaml


@pytest.mark.parametrize(
    ("written", "value"),
    [
        ("1e-5", 1e-5),
        ("2.0e-5", 2e-5),
        (".5", 0.5),
        ("+3", 3),
        ("010", 10),
        ("12:30", "12:30"),
        ("on", "on"),
        ("2024-01-02", "2024-01-02"),
        ("true", True),
        ("False", False),
        ("~", None),
        ("", None),
        ('"1.5"', "1.5"),
        ("30 rpm", "30 rpm"),
        ("[1, {b: 2}]", [1, {"b": 2}]),
        (".inf", math.inf),
        ("-.inf", -math.inf),
    ],
)
def test_words(written: str, value: object):
    read = parse_yaml(f"a: {written}\n".encode(), "f").data["a"]
    assert read == value
    assert type(read) is type(value)


def test_a_byte_order_mark_is_no_part_of_the_text():
    assert parse_yaml(b"\xef\xbb\xbfa: 1\n", "f").data == {"a": 1}


def test_lines():
    lines = parse_yaml(b"# comment\na: 1\nb:\n  c:\n    - 1\n    - d: 2\n", "f").lines
    assert lines == {
        ("a",): 2,
        ("b",): 3,
        ("b", "c"): 4,
        ("b", "c", 0): 5,
        ("b", "c", 1): 6,
        ("b", "c", 1, "d"): 6,
    }
