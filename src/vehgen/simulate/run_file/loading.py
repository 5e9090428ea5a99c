"""From a run file to a checked run: the file, the vehicle it names and the channels it asks for."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass, replace
from numbers import Real
from pathlib import Path

from vehgen.errors import ArgumentError, InputError, did_you_mean, shown
from vehgen.files import note_read
from vehgen.files.document import Located
from vehgen.files.entry import read_entries
from vehgen.files.limits import SPEED_LIMIT
from vehgen.mechanics.outputs import Output, Place, PointOutput
from vehgen.mechanics.quantities import QUANTITIES
from vehgen.simulate.run_file.checks import check_run
from vehgen.simulate.run_file.entries import RunFile
from vehgen.vehicle.loading import VehicleLike, as_vehicle, load_vehicle
from vehgen.vehicle.model import Vehicle

DEFAULT_DECIMATION = 10


@dataclass(frozen=True)
class Run:
    """A run file with the vehicle it names and the folder its own files are relative to."""

    file: RunFile
    vehicle: Vehicle
    folder: Path
    document: Located

    @property
    def decimation(self) -> int:
        """Every how many steps a sample is kept."""
        return DEFAULT_DECIMATION if self.file.sample is None else round(self.file.sample / self.file.step)

    def changed(self, *, speed: float | None = None, parameter_set: str | None = None) -> Run:
        """Return this run at another constant speed [m/s], with another of the vehicle's sets, or both.

        Raises
        ------
        InputError
            For a speed that cannot be, a set that the vehicle lacks, and what does not go with the rest of the run.
        """
        update: dict[str, float | str] = {}
        if speed is not None:
            if isinstance(speed, bool) or not isinstance(speed, Real) or not 0 < speed < math.inf:
                raise ArgumentError(f"`speed`: a number above 0 in m/s was expected, found {shown(speed)}", "speed")
            if (reason := SPEED_LIMIT.refusal(float(speed))) is not None:
                raise ArgumentError(f"`speed`: {reason}", "speed")
            if not self.vehicle.axles:
                raise ArgumentError(f"`speed`: {self.vehicle.name} has no wheels, nothing depends on it", "speed")
            update["speed"] = float(speed)
        if parameter_set is not None:
            if not isinstance(parameter_set, str) or parameter_set not in self.vehicle.sets:
                known = did_you_mean(str(parameter_set), self.vehicle.sets)
                said = f"`parameter_set`: {self.vehicle.name} has no parameter set {shown(parameter_set)}; {known}"
                raise ArgumentError(said, "parameter_set")
            update["set"] = parameter_set
        changed = replace(self, file=self.file.model_copy(update=update))
        check_run(changed)
        return changed

    def values(self) -> dict[str, float]:
        """Return the vehicle's free parameters in this run [SI]: file, then set, then the run's own."""
        own = {name: expression.evaluate({}) for name, expression in self.file.parameters.items()}
        return self.vehicle.values(self.file.set, own)

    def outputs(self) -> tuple[Output, ...]:
        """Return every channel the run asks for; with no sensor and no output, the acceleration of every body's COG."""
        found: list[Output] = []
        for name, sensor in self.file.sensors.items():
            found += [sensor.output(name, quantity) for quantity in sensor.channels]
        found += [output.output(name) for name, output in self.file.outputs.items()]
        if not found:
            found = [PointOutput(f"{name}_acceleration", Place(name, name), "acceleration") for name in self.vehicle.bodies]
        return tuple(found)

    def readings(self) -> tuple[tuple[str, float], ...]:
        """Return for the channels of :meth:`outputs` the unit of each, and what one of it is worth in SI, its sign included."""
        sensors = self.file.sensors.values()
        found = [(sensor.unit(quantity), sensor.factor(quantity)) for sensor in sensors for quantity in sensor.channels]
        found += [(output.quantities[output.quantity], 1.0) for output in self.file.outputs.values()]
        return tuple(found) or ((QUANTITIES["acceleration"], 1.0),) * len(self.outputs())

    def forces(self) -> tuple[Place, ...]:
        """Return the places of the applied forces."""
        return tuple(entry.place(name) for name, entry in self.file.forces.items())

    def places(self) -> tuple[Place, ...]:
        """Return where its sensors are and its forces act; a place of several channels comes once for each."""
        return (*(output.place for output in self.outputs() if isinstance(output, PointOutput)), *self.forces())


def load_run(path: str | Path, vehicle: Vehicle | None = None) -> Run:
    """Read a run file and the vehicle it names, or take another vehicle in its place.

    Raises
    ------
    InputError
        With file, line and column, what is wrong and what would be right.
    """
    path = Path(path)
    file, document = read_entries(RunFile, path)
    try:
        vehicle = vehicle or load_vehicle(file.vehicle, path.parent)
    except InputError as error:
        if error.position is None:
            raise InputError(error.message, document.find(("vehicle",))) from error
        raise
    if file.recording is not None:
        note_read(path.parent / file.recording)  # no result may replace it, even where only its name is read
    run = Run(file, vehicle, path.parent, document)
    check_run(run)
    return run


RunLike = Run | str | os.PathLike[str]
"""A run or its file."""


def as_run(run: RunLike, vehicle: VehicleLike | None = None) -> Run:
    """Return the run that an argument means; `vehicle` takes the place of the one that it names.

    Raises
    ------
    InputError
        For a file that cannot be used, and for anything else than a run or a file.
    """
    own = None if vehicle is None else as_vehicle(vehicle)
    if isinstance(run, Run):
        return run if own is None else replace(run, vehicle=own)
    if isinstance(run, str | os.PathLike):
        return load_run(Path(run), own)
    raise ArgumentError(f"`run`: a Run or a run file was expected, found {type(run).__name__}", "run")
