"""Static axle loads, hinge and link forces under gravity."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError
from vehgen.files.result_fields import Array1D, PairKeys
from vehgen.files.results import Result, Table
from vehgen.mechanics.derivation import ModelLike, all_values, as_model
from vehgen.mechanics.equations_of_motion import GRAVITY, EquationsOfMotion
from vehgen.mechanics.equilibrium import equilibria
from vehgen.mechanics.hinge_forces import far_side, lifted_travel
from vehgen.mechanics.numeric_model import NumericModel
from vehgen.mechanics.quantities import WITH_STATIC

Array = NDArray[np.float64]
HELD = 1e-12
"""A motion whose stiffness is below this share of the stiffest one's, coordinates being scaled alike, is held by no spring."""
UNWEIGHED = 1e-9
"""A weight has no part in a motion where that is below this share of the whole."""


@dataclass(frozen=True, eq=False)
class StaticLoads(Result):
    """Forces in static equilibrium [N], compression positive.

    `axles` is what each wheel presses on the road; `hinges` the vertical force that the first-named body exerts upwards on the
    second; `elements` the force in every suspension, tyre and link by (kind, name); `displacement shape (n_dof,)` [m, rad].
    """

    KIND: ClassVar[str] = "static loads"
    DRAWING: ClassVar[str] = "vehgen.report.plots.result_plots:plot_static_loads"

    axles: dict[str, float]
    hinges: dict[str, float]
    elements: PairKeys
    displacement: Array1D

    def within(self, quantity: str, owner: str) -> float:
        """Return what an output of a tyre's or hinge's whole load counts of the static one [N]; 0 for every other quantity."""
        if quantity not in WITH_STATIC:
            return 0.0
        return self.axles[owner] if quantity == "tyre_load" else self.hinges[owner]

    def table(self) -> Table:
        """Return all forces, a row each: of axles, hinges, then of springs and links."""
        rows = [("axle", *item) for item in self.axles.items()] + [("hinge", *item) for item in self.hinges.items()]
        return ("kind", "name", "force [N]"), [*rows, *((*key, force) for key, force in self.elements.items())]


def static_loads(model: ModelLike, values: Mapping[str, float] | None = None, *, parameter_set: str | None = None) -> StaticLoads:
    """Solve K q = weight, with the laws that count from the unloaded position; without gravity all loads are zero.

    Parameters
    ----------
    model
        Equations of motion, or a vehicle: itself, its file, or the name of a bundled model.
    values
        Parameters [SI] by name; what is not named keeps the value of the set, or the file's.
    parameter_set
        One of the vehicle's sets.

    Raises
    ------
    InputError
        When K is singular (part of the vehicle rests on nothing), or when those laws cannot carry the weight.
    """
    model = as_model(model)
    values = all_values(model, values, parameter_set)
    if model.is_preloaded:
        found = equilibria(model, np.array([[values[name] for name in model.parameters]], dtype=np.float64))
        if found.failures:
            raise InputError(f"{model.vehicle.name}: {found.failures[0]}", model.vehicle.position())
        displacement, forces = found.displacement[0], found.forces[0]
    elif not model.vehicle.gravity:
        displacement, forces = np.zeros(model.n_dof), np.zeros(len(model.elements))
    else:
        numeric = model.numeric(values)
        displacement = _solve(model, numeric)
        rows, stiffness = element_rows(model, values)
        forces = stiffness * (rows @ displacement)
    elements: dict[tuple[str, str], float] = {
        (element.kind, element.name): float(force) for element, force in zip(model.elements, forces, strict=True)
    }
    axles = {name: elements["tyre", name] for name in model.vehicle.axles}
    hinges = {name: _hinge_force(model, name, elements, values) for name in model.vehicle.hinges}
    return StaticLoads(axles, hinges, elements, displacement)


