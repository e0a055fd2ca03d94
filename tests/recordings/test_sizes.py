"""Sizes are written as people write them: three digits, and no exponent for a metre."""

import pytest

from rr_opt.recordings.warnings import size_text


@pytest.mark.parametrize(
    ("channel", "size", "text"),
    [("x", 0.00123, "1.23 mm"), ("y", 1.0, "1000 mm"), ("phi", 1.2345, "1230 mrad"), ("t", 2, "2")],
)
def test_a_size_reads_as_it_would_be_written(channel, size, text):
    assert size_text(channel, size) == text
