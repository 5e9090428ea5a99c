"""What makes a simulated response doubtful."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vehgen.files.number_text import five_digits
from vehgen.mechanics.equations_of_motion import EquationsOfMotion
from vehgen.mechanics.outputs import Place
from vehgen.mechanics.static_loads import static_loads
from vehgen.road import Hump, MeasuredProfile
from vehgen.simulate.budgets import MAX_RESPONSE_NUMBERS
from vehgen.simulate.modes import natural_modes
from vehgen.simulate.response import ResponseChannel
from vehgen.simulate.scenario import Scenario

if TYPE_CHECKING:
    from vehgen.simulate.simulator import Simulator

Array = NDArray[np.float64]
MAX_PERIOD_ERROR = 0.02
"""Newmark's relative period error (w dt/2)/atan(w dt/2) - 1 above which a mode is worth a warning."""
MISSED_PEAK = 0.1
"""A peak between samples that exceeds the largest of them by this share is worth a warning."""
STEPS_OF_A_CYCLE = 10
"""A harmonic of fewer steps a cycle is bent."""
SHORT_M = 2.0
"""A vehicle is taken to be so long at least [m]: bodies reach beyond axles and COGs."""
NULL_WIDTH = 0.05
"""A spectral null this near (relative) to a hop frequency leaves the mode unexcited."""


def at_every_step(simulator: Simulator, parameters: Array, scenario: Scenario, kept: Array) -> Array:
    """Return one individual's response at every step of a run, or what was kept where that is all, or more would fill the memory."""
    too_many = len(scenario.time) * kept.shape[1] > MAX_RESPONSE_NUMBERS
    if too_many or (scenario.decimation == 1 and not scenario.chains):
        return kept
    every = replace(scenario, decimation=1, skipped=scenario.skipped * scenario.decimation, chains={})
    return np.asarray(simulator.run(parameters, every).responses[0])


def lift_off(model: EquationsOfMotion, values: Mapping[str, float], tyre_forces: NDArray[np.float64]) -> Iterator[str]:
    """Warn where a tyre's dynamic force `shape (n_samples, n_axles)` [N] unloads it wholly: the linear tyre would pull on the road."""
    if not model.vehicle.axles:
        return
    loads = static_loads(model, values).axles
    lifting = {element.name for element in model.elements if any(term.law.name == "tyre_liftoff" for term in element.laws)}
    for (name, load), force in zip(loads.items(), tyre_forces.T, strict=True):
        if load > 0 and force.min() < -load and name not in lifting:
            yield f"the tyre of {name} would leave the road: its dynamic force falls to {force.min() / load:.2f} of its static load"


def missed_peaks(
    channels: Sequence[ResponseChannel], scenario: Scenario, kept: NDArray[np.float64], steps: NDArray[np.float64]
) -> Iterator[str]:
    """Warn where samples of a channel pass over its peak; responses `shape (n, n_channels)` as kept and at every step, in its unit."""
    largest, peaks = np.abs(kept).max(axis=0), np.abs(steps).max(axis=0)
    passed = [
        peak / most - 1 if most > 0 and scenario.chain(item.name).is_point_sample else 0.0
        for item, most, peak in zip(channels, largest, peaks, strict=True)
    ]
    beyond = [i for i, share in enumerate(passed) if share > MISSED_PEAK]
    if not beyond:
        return
    worst = max(beyond, key=lambda i: passed[i])
    others = f" (in all {len(beyond)} channels do by more than {MISSED_PEAK:.0%})" if len(beyond) > 1 else ""
    yield (
        f"between samples every {scenario.dt * scenario.decimation * 1e3:g} ms {channels[worst].name} reaches {five_digits(peaks[worst])} "
        f"{channels[worst].unit}, {passed[worst]:.0%} more than the largest of them{others}; "
        f"`sample: {scenario.dt * 1e3:g} ms` in the run file keeps every step"
    )


