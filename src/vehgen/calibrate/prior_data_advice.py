"""Which fact known from elsewhere would help a calibration most: a weight, a length, asked for where it narrows the intervals.

A fact is a row of the information matrix. Each that could be measured is added to what recordings and facts tell so far, and the widths
of all parameters' intervals compare before and after; where nothing tells a parameter its search range does.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from vehgen.calibrate.intervals import Uncertainty
from vehgen.calibrate.result import FactAdvice
from vehgen.errors import InputError
from vehgen.files.units import LENGTH
from vehgen.fit.prior_data import KERB_MASS, Fact, PriorData, axle_load, kerb_mass, parameter_value, uncouple
from vehgen.mechanics import EquationsOfMotion, derive, static_loads
from vehgen.vehicle import Vehicle

Array = NDArray[np.float64]
WEIGHING_ERROR = 0.01
"""Relative standard deviation of a weight as a weighbridge tells it."""
TAPE_ERROR_M = 0.01
"""Standard deviation of a length taken with a tape [m]."""
DRAWING_ERROR_M = 0.05
"""Standard deviation of a length that drawings or data sheets tell, such as the height of a COG [m]."""
RANGE_SIGMA = 12**-0.5
"""Standard deviation, in the unit cube, of a parameter of which only its range is known."""
MUCH_NARROWER = 0.5
"""An interval that keeps less than this share of its width is helped."""


def advise_prior_data(known: Uncertainty, facts: PriorData | None = None) -> tuple[FactAdvice, ...]:
    """Rank facts that could be measured by how much each narrows the parameters' intervals.

    Parameters
    ----------
    known
        How sure the fit is.
    facts
        What is known already, and not asked for again.

    Returns
    -------
    Best first.
    """
    problem = known.fit.misfit.problem
    taken = set() if facts is None else {fact.name for fact in facts.facts}
    candidates = [(fact, entry) for fact, entry in _candidates(known) if fact.name not in taken]
    if not candidates:
        return ()
    rows = PriorData(problem, tuple(fact for fact, _ in candidates)).jacobian(known.values) * problem.space.slopes(known.values)
    covariance = np.linalg.inv(known.information + np.eye(problem.space.size) / RANGE_SIGMA**2)
    alone = [_with_fact(covariance, row) for row in rows]
    shares = np.array([_widths_left(covariance, after) for after in alone])
    best = int(np.argmin(np.log(shares).sum(axis=1)))
    beside = np.array([_widths_left(covariance, _with_fact(alone[best], row)) for row in rows])
    found = [
        FactAdvice(
            fact=fact.name,
            entry=entry,
            expected=fact.value,
            uncertainty=fact.uncertainty,
            unit=_unit(known, fact),
            width_left=_mean(share),
            width_left_beside_best=_mean(both),
            narrows=tuple(problem.space.names[i] for i in np.argsort(share) if share[i] < MUCH_NARROWER),
        )
        for (fact, entry), share, both in zip(candidates, shares, beside, strict=True)
    ]
    return tuple(sorted(found, key=lambda item: item.width_left))


def _mean(shares: Array) -> float:
    return float(np.exp(np.mean(np.log(shares))))


def _with_fact(covariance: Array, row: Array) -> Array:
    """Return a covariance with one more observation, `row` its derivatives over its standard deviation."""
    moved = covariance @ row
    return np.asarray(covariance - np.outer(moved, moved) / (1.0 + row @ moved))


def _widths_left(before: Array, after: Array) -> Array:
    """Return the share of every interval's width that is left, `shape (n_parameters,)`."""
    return np.sqrt(np.clip(np.diag(after) / np.diag(before), 1e-12, 1.0))


def _unit(known: Uncertainty, fact: Fact) -> str:
    if fact.name == KERB_MASS:
        return "kg"
    dimensions = known.fit.misfit.problem.trials[0].run.vehicle.dimensions
    return str(dimensions[fact.name]) if fact.name in dimensions else "N"


def _candidates(known: Uncertainty) -> Iterator[tuple[Fact, str]]:
    """Yield facts that could be measured, with the place of each in a file of facts, at the values that the fit expects."""
    problem = known.fit.misfit.problem
    trial = problem.trials[0]
    vehicle, values = trial.run.vehicle, problem.values_of(known.values, trial)
    for name in problem.space.names:
        if vehicle.dimensions[name] == LENGTH:
            error = TAPE_ERROR_M if _moves_an_axle(trial.simulator.model, values, name) else DRAWING_ERROR_M
            yield Fact(name, parameter_value(vehicle, name), values[name], error), f"parameters: {{{name}: ...}}"
    for part, suffix, entry in _weighable_parts(vehicle):
        model = derive(part)
        try:
            loads = static_loads(model, {name: values[name] for name in model.parameters}).axles
        except InputError:
            continue  # it does not stand on its own wheels: no scale tells what they carry
        if min(loads.values()) <= 0:
            continue
        if part is vehicle:
            total = model.total_mass({name: values[name] for name in model.parameters})
            yield Fact(KERB_MASS, kerb_mass(model), total, WEIGHING_ERROR * total), "kerb_mass: ..."
        for axle, load in loads.items():
            yield Fact(f"load of {axle}{suffix}", axle_load(model, axle), load, WEIGHING_ERROR * load), entry.format(axle)


def _moves_an_axle(model: EquationsOfMotion, values: Mapping[str, float], name: str) -> bool:
    """Return whether a length sets how far axles stand apart, which a tape tells; others reach to a COG or stand in drawings."""
    offsets = [model.wheel_offsets({**values, name: values[name] + moved}) for moved in (0.0, TAPE_ERROR_M)]
    return bool(np.abs(offsets[1] - offsets[0]).max(initial=0.0) > TAPE_ERROR_M / 2)


def _weighable_parts(vehicle: Vehicle) -> Iterator[tuple[Vehicle, str, str]]:
    """Yield the vehicle, then what each of its bodies leaves standing with the hinges open, with the places of their axles' loads."""
    if vehicle.axles:
        yield vehicle, "", "axle_weights: {{{}: ...}}"
    parts: set[frozenset[str]] = {frozenset(vehicle.bodies)}
    for body in vehicle.bodies:
        part = uncouple(vehicle, body)
        if part.axles and frozenset(part.bodies) not in parts:
            parts.add(frozenset(part.bodies))
            yield part, f" of {body} alone", f"uncoupled: {{{{{body}: {{{{{{}}: ...}}}}}}}}"
