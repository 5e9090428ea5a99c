"""A compiled kernel that runs populations."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import ModuleType
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray

from vehgen.codegen.cache import cache_folder, import_kernel, is_compiled, kernel_name
from vehgen.codegen.kernel_source import KernelSource, Precision, write_kernel
from vehgen.errors import InputError, did_you_mean, shown
from vehgen.mechanics.equations_of_motion import GRAVITY, EquationsOfMotion
from vehgen.mechanics.equilibrium import equilibria

Array = NDArray[np.float64]
WORTH_THREADS = 1_000_000
"""Blocks times steps times degrees of freedom below which one core is as quick as several."""
UNCONVERGED = 0.01
"""Residual of the force laws over the vehicle's weight above which an individual counts as failed."""


@dataclass(frozen=True)
class Excitation:
    """What moves a vehicle, at the ends of every step of `dt` [s].

    `inputs`, `rates` `shape (n_steps + 1, n_inputs)`: displacement inputs [m] and their rates [m/s]; `forces` `shape (n_steps + 1,
    n_forces)` [N]. All three may have an axis more ahead, of individuals each with inputs of its own.
    """

    dt: float
    inputs: Array
    rates: Array
    forces: Array

    @property
    def n_steps(self) -> int:
        """Number of time steps."""
        return int(self.inputs.shape[-2]) - 1

    @property
    def time(self) -> Array:
        """Times of the inputs [s]."""
        return np.arange(self.n_steps + 1, dtype=np.float64) * self.dt

    @property
    def nbytes(self) -> int:
        """Size of its arrays [bytes]."""
        return int(self.inputs.nbytes + self.rates.nbytes + self.forces.nbytes)


@dataclass(frozen=True)
class KernelResult:
    """What a kernel computed.

    `responses shape (n_individuals, n_samples, n_channels)` in the channels' units; `failures` maps an individual's number to why its
    response cannot be used; `residuals shape (n_individuals,)` is the largest change of a law's force in the last sweep of a step [N].
    """

    responses: Array
    failures: dict[int, str]
    residuals: Array


def find_failures(names: tuple[str, ...], parameters: Array, responses: Array) -> dict[int, str]:
    """Say of each individual without a finite response why it has none."""
    failures: dict[int, str] = {}
    for individual in np.flatnonzero(~np.isfinite(responses).all(axis=(1, 2))):
        bad = [name for name, value in zip(names, parameters[individual], strict=True) if not np.isfinite(value)]
        if bad:
            failures[int(individual)] = f"its parameter {bad[0]} is not a finite number"
        else:
            failures[int(individual)] = "it diverges: its matrices are not positive definite, or the step is too coarse for it"
    return failures


