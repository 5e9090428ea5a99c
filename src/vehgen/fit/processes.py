"""Pieces of work on this machine, side by side in processes: one that is killed costs the others nothing."""

from __future__ import annotations

import os
import signal
import time
import warnings
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import closing, suppress
from dataclasses import dataclass
from itertools import islice
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from multiprocessing.reduction import ForkingPickler
from typing import Any, Self

from vehgen.errors import InputError
from vehgen.fit.parallel import RETRIES, Input, Lost, R, Runner, on_one_thread
from vehgen.process_start import process_context, uninterrupted

WORTH_PROCESSES_S = 3.0
"""Work that has taken longer is spread over processes [s]; these need a second or two to start."""
FUNCTION_FOLLOWS = b""
"""What is sent to a process before another function: nothing else is empty."""
LOST_PROCESS = "its process ended before it was done, {} times: too little memory, or a script without `if __name__ == '__main__':`"


@dataclass
class _Worker:
    """A process, the end of its pipe, and the number of the function that it holds."""

    end: Connection
    process: BaseProcess
    holds: int = 0

    def stop(self) -> None:
        """End the process."""
        self.end.close()
        self.process.terminate()
        self.process.join()


@dataclass
class _Job:
    """A piece of work under way: its number, its input, its worker, and how often it was begun."""

    number: int
    item: Any
    worker: _Worker
    begun: int


class ProcessRunner(Runner):
    """A runner on so many processes at once (default: one per core), which last until it is closed.

    A script that uses it needs the usual `if __name__ == "__main__":` around its work (:mod:`vehgen.process_start`).
    """

    def __init__(self, processes: int | None = None) -> None:
        super().__init__()
        self._most = processes or os.cpu_count() or 1
        self._taken = 0.0
        self._idle: list[_Worker] = []
        self._functions = 0

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        while self._idle:
            self._idle.pop().stop()

    def map(self, function: Callable[[Input], R], inputs: Iterable[Input]) -> Iterator[R]:
        """Yield the function's values, in the order of the inputs; an error of the function is raised here.

        Short work is done here, until all that was asked for took so long that the rest is worth processes.
        """
        left = iter(inputs)
        while self._taken <= WORTH_PROCESSES_S:
            begun = time.perf_counter()
            try:
                value = function(next(left))
            except StopIteration:
                return
            self._taken += time.perf_counter() - begun
            yield value
        found: dict[int, Any] = {}
        after = 0
        with closing(self._completed(function, left)) as answers:
            for job, answer in answers:
                if isinstance(answer, Lost):
                    raise InputError(f"a piece of work was lost: {answer.reason}")
                found[job.number] = answer
                while after in found:
                    yield _value(found.pop(after))
                    after += 1

    def as_completed(self, function: Callable[[Input], R], inputs: Iterable[Input]) -> Generator[tuple[Input, R | Lost], None, None]:
        """Yield every input with its value as soon as it is there; processes still at work are ended with the iteration."""
        with closing(self._completed(function, inputs)) as answers:
            for job, answer in answers:
                yield job.item, answer if isinstance(answer, Lost) else _value(answer)

    def _completed(self, function: Callable[[Input], R], inputs: Iterable[Input]) -> Generator[tuple[_Job, Any], None, None]:
        """Yield every job with what its process sent, or with its loss."""
        jobs: dict[Connection, _Job] = {}
        left = enumerate(inputs)
        self._functions += 1
        sent = self._functions, ForkingPickler.dumps(function)
        try:
            while True:
                for number, item in islice(left, self._most - len(jobs)):
                    self._begin(jobs, sent, number, item)
                if not jobs:
                    return
                for end in wait(list(jobs)):
                    assert isinstance(end, Connection)
                    job = jobs.pop(end)
                    try:
                        data = end.recv_bytes()
                    except (EOFError, OSError):
                        job.worker.stop()
                        if job.begun <= RETRIES:
                            self._begin(jobs, sent, job.number, job.item, job.begun + 1)
                        else:
                            yield job, Lost(LOST_PROCESS.format(job.begun))
                        continue
                    self._idle.append(job.worker)
                    yield job, _unpacked(data)
        finally:
            for job in jobs.values():
                job.worker.stop()

    def _begin(self, jobs: dict[Connection, _Job], sent: tuple[int, memoryview], number: int, item: Input, begun: int = 1) -> None:
        """Begin a piece of work: a process is sent a numbered function once, and inputs from then on."""
        function, packed = sent
        with uninterrupted():
            worker = self._idle.pop() if self._idle else _started()
            jobs[worker.end] = _Job(number, item, worker, begun)
        data = ForkingPickler.dumps(item)
        with suppress(OSError):  # it has died meanwhile, which is seen when its answer is read
            if worker.holds != function:
                worker.end.send_bytes(FUNCTION_FOLLOWS)
                worker.end.send_bytes(packed)
                worker.holds = function
            worker.end.send_bytes(data)


def _started() -> _Worker:
    """Return a new process."""
    context = process_context()
    ours, theirs = context.Pipe()
    process = context.Process(target=_work, args=(theirs, dict(os.environ)), daemon=True)
    process.start()
    theirs.close()  # the process holds the only end, so that its death ends the pipe
    return _Worker(ours, process)


def _work(end: Connection, environment: dict[str, str]) -> None:
    """Do pieces of work until the pipe ends; a function serves until another one comes."""
    os.environ.clear()
    os.environ.update(environment)  # a fork has that of the time when its server began
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the process that waits: it ends this one
    warnings.simplefilter("ignore")
    packed: bytes | None = None
    function: Any = None
    with suppress(EOFError, OSError):  # nobody waits for it any more
        while True:
            data = end.recv_bytes()
            if data == FUNCTION_FOLLOWS:
                packed, data = end.recv_bytes(), end.recv_bytes()
            answer: tuple[Any, Exception | None]
            try:
                if packed is not None:
                    function, packed = ForkingPickler.loads(packed), None
                answer = on_one_thread(function, ForkingPickler.loads(data)), None
            except Exception as error:  # raised again by the process that waits
                answer = None, error
            end.send_bytes(_packed(answer))


def _packed(answer: tuple[Any, Exception | None]) -> memoryview:
    """Return an answer as it travels; one that cannot travel is lost once, and an error that cannot is told by its type and text."""
    error = answer[1]
    try:
        data = ForkingPickler.dumps(answer)
        if error is not None:
            ForkingPickler.loads(data)
        return data
    except Exception as fault:  # what a value's own way to be packed may raise is not known
        if error is None:
            return ForkingPickler.dumps(Lost(f"its value cannot be sent from its process: {_told(fault)}"))
        return ForkingPickler.dumps((None, RuntimeError(_told(error))))


def _unpacked(data: bytes) -> tuple[Any, Exception | None] | Lost:
    try:
        found: tuple[Any, Exception | None] | Lost = ForkingPickler.loads(data)
    except Exception as fault:  # as above
        return Lost(f"its value cannot be read from its process: {_told(fault)}")
    return found


def _told(error: Exception) -> str:
    return f"{type(error).__name__}: {' '.join(str(error).split())}"


def _value(answer: tuple[Any, Exception | None]) -> Any:
    value, error = answer
    if error is not None:
        raise error
    return value
