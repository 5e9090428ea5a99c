"""From a run file to what drives the vehicle: road under every wheel, forces, moving ground."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vehgen.codegen import Excitation
from vehgen.errors import InputError
from vehgen.files.checks import unit_factor
from vehgen.files.limits import HUMP_HEIGHT, HUMP_LENGTH, SPEED_LIMIT
from vehgen.files.tables import TableColumns, read_columns
from vehgen.measure.acquisition import POINT_SAMPLES, AcquisitionChain
from vehgen.mechanics.equations_of_motion import EquationsOfMotion
from vehgen.road import (
    AdjustedSpeed,
    ConstantSpeed,
    Hump,
    Iso8608Road,
    MeasuredProfile,
    Profile,
    SpeedHistory,
    SpeedLaw,
    Track,
    Wander,
    check_length,
    pass_time,
    wheel_inputs,
)
from vehgen.simulate.budgets import check_run, placed
from vehgen.simulate.excitation_cache import ExcitationCache
from vehgen.simulate.initial_state import initial_state
from vehgen.simulate.run_file import Run
from vehgen.simulate.run_file.acquisition import channel_chains
from vehgen.simulate.run_file.entries import DisplacementEntry, ForceEntry, HumpEntry
from vehgen.simulate.signals import Signal

Array = NDArray[np.float64]
AFTER_LAST_HUMP = 3.0
"""Seconds simulated after the last wheel left the last hump, where a run does not say how long it is."""
NULLS_TO = 30.0
"""Above it [Hz] no axle hops."""
LOBES_SOUGHT = 2000.0
"""So many lobes of all humps' spectra together are searched for nulls: a second of work."""
_EXCITATIONS = ExcitationCache()


