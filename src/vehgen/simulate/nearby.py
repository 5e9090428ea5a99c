"""Excitations of scenarios that hardly differ from one another: what derivatives by a run's speed, clock and road are taken from."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vehgen.codegen import Excitation
from vehgen.road import nearby_inputs
from vehgen.simulate.scenario import Array, Scenario


def nearby_excitation(scenario: Scenario, others: Sequence[Scenario], offsets: Array) -> Excitation:
    """Return the excitation of a scenario and of others nearby, in this order, each individual's own.

    Those that differ in speed alone are found to the first order, all at once (see :func:`vehgen.road.nearby_inputs`); those that differ in
    the road's height alone are multiples.

    Parameters
    ----------
    scenario, others
        Scenarios of the same length and step.
    offsets
        Each axle's distance behind the first to arrive `shape (n_axles,)` [m].
    """
    centre = scenario.excitation(offsets)
    found = [centre] * len(others)
    same = [other.ground is scenario.ground and other.forces is scenario.forces for other in others]
    by_speed = [i for i, other in enumerate(others) if same[i] and other.same_road(scenario)]
    for i, other in enumerate(others):
        if not (same[i] and other.same_road(scenario)):
            higher = same[i] and other.same_speed(scenario) and other.same_road(scenario, but_height=True) and scenario.track.scale != 0
            found[i] = _higher(centre, other, scenario, len(offsets)) if higher else other.new_excitation(offsets)
    if by_speed:
        wheels = nearby_inputs(scenario.track, scenario.speed, [others[i].speed for i in by_speed], offsets, scenario.time)
        for i, heights, rates in zip(by_speed, wheels.heights, wheels.rates, strict=True):
            found[i] = _with_wheels(centre, heights, rates)
    all_of_them = [centre, *found]
    return Excitation(
        centre.dt,
        np.stack([item.inputs for item in all_of_them]),
        np.stack([item.rates for item in all_of_them]),
        np.stack([item.forces for item in all_of_them]),
    )


def _higher(centre: Excitation, other: Scenario, scenario: Scenario, n_axles: int) -> Excitation:
    factor = other.track.scale / scenario.track.scale
    return _with_wheels(centre, factor * centre.inputs[:, :n_axles], factor * centre.rates[:, :n_axles])


def _with_wheels(centre: Excitation, heights: Array, rates: Array) -> Excitation:
    """Return an excitation with another road under its wheels, whose inputs come first."""
    width = heights.shape[1]
    inputs, moved = (np.hstack([own, old[:, width:]]) for own, old in ((heights, centre.inputs), (rates, centre.rates)))
    return Excitation(centre.dt, inputs, moved, centre.forces)
