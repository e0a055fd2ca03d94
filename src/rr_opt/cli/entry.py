"""The entry point of `rr-opt`, and how Ctrl-C ends it."""

import gc
import os

# An interrupt during these imports shows a traceback, so they are few and light.
from rr_opt import interrupt
from rr_opt.outcome import EXIT_INTERRUPTED


def main() -> None:
    """Run the command, and exit with 130 on an interrupt, whatever it was turned into.

    Partly imported libraries and compiled solvers turn it into other errors, or swallow it.
    """
    try:
        interrupt.watch()
        # Imports create no garbage, and collecting it takes a tenth of the startup time.
        gc.set_threshold(100_000)
        from rr_opt.batch import ONE_THREAD

        for name, count in ONE_THREAD.items():
            os.environ.setdefault(name, count)
        from rr_opt.cli.main import app

        app()
    except SystemExit as end:
        if interrupt.seen() and end.code != 0:
            _end(silent=end.code == EXIT_INTERRUPTED)
        interrupt.ignore()
        raise
    except BaseException:
        if interrupt.seen():
            _end(silent=False)
        raise
    finally:
        # Python would look for garbage once more before it ends, which takes a third of a second.
        gc.freeze()


def _end(*, silent: bool) -> None:
    """Exit immediately: partly imported libraries complain at an orderly exit."""
    import sys

    interrupt.ignore()
    if not silent:
        print(interrupt.MESSAGE, file=sys.stderr)  # noqa: T201 - typer may not be there
    sys.stderr.flush()
    sys.stdout.flush()
    os._exit(EXIT_INTERRUPTED)