@dataclass(frozen=True)
class Scenario:
    """What happens to a vehicle from `start` [s]: a track at a speed, signals at ground links and forces, step and samples.

    `ground` and `forces` are in the order of the model's inputs and forces; `chains` says by a channel's name what acquires it: channels
    without one are sampled at their instants. The first `skipped` samples are simulated but not kept. `initial` are displacements, then
    velocities, at the start, `shape (2 n_dof,)` (default: at rest).
    """

    track: Track
    speed: SpeedLaw
    duration: float
    dt: float
    decimation: int
    ground: tuple[Signal | None, ...] = ()
    forces: tuple[Signal, ...] = ()
    start: float = 0.0
    chains: Mapping[str, AcquisitionChain] = field(default_factory=dict)
    skipped: int = 0
    initial: Array | None = None
    time: Array = field(init=False)

    def __post_init__(self) -> None:
        steps = round(self.duration / (self.dt * self.decimation)) * self.decimation
        object.__setattr__(self, "time", self.start + np.arange(steps + 1) * self.dt)

    def chain(self, channel: str) -> AcquisitionChain:
        """Return what acquires a channel."""
        return self.chains.get(channel, POINT_SAMPLES)

    @property
    def humps(self) -> tuple[Hump, ...]:
        """The humps of the track, in its order."""
        return tuple(part for part in self.track.parts if isinstance(part, Hump))

    @property
    def over_humps_alone(self) -> bool:
        """Whether the track has humps, and no road of known profile."""
        return 0 < len(self.humps) == len(self.track.parts)

    @cached_property
    def nulls(self) -> tuple[float, ...]:
        """The frequencies [Hz], rounded to mHz, up to NULLS_TO at which a hump of the track excites nothing; found when first asked for."""
        top = float(np.max(np.diff(self.speed.distance(np.linspace(0.0, self.duration, 200)))) / (self.duration / 199))
        share = LOBES_SOUGHT / max(len(self.humps), 1)
        found = (hump.spectral_nulls(top, min(NULLS_TO, share * top / hump.length)) for hump in self.humps)
        return tuple(sorted({round(float(null), 3) for nulls in found for null in nulls}))

    @property
    def top_speed(self) -> float:
        """The highest speed of the run [m/s]."""
        return float(np.max(np.diff(self.speed.distance(self.time)) / self.dt)) if len(self.time) > 1 else 0.0

    @cached_property
    def first_arrival(self) -> float:
        """When the first axle meets the first hump, or a profile that begins ahead [s]; the start of the run where there is neither."""
        along = self.speed.distance(self.time)
        ahead = [part.distance[0] for part in self.track.parts if isinstance(part, MeasuredProfile)]
        starts = [place for place in (*(hump.at for hump in self.humps), *ahead) if place > along[0]]
        return float(np.interp(min(starts), along, self.time)) if starts else self.start

    def adjusted(
        self,
        delay: float = 0.0,
        speed: float = 1.0,
        height: float = 1.0,
        *,
        anchor: float = 0.0,
        wander: Wander | None = None,
        deformation: tuple[float, float, float, float] | None = None,
        forces: Sequence[tuple[float, float]] = (),
        displacements: Sequence[float] = (),
    ) -> Scenario:
        """Return the same run, `delay` [s] later, at `speed` times the speed, on a road `height` times as high.

        Speed and `wander` are seen from where the vehicle is at the time `anchor` [s]; `deformation` is that of the humps
        (length, form, skew, rounding; default: as it is). `forces` are gains and offsets [N] of the forces, `displacements` gains of
        those of the ground; on a rig without a road both come `delay` later.
        """
        late = delay if not self.track.parts else 0.0
        same = (delay, speed, wander) == (0.0, 1.0, None)
        law = self.speed if same else AdjustedSpeed(self.speed, delay, speed, anchor, wander)
        track = replace(self.track, scale=self.track.scale * height, deformation=deformation or self.track.deformation)
        found = replace(self, speed=law, track=track)
        if not (forces or displacements or late):
            return found
        errors = forces or [(1.0, 0.0)] * len(self.forces)
        pushed = tuple(item.with_errors(gain, offset, late) for item, (gain, offset) in zip(self.forces, errors, strict=True))
        gains = displacements or [1.0] * len(self.ground)
        moved = tuple(None if item is None else item.with_errors(gain, late=late) for item, gain in zip(self.ground, gains, strict=True))
        return replace(found, forces=pushed, ground=moved)

    def excitation(self, offsets: Array) -> Excitation:
        """Return the inputs of a vehicle whose axles run `offsets shape (n_axles,)` [m] behind the first to arrive.

        Neither they nor the arrays of the scenario are to be written to: the last excitations are remembered.
        """
        law: SpeedLaw = self.speed
        errors: tuple[object, ...] = ()
        while isinstance(law, AdjustedSpeed):
            errors = (*errors, law.delay, law.scale, law.anchor, law.wander)
            law = law.law
        track = (id(self.track.parts), self.track.footprint, self.track.scale, self.track.deformation)
        road = (*track, id(law), errors, np.asarray(offsets, dtype=float).tobytes())
        key = (*road, self.start, self.dt, len(self.time), id(self.ground), id(self.forces))
        return _EXCITATIONS.find(key, (self.track, self.speed, self.ground, self.forces), lambda: self._excitation(offsets))

    def _excitation(self, offsets: Array) -> Excitation:
        wheels = wheel_inputs(self.track, self.speed, offsets, self.time)
        half = self.dt / 2
        ground, ground_rates = [], []
        for signal in self.ground:
            ground.append(np.zeros_like(self.time) if signal is None else signal.at(self.time))
            ground_rates.append(
                np.zeros_like(self.time) if signal is None else (signal.at(self.time + half) - signal.at(self.time - half)) / self.dt
            )
        forces = np.column_stack([signal.at(self.time) for signal in self.forces]) if self.forces else np.zeros((len(self.time), 0))
        inputs = np.column_stack([wheels.heights, *ground])
        rates = np.column_stack([wheels.rates, *ground_rates])
        return Excitation(self.dt, inputs, rates, forces)


