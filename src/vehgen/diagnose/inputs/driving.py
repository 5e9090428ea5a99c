"""Measured forces and displacements that drive a rig, in another unit than stated or with their sign turned.

All channels then answer too much, too little, or the other way round, each alike. For every factor that units make, with both signs, the
vehicle file's prediction is laid over the recording; where one suits it clearly better than the numbers as they stand, a refit judges.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from vehgen.diagnose.inputs.comparison import compare
from vehgen.diagnose.inputs.fault import Hypothesis, MeasurementFault, always, place_words
from vehgen.diagnose.inputs.refits import BaseRefits
from vehgen.files.checks import unit_factor
from vehgen.files.units import POUND_KG, STANDARD_GRAVITY, UNITS
from vehgen.fit.nuisances import measured_displacements, measured_forces
from vehgen.fit.trial import Trial
from vehgen.simulate.run_scenario import ground_links

INPUT_UNITS = {
    "force": {"N": 1.0, "kN": 1e3, "MN": 1e6, "lbf": POUND_KG * STANDARD_GRAVITY, "kgf": STANDARD_GRAVITY},
    "displacement": {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "in": 0.0254},
}
"""What a measured input's units are worth in SI."""
CLEARLY_LESS = 0.5
"""A factor must leave at most this share of what the numbers as they stand leave of the channels' energy."""
INPUT_LEFT = 0.5
"""Largest share of the excess that another input may leave: the true effect may still be in it."""
REACH_S = 0.05
"""An input's clock may be off by this [s] where factors are compared: one recorder keeps what pushes and what answers."""


@dataclass(frozen=True)
class _Input:
    """A measured input of a run: a `force`, or the `displacement` of a ground link, by its name, and the unit it is taken to be in."""

    kind: str
    name: str
    unit: str


def input_hypotheses(case: BaseRefits) -> Iterator[Hypothesis]:
    """Yield, input by input, that it is in another unit or of turned sign in the runs whose recordings suit that better."""
    for item in dict.fromkeys(item for trial in case.trials for item in _inputs(trial)):
        trials, found = list(case.trials), dict[tuple[str, int], list[str]]()
        for t, trial in enumerate(case.trials):
            if item in _inputs(trial) and (true := _true(case, trial, item)) != (item.unit, 1):
                trials[t] = _scaled(trial, item, _factor(item, *true))
                found.setdefault(true, []).append(trial.name)
        if found:
            faults = (_fault(case, item, *true, tuple(runs)) for true, runs in found.items())
            yield Hypothesis(tuple(trials), always(*faults), INPUT_LEFT)


def _inputs(trial: Trial) -> tuple[_Input, ...]:
    file = trial.run.file
    forces = tuple(_Input("force", name, file.forces[name].unit or "N") for name in measured_forces(trial))
    links = measured_displacements(trial)
    return (*forces, *(_Input("displacement", name, file.displacements[name].unit or "m") for name in links))


def _factor(item: _Input, unit: str, sign: int) -> float:
    """Return by what an input's numbers must be multiplied where they are in a unit, times a sign."""
    units = INPUT_UNITS[item.kind]
    return sign * units[unit] / unit_factor(item.unit, next(iter(units)), item.kind, None)


def _scaled(trial: Trial, item: _Input, factor: float) -> Trial:
    """Return a trial with an input so many times as large."""
    scenario = trial.scenario
    if item.kind == "force":
        names = trial.simulator.model.forces
        forces = tuple(own.scaled(factor) if name == item.name else own for name, own in zip(names, scenario.forces, strict=True))
        return replace(trial, scenario=replace(scenario, forces=forces))
    links = ground_links(trial.simulator.model)
    ground = tuple(
        own.scaled(factor) if name == item.name and own is not None else own for name, own in zip(links, scenario.ground, strict=True)
    )
    return replace(trial, scenario=replace(scenario, ground=ground))


def _true(case: BaseRefits, trial: Trial, item: _Input) -> tuple[str, int]:
    """Return the unit and the sign with which the prediction suits the recording clearly better, or those that the file states."""
    left = {}
    for unit, sign in product(dict.fromkeys((item.unit, *INPUT_UNITS[item.kind])), (1, -1)):
        if unit in INPUT_UNITS[item.kind]:
            predicted = case.predict(_scaled(trial, item, _factor(item, unit, sign)))
            if np.isfinite(predicted).all():
                left[unit, sign] = compare(trial, predicted, case.band, REACH_S).unexplained
    stated = item.unit, 1
    best = min(left, key=lambda pair: left[pair], default=stated)
    return best if left and left[best] < CLEARLY_LESS * left.get(stated, np.inf) else stated


def _fault(case: BaseRefits, item: _Input, unit: str, sign: int, runs: tuple[str, ...]) -> MeasurementFault:
    """Return what is told of an input whose numbers are in a unit, times a sign."""
    subject, where, factor = f"the {item.kind} {item.name}", place_words(runs, case.runs), _factor(item, unit, sign)
    channels = {channel for trial in case.trials for channel in trial.channels}
    if unit == item.unit:
        doubt = f", or {next(iter(channels))} has its sign turned" if len(channels) == 1 else ""
        message = f"{subject} acts the other way round {where} than its column says{doubt}"
        return MeasurementFault("turned", runs, (item.name,), message, "turn the sign of its column: upwards is positive", factor)
    many = f"{1 / abs(factor):.4g} times too large" if abs(factor) < 1 else f"{abs(factor):.4g} times too small"
    doubt = f", or {next(iter(channels))} is as much {'too small' if abs(factor) < 1 else 'too large'}" if len(channels) == 1 else ""
    turned = ", with its sign turned" if sign < 0 else ""
    message = f"{subject} is {many} {where}: its numbers are in {unit}, and taken as {item.unit}{turned}{doubt}"
    cure = f"set `unit: {unit}` for it in the run file" if unit in UNITS and sign > 0 else f"multiply its column by {factor:.6g}"
    return MeasurementFault("unit", runs, (item.name,), message, cure, 1 / factor)
