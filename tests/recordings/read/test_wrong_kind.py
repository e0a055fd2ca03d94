"""A long file of another kind is refused by its first lines, and does not fill the memory."""

import tracemalloc

import pytest

from rr_opt.outcome import InputError
from rr_opt.recordings.readers.text import Text, read_table

ROWS = 100_000


def test_mistakes_are_counted_as_far_as_that_says_something_and_not_kept():
    text = Text("run.json", "utf-8", [f"- timestamp: {k}" for k in range(ROWS)], True)
    tracemalloc.start()
    with pytest.raises(InputError) as caught:
        read_table(text, 0, ROWS, ",", ["t"])
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert "There are thousands of other mistakes" in str(caught.value)
    assert peak < 100 * ROWS
