"""Where `rr-opt` begins, and how Ctrl-C ends it."""

import gc
import os

# An interrupt while these are loaded shows a traceback, so they are few and light.
from rr_opt import interrupt
from rr_opt.outcome import EXIT_INTERRUPTED


def main() -> None:
    """Run the command, and end with 130 whatever an interrupt has turned into on its way.

    Libraries that are being loaded, and compiled solvers, make other errors of it, or none.
    """
    try:
        interrupt.watch()
        # What is being loaded is no garbage, and looking for some takes a tenth of the start.
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


def _end(*, silent: bool) -> None:
    """End here and now: libraries that are half loaded complain when they are tidied up."""
    import sys

    interrupt.ignore()
    if not silent:
        print(interrupt.MESSAGE, file=sys.stderr)  # noqa: T201 - typer may not be there
    sys.stderr.flush()
    sys.stdout.flush()
    os._exit(EXIT_INTERRUPTED)
