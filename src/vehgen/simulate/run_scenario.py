"""A run file's scenario: its road, speed, forces and moving ground, read from the files that it names."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError
from vehgen.files.tables import read_columns
from vehgen.mechanics.equations_of_motion import EquationsOfMotion
from vehgen.road import (
    ConstantSpeed,
    Hump,
    Iso8608Road,
    MeasuredProfile,
    Profile,
    SpeedHistory,
    SpeedLaw,
    Track,
    check_length,
    pass_time,
)
from vehgen.simulate.budgets import check_run, placed
from vehgen.simulate.initial_state import initial_state
from vehgen.simulate.measured_tables import Finder, hump_table, input_table, profile_table, speed_table
from vehgen.simulate.run_file import Run
from vehgen.simulate.run_file.acquisition import channel_chains
from vehgen.simulate.run_file.checks import TIME_COLUMN
from vehgen.simulate.run_file.entries import DisplacementEntry, ForceEntry, HumpEntry
from vehgen.simulate.run_file.loading import RunLike, as_run
from vehgen.simulate.scenario import Scenario
from vehgen.simulate.signals import Signal

Array = NDArray[np.float64]
AFTER_LAST_HUMP = 3.0
"""Seconds simulated after the last wheel left the last hump, where a run does not say how long it is."""


def make_scenario(run: RunLike, model: EquationsOfMotion, values: Mapping[str, float], begin: float = 0.0) -> Scenario:
    """Build the scenario of a run or its file.

    What lies behind the first wheel at the time `begin` [s] is no part of a measured profile.

    Raises
    ------
    InputError
        For files that cannot be read, dimensions that do not fit, a run with no end, and one that would cost too much.
    """
    run = _as_recorded(as_run(run))
    file = run.file
    offsets = model.wheel_offsets(values)
    speed = _speed(run)
    if file.duration is not None:
        _check_cost(run, file.duration, speed, model)
    parts = tuple(_road_part(number, run, speed, offsets, begin) for number in range(len(file.road)))
    track = Track(parts, footprint=file.footprint or 0.0)
    if file.duration is not None:
        duration = file.duration
    elif any(isinstance(part, Hump) for part in parts):
        with placed(run, "road", key=True):
            duration = pass_time(track, speed, offsets) + AFTER_LAST_HUMP
        _check_cost(run, duration, speed, model)
    else:
        raise InputError("a run without a hump or recording needs `duration`, e.g. 10 s", run.document.position)
    ground = tuple(_ground(run, link) for link in ground_links(model))
    forces = tuple(
        Signal(harmonic=entry.harmonic) if entry.harmonic else _measured(run, entry, "forces", name) for name, entry in file.forces.items()
    )
    _check_overlap(run, duration, speed, dict(zip(ground_links(model), ground, strict=True)), dict(zip(file.forces, forces, strict=True)))
    chains = channel_chains(run, 1 / (file.step * run.decimation))
    return Scenario(track, speed, duration, file.step, run.decimation, ground, forces, chains=chains, initial=initial_state(run, model))


def ground_links(model: EquationsOfMotion) -> tuple[str, ...]:
    """Return the links to the ground, in the order of a model's inputs."""
    return tuple(name.partition(".")[2] for name in model.inputs[len(model.vehicle.axles) :])


def _as_recorded(run: Run) -> Run:
    """Return a run that says how long it is, where it has no hump: as long as its recording."""
    file = run.file
    if file.duration is not None or file.recording is None or any(entry.hump for entry in file.road):
        return run
    with placed(run, "recording"):
        found = read_columns(Path(run.folder) / file.recording, (TIME_COLUMN,)).in_si(0, "s", "time")
    return replace(run, file=file.model_copy(update={"duration": float(found.values[0].max())}))


def _check_cost(run: Run, duration: float, speed: SpeedLaw, model: EquationsOfMotion) -> None:
    check_run(run, duration, float(speed.distance(np.array([duration]))[0]), len(model.inputs))


