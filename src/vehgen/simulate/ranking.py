"""Populations of a search, which only has to tell better individuals from worse ones: in single precision where that is safe.

Safe are linear kernels in residual form, from rest, for recorders that are alike, over roads without hills. Responses then differ by some
1e-5 from those in double precision, and twice as many individuals fit a vector.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vehgen.mechanics.quantities import WITH_STATIC
from vehgen.simulate.acquired import acquired_excitation, keeps_what_recorders_keep
from vehgen.simulate.scenario import Scenario
from vehgen.simulate.simulator import Simulator

Array = NDArray[np.float64]
Reduction = Callable[[NDArray[Any]], Array]
"""Makes of responses `shape (n, n_samples, n_channels)`, in single or double precision, what is kept, the first axis n long."""
LEAST_RANKED = 16
"""Fewer individuals for a layout of axles fill less than half of the lanes of a kernel in single precision."""
NO_HILL_M = 1.0
"""On higher roads [m] the rounding of heights to single precision, 6e-8 of them, would itself shake the vehicle."""


def rank_population(simulator: Simulator, parameters: Array, scenario: Scenario, reduction: Reduction) -> tuple[Array, NDArray[np.bool_]]:
    """Simulate a population for a search, and keep only what a reduction makes of its responses.

    Parameters
    ----------
    simulator
        The vehicle's.
    parameters
        `shape (n_individuals, n_parameters)`.
    scenario
        The run.
    reduction
        Called with responses of parts of the population, by several threads.

    Returns
    -------
    What is kept of all individuals, and which of them failed `shape (n_individuals,)`.
    """
    failed = np.zeros(len(parameters), dtype=bool)
    layouts, group = simulator.layouts(parameters)
    if len(layouts) * LEAST_RANKED > len(parameters) or not _may_be_single(simulator, scenario):
        result = simulator.run(parameters, scenario)
        failed[list(result.failures)] = True
        return reduction(result.responses), failed
    parts = []
    for index, layout in enumerate(layouts):
        members = np.flatnonzero(group == index)
        excitation, first = acquired_excitation(simulator.kernel, scenario, layout)
        flat = np.abs(excitation.inputs).max(initial=0.0) < NO_HILL_M
        kernel = simulator.single_kernel if flat else simulator.kernel
        part, failures = kernel.reduce(parameters[members], excitation, partial(_from_sample, first, reduction), scenario.decimation)
        parts.append(part)
        failed[members[list(failures)]] = True
    found = np.empty((len(parameters), *parts[0].shape[1:]))
    found[np.argsort(group, kind="stable")] = np.concatenate(parts)
    return found, failed


def _may_be_single(simulator: Simulator, scenario: Scenario) -> bool:
    static = any(channel.quantity in WITH_STATIC for channel in simulator.model.channels)
    source = simulator.kernel.source
    return source.from_rest and not source.nonlinear and not static and keeps_what_recorders_keep(simulator.kernel, scenario)


def _from_sample(first: int, reduction: Reduction, responses: NDArray[Any]) -> Array:
    return reduction(responses[:, first:])
