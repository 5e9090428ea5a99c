"""A drive over a rough road, from phone exports or from a run with its recording, with the model of the vehicle where one is given."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import ArgumentError, InputError
from vehgen.fit.recording import read_recording
from vehgen.mechanics import EquationsOfMotion, derive
from vehgen.phones import PhoneSensor
from vehgen.phones.csv_table import ColumnMaps
from vehgen.phones.importing import with_forward
from vehgen.phones.rough_road import read_drive
from vehgen.simulate import Run, as_run, make_scenario
from vehgen.vehicle import VehicleLike, as_vehicle

Array = NDArray[np.float64]
Recordings = Run | str | os.PathLike[str] | Sequence[str | os.PathLike[str]]
INSTEAD = (
    "record the drive with a second phone at another place, or one pass over a known hump for `vehgen import`; or say which axis of this "
    "phone pointed forward (`forward`), so that its pitch rate counts as a second channel"
)


@dataclass(frozen=True, eq=False)
class RoughDrive:
    """Channels on one clock, the reference first.

    `time shape (n,)` [s], `values_by_channel shape (n, n_channels)`; by channel its name, sensor, quantity and unit; `speed` moments [s]
    and speeds [m/s]; `holes` begin and end [s] of what was not recorded; `model` of the vehicle with these channels, and its parameters'
    `values` [SI].
    """

    title: str
    time: Array
    values_by_channel: Array
    names: tuple[str, ...]
    sensors: tuple[str, ...]
    quantities: tuple[str, ...]
    units: tuple[str, ...]
    speed: tuple[Array, Array] | None
    holes: tuple[tuple[float, float], ...]
    model: EquationsOfMotion | None
    values: Mapping[str, float] | None
    vehicle_title: str | None
    notes: tuple[str, ...]
    warnings: tuple[str, ...]

    def with_reference(self, number: int) -> RoughDrive:
        """Return the drive with another channel as its first."""
        if number == 0:
            return self
        order = [number, *(i for i in range(len(self.names)) if i != number)]
        moved = replace(
            self,
            values_by_channel=self.values_by_channel[:, order],
            names=tuple(self.names[i] for i in order),
            sensors=tuple(self.sensors[i] for i in order),
            quantities=tuple(self.quantities[i] for i in order),
            units=tuple(self.units[i] for i in order),
        )
        if self.model is None:
            return moved
        return replace(moved, model=replace(self.model, channels=tuple(self.model.channels[i] for i in order)))


def as_exports(recordings: Recordings) -> list[str | os.PathLike[str]] | None:
    """Return recordings as exports of phones, None where they are a run or a run file.

    Raises
    ------
    InputError
        For none at all.
    """
    if isinstance(recordings, Run):
        return None
    paths = [recordings] if isinstance(recordings, str | os.PathLike) else list(recordings)
    if not paths:
        raise ArgumentError("`recordings`: exports of phones, or a run file, were expected; none was given", "recordings")
    return None if len(paths) == 1 and Path(paths[0]).suffix.lower() in (".yaml", ".yml") else paths


def drive_of_run(run: Recordings, vehicle: VehicleLike | None, parameter_set: str | None, sensors: Sequence[PhoneSensor]) -> RoughDrive:
    """Return what a run's sensors recorded, with the model of its vehicle, or of another in its place.

    Raises
    ------
    InputError
        For a run that cannot be used, without a recording, or of one channel alone; and for sensors and a set, which the run file names.
    """
    if sensors:
        raise ArgumentError("`sensors`: a run file says itself where its sensors are; leave them out", "sensors")
    if parameter_set is not None:
        raise ArgumentError("`parameter_set`: a run file names its own `set`; leave it out", "parameter_set")
    own = as_run(run if isinstance(run, Run | str | os.PathLike) else run[0], vehicle)
    recording = read_recording(own)
    if len(recording.channels) < 2:
        raise InputError(_one_channel(recording.channels[0].name))
    model = derive(own.vehicle, tuple(channel.output for channel in recording.channels), own.forces())
    values = model.values(overrides=own.values())
    law = make_scenario(own, model, values).speed
    time = recording.time - recording.time[0]
    travelled = law.distance(recording.time)
    moments, speeds = (time[1:] + time[:-1]) / 2, np.diff(travelled) / np.diff(recording.time)
    return RoughDrive(
        title=f"{own.vehicle.title or own.vehicle.name}, {own.file.recording}",
        time=time,
        values_by_channel=recording.values,
        names=tuple(channel.name for channel in recording.channels),
        sensors=tuple(channel.sensor for channel in recording.channels),
        quantities=tuple(channel.quantity for channel in recording.channels),
        units=tuple(channel.unit for channel in model.channels),
        speed=(moments, speeds),
        holes=(),
        model=model,
        values=values,
        vehicle_title=own.vehicle.title or own.vehicle.name,
        notes=(),
        warnings=(),
    )


def drive_of_phones(
    exports: Sequence[str | os.PathLike[str]],
    vehicle: VehicleLike | None,
    sensors: Sequence[PhoneSensor],
    parameter_set: str | None,
    forward: str | None,
    top: float,
    segment: float,
    columns: ColumnMaps,
) -> RoughDrive:
    """Return what phones recorded on one drive; raises InputError for exports that cannot be used, or give one channel alone."""
    own = None if vehicle is None else as_vehicle(vehicle)
    places = list(sensors)
    if own is None:
        if parameter_set is not None:
            raise ArgumentError("`parameter_set` needs a `vehicle`", "parameter_set", "vehicle")
        places = places or [PhoneSensor(f"S{i}", "") for i in range(1, len(exports) + 1)]
    elif not places:
        raise ArgumentError("with a `vehicle`, `sensors` must say where each phone lay", "vehicle", "sensors")
    else:
        for sensor in places:
            sensor.check(own)
    found = read_drive(exports, with_forward(places, forward), top, segment, columns)
    if len(found.channels) < 2:
        raise ArgumentError(_one_channel(found.channels[0].name), "forward")
    pitching = {channel.sensor for channel in found.channels if channel.quantity == "pitch_rate"}
    model = None if own is None else derive(own, [output for place in places for output in place.outputs(place.name in pitching)])
    return RoughDrive(
        title=(own.title or own.name if own else ", ".join(Path(path).name for path in exports)),
        time=found.time,
        values_by_channel=found.values,
        names=tuple(channel.name for channel in found.channels),
        sensors=tuple(channel.sensor for channel in found.channels),
        quantities=tuple(channel.quantity for channel in found.channels),
        units=tuple(channel.unit for channel in found.channels),
        speed=found.gps,
        holes=found.holes,
        model=model,
        values=None if model is None or own is None else model.values(parameter_set),
        vehicle_title=None if own is None else own.title or own.name,
        notes=found.notes,
        warnings=found.warnings,
    )


def _one_channel(name: str) -> str:
    return f"there is one channel only ({name}), and a road that nobody measured: that tells nothing of transmissibility; {INSTEAD}"