def aligned(size: int, number: type[np.floating[Any]] = np.float64) -> NDArray[Any]:
    """Return zeros that start on a cache line (64 bytes): vector loads that straddle two lines take twice as long."""
    width = np.dtype(number).itemsize
    raw = np.zeros(size + 64 // width, dtype=number)
    start = (-raw.ctypes.data // width) % (64 // width)
    return raw[start : start + size]


class Kernel:
    """The compiled Newmark kernel of a model.

    Parameters
    ----------
    model
        A derived model; its channels are what comes out.
    folder
        Where the compiled code is kept (default: the user's cache folder).
    sweeps
        How often a step solves for the forces of the laws (default: 2 or 3, as the laws need).
    precision
        `double`, or `single`: twice the individuals in a vector, with errors of about 1e-4 (docs/performance.md). Differences of
        nearly equal responses, such as derivatives by small steps, need double.

    """

    def __init__(
        self, model: EquationsOfMotion, folder: Path | None = None, sweeps: int | None = None, precision: Precision = "double"
    ) -> None:
        if precision not in get_args(Precision):
            raise InputError(f"unknown precision {shown(precision)}; {did_you_mean(precision, get_args(Precision))}")
        self.model = model
        self.source: KernelSource = write_kernel(model, sweeps=sweeps, precision=precision)
        self._options: tuple[int | None, Precision] = sweeps, precision
        self._number = np.float32 if precision == "single" else np.float64
        self._folder = folder

    @property
    def name(self) -> str:
        """The name of its file: the hash of its source."""
        return kernel_name(self.source.text)

    def __getstate__(self) -> dict[str, object]:
        """Leave the compiled code behind: who receives a kernel imports it again from the cache, or compiles it."""
        return {key: value for key, value in vars(self).items() if key not in ("_module", "_moving")}

    @property
    def folder(self) -> Path:
        """Where its compiled code is kept, if that folder can be used."""
        return self._folder or cache_folder()

    @property
    def is_compiled(self) -> bool:
        """Whether its compiled code is at hand, so that the first run need not wait."""
        return is_compiled(self.source.text, self.folder)

    @cached_property
    def _module(self) -> ModuleType:
        return import_kernel(self.source.text, self._folder)

    @cached_property
    def _moving(self) -> tuple[KernelSource, ModuleType]:
        """The kernel of runs that do not start from rest: the same one, unless its states are no displacements and velocities."""
        if not self.source.from_rest:
            return self.source, self._module
        sweeps, precision = self._options
        source = write_kernel(self.model, sweeps=sweeps, precision=precision, from_rest=False)
        return source, import_kernel(source.text, self._folder)

    def compile(self) -> None:
        """Compile now, or load what an earlier process compiled."""
        _ = self._module

    def reduce(
        self,
        parameters: Array,
        excitation: Excitation,
        reduction: Callable[[Array], Array],
        decimation: int = 10,
        block: int = 1024,
        threads: int | None = None,
    ) -> tuple[Array, dict[int, str]]:
        """Simulate a population of any size and keep only what a reduction makes of each individual's response.

        Parameters
        ----------
        parameters, excitation, decimation, threads
            As in :meth:`run`.
        reduction
            Maps responses `shape (n, n_samples, n_channels)` to an array whose first axis is n.
        block
            Individuals whose responses are in memory at a time.

        Returns
        -------
        The reductions of all individuals, and the failures as in :class:`KernelResult`.
        """
        parts: list[Array] = []
        failures: dict[int, str] = {}
        for first in range(0, len(parameters), block):
            result = self.run(parameters[first : first + block], excitation, decimation, threads=threads)
            failures.update({first + i: reason for i, reason in result.failures.items()})
            parts.append(np.asarray(reduction(result.responses)))
        return np.concatenate(parts), failures

    def run(
        self, parameters: Array, excitation: Excitation, decimation: int = 10, initial: Array | None = None, threads: int | None = None
    ) -> KernelResult:
        """Simulate a population.

        Parameters
        ----------
        parameters
            `shape (n_individuals, n_parameters)` in the order of `model.parameters`, SI units.
        excitation
            Inputs and step, the same for all individuals or each one's own.
        decimation
            Every how many steps a sample is kept.
        initial
            `shape (n_individuals, 2 n_dof)`: displacements then velocities at the start (default: at rest in equilibrium).
        threads
            How many cores to use at most (default: all).

        Returns
        -------
        The responses, and which individuals failed and why; a failed individual leaves the others as they are.

        Where laws count their travel from the unloaded position, static equilibrium is solved first, and an individual that has none
        fails.
        """
        parameters = np.ascontiguousarray(np.atleast_2d(parameters), dtype=np.float64)
        self._check(parameters, excitation, decimation)
        columns, unheld = parameters, {}
        if self.source.static_travels:
            rest = equilibria(self.model, parameters)
            columns, unheld = np.hstack([parameters, rest.travels[:, self.source.static_travels]]), rest.failures
        responses, residuals = self._advance(columns, excitation, decimation, initial, threads)
        return KernelResult(responses, {**self._failures(parameters, responses, residuals), **unheld}, residuals)

    def _advance(
        self, columns: Array, excitation: Excitation, decimation: int, initial: Array | None, threads: int | None
    ) -> tuple[Array, Array]:
        """Return the responses and residuals of individuals with these columns, blocks of lanes shared among threads."""
        source, module = (self.source, self._module) if initial is None else self._moving
        n_individuals, lanes, n_dof, number = len(columns), source.lanes, self.model.n_dof, self._number
        n_samples, n_channels = excitation.n_steps // decimation + 1, len(self.model.channels)
        responses = np.empty((n_individuals, n_samples, n_channels))
        residuals = np.zeros(n_individuals)
        arrays = [np.ascontiguousarray(item, dtype=number) for item in (excitation.inputs, excitation.rates, excitation.forces)]
        own = excitation.inputs.ndim == 3

        def block(first: int) -> None:
            last = min(first + lanes, n_individuals)
            rows = np.minimum(np.arange(first, first + lanes), last - 1)
            work = aligned(module.WORK, number)
            work[: columns.shape[1] * lanes] = np.ascontiguousarray(columns[rows].T).ravel()
            state = work[module.STATE : module.DRIVES]
            if initial is not None:
                state[: 2 * n_dof * lanes] = np.ascontiguousarray(initial[rows].T).ravel()
            direct = last - first == lanes and number is np.float64
            target = responses[first:last] if direct else np.empty((lanes, n_samples, n_channels), dtype=number)
            drives = (item[first:last] if own else item[None] for item in arrays)
            module.advance(work, *drives, excitation.dt, decimation, target)
            if not direct:
                responses[first:last] = target[: last - first]
            if source.nonlinear:
                residuals[first:last] = state[-lanes:][: last - first]

        starts = range(0, n_individuals, lanes)
        many = len(starts) > 1 and len(starts) * excitation.n_steps * n_dof > WORTH_THREADS
        workers = min(threads or os.cpu_count() or 1, len(starts)) if many else 1
        if workers > 1:
            with ThreadPoolExecutor(workers) as pool:
                list(pool.map(block, starts))
        else:
            for first in starts:
                block(first)
        return responses, residuals

    def _failures(self, parameters: Array, responses: Array, residuals: Array) -> dict[int, str]:
        failures = find_failures(self.model.parameters, parameters, responses)
        if self.source.nonlinear:
            limit = UNCONVERGED * self._force_scale
            for individual in np.flatnonzero(residuals > limit):
                reason = f"its force laws did not converge: {residuals[individual]:.3g} N were left in the worst step; take a smaller step"
                failures.setdefault(int(individual), reason)
        return failures

    @cached_property
    def _force_scale(self) -> float:
        return GRAVITY * self.model.total_mass()

    def _check(self, parameters: Array, excitation: Excitation, decimation: int) -> None:
        expected = len(self.model.parameters)
        if parameters.ndim != 2 or parameters.shape[1] != expected:
            raise InputError(
                f"parameters have shape {parameters.shape}; (n_individuals, {expected}) was expected: {', '.join(self.model.parameters)}"
            )
        shapes = {"inputs": len(self.model.inputs), "rates": len(self.model.inputs), "forces": len(self.model.forces)}
        for key, width in shapes.items():
            found = getattr(excitation, key).shape
            if found not in ((excitation.n_steps + 1, width), (len(parameters), excitation.n_steps + 1, width)):
                raise InputError(f"the excitation's {key} have shape {found}; ({excitation.n_steps + 1}, {width}) was expected")
        if not (excitation.dt > 0 and decimation >= 1):
            raise InputError(
                f"the step must be positive and the decimation at least 1, found dt = {excitation.dt} and decimation = {decimation}"
            )
