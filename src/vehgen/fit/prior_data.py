"""Facts that are known from elsewhere and close what recordings leave open: weights of axles and of the whole, and single parameters.

A facts file:

    parameters:   {mS: {value: 22 t, uncertainty: 0.5 t}}
    kerb_mass:    {value: 62.4 t, uncertainty: 0.3 t}                    # bodies and axles, all together
    axle_weights: {axle1: {value: 71 kN, uncertainty: 0.5 kN}}           # on a scale, all coupled
    uncoupled:    {tractor: {axle1: {value: 50 kN, uncertainty: 0.5 kN}}}  # the body alone, its hinges opened

A fact enters the fit as a residual, (model - value)/uncertainty.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from vehgen.errors import InputError, shown
from vehgen.files.checks import check_known, plain_quantity
from vehgen.files.document import Located
from vehgen.files.entry import FileModel, read_entries
from vehgen.files.expressions import Expression
from vehgen.files.names import Name
from vehgen.files.quantities import Mass, PositiveForce
from vehgen.fit.problem import Problem
from vehgen.mechanics import EquationsOfMotion, derive
from vehgen.mechanics.evaluation import PopulationValues
from vehgen.mechanics.static_loads import axle_loads
from vehgen.vehicle import Vehicle
from vehgen.vehicle.parts import GROUND

Array = NDArray[np.float64]
_JACOBIAN_STEP = 1e-6
LEAST_UNCERTAINTY = 1e-6
"""No fact is known better than to this share of its value: beyond it rounding decides."""
MISSED_SIGMAS, RANGE_SIGMAS = 4.0, 3.0
"""A fact that a fit misses by so many standard deviations is told; one of a parameter must lie in its range, so many of them added."""
KERB_MASS = "kerb mass"
"""What the fact of the whole vehicle's mass is called."""
FactModel = Callable[[Mapping[str, Array]], Array]
"""Computes what a fact tells of vehicles `shape (n,)` from all their free parameters [SI], `shape (n,)` each."""


class Weight(FileModel):
    """What an axle presses on the road, and how well that is known."""

    value: PositiveForce
    uncertainty: PositiveForce


class WholeMass(FileModel):
    """The mass of the vehicle with all that it carries, and how well that is known."""

    value: Mass
    uncertainty: Mass


class Known(FileModel):
    """A parameter's value from elsewhere, and how well it is known."""

    value: Expression
    uncertainty: Expression


class PriorDataFile(FileModel):
    """A facts file as it is written."""

    parameters: dict[Name, Known] = Field(default_factory=dict)
    kerb_mass: WholeMass | None = None
    axle_weights: dict[Name, Weight] = Field(default_factory=dict)
    uncoupled: dict[Name, dict[Name, Weight]] = Field(default_factory=dict)


@dataclass(frozen=True)
class Fact:
    """One fact: how the model computes it from all free parameters, and what it is."""

    name: str
    model: FactModel
    value: float
    uncertainty: float


@dataclass(frozen=True)
class PriorData:
    """Facts about the vehicle of a problem, as residuals; `file` is where they were read."""

    problem: Problem
    facts: tuple[Fact, ...]
    file: Path | None = None

    def residuals(self, values: Array) -> Array:
        """Return (model - value)/uncertainty at searched values `shape (n_parameters,)` [SI]."""
        return np.asarray(self._residuals(values[None])[0])

    def jacobian(self, values: Array) -> Array:
        """Return the residuals' derivatives per SI unit, `shape (n_facts, n_parameters)`."""
        space = self.problem.space
        steps = _JACOBIAN_STEP * (space.upper - space.lower)
        above, below = np.split(self._residuals(np.concatenate([values + np.diag(steps), values - np.diag(steps)])), 2)
        return np.asarray((above - below).T / (2 * steps))

    def drawn(self, values: Array, random: np.random.Generator) -> PriorData:
        """Return the facts as they might have been told of a vehicle of these values `shape (n_parameters,)` [SI]."""
        strayed = self.residuals(values) + random.standard_normal(len(self.facts))
        facts = (replace(item, value=item.value + item.uncertainty * off) for item, off in zip(self.facts, strayed.tolist(), strict=True))
        return replace(self, facts=tuple(facts))

    def missed(self, values: Array) -> list[str]:
        """Return a sentence for each fact that searched values `shape (n_parameters,)` [SI] miss by far."""
        return [
            f"the fact {shown(fact.name)} is missed by {abs(off):.0f} standard deviations; check its value, its unit and its uncertainty"
            for fact, off in zip(self.facts, self.residuals(values).tolist(), strict=True)
            if abs(off) > MISSED_SIGMAS
        ]

    def _residuals(self, points: Array) -> Array:
        """Return the residuals at searched values `shape (n, n_parameters)`: `shape (n, n_facts)`."""
        fixed = {name: np.full(len(points), value) for name, value in self.problem.trials[0].values.items()}
        known = fixed | dict(zip(self.problem.space.names, points.T, strict=True))
        return np.column_stack([(fact.model(known) - fact.value) / fact.uncertainty for fact in self.facts])