def _speed(run: Run) -> SpeedLaw:
    spec = run.file.speed
    if isinstance(spec, float):
        return ConstantSpeed(spec)
    place = ("speed",)
    with placed(run, *place, "file"):
        found = speed_table(Path(run.folder) / spec.file, spec, _finder(run, *place))
    return SpeedHistory(*found.values)


def _road_part(number: int, run: Run, speed: SpeedLaw, offsets: Array, begin: float) -> Profile:
    entry = run.file.road[number]
    if entry.hump is not None:
        return _hump(entry.hump, run, ("road", number, "hump"))
    if entry.profile is not None:
        place = ("road", number, "profile")
        with placed(run, *place, "file"):
            found = profile_table(Path(run.folder) / entry.profile.file, entry.profile, _finder(run, *place))
            stands, profile = float(speed.distance(np.array([begin]))[0]), MeasuredProfile(*found.values)
            if profile.end <= stands:
                raise InputError(f"the profile ends at {profile.end:.6g} m, behind the first wheel, which begins at {stands:.6g} m")
        return profile.met_from(stands)
    assert entry.iso8608 is not None
    with placed(run, "road", number, "iso8608", key=True):
        return Iso8608Road(entry.iso8608.class_, entry.iso8608.seed, _random_length(run, speed, offsets))


def _random_length(run: Run, speed: SpeedLaw, offsets: Array) -> float:
    """Return how long random roads must be [m]; raises InputError where all of them together would be too long."""
    if run.file.duration is None:
        length = 100.0 + float(offsets.max(initial=0.0))
        length = max([length, *(item.hump.at + 100.0 for item in run.file.road if item.hump is not None)])
    else:
        length = float(speed.distance(np.array([run.file.duration]))[0]) + 10.0
    check_length(length * sum(entry.iso8608 is not None for entry in run.file.road))
    return length


def _hump(entry: HumpEntry, run: Run, place: tuple[str | int, ...]) -> Hump:
    if entry.shape == "points":
        with placed(run, *place, "file"):
            found = hump_table(Path(run.folder) / (entry.file or ""), entry, _finder(run, *place))
        return Hump.from_points(entry.at, *found.values)
    extra = {"ramp": entry.ramp} if entry.ramp is not None else {}
    if entry.radius is not None:
        extra["radius"] = entry.radius
    assert entry.length is not None
    assert entry.height is not None
    with placed(run, *place, "radius" if entry.shape == "rectangle" else "length"):
        return Hump.from_shape(entry.shape, entry.at, entry.length, entry.height, **extra)


def _ground(run: Run, link: str) -> Signal | None:
    entry = run.file.displacements.get(link)
    if entry is None:
        return None
    if entry.harmonic is not None:
        return Signal(harmonic=entry.harmonic)
    return _measured(run, entry, "displacements", link)


def _measured(run: Run, entry: ForceEntry | DisplacementEntry, *place: str) -> Signal:
    with placed(run, *place, "file"):
        found = input_table(Path(run.folder) / (entry.file or ""), entry, _finder(run, *place))
    return Signal(time=found.values[0], values=found.values[1])


def _check_overlap(run: Run, duration: float, speed: SpeedLaw, ground: Mapping[str, Signal | None], forces: Mapping[str, Signal]) -> None:
    """Refuse tables of speeds, displacements and forces whose times all lie outside of the run."""
    tables: dict[tuple[str, ...], Array | None] = {("speed",): speed.time if isinstance(speed, SpeedHistory) else None}
    for kind, signals in (("displacements", ground), ("forces", forces)):
        tables |= {(kind, name): None if item is None else item.time for name, item in signals.items()}
    for place, times in tables.items():
        if times is not None and (times[0] > duration or times[-1] < 0):
            raise InputError(
                f"the times of this table, {times[0]:.6g} to {times[-1]:.6g} s, lie outside of the run, 0 to {duration:.4g} s: "
                "let them begin with the run",
                run.document.find((*place, "file")),
            )


def _finder(run: Run, *place: str | int) -> Finder:
    return lambda key: run.document.find((*place, key))
