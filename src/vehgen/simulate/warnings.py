"""What makes a simulated response doubtful."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from vehgen.mechanics.equations_of_motion import EquationsOfMotion
from vehgen.mechanics.static_loads import static_loads
from vehgen.simulate.modes import natural_modes
from vehgen.simulate.scenario import Scenario

MAX_PERIOD_ERROR = 0.02
"""Newmark's relative period error (w dt/2)/atan(w dt/2) - 1 above which a mode is worth a warning."""
NULL_WIDTH = 0.05
"""A spectral null this near (relative) to a hop frequency leaves the mode unexcited."""


def lift_off(model: EquationsOfMotion, values: Mapping[str, float], tyre_forces: NDArray[np.float64]) -> Iterator[str]:
    """Warn where a tyre's dynamic force `shape (n_samples, n_axles)` [N] unloads it wholly: the linear tyre would pull on the road."""
    if not model.vehicle.axles:
        return
    loads = static_loads(model, values).axles
    for (name, load), force in zip(loads.items(), tyre_forces.T, strict=True):
        if load > 0 and force.min() < -load:
            yield f"the tyre of {name} would leave the road: its dynamic force falls to {force.min() / load:.2f} of its static load"


def spectral_nulls(model: EquationsOfMotion, values: Mapping[str, float], scenario: Scenario) -> Iterator[str]:
    """Warn where a null of a hump's spectrum meets a hop mode: the run hardly excites that axle."""
    hop = np.array([item.motion == "hop" for item in model.coordinates])
    for mode in natural_modes(model, values):
        if not hop.any() or mode.energy[hop].sum() < 0.5:
            continue
        for null in scenario.nulls:
            if abs(null - mode.undamped_hz) < NULL_WIDTH * mode.undamped_hz:
                yield (
                    f"the hump's spectrum has a null at {null:.2f} Hz, beside {mode.name} at {mode.undamped_hz:.2f} Hz: "
                    "this run hardly excites it; change the speed or the hump's length"
                )


def step_too_coarse(model: EquationsOfMotion, values: Mapping[str, float], scenario: Scenario) -> Iterator[str]:
    """Warn where the step stretches the period of a mode, or steps over a hump."""
    fastest = natural_modes(model, values)[-1]
    half = np.pi * fastest.undamped_hz * scenario.dt
    error = half / np.arctan(half) - 1 if half else 0.0
    if error > MAX_PERIOD_ERROR:
        yield (
            f"the step of {scenario.dt * 1e3:g} ms is too coarse: it stretches the period of {fastest.name} "
            f"({fastest.undamped_hz:.1f} Hz) by {error:.1%}; 1 ms or less is usual"
        )
    for hump in scenario.humps:
        length = hump.length
        steps = length / (scenario.top_speed * scenario.dt)
        if steps < 20:
            yield f"the step of {scenario.dt * 1e3:g} ms crosses a hump of {length:g} m in {steps:.0f} steps; take at least 20"
    if not 0.5 / (scenario.dt * scenario.decimation) > fastest.undamped_hz:
        yield f"samples every {scenario.dt * scenario.decimation * 1e3:g} ms cannot show {fastest.name} at {fastest.undamped_hz:.1f} Hz"
