"""Where independent pieces of work run: here, on an executor of `concurrent.futures`, or on a Dask cluster."""

from __future__ import annotations

import os.path
import pickle
import sys
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import Executor
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from functools import cache, partial
from importlib import import_module
from itertools import islice
from typing import Any, TypeVar

from threadpoolctl import ThreadpoolController

from vehgen.errors import ArgumentError, InputError

Input = TypeVar("Input")
R = TypeVar("R")
RETRIES = 3
"""How often a piece of work is tried again whose worker was lost."""
AHEAD = 2
"""So many pieces of work a cluster holds for each of its threads."""


def can_be_sent(value: object) -> bool:
    """Return whether a value can be sent to another process of this machine: what a notebook's cell defines is not known there."""
    try:
        packed = pickle.dumps(value)
    except Exception:  # what a value's own way to be packed may raise is not known
        return False
    return b"__main__" not in packed or os.path.isfile(getattr(sys.modules["__main__"], "__file__", None) or "")


def one_blas_thread() -> AbstractContextManager[Any]:
    """Return a context in which linear algebra runs on one thread: small matrices, for which more threads only wait for one another."""
    limit: AbstractContextManager[Any] = _libraries().limit(limits=1, user_api="blas")
    return limit


@cache
def _libraries() -> ThreadpoolController:
    """Return the libraries that are limited; looking them up takes as long as a small fit's step."""
    import_module("scipy.linalg")  # which brings a BLAS of its own
    return ThreadpoolController()


def on_one_thread(function: Callable[[Input], R], item: Input) -> R:
    """Return a function's value, with one BLAS thread: matrices are small, and in a process of its own more would only wait."""
    with one_blas_thread():
        return function(item)


@dataclass(frozen=True)
class Lost:
    """Stands for the value of a piece of work that was lost with its worker, again and again; `reason` says what is known of it."""

    reason: str


@dataclass(frozen=True)
class Runner:
    """Maps a function over inputs, in order, with the same results wherever it runs.

    Parameters
    ----------
    executor
        Any `concurrent.futures` executor; None runs here, one after the other.
    """

    executor: Executor | None = None

    def map(self, function: Callable[[Input], R], inputs: Iterable[Input]) -> Iterator[R]:
        """Yield the function's values, in the order of the inputs."""
        yield from map(function, inputs) if self.executor is None else self.executor.map(function, inputs)

    def as_completed(self, function: Callable[[Input], R], inputs: Iterable[Input]) -> Generator[tuple[Input, R | Lost], None, None]:
        """Yield every input with the function's value as soon as it is there; inputs are taken when there is somebody to work on them.

        The function must not raise: what goes wrong belongs into its value.
        """
        for item in inputs:
            yield item, function(item)


HERE = Runner()
"""Runs here, one after the other."""


@dataclass(frozen=True)
class DaskRunner(Runner):
    """A runner on a Dask cluster: a lost worker costs only the time to do its work again."""

    client: Any = None

    def map(self, function: Callable[[Input], R], inputs: Iterable[Input]) -> Iterator[R]:
        """Yield the function's values, in the order of the inputs."""
        for future in self.client.map(partial(on_one_thread, function), list(inputs), retries=RETRIES, pure=False):
            yield future.result()

    def as_completed(self, function: Callable[[Input], R], inputs: Iterable[Input]) -> Generator[tuple[Input, R | Lost], None, None]:
        """Yield every input with the function's value as soon as it is there; what is under way is cancelled with the iteration."""
        left = iter(inputs)
        under_way: dict[Any, Input] = {}
        results = import_module("distributed").as_completed()

        def submit(count: int) -> None:
            for item in islice(left, count):
                future = self.client.submit(on_one_thread, function, item, retries=RETRIES, pure=False)
                under_way[future] = item
                results.add(future)

        submit(max(1, AHEAD * sum(self.client.nthreads().values())))
        try:
            for future in results:
                item = under_way.pop(future)
                yield item, future.result() if future.status == "finished" else Lost(_why(future))
                submit(1)
        finally:
            self.client.cancel(list(under_way))


def _why(future: Any) -> str:
    """Say why a piece of work on a cluster has no value."""
    error = future.exception() if future.status == "error" else None
    told = " ".join(str(error).split()) if error else "its worker or the scheduler is gone"
    return f"lost on the cluster: {told}"


@contextmanager
def runner_at(scheduler: str | None, processes: int = 1) -> Iterator[Runner]:
    """Yield a runner: on the Dask scheduler at an address such as `tcp://host:8786`; where there is none, here, by so many processes.

    Raises
    ------
    InputError
        Where the extra `cluster` is not installed, or nothing answers at the address.
    """
    if scheduler is None and processes > 1:
        from vehgen.fit.processes import ProcessRunner

        with ProcessRunner(processes) as runner:
            yield runner
        return
    if scheduler is None:
        yield Runner()
        return
    try:
        connect: Any = import_module("distributed").Client
    except ImportError as error:
        raise ArgumentError("`scheduler` needs Dask: pip install 'vehgen[cluster]'", "scheduler") from error
    try:
        client = connect(scheduler, timeout=10)
    except (OSError, ValueError) as error:
        raise InputError(f"no Dask scheduler answers at {scheduler}: {error or type(error).__name__}") from error
    try:
        yield DaskRunner(client=client)
    finally:
        client.close()
