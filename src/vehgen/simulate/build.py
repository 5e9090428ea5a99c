"""A built vehicle as a value: its file's data, and every number that its page shows."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any, ClassVar

from vehgen.codegen import Kernel
from vehgen.errors import InputError
from vehgen.files.document import MAX_DOCUMENT_BYTES
from vehgen.files.provenance import file_hashes, versions
from vehgen.files.result_fields import IN_MEMORY
from vehgen.files.results import Result, Table
from vehgen.mechanics import EquationsOfMotion, Place, PointOutput, StaticLoads
from vehgen.simulate.modes import Mode, Modes
from vehgen.vehicle import Vehicle, parse_vehicle
from vehgen.vehicle.loading import vehicle_files
from vehgen.vehicle.writing import plain_data

PAGE_PACKAGES = ("sympy", "numpy", "numba", "matplotlib")
"""Packages whose versions a page names."""


@dataclass(frozen=True)
class BuiltParameter:
    """A parameter's value, its unit and its range [SI]."""

    value: float
    unit: str
    range: tuple[float, float] | None = None


@dataclass(frozen=True, eq=False)
class Build(Result):
    """What building a vehicle tells.

    Attributes
    ----------
    vehicle
        The plain data of its file, with all that this extends: equations and drawings follow from them.
    values
        Its free parameters [SI], by name.
    parameters
        All parameters, those with `equals` too.
    modes, loads, weight
        Natural modes; static loads; the weight of all bodies and axles [N].
    warnings
        What deserves doubt.
    operation_counts
        Of the equations, by matrix.
    versions, inputs
        Of packages; names of its files with their SHA-256 (empty where a file was gone).
    plots
        Whether the page has drawings.
    model, kernel
        Its equations of motion and its compiled kernel, None in a build that was read from a file.
    """

    KIND: ClassVar[str] = "build"
    DRAWING: ClassVar[str] = "vehgen.report.pages.build_page:draw_built_vehicle"

    vehicle: dict[str, Any]
    values: dict[str, float]
    parameters: dict[str, BuiltParameter]
    modes: Modes
    loads: StaticLoads
    weight: float
    warnings: tuple[str, ...]
    operation_counts: dict[str, int]
    versions: dict[str, str]
    inputs: dict[str, str]
    plots: bool = True
    model: Annotated[EquationsOfMotion | None, IN_MEMORY] = field(default=None, repr=False)
    kernel: Annotated[Kernel | None, IN_MEMORY] = field(default=None, repr=False)

    def read_vehicle(self, source: str) -> Vehicle:
        """Return the vehicle, checked as a file is; `source` is what errors call it.

        Raises
        ------
        InputError
            For data that are no vehicle, or none.
        """
        text = json.dumps(self.vehicle)
        if not self.vehicle or len(text) > MAX_DOCUMENT_BYTES:
            raise InputError(f"{source} holds no vehicle's data of at most {MAX_DOCUMENT_BYTES} bytes")
        vehicle = parse_vehicle(text, source)
        if set(self.parameters) != set(vehicle.parameters) or not set(vehicle.free_parameters) <= set(self.values):
            raise InputError(f"{source} holds other parameters than its vehicle has: build it again")
        return vehicle

    def table(self) -> Table:
        """Return all parameters, a row each."""
        return ("parameter", "value", "unit"), [(name, item.value, item.unit) for name, item in self.parameters.items()]


def summarise_build(
    model: EquationsOfMotion, values: Mapping[str, float], modes: Sequence[Mode], loads: StaticLoads, warnings: Sequence[str], plots: bool
) -> Build:
    """Return what building a vehicle tells, at values of its free parameters."""
    vehicle = model.vehicle
    free = {name: float(values[name]) for name in vehicle.free_parameters}
    everything, ranges, dimensions = vehicle.all_values(free), vehicle.ranges(), vehicle.dimensions
    known = versions(PAGE_PACKAGES)
    files = vehicle_files(vehicle)
    hashes = file_hashes(files)
    return Build(
        vehicle=plain_data(vehicle),
        values={name: float(value) for name, value in values.items()},
        parameters={name: BuiltParameter(float(everything[name]), str(dimensions[name]), ranges.get(name)) for name in vehicle.parameters},
        modes=Modes(tuple(item.name for item in model.coordinates), tuple(modes)),
        loads=loads,
        weight=model.total_weight(values),
        warnings=tuple(warnings),
        operation_counts=model.operation_counts(),
        versions={**{name: text for name, text in known.items() if name != "python"}, "Python": known["python"]},
        inputs={name: hashes.get(name, "") for name in files},
        plots=plots,
        model=model,
    )


def body_channels(vehicle: Vehicle) -> list[PointOutput]:
    """Return the channels of a built kernel: acceleration and pitch rate of every body."""
    return [
        PointOutput(f"{name}_{quantity}", Place(name, name), quantity)
        for name in vehicle.bodies
        for quantity in ("acceleration", "pitch_rate")
    ]
