"""What drives the vehicle in a run: road under every wheel, forces, moving ground."""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from vehgen.codegen import Excitation
from vehgen.errors import ArgumentError
from vehgen.measure.acquisition import POINT_SAMPLES, AcquisitionChain
from vehgen.road import (
    AdjustedSpeed,
    Hump,
    MeasuredProfile,
    SpeedLaw,
    Track,
    Wander,
    WheelInputs,
    wheel_inputs,
)
from vehgen.simulate.last_used import LastUsed
from vehgen.simulate.signals import Signal

Array = NDArray[np.float64]
NULLS_TO = 30.0
"""Above it [Hz] no axle hops."""
LOBES_SOUGHT = 2000.0
"""So many lobes of all humps' spectra together are searched for nulls: a second of work."""
_EXCITATIONS = LastUsed[Excitation](lambda item: item.nbytes)


@dataclass(frozen=True)
class Scenario:
    """What happens to a vehicle from `start` [s]: a track at a speed, signals at ground links and forces, step and samples.

    `ground` and `forces` are in the order of the model's inputs and forces; `chains` says by a channel's name what acquires it: channels
    without one are sampled at their instants. The first `skipped` samples are simulated but not kept. `initial` are displacements, then
    velocities, at the start, `shape (2 n_dof,)` (default: at rest). `farther` says how much farther behind the first axle to arrive each
    axle runs than the vehicle's layout has it [m] (default: not at all).
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
    farther: tuple[float, ...] = ()
    time: Array = field(init=False)

    def __post_init__(self) -> None:
        steps = round(self.duration / (self.dt * self.decimation)) * self.decimation
        object.__setattr__(self, "time", _times(self.start, self.dt, steps))

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

    @property
    def over_measured_road(self) -> bool:
        """Whether a part of the track is a road of known profile."""
        return any(isinstance(part, MeasuredProfile) for part in self.track.parts)

    @cached_property
    def nulls(self) -> tuple[float, ...]:
        """The frequencies [Hz], rounded to mHz, up to NULLS_TO that no hump of the track excites; found when first asked for."""
        top = float(np.max(np.diff(self.speed.distance(np.linspace(0.0, self.duration, 200)))) / (self.duration / 199))
        share = LOBES_SOUGHT / max(len(self.humps), 1)
        found = (hump.spectral_nulls(top, min(NULLS_TO, share * top / hump.length)) for hump in self.humps)
        nulls = [{round(float(null), 3) for null in own} for own in found]
        return tuple(sorted(set.intersection(*nulls))) if nulls else ()

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
        farther: tuple[float, ...] = (),
    ) -> Scenario:
        """Return the same run, `delay` [s] later, at `speed` times the speed, on a road `height` times as high.

        Speed and `wander` are seen from where the vehicle is at the time `anchor` [s]; `deformation` is that of the humps
        (length, form, skew, rounding; default: as it is). `forces` are gains and offsets [N] of the forces, `displacements` gains of
        those of the ground; on a rig without a road both come `delay` later. `farther` is each axle's [m], beside what the run already has.
        """
        if not (0 < speed < math.inf and math.isfinite(delay) and math.isfinite(height)):
            said = "a finite `delay` and `height` and a `speed` above 0 were expected"
            raise ArgumentError(f"{said}, found {delay:g}, {height:g} and {speed:g}", "delay", "height", "speed")
        late = delay if not self.track.parts else 0.0
        same = (delay, speed, wander) == (0.0, 1.0, None)
        law = self.speed if same else AdjustedSpeed(self.speed, delay, speed, anchor, wander)
        track = replace(self.track, scale=self.track.scale * height, deformation=deformation or self.track.deformation)
        found = replace(self, speed=law, track=track, farther=_together(self.farther, farther))
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
        key = self._drive_key, np.asarray(offsets, dtype=float).tobytes()
        return _EXCITATIONS.find(key, self.sources, lambda: self.new_excitation(offsets))

    @property
    def key(self) -> Hashable:
        """What decides how a vehicle answers: scenarios of equal keys are equal, as long as their `sources` live."""
        begun = None if self.initial is None else self.initial.tobytes()
        return self._drive_key, self.decimation, self.skipped, begun, id(self.chains)

    @property
    def sources(self) -> tuple[object, ...]:
        """The objects that :attr:`key` knows by their ids."""
        return self.track, self.speed, self.ground, self.forces, self.chains

    @property
    def _drive_key(self) -> tuple[object, ...]:
        road = (*self._road_key, self.track.scale, *self._speed_key)
        return (*road, self.start, self.dt, len(self.time), id(self.ground), id(self.forces), self.farther)

    @property
    def _road_key(self) -> tuple[object, ...]:
        return id(self.track.parts), self.track.footprint, self.track.deformation

    @property
    def _speed_key(self) -> tuple[object, ...]:
        law: SpeedLaw = self.speed
        errors: tuple[object, ...] = ()
        while isinstance(law, AdjustedSpeed):
            errors = (*errors, law.delay, law.scale, law.anchor, law.wander)
            law = law.law
        return id(law), errors

    def same_road(self, other: Scenario, *, but_height: bool = False) -> bool:
        """Whether the vehicle of another scenario drives over the same road, or one that differs in its height alone."""
        return self._road_key == other._road_key and (but_height or self.track.scale == other.track.scale)

    def same_samples(self, other: Scenario) -> bool:
        """Whether another scenario has the same steps, at the same times, and keeps the same of them in the same way."""
        mine, its = ((item.start, item.dt, len(item.time), item.decimation, item.skipped) for item in (self, other))
        return mine == its and self.chains is other.chains

    def same_pushes(self, other: Scenario) -> bool:
        """Whether forces and moving ground of another scenario are these."""
        return self.ground is other.ground and self.forces is other.forces

    def same_speed(self, other: Scenario) -> bool:
        """Whether the vehicle of another scenario is always where this one is."""
        return self._speed_key == other._speed_key

    def axle_offsets(self, offsets: Array) -> Array:
        """Return how far each axle runs behind the first [m], where the layout has `offsets shape (n_axles,)`."""
        return np.asarray(offsets + np.array(self.farther)) if self.farther else offsets

    def new_excitation(self, offsets: Array) -> Excitation:
        """Return what :meth:`excitation` does, neither looked up nor remembered."""
        wheels, pushes = self.wheels(offsets), self.pushes()
        if not self.ground:
            return Excitation(self.dt, wheels.heights, wheels.rates, pushes.forces)
        inputs, rates = np.hstack([wheels.heights, pushes.inputs]), np.hstack([wheels.rates, pushes.rates])
        return Excitation(self.dt, inputs, rates, pushes.forces)

    def wheels(self, offsets: Array) -> WheelInputs:
        """Return the road under every axle, where the layout has `offsets shape (n_axles,)`."""
        return wheel_inputs(self.track, self.speed, self.axle_offsets(offsets), self.time)

    def pushes(self) -> Excitation:
        """Return what excites the vehicle besides the road under its axles: moving ground, as the only inputs, and forces."""
        inputs, rates = (np.zeros((len(self.time), len(self.ground))) for _ in range(2))
        for i, signal in enumerate(self.ground):
            if signal is not None:
                inputs[:, i] = signal.at(self.time)
                rates[:, i] = (signal.at(self.time + self.dt / 2) - signal.at(self.time - self.dt / 2)) / self.dt
        forces = np.column_stack([signal.at(self.time) for signal in self.forces]) if self.forces else np.zeros((len(self.time), 0))
        return Excitation(self.dt, inputs, rates, forces)


@lru_cache(maxsize=64)
def _times(start: float, dt: float, steps: int) -> Array:
    """Return the times of so many steps [s]: not to be written to."""
    times = np.asarray(start + np.arange(steps + 1) * dt, dtype=np.float64)
    times.setflags(write=False)
    return times


def _together(farther: tuple[float, ...], more: tuple[float, ...]) -> tuple[float, ...]:
    """Return how much farther behind the first each axle runs for two reasons [m]; nothing where there is neither."""
    return tuple(one + other for one, other in zip(farther, more, strict=True)) if farther and more else farther or more