def make_scenario(run: Run, model: EquationsOfMotion, values: dict[str, float]) -> Scenario:
    """Build the scenario of a run file.

    Raises
    ------
    InputError
        For files that cannot be read, dimensions that do not fit, a run with no end, and one that would cost too much.
    """
    file = run.file
    offsets = model.wheel_offsets(values)
    speed = _speed(run)
    if file.duration is not None:
        _check_cost(run, file.duration, speed, model)
    parts = tuple(_road_part(number, run, speed, offsets) for number in range(len(file.road)))
    track = Track(parts, footprint=file.footprint or 0.0)
    if file.duration is not None:
        duration = file.duration
    elif any(isinstance(part, Hump) for part in parts):
        with placed(run, "road", key=True):
            duration = pass_time(track, speed, offsets) + AFTER_LAST_HUMP
        _check_cost(run, duration, speed, model)
    else:
        raise InputError("a run without a hump needs `duration`, e.g. 10 s", run.document.position)
    ground = tuple(_ground(run, link) for link in ground_links(model))
    forces = tuple(
        Signal(harmonic=entry.harmonic) if entry.harmonic else _measured(run, entry, entry.force, "N", ("forces", name))
        for name, entry in file.forces.items()
    )
    chains = channel_chains(run, 1 / (file.step * run.decimation))
    return Scenario(track, speed, duration, file.step, run.decimation, ground, forces, chains=chains, initial=initial_state(run, model))


def ground_links(model: EquationsOfMotion) -> tuple[str, ...]:
    """Return the links to the ground, in the order of a model's inputs."""
    return tuple(name.partition(".")[2] for name in model.inputs[len(model.vehicle.axles) :])


def _check_cost(run: Run, duration: float, speed: SpeedLaw, model: EquationsOfMotion) -> None:
    check_run(run, duration, float(speed.distance(np.array([duration]))[0]), len(model.inputs))


def _speed(run: Run) -> SpeedLaw:
    spec = run.file.speed
    if isinstance(spec, float):
        return ConstantSpeed(spec)
    found = _columns(run, spec.file, (spec.time, spec.speed), ("speed", "file"))
    found.check_ascending()
    if (stands := np.flatnonzero(found.values[1] <= 0)).size:
        raise InputError("every speed of a history must be above 0", found.place(int(stands[0]), 1))
    found.check_limit(1, SPEED_LIMIT)
    return SpeedHistory(*found.values)


def _road_part(number: int, run: Run, speed: SpeedLaw, offsets: Array) -> Profile:
    entry = run.file.road[number]
    if entry.hump is not None:
        return _hump(entry.hump, run, ("road", number, "hump"))
    if entry.profile is not None:
        names = entry.profile.distance, entry.profile.height
        found = _columns(run, entry.profile.file, names, ("road", number, "profile", "file"))
        found.check_ascending()
        return MeasuredProfile(*found.values)
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
        found = _columns(run, entry.file or "", (entry.distance, entry.height_column), (*place, "file"))
        check_hump_points(found)
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
    return _measured(run, entry, entry.displacement, "m", ("displacements", link))


def _measured(run: Run, entry: ForceEntry | DisplacementEntry, column: str, usual: str, place: tuple[str, ...]) -> Signal:
    found = _columns(run, entry.file or "", (entry.time, column), (*place, "file"))
    found.check_ascending(least=1)
    return Signal(time=found.values[0], values=found.values[1] * unit_factor(entry.unit or usual, usual, place[0], None))


def _columns(run: Run, file: str, names: tuple[str, str], place: tuple[str | int, ...]) -> TableColumns:
    with placed(run, *place):
        return read_columns(Path(run.folder) / file, names)


def check_hump_points(points: TableColumns) -> None:
    """Check the points of a hump, distance and height [m]; raises InputError at the row that is wrong."""
    points.check_ascending()
    points.check_limit(1, HUMP_HEIGHT)
    length = float(np.ptp(points.values[0]))
    if (reason := HUMP_LENGTH.refusal(length)) is not None:
        raise InputError(reason, points.place(-1))
