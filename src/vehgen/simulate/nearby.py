"""Excitations of drives that hardly differ: what derivatives by a run's speed, start and road, and by axles' places, are taken from."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vehgen.codegen import Excitation
from vehgen.road import WheelInputs, nearby_inputs
from vehgen.simulate.scenario import Array, Scenario

Drive = tuple[Scenario, Array]
"""A scenario, and each axle's distance behind the first to arrive `shape (n_axles,)` [m]."""


def nearby_excitation(scenario: Scenario, offsets: Array, others: Sequence[Drive]) -> Excitation:
    """Return the excitation of a scenario and of drives nearby, in this order, each individual's own.

    Over the same road the others are found to the first order, all at once (see :func:`vehgen.road.nearby_inputs`); those that differ in
    the road alone share the way, and those that differ in its height alone are multiples.

    Parameters
    ----------
    scenario, offsets
        The drive about which others are.
    others
        Drives with scenarios of the same steps and samples.

    Raises
    ------
    ValueError
        Where a scenario has other steps or samples.
    """
    if not all(other.same_samples(scenario) for other, _ in others):
        raise ValueError("drives nearby have the same steps and samples")
    centre, n_axles = scenario.excitation(offsets), len(offsets)
    inputs, rates = (np.zeros((1 + len(others), *centre.inputs.shape)) for _ in range(2))
    forces = np.repeat(centre.forces[None], 1 + len(others), axis=0)
    for own, item in ((inputs, centre.inputs), (rates, centre.rates)):
        own[:] = item
        own[1:, :, :n_axles] = 0.0
    by_road, by_way = [], []
    for i, (other, behind) in enumerate(others, start=1):
        if not other.same_pushes(scenario):
            pushes = other.pushes()
            inputs[i, :, n_axles:], rates[i, :, n_axles:], forces[i] = pushes.inputs, pushes.rates, pushes.forces
        same_way = other.same_speed(scenario) and other.farther == scenario.farther and np.array_equal(behind, offsets)
        if other.same_road(scenario) and not same_way:
            by_way.append(i)
        elif same_way and other.same_road(scenario, but_height=True) and scenario.track.scale != 0:
            factor = other.track.scale / scenario.track.scale
            inputs[i, :, :n_axles], rates[i, :, :n_axles] = factor * centre.inputs[:, :n_axles], factor * centre.rates[:, :n_axles]
        elif same_way:
            by_road.append(i)
        else:
            wheels = other.wheels(behind)
            inputs[i, :, :n_axles], rates[i, :, :n_axles] = wheels.heights, wheels.rates
    tracks = [others[i - 1][0].track for i in by_road]
    ways = [(other.speed, other.axle_offsets(behind)) for other, behind in (others[i - 1] for i in by_way)]
    near = [WheelInputs(inputs[i, :, :n_axles], rates[i, :, :n_axles]) for i in (*by_road, *by_way)]
    nearby_inputs(scenario.track, scenario.speed, tracks, ways, scenario.axle_offsets(offsets), scenario.time, near)
    return Excitation(centre.dt, inputs, rates, forces)
