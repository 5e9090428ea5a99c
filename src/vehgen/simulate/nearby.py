"""Excitations of scenarios that hardly differ from one another: what derivatives by a run's speed, clock and road are taken from."""

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

    Those that differ in speed, or in where axles run, alone are found to the first order, all at once (see
    :func:`vehgen.road.nearby_inputs`); those that differ in the road alone share the way, and those that differ in its height alone are
    multiples.

    Parameters
    ----------
    scenario, offsets
        The drive about which others are.
    others
        Drives with scenarios of the same length and step.
    """
    centre, n_axles = scenario.excitation(offsets), len(offsets)
    inputs, rates = (np.zeros((1 + len(others), *centre.inputs.shape)) for _ in range(2))
    forces = np.repeat(centre.forces[None], 1 + len(others), axis=0)
    for own, item in ((inputs, centre.inputs), (rates, centre.rates)):
        own[0], own[1:, :, n_axles:] = item, item[:, n_axles:]
    by_road, by_way = [], []
    for i, (other, behind) in enumerate(others, start=1):
        same = other.ground is scenario.ground and other.forces is scenario.forces
        same_way = other.same_speed(scenario) and other.farther == scenario.farther and np.array_equal(behind, offsets)
        if same and other.same_road(scenario):
            by_way.append(i)
        elif same and same_way and other.same_road(scenario, but_height=True) and scenario.track.scale != 0:
            factor = other.track.scale / scenario.track.scale
            inputs[i, :, :n_axles], rates[i, :, :n_axles] = factor * centre.inputs[:, :n_axles], factor * centre.rates[:, :n_axles]
        elif same and same_way:
            by_road.append(i)
        else:
            found = other.new_excitation(behind)
            inputs[i], rates[i], forces[i] = found.inputs, found.rates, found.forces
    tracks = [others[i - 1][0].track for i in by_road]
    ways = [(other.speed, other.axle_offsets(behind)) for other, behind in (others[i - 1] for i in by_way)]
    near = [WheelInputs(inputs[i, :, :n_axles], rates[i, :, :n_axles]) for i in (*by_road, *by_way)]
    nearby_inputs(scenario.track, scenario.speed, tracks, ways, scenario.axle_offsets(offsets), scenario.time, near)
    return Excitation(centre.dt, inputs, rates, forces)