def axle_loads(model: EquationsOfMotion, parameters: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Return what each wheel of a population presses on the road [N], `shape (n_individuals,)` by axle; zero without gravity.

    Parameters
    ----------
    parameters
        `shape (n_individuals, n_parameters)` [SI].

    Raises
    ------
    InputError
        As :func:`static_loads`, of the first individual that has no equilibrium.
    """
    if not model.vehicle.gravity:
        return dict.fromkeys(model.vehicle.axles, np.zeros(len(parameters)))
    found = equilibria(model, parameters)
    places = {element.name: i for i, element in enumerate(model.elements) if element.kind == "tyre"}
    loads = {name: found.forces[:, places[name]] for name in model.vehicle.axles}
    for individual in found.failures:  # alone it is found, or told why not
        for name, load in static_loads(model, dict(zip(model.parameters, parameters[individual], strict=True))).axles.items():
            loads[name][individual] = load
    return loads


def element_rows(model: EquationsOfMotion, values: Mapping[str, float]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the travel rows `shape (n_elements, n_dof)` and stiffnesses `shape (n_elements,)` of all springs."""
    entries = {(i, j): value for i, element in enumerate(model.elements) for j, value in element.row.items()}
    rows = model.evaluate_matrix(entries, (len(model.elements), model.n_dof), values)
    return rows, np.array(model.evaluate_list((element.k for element in model.elements), values))


def static_deflections(model: EquationsOfMotion, values: Mapping[str, float], loads: StaticLoads) -> dict[tuple[str, str], float]:
    """Return how far every suspension, tyre and link is compressed at rest [m], by (kind, name).

    Parameters
    ----------
    values
        Parameters [SI] by name.
    loads
        The vehicle's static loads at these values.
    """
    rows, _ = element_rows(model, values)
    travels = rows @ loads.displacement
    found = {(element.kind, element.name): float(travel) for element, travel in zip(model.elements, travels, strict=True)}
    return {key: travel for key, travel in found.items() if key[0] in ("suspension", "tyre", "link")}


def is_held(model: EquationsOfMotion, values: Mapping[str, float]) -> bool:
    """Return whether springs hold the vehicle in every motion, at values of its parameters [SI]."""
    return not _Balance.of(model.numeric(values)).loose.size


@dataclass(frozen=True)
class _Balance:
    """K q = weight with coordinates in units `scale shape (n_dof,)` in which they are alike stiff; no spring holds the motions `loose`."""

    stiffness: Array
    scale: Array
    loose: Array

    @classmethod
    def of(cls, numeric: NumericModel) -> _Balance:
        stiff = np.diag(numeric.K)
        scale = np.sqrt(np.where(stiff > 0, stiff, stiff.max(initial=0.0) or 1.0))
        stiffness = numeric.K / np.outer(scale, scale)
        eigenvalues, vectors = np.linalg.eigh(stiffness)
        return cls(stiffness, scale, vectors[:, eigenvalues < HELD * max(eigenvalues[-1], 1.0)])


def _solve(model: EquationsOfMotion, numeric: NumericModel) -> Array:
    """Return the displacement at rest; of a motion that neither spring nor weight decides, that of the least travel."""
    balance = _Balance.of(numeric)
    weight = numeric.weight / balance.scale
    if not balance.loose.size:
        return np.asarray(np.linalg.solve(balance.stiffness, weight) / balance.scale, dtype=np.float64)
    falling = balance.loose @ (balance.loose.T @ weight)
    if np.linalg.norm(falling) <= UNWEIGHED * np.linalg.norm(weight):
        return np.asarray(np.linalg.lstsq(balance.stiffness, weight - falling, rcond=HELD)[0] / balance.scale, dtype=np.float64)
    motion = falling / balance.scale
    free = model.coordinates[int(np.argmax(motion * (numeric.M @ motion)))]
    raise InputError(
        f"singular stiffness: nothing holds {free.name} against gravity; give it a spring, a tyre or a link",
        model.vehicle.position("axles" if free.motion == "hop" else "bodies", free.owner, key=True),
    )


def _hinge_force(model: EquationsOfMotion, name: str, elements: Mapping[tuple[str, str], float], values: Mapping[str, float]) -> float:
    """Balance the bodies on the far side of a hinge: weight = suspensions, tyres and links on them + hinge force."""
    vehicle = model.vehicle
    side = far_side(vehicle, name)
    parameters = vehicle.all_values({key: values[key] for key in vehicle.free_parameters})
    load = sum(vehicle.bodies[body].mass.evaluate(parameters) for body in side) * GRAVITY * vehicle.gravity
    load += sum(elements[item.kind, item.name] * lifted_travel(vehicle, item, side) for item in model.elements)
    return float(load)
