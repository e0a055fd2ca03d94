"""Processes of this machine, or of a cluster via a dask scheduler."""

import os
import re
import signal
import socket
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from multiprocessing import resource_tracker
from typing import Any

from joblib import cpu_count
from joblib.externals.loky import ProcessPoolExecutor

from rr_opt.batch import ONE_THREAD
from rr_opt.interrupt import held_back
from rr_opt.outcome import InputError
from rr_opt.version import __version__

_LOOK = 1.0  # s
_HANDED_ON = 1.0
"""Time for the executor to hand over work before it is ended, s."""


class LocalPool:
    """`workers` processes on this machine; None: one per usable core.

    One case takes one core: numerical libraries are limited to one thread.
    """

    def __init__(self, workers: int | None = None):
        self.workers = workers or cpu_count()
        self._executor = self._started()
        self._given: set[Future[Any]] = set()

    @property
    def ahead(self) -> int:
        """Two cases per process: the current one and the next."""
        return 2 * self.workers

    def submit(self, function: Callable[[Any], Any], argument: Any) -> Future[Any]:
        """Have function(argument) computed."""
        # An interrupt halfway would leave work that nobody tracks.
        with held_back(signal.SIGINT, signal.SIGTERM), _blocked(signal.SIGINT):
            future = self._executor.submit(function, argument)
            self._given = {one for one in self._given if not one.done()} | {future}
        return future

    def is_lost(self, error: BaseException) -> bool:  # noqa: ARG002 - as every pool
        """Never: BrokenExecutor reports dead processes."""
        return False

    def restart(self) -> None:
        """Start new processes."""
        self.close()
        self._executor = self._started()

    def close(self) -> None:
        """End all processes."""
        # The executor's own thread fails noisily if it is ended before it has handed over work.
        end = time.monotonic() + _HANDED_ON
        while time.monotonic() < end and not all(f.running() or f.done() for f in self._given):
            time.sleep(_HANDED_ON / 100)
        self._given = set()
        self._executor.shutdown(wait=True, kill_workers=True)
        self._temporary.cleanup()

    def _started(self) -> ProcessPoolExecutor:
        # A killed process leaves its temporary files behind.
        self._temporary = tempfile.TemporaryDirectory(prefix="rr-opt-", ignore_cleanup_errors=True)
        return ProcessPoolExecutor(
            max_workers=self.workers,
            timeout=None,
            initializer=_begin,
            initargs=(os.getpid(),),
            env={**ONE_THREAD, "TMPDIR": self._temporary.name},
        )


@contextmanager
def _blocked(number: signal.Signals) -> Iterator[None]:
    """Block the signal in this thread and in processes started within, which inherit the mask:
    Ctrl-C reaches them too while they load."""
    # It would unblock the signal if started within (Python 3.11).
    resource_tracker.ensure_running()
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, [number])
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)


def _begin(parent: int) -> None:
    """Leave Ctrl-C to the parent process, and exit with it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def watch() -> None:
        never = threading.Event()
        while os.getppid() == parent:
            never.wait(_LOOK)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


_PATIENCE = 10  # s
_ADDRESS = re.compile(
    r"(?:(?P<scheme>tcp|tls)://)?(?P<host>\[[0-9a-fA-F:.]+\]|[^\s:/\[\]]+):(?P<port>[0-9]{1,5})"
)
_AT_LEAST = 8
_PER_CORE = 2


class ClusterPool:
    """The workers of the scheduler at an address, tcp://HOST:PORT, as they come and go.

    A case whose worker dies is rescheduled on another one.
    """

    def __init__(self, address: str):
        client = _client()
        try:
            # A dask client that finds no scheduler waits long, and complains when discarded.
            _knock(address)
            self._client = client(address, timeout=_PATIENCE, set_as_default=False)
        except (OSError, ValueError, TimeoutError) as error:
            raise InputError(
                f"No dask scheduler answers at {address!r} ({_first_line(error)}). Expected an "
                "address such as tcp://host:8786. Start one with `dask scheduler`, and workers "
                "with `dask worker`."
            ) from None
        self._check_versions()
        self._executor = self._client.get_executor(pure=False)

    @property
    def ahead(self) -> int:
        """Two cases per thread of the current workers."""
        cores = sum(self._client.ncores().values())
        return max(_AT_LEAST, _PER_CORE * cores)

    def submit(self, function: Callable[[Any], Any], argument: Any) -> Future[Any]:
        """Have function(argument) computed by a worker."""
        return self._executor.submit(function, argument)

    def is_lost(self, error: BaseException) -> bool:
        """Whether the scheduler gave up on a case because its workers died."""
        from distributed import KilledWorker

        return isinstance(error, KilledWorker)

    def restart(self) -> None:
        """Nothing to do: the scheduler replaces workers."""

    def close(self) -> None:
        """Cancel unfinished work, and leave the cluster as it was."""
        self._executor.shutdown(wait=False)
        self._client.close(timeout=_PATIENCE)

    def _check_versions(self) -> None:
        """Raise InputError if a worker has a different rr-opt, or none."""
        try:
            others = self._client.run(installed_version)
        except Exception as error:
            raise InputError(
                f"A worker of the cluster cannot run rr-opt ({_first_line(error)}). Expected "
                f"rr-opt {__version__} on every worker. Install it there."
            ) from None
        wrong = {place: found for place, found in others.items() if found != __version__}
        for place, found in wrong.items():
            raise InputError(
                f"The worker {place} has rr-opt {found}. Expected {__version__}, as here. "
                "Install the same version on every worker."
            )


def installed_version() -> str:
    """The version of rr-opt on this worker."""
    # Cases leave a worker no time for threads of numerical libraries.
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    return __version__


def _knock(address: str) -> None:
    """Raise ValueError for an invalid address, OSError if no scheduler is there."""
    match = _ADDRESS.fullmatch(address)
    if match is None or not 0 < int(match["port"]) < 2**16:
        raise ValueError("it is not an address")
    place = match["host"].strip("[]"), int(match["port"])
    with socket.create_connection(place, _PATIENCE) as line:
        # A scheduler speaks first, unless TLS has to be negotiated before.
        if match["scheme"] != "tls" and not line.recv(1):
            raise OSError("it closes the connection")


def _first_line(error: BaseException) -> str:
    return (str(error) or type(error).__name__).splitlines()[0]


def _client() -> Any:
    """The class dask.distributed.Client. Raises InputError if it is not installed."""
    try:
        from distributed import Client
    except ImportError:
        raise InputError(
            "A cluster needs dask.distributed, which is not installed. "
            "Run `pip install 'rr-opt[cluster]'`, or leave out --scheduler."
        ) from None
    return Client


Pool = LocalPool | ClusterPool
"""Processes that work in parallel. A future whose process died raises BrokenExecutor, and then all
other futures of the pool may too; `restart` makes the pool usable again."""
