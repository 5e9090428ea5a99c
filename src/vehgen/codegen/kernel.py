"""A compiled kernel that runs populations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from numbers import Integral
from pathlib import Path
from types import ModuleType
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray

from vehgen.codegen.cache import cache_folder, import_kernel, is_compiled, kernel_name
from vehgen.codegen.kernel_source import KernelSource, Precision, write_kernel
from vehgen.codegen.population_run import Excitation, PopulationRun, compile_time_loop, own_drives
from vehgen.errors import ArgumentError, InputError, did_you_mean, shown
from vehgen.mechanics.equations_of_motion import GRAVITY, EquationsOfMotion
from vehgen.mechanics.equilibrium import equilibria

Array = NDArray[np.float64]
GROWN = 1e3
"""Laws that leave so many times the weight in a step have let a motion grow beyond what any has."""
UNCONVERGED = 0.01
"""Residual of the force laws over the vehicle's weight above which an individual counts as failed."""


@dataclass(frozen=True)
class KernelResult:
    """What a kernel computed.

    `responses shape (n_individuals, n_samples, n_channels)` in the channels' units; `failures` maps an individual's number to why its
    response cannot be used; `residuals shape (n_individuals,)` is the largest change of a law's force in the last sweep of a step [N].
    """

    responses: Array
    failures: dict[int, str]
    residuals: Array


def find_failures(names: tuple[str, ...], parameters: Array, responses: NDArray[Any]) -> dict[int, str]:
    """Say of each individual without a finite response why it has none; further columns of `parameters` have no name."""
    failures: dict[int, str] = {}
    for individual in np.flatnonzero(~np.isfinite(responses).all(axis=(1, 2))):
        bad = [name for name, value in zip(names, parameters[individual], strict=False) if not np.isfinite(value)]
        if bad:
            failures[int(individual)] = f"its parameter {bad[0]} is not a finite number"
        else:
            failures[int(individual)] = "it diverges: its matrices are not positive definite, or the step is too coarse for it"
    return failures


