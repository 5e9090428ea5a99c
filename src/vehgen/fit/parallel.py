"""Where independent pieces of work run: here, on an executor of `concurrent.futures`, or on a Dask cluster."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from typing import Any, TypeVar

from vehgen.errors import ArgumentError, InputError

Input = TypeVar("Input")
R = TypeVar("R")
RETRIES = 3
"""How often a cluster tries a piece of work again whose worker was lost."""


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


@dataclass(frozen=True)
class DaskRunner(Runner):
    """A runner on a Dask cluster: a lost worker costs only the time to do its work again."""

    client: Any = None

    def map(self, function: Callable[[Input], R], inputs: Iterable[Input]) -> Iterator[R]:
        """Yield the function's values, in the order of the inputs."""
        for future in self.client.map(function, list(inputs), retries=RETRIES, pure=False):
            yield future.result()


@contextmanager
def runner_at(scheduler: str | None) -> Iterator[Runner]:
    """Yield a runner: on the Dask scheduler at an address such as `tcp://host:8786`, or here where there is none.

    Raises
    ------
    InputError
        Where the extra `cluster` is not installed, or nothing answers at the address.
    """
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
