"""A dask cluster of this machine's own: arguments of Python that start its parts."""

import socket

SCHEDULER = ("-m", "distributed.cli.dask_scheduler", "--no-dashboard", "--host")
WORKER = (
    *("-m", "distributed.cli.dask_worker", "--nthreads", "1", "--no-nanny", "--no-dashboard"),
)
"""Both are followed by the scheduler's address."""


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]
