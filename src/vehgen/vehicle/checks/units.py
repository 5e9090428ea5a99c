"""Units: plain quantities where they are asked for, and the dimension that every expression must have."""

from __future__ import annotations

from vehgen.errors import InputError, did_you_mean, shortened, shown
from vehgen.files.checks import check_dimension, dimension_of
from vehgen.files.units import Dimension
from vehgen.vehicle.model import Vehicle


def check_units(vehicle: Vehicle) -> None:
    """Check the units of parameters, of all quantities of the parts, of ranges and of sets; raises InputError at the first fault."""
    document = vehicle.document
    for name in vehicle.parameters:
        _check_plain(vehicle, name)
    dimensions: dict[str, Dimension] = {}
    for name in vehicle.parameters:
        _find_dimension(vehicle, name, dimensions)
    for path, expression, expected in vehicle.quantities():
        check_dimension(expression, expected, dimensions, document, *path, what=".".join(path))
    for name, parameter in vehicle.parameters.items():
        for index, bound in enumerate(parameter.range or ()):
            path = ("parameters", name, "range")
            check_dimension(bound, dimensions[name], {}, document, *path, index, what=f"{'.'.join(path)}.{index}")
    for set_name in vehicle.sets:
        _check_set(vehicle, set_name, dimensions)


def _check_plain(vehicle: Vehicle, name: str) -> None:
    """Refuse a parameter whose `value` or `range` uses other parameters."""
    parameter = vehicle.parameters[name]
    for entry, expression in (("value", parameter.value), *(("range", item) for item in parameter.range or ())):
        if expression is not None and expression.names:
            message = f"`{entry}` is a plain quantity; to follow other parameters write `equals: {shortened(str(expression))}`"
            raise InputError(message, vehicle.position("parameters", name, entry))


def _check_set(vehicle: Vehicle, set_name: str, dimensions: dict[str, Dimension]) -> None:
    for name, expression in vehicle.sets[set_name].items():
        if name not in vehicle.free_parameters:
            message = f"a set changes parameters that have a `value`; {shown(name)} is none; {did_you_mean(name, vehicle.free_parameters)}"
            if name in vehicle.parameters:
                message = f"a set changes parameters that have a `value`; {shown(name)} has `equals`, and follows others"
            raise InputError(message, vehicle.position("sets", set_name, name, key=True))
        if expression.names:
            raise InputError("a set lists plain quantities, not expressions of parameters", vehicle.position("sets", set_name, name))
        path = ("sets", set_name, name)
        check_dimension(expression, dimensions[name], {}, vehicle.document, *path, what=".".join(path))


def _find_dimension(vehicle: Vehicle, name: str, dimensions: dict[str, Dimension]) -> None:
    """Add a parameter's dimension, and those it follows from, to `dimensions`."""
    if name in dimensions:
        return
    parameter = vehicle.parameters[name]
    for symbol in parameter.definition.symbols:
        _find_dimension(vehicle, symbol.name, dimensions)
    entry = "equals" if parameter.value is None else "value"
    dimensions[name] = dimension_of(parameter.definition, dimensions, vehicle.document, "parameters", name, entry)
