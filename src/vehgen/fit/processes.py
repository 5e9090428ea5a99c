"""Pieces of work on this machine, each in a process of its own: one that is killed costs the others nothing."""

from __future__ import annotations

import multiprocessing
import os
import signal
import warnings
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from itertools import islice
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from typing import Any

from vehgen.fit.parallel import RETRIES, Input, Lost, R, Runner

LOST_PROCESS = "its process ended before it was done, {} times: too little memory, or a script without `if __name__ == '__main__':`"


@dataclass
class _Job:
    """A piece of work under way: its input, its process, and how often it was begun."""

    item: Any
    process: SpawnProcess
    begun: int


@dataclass(frozen=True)
class ProcessRunner(Runner):
    """A runner that gives every piece of work a new process, so many at once (default: one per core).

    The processes start afresh (spawn): a script that uses it needs the usual `if __name__ == "__main__":` around its work.
    """

    processes: int | None = None

    def as_completed(self, function: Callable[[Input], R], inputs: Iterable[Input]) -> Generator[tuple[Input, R | Lost], None, None]:
        """Yield every input with its value as soon as it is there; processes still at work are ended with the iteration."""
        jobs: dict[Connection, _Job] = {}
        left = iter(inputs)
        most = self.processes or os.cpu_count() or 1
        try:
            while True:
                for item in islice(left, most - len(jobs)):
                    _begin(jobs, function, item)
                if not jobs:
                    return
                for ready in wait(list(jobs)):
                    assert isinstance(ready, Connection)
                    job = jobs.pop(ready)
                    value = _received(ready)
                    job.process.join()
                    if value is not None:
                        yield job.item, value[0]
                    elif job.begun > RETRIES:
                        yield job.item, Lost(LOST_PROCESS.format(job.begun))
                    else:
                        _begin(jobs, function, job.item, job.begun + 1)
        finally:
            for job in jobs.values():
                job.process.terminate()
            for job in jobs.values():
                job.process.join()


def _begin(jobs: dict[Connection, _Job], function: Callable[[Input], R], item: Input, begun: int = 1) -> None:
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe(duplex=False)
    process = context.Process(target=_work, args=(theirs, function, item), daemon=True)
    with _unstopped():
        process.start()
        theirs.close()  # the process holds the only end, so that its death ends the pipe
        jobs[ours] = _Job(item, process, begun)


def _work(answer: Connection, function: Callable[[Input], R], item: Input) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the process that waits: it ends this one
    warnings.simplefilter("ignore")
    answer.send((function(item),))


def _received(answer: Connection) -> tuple[Any] | None:
    """Return what a process sent, packed; None where it ended without."""
    with suppress(EOFError, OSError), answer:
        packed: tuple[Any] = answer.recv()
        return packed
    return None


@contextmanager
def _unstopped() -> Iterator[None]:
    """Begin processes that Ctrl-C passes by from their first moment on; here it comes when the block ends."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    former = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, former)
