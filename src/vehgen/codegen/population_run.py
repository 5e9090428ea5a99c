"""A population, moved by an excitation, through a compiled kernel: blocks of lanes, shared among threads."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from numbers import Real
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vehgen.codegen.cache import compile_loops
from vehgen.codegen.kernel_source import KernelSource
from vehgen.codegen.time_loop import LOOP_IMPORTS, LOOP_SIGNATURE, SHARED_SIGNATURE, advance_block, read_shared
from vehgen.errors import ArgumentError, shown
from vehgen.files.limits import check_count

Array = NDArray[np.float64]
Consume = Callable[[slice, NDArray[Any], Array], None]
"""Given which individuals a block holds, their responses, and their residuals; several threads call it."""
OWN_ROWS = 64
"""Steps whose drives are read at once where each lane has its own: few enough for the first cache."""
BLOCK_SIZE = 32
"""Individuals that a thread takes at once."""
MOST_THREADS = 10_000
"""More are a slip of the pen."""
WORTH_THREADS = 250_000
"""Blocks times steps times coordinates below which one core is as quick as several."""


@dataclass(frozen=True)
class Excitation:
    """What moves a vehicle, at the ends of every step of `dt` [s].

    `inputs`, `rates` `shape (n_steps + 1, n_inputs)`: displacement inputs [m] and their rates [m/s]; `forces` `shape (n_steps + 1,
    n_forces)` [N]. All three may have an axis more ahead, of individuals each with inputs of its own. Another shape, or a step that is no
    number above 0, is an InputError.
    """

    dt: float
    inputs: Array
    rates: Array
    forces: Array

    def __post_init__(self) -> None:
        if isinstance(self.dt, bool) or not (isinstance(self.dt, Real) and 0 < self.dt < float("inf")):
            raise ArgumentError(f"`dt`: a step in seconds above 0 was expected, found {shown(self.dt)}", "dt")
        for key in ("inputs", "rates", "forces"):
            given = getattr(self, key)
            try:
                array = given if isinstance(given, np.ndarray) and given.dtype.kind == "f" else np.asarray(given, dtype=np.float64)
            except (TypeError, ValueError):
                array = np.empty(0)
            if array.ndim not in (2, 3):
                found = f"shape {array.shape}" if isinstance(given, np.ndarray) else type(given).__name__
                raise ArgumentError(f"`{key}`: an array of shape (n_steps + 1, n) was expected, found {found}", key)
            object.__setattr__(self, key, array)
        rows = {key: getattr(self, key).shape[-2] for key in ("inputs", "rates", "forces")}
        if len(set(rows.values())) > 1 or not rows["inputs"]:
            found = ", ".join(f"{count} of {key}" for key, count in rows.items())
            raise ArgumentError(f"`inputs`, `rates`, `forces`: a row each for the ends of every step was expected, found {found}", *rows)

    @property
    def n_steps(self) -> int:
        """Number of time steps."""
        return int(self.inputs.shape[-2]) - 1

    @property
    def is_finite(self) -> bool:
        """Whether all of it are finite numbers."""
        return all(bool(np.isfinite(item).all()) for item in (self.inputs, self.rates, self.forces))

    @property
    def time(self) -> Array:
        """Times of the inputs [s]."""
        return np.arange(self.n_steps + 1, dtype=np.float64) * self.dt

    @property
    def nbytes(self) -> int:
        """Size of its arrays [bytes]."""
        return int(self.inputs.nbytes + self.rates.nbytes + self.forces.nbytes)


def aligned(size: int, number: type[np.floating[Any]] = np.float64) -> NDArray[Any]:
    """Return zeros that start on a cache line (64 bytes): vector loads that straddle two lines take twice as long."""
    width = np.dtype(number).itemsize
    raw = np.zeros(size + 64 // width, dtype=number)
    start = (-raw.ctypes.data // width) % (64 // width)
    return raw[start : start + size]


def compile_time_loop(single: bool) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """Return the loop over time and what reads shared drives, in single or double precision: compiled, or loaded from the cache."""
    f = "f4" if single else "f8"
    loop = compile_loops(advance_block, LOOP_SIGNATURE.format(f=f), LOOP_IMPORTS)
    return loop, compile_loops(read_shared, SHARED_SIGNATURE.format(f=f))


def own_drives(excitation: Excitation) -> bool:
    """Whether individuals have drives of their own."""
    return any(item.ndim == 3 for item in (excitation.inputs, excitation.rates, excitation.forces))


@dataclass(frozen=True)
class PopulationRun:
    """A population that is to run: `columns shape (n_individuals, n_parameters and travels at rest)`; the rest as in :meth:`Kernel.run`."""

    source: KernelSource
    module: ModuleType
    columns: Array
    excitation: Excitation
    decimation: int
    initial: Array | None = None

    def advance(self, consume: Consume, threads: int | None, into: NDArray[Any] | None = None) -> None:
        """Advance all individuals, and hand over what each block answers.

        Parameters
        ----------
        consume
            Gets the blocks, in any order.
        threads
            How many cores to use at most (default: all).
        into
            `shape (n_individuals, n_samples, n_channels)`, in the kernel's precision: where whole blocks write their responses.
        """
        if threads is not None:
            check_count(threads, "threads", 1, MOST_THREADS)
        drives = self._drives()
        shared = [] if self.own_drives else self._shared(drives)
        starts = range(0, len(self.columns), BLOCK_SIZE)
        many = len(starts) > 1 and len(starts) * self.excitation.n_steps * self.source.n_dof > WORTH_THREADS
        workers = min(threads or os.cpu_count() or 1, len(starts)) if many else 1
        left = iter(starts)

        def work_off(_worker: int) -> None:
            for first in left:
                self._advance_block(first, drives, shared, consume, into)

        if workers > 1:
            with ThreadPoolExecutor(workers) as pool:
                list(pool.map(work_off, range(workers)))
        else:
            work_off(0)

    def _drives(self) -> list[NDArray[Any]]:
        """Return inputs, rates and forces in the kernel's precision, `shape (sets, n_steps + 1, width)`: one set, or one an individual."""
        items = (self.excitation.inputs, self.excitation.rates, self.excitation.forces)
        arrays = [np.ascontiguousarray(item, dtype=self.source.number) for item in items]
        return [item if item.ndim == 3 else item[None] for item in arrays]

    def _shared(self, drives: list[NDArray[Any]]) -> list[NDArray[Any]]:
        """Return the rows of drives that all individuals share, those of steps and those of samples."""
        reads, n_steps = self.source.reads, self.excitation.n_steps
        number = self.source.number
        rows = [np.empty((n_steps + 1, reads.step_row), number), np.empty((n_steps // self.decimation + 1, reads.sample_row), number)]
        read = compile_time_loop(self.source.single)[1]
        for group, columns in enumerate(reads.columns):
            target, every, before = (rows[1], self.decimation, reads.step_row) if group else (rows[0], 1, 0)
            for array, (start, end, place, pattern) in zip(drives, columns, strict=True):
                if end > start:
                    read(array, start, end, pattern, every, target, place - before)
        return rows

    def _space(self) -> list[NDArray[Any]]:
        """Return space for some rows of steps' and of samples' drives where each lane has its own."""
        reads, lanes, samples = self.source.reads, self.source.lanes, max(1, OWN_ROWS // self.decimation)
        steps = min(samples * self.decimation, self.excitation.n_steps + 1)
        shapes = ((steps, reads.step_row * lanes), (samples, reads.sample_row * lanes))
        return [aligned(rows * width, self.source.number).reshape(rows, width) for rows, width in shapes]

    @property
    def own_drives(self) -> bool:
        """Whether individuals have drives of their own."""
        return own_drives(self.excitation)

    def _advance_block(
        self, first: int, drives: list[NDArray[Any]], shared: list[NDArray[Any]], consume: Consume, into: NDArray[Any] | None
    ) -> None:
        from vehgen.codegen.emit_llvm import compiles

        source, module, lanes = self.source, self.module, self.source.lanes
        block = slice(first, min(first + BLOCK_SIZE, len(self.columns)))
        columns = self.columns[block]
        beginnings = np.zeros((len(columns), module.KEPT // lanes), source.number)
        beginnings[:, : columns.shape[1]] = columns
        if self.initial is not None:
            beginnings[:, module.STATE // lanes :][:, : self.initial.shape[1]] = self.initial[block]
        if into is None:
            target = np.empty((len(columns), self.excitation.n_steps // self.decimation + 1, source.n_channels), dtype=source.number)
        else:
            target = into[block]
        own = (item if len(item) == 1 else item[block] for item in drives)
        loop = compile_time_loop(source.single)[0]
        kernel: Any = module.run.address if compiles() else module.run
        places, shares = shared or self._space(), int(bool(shared))
        reads, ends = source.reads.array(), int(source.from_rest)
        work, residuals = aligned(module.WORK, source.number), np.empty(len(columns), source.number)
        loop(kernel, work, lanes, self.excitation.dt, beginnings, *places, shares, *own, reads, self.decimation, ends, target, residuals)
        consume(block, target, residuals if source.nonlinear else np.zeros(len(columns)))
