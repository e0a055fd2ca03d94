"""One fit in a process of its own, imports and compiling included: `-m benchmarks.fit.one WAY`."""

from __future__ import annotations

import sys

from benchmarks.fit.case import case
from benchmarks.fit.ways import near, way


def main() -> None:
    print(*way(sys.argv[1])(case(), near(1)[0]).tolist())


if __name__ == "__main__":
    main()