class Kernel:
    """The compiled Newmark kernel of a model.

    Parameters
    ----------
    model
        A derived model; its channels are what comes out.
    folder
        Where the compiled code is kept (default: the user's cache folder).
    sweeps
        How often a step solves for the forces of the laws (default: 2 to 12, as the laws need).
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
        self._options: tuple[int | None, Precision] = sweeps, precision
        self._folder = folder

    @cached_property
    def source(self) -> KernelSource:
        """What it is compiled from: written when first asked for, as many models are only looked at."""
        sweeps, precision = self._options
        return write_kernel(self.model, sweeps=sweeps, precision=precision)

    @property
    def name(self) -> str:
        """The name of its file: the hash of its source."""
        return kernel_name(self.source.text)

    def __getstate__(self) -> dict[str, object]:
        """Leave the compiled code behind: who receives a kernel imports it again from the cache, or compiles it."""
        return {key: value for key, value in vars(self).items() if key not in ("_module", "_variants")}

    @property
    def folder(self) -> Path:
        """Where its compiled code is kept, if that folder can be used."""
        return self._folder or cache_folder()

    @property
    def is_compiled(self) -> bool:
        """Whether its own code is at hand; the loop over time, which all kernels share, may yet have to be compiled once."""
        return is_compiled(self.source.text, self.folder)

    @cached_property
    def _module(self) -> ModuleType:
        return import_kernel(self.source.text, self._folder)

    @cached_property
    def _variants(self) -> dict[tuple[bool, bool], tuple[KernelSource, ModuleType]]:
        return {}

    def _variant(self, moving: bool, own_drives: bool) -> tuple[KernelSource, ModuleType]:
        """Return the kernel of runs that do not start from rest, or whose individuals have drives of their own."""
        moving = moving and self.source.from_rest
        if not moving and not own_drives:
            return self.source, self._module
        if (moving, own_drives) not in self._variants:
            sweeps, precision = self._options
            source = write_kernel(self.model, sweeps=sweeps, precision=precision, from_rest=not moving, own_drives=own_drives)
            self._variants[moving, own_drives] = source, import_kernel(source.text, self._folder)
        return self._variants[moving, own_drives]

    def compile(self) -> None:
        """Compile now, or load what an earlier process compiled, the loop over time included."""
        _ = self._module
        compile_time_loop(self.source.single)

    def reduce(
        self,
        parameters: Array,
        excitation: Excitation,
        reduction: Callable[[NDArray[Any]], Array],
        decimation: int = 10,
        threads: int | None = None,
    ) -> tuple[Array, dict[int, str]]:
        """Simulate a population of any size and keep only what a reduction makes of each individual's response.

        Parameters
        ----------
        parameters, excitation, decimation, threads
            As in :meth:`run`.
        reduction
            Maps responses `shape (n, n_samples, n_channels)`, in the kernel's precision, to an array whose first axis is n. It is called
            with the individuals that advance together, by several threads, and may not keep what it is given.

        Returns
        -------
        The reductions of all individuals, and the failures as in :class:`KernelResult`.
        """
        columns, unheld = self._columns(parameters, excitation, decimation)
        parts: dict[int, Array] = {}
        failures: dict[int, str] = {}

        def consume(own: slice, responses: NDArray[Any], residuals: Array) -> None:
            parts[own.start] = np.asarray(reduction(responses))
            found = self._failures(columns[own], responses, residuals, excitation)
            failures.update({own.start + i: reason for i, reason in found.items()})

        self._population(columns, excitation, decimation).advance(consume, threads)
        return np.concatenate([parts[first] for first in sorted(parts)]), {**failures, **unheld}

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
        The responses, and which individuals failed and why; a failed individual leaves the others as they are. Loads of tyres and hinges
        are without their static part, which `Simulator` adds.

        Where laws count their travel from the unloaded position, static equilibrium is solved first, and an individual that has none
        fails.
        """
        columns, unheld = self._columns(parameters, excitation, decimation)
        initial = None if initial is None else self._initial(initial, len(columns))
        shape = (len(columns), excitation.n_steps // decimation + 1, len(self.model.channels))
        found, left = np.empty(shape, dtype=self.source.number), np.zeros(len(columns))

        def consume(own: slice, responses: NDArray[Any], residuals: Array) -> None:
            if responses.base is not found:
                found[own] = responses
            left[own] = residuals

        self._population(columns, excitation, decimation, initial).advance(consume, threads, found)
        responses = found.astype(np.float64, copy=False)
        return KernelResult(responses, {**self._failures(columns, responses, left, excitation), **unheld}, left)

    def _columns(self, parameters: Array, excitation: Excitation, decimation: int) -> tuple[Array, dict[int, str]]:
        """Return a checked population with the travels at rest that the kernel asks for as further columns, and who cannot rest."""
        parameters = np.ascontiguousarray(np.atleast_2d(parameters), dtype=np.float64)
        self._check(parameters, excitation, decimation)
        if not self.source.static_travels:
            return parameters, {}
        rest = equilibria(self.model, parameters)
        return np.hstack([parameters, rest.travels[:, self.source.static_travels]]), rest.failures

    def _initial(self, given: Array, count: int) -> Array:
        """Return states to begin in as an array, one of every individual; raises ArgumentError for others."""
        try:
            found = np.asarray(given, dtype=np.float64)
        except (TypeError, ValueError) as error:
            raise ArgumentError("`initial`: displacements, then velocities, of every individual were expected", "initial") from error
        if found.shape != (count, 2 * self.model.n_dof):
            expected = f"(n_individuals, 2 n_dof) = {(count, 2 * self.model.n_dof)}"
            raise ArgumentError(f"`initial` has shape {found.shape}; {expected} was expected", "initial")
        return found

    def _population(self, columns: Array, excitation: Excitation, decimation: int, initial: Array | None = None) -> PopulationRun:
        source, module = self._variant(initial is not None, own_drives(excitation))
        return PopulationRun(source, module, columns, excitation, decimation, initial)

    def _failures(self, columns: Array, responses: NDArray[Any], residuals: Array, excitation: Excitation) -> dict[int, str]:
        failures = find_failures(self.model.parameters, columns, responses)
        if failures and not excitation.is_finite:
            failures = dict.fromkeys(failures, "what drives it, road or forces, is not finite")
        if self.source.nonlinear:
            limit = UNCONVERGED * self._force_scale
            for individual in np.flatnonzero(residuals > limit):
                cure = "take a smaller step"
                if residuals[individual] > self._force_scale * GROWN:
                    cure += ", or does a law push along with its motion?"
                reason = f"its force laws did not converge: {residuals[individual]:.3g} N were left in the worst step; {cure}"
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
        if not (isinstance(decimation, Integral) and decimation >= 1):
            raise ArgumentError(f"`decimation`: a whole number of at least 1 was expected, found {shown(decimation)}", "decimation")