def load_prior_data(path: str | Path, problem: Problem) -> PriorData:
    """Read a facts file about a problem's vehicle.

    Raises
    ------
    InputError
        With its place, for a name the vehicle lacks, a wrong unit, or an uncertainty that is not positive.
    """
    file, document = read_entries(PriorDataFile, path)
    vehicle = problem.trials[0].run.vehicle
    _check_uncertainties(file, document)
    facts = [_parameter_fact(vehicle, name, known, document) for name, known in file.parameters.items()]
    if (whole := file.kerb_mass) is not None:
        facts.append(Fact(KERB_MASS, kerb_mass(derive(vehicle)), whole.value, whole.uncertainty))
    groups: list[tuple[tuple[str, ...], Vehicle, str, dict[str, Weight]]] = [(("axle_weights",), vehicle, "", file.axle_weights)]
    for body, weights in file.uncoupled.items():
        check_known(body, vehicle.bodies, f"{vehicle.name} has no body", document, "uncoupled", body, key=True)
        groups.append((("uncoupled", body), uncouple(vehicle, body), f" of {body} alone", weights))
    for place_of, part, suffix, weights in groups:
        model = derive(part) if weights else None
        for axle, weight in weights.items():
            check_known(axle, part.axles, f"{part.name} has no axle", document, *place_of, axle, key=True)
            assert model is not None
            facts.append(Fact(f"load of {axle}{suffix}", axle_load(model, axle), weight.value, weight.uncertainty))
    if not facts:
        raise InputError("no fact was found: parameters, kerb_mass, axle_weights or uncoupled were expected", document.position)
    return PriorData(problem, tuple(facts), Path(path))


def _parameter_fact(vehicle: Vehicle, name: str, known: Known, document: Located) -> Fact:
    """Return the fact of a parameter; raises InputError at an unknown name, a wrong unit or an uncertainty that is not above 0."""
    check_known(name, vehicle.parameters, f"{vehicle.name} has no parameter", document, "parameters", name, key=True)
    dimension, path = vehicle.dimensions[name], ("parameters", name)
    value = plain_quantity(known.value, dimension, document, *path, "value", what=name)
    uncertainty = plain_quantity(known.uncertainty, dimension, document, *path, "uncertainty", what=f"the uncertainty of {name}")
    _check_known_to(value, uncertainty, document, *path)
    low, high = vehicle.ranges().get(name, (-np.inf, np.inf))
    if not low - RANGE_SIGMAS * uncertainty <= value <= high + RANGE_SIGMAS * uncertainty:
        raise InputError(f"{name} is searched from {low:g} to {high:g} (SI units), found {value:g}", document.find((*path, "value")))
    return Fact(name, parameter_value(vehicle, name), value, uncertainty)


def _check_uncertainties(file: PriorDataFile, document: Located) -> None:
    """Check how well weights are known."""
    given: dict[tuple[str, ...], Weight] = {("axle_weights", name): item for name, item in file.axle_weights.items()}
    given |= {("uncoupled", body, name): item for body, items in file.uncoupled.items() for name, item in items.items()}
    for path, item in given.items():
        _check_known_to(item.value, item.uncertainty, document, *path)
    if file.kerb_mass is not None:
        _check_known_to(file.kerb_mass.value, file.kerb_mass.uncertainty, document, "kerb_mass")


def _check_known_to(value: float, uncertainty: float, document: Located, *path: str) -> None:
    """Refuse an uncertainty that is not above 0, or that rounding exceeds."""
    place = document.find((*path, "uncertainty"))
    if not uncertainty > 0:
        raise InputError("an uncertainty above 0 was expected", place)
    if uncertainty < LEAST_UNCERTAINTY * abs(value):
        raise InputError(f"an uncertainty of at least {LEAST_UNCERTAINTY:g} of the value was expected, found {uncertainty:g}", place)


def uncouple(vehicle: Vehicle, body: str) -> Vehicle:
    """Return what stands when the hinges of a body are opened: it, all that links and carrying join to it, and their axles."""
    side, grown = {body}, True
    while grown:
        pairs = [set(link.points) - {GROUND} for link in vehicle.links.values()]
        pairs += [{name, item.carried_by.body} for name, item in vehicle.bodies.items() if item.carried_by is not None]
        wider = side.union(*(pair for pair in pairs if pair & side))
        grown, side = wider != side, wider
    return vehicle.model_copy(
        update={
            "name": f"{vehicle.name}, {body} alone",
            "bodies": {name: item for name, item in vehicle.bodies.items() if name in side},
            "hinges": {name: hinge for name, hinge in vehicle.hinges.items() if set(hinge.points) <= side},
            "axles": {name: axle for name, axle in vehicle.axles.items() if axle.body in side},
            "links": {name: link for name, link in vehicle.links.items() if set(link.points) - {GROUND} <= side},
        }
    )


def parameter_value(vehicle: Vehicle, name: str) -> FactModel:
    """Return how a parameter's value follows from the free ones [SI]."""
    return partial(_parameter_values, vehicle, name)


def _parameter_values(vehicle: Vehicle, name: str, values: Mapping[str, Array]) -> Array:
    rows = zip(*(values[key] for key in vehicle.free_parameters), strict=True)
    return np.array([vehicle.all_values(dict(zip(vehicle.free_parameters, map(float, row), strict=True)))[name] for row in rows])


def axle_load(model: EquationsOfMotion, axle: str) -> FactModel:
    """Return how an axle's static load [N] follows from the parameters."""
    return partial(_axle_load, model, axle)


def _axle_load(model: EquationsOfMotion, axle: str, values: Mapping[str, Array]) -> Array:
    return axle_loads(model, _population(model, values))[axle]


def kerb_mass(model: EquationsOfMotion) -> FactModel:
    """Return how the mass of all bodies and axles [kg] follows from the parameters, whatever they stand on."""
    return partial(_kerb_mass, model)


def _kerb_mass(model: EquationsOfMotion, values: Mapping[str, Array]) -> Array:
    columns = PopulationValues(model, _population(model, values))
    return np.asarray(sum(columns.value(term.inertia) for term in model.energies.weights))


def _population(model: EquationsOfMotion, values: Mapping[str, Array]) -> Array:
    """Return the model's parameters, `shape (n, n_parameters)`."""
    return np.column_stack([values[name] for name in model.parameters])
