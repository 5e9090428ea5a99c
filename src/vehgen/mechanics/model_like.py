"""A model and its parameters as arguments: equations that were derived or a vehicle, and all parameters or some of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from vehgen.mechanics.derivation import derive
from vehgen.mechanics.equations_of_motion import EquationsOfMotion
from vehgen.mechanics.outputs import Output
from vehgen.vehicle import VehicleLike

ModelLike = EquationsOfMotion | VehicleLike
"""Equations of motion, or a vehicle to derive them of."""


def as_model(model: ModelLike, outputs: Iterable[Output] = ()) -> EquationsOfMotion:
    """Return the equations of motion that an argument means; those of a vehicle are derived, with `outputs`."""
    return model if isinstance(model, EquationsOfMotion) else derive(model, outputs)


def all_values(
    model: EquationsOfMotion, values: Mapping[str, float] | None = None, parameter_set: str | None = None
) -> Mapping[str, float]:
    """Return the values [SI] of all of a model's parameters: those given, then those of the set, then those of the file.

    Raises
    ------
    InputError
        For a parameter or a set that the vehicle does not have.
    """
    if values is not None and parameter_set is None and all(name in values for name in model.parameters):
        return values
    return model.values(parameter_set, values)