def doubtful_scenario(model: EquationsOfMotion, values: Mapping[str, float], scenario: Scenario, places: Iterable[Place]) -> Iterator[str]:
    """Warn of what a run does not meet or hardly excites, of steps that are too coarse, and of sensors and forces beside the vehicle."""
    yield from nothing_drives(scenario)
    yield from far_places(model, values, places)
    yield from doubtful_humps(scenario, dict(zip(model.vehicle.axles, model.wheel_offsets(values).tolist(), strict=True)))
    yield from spectral_nulls(model, values, scenario)
    yield from step_too_coarse(model, values, scenario)


def nothing_drives(scenario: Scenario) -> Iterator[str]:
    """Warn of a run in which nothing moves the vehicle."""
    if not (scenario.track.parts or scenario.forces or any(scenario.ground) or scenario.initial is not None):
        yield "nothing drives the vehicle, which stays at rest: add a `road`, `forces`, `displacements` or `initial`"


def far_places(model: EquationsOfMotion, values: Mapping[str, float], places: Iterable[Place]) -> Iterator[str]:
    """Warn of sensors and forces of a model that are farther from all axles, hinges and bodies' COGs than these are from each other."""
    layout = model.layout
    known = [*layout.axles.values(), *(x for x, _ in (*layout.bodies.values(), *layout.hinges.values()))]
    named = {place.name: place for place in places}.values()
    wanted = [layout.bodies[place.body][0] + place.locate(model.vehicle, layout) for place in named]
    found = np.array(model.evaluate_list([*known, *wanted], values))
    last, first = found[: len(known)].min(), found[: len(known)].max()
    length = max(first - last, SHORT_M)
    for place, x in zip(named, found[len(known) :].tolist(), strict=True):
        beyond, where = (x - first, "ahead of") if x > first else (last - x, "behind")
        if beyond > length:
            yield (
                f"{place.name} is {beyond:.3g} m {where} all axles, hinges and COGs of the vehicle, which span {first - last:.3g} m: "
                "is its place right?"
            )


def doubtful_humps(scenario: Scenario, axles: Mapping[str, float]) -> Iterator[str]:
    """Warn of humps and profiles beyond where the run ends, and of humps that lie under a wheel, or behind the first, as it begins.

    Axles stand so far behind the first [m]. A hump under a wheel acts as a sudden step.
    """
    end = float(scenario.speed.distance(scenario.time)[-1])
    for part in scenario.track.parts:
        begin = part.at if isinstance(part, Hump) else part.distance[0] if isinstance(part, MeasuredProfile) else 0.0
        if begin > end:
            what = "hump" if isinstance(part, Hump) else "profile"
            yield f"the {what} at {begin:.4g} m is not met: the run ends at {end:.4g} m; a longer `duration`, or a road that begins earlier"
    reach = scenario.track.footprint / 2
    for hump in scenario.humps:
        past = hump.at + hump.length
        if under := [name for name, behind in axles.items() if hump.at - reach < -behind < past + reach]:
            yield f"the hump at {hump.at:g} m lies under {under[0]} as the run begins, which it meets as a sudden step: put it ahead (`at`)"
        elif past <= 0 and axles:
            later = next((name for name, behind in axles.items() if -behind <= hump.at), None)
            met = "it is not met" if later is None else f"it is met from {later} on alone"
            yield f"the hump at {hump.at:g} m lies behind the first wheel as the run begins: {met}"


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
    for frequency in sorted({item.harmonic.frequency for item in (*scenario.forces, *scenario.ground) if item and item.harmonic}):
        if (steps := 1 / (frequency * scenario.dt)) < STEPS_OF_A_CYCLE:
            yield f"a cycle of {frequency:g} Hz takes {steps:.3g} steps of {scenario.dt * 1e3:g} ms; take at least {STEPS_OF_A_CYCLE}"
    for hump in scenario.humps:
        length = hump.length
        steps = length / (scenario.top_speed * scenario.dt)
        if steps < 20:
            yield f"the step of {scenario.dt * 1e3:g} ms crosses a hump of {length:g} m in {steps:.0f} steps; take at least 20"
    if not 0.5 / (scenario.dt * scenario.decimation) > fastest.undamped_hz:
        yield f"samples every {scenario.dt * scenario.decimation * 1e3:g} ms cannot show {fastest.name} at {fastest.undamped_hz:.1f} Hz"
