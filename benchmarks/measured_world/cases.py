"""What a case consists of: a vehicle, how it is driven over which road, what records it, and what is hidden or wrong."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from benchmarks.hidden_effects.generator.cases import Effect, SensorSpec
from benchmarks.measured_world.hump import Hump
from benchmarks.measured_world.logger import Logger
from benchmarks.measured_world.phone import Phone
from benchmarks.measured_world.roads import Profile, Profiler

Array = NDArray[np.float64]
AFTER = 3.5
"""Recorded after the last wheel has left a hump [s]."""


@dataclass(frozen=True)
class Road:
    """A random road that was measured: class, duration of the drive over it [s], and the profiler."""

    roughness: str
    duration: float
    profiler: Profiler


@dataclass(frozen=True)
class Run:
    """A run: what is stated of it, and how it was.

    stated: speed [m/s], hump (or road), and `lead`: how long before the hump the recording begins at that speed [s].
    true: mean speed [m/s], share and correlation [s] of its wandering, hump as it lies, class of the road that nobody measured and a factor
    of its heights.
    `timed`: the recording begins a fixed time before the front wheel meets the hump (a light barrier); else when it passes a
    mark, `start_error` [s] late.
    """

    name: str
    speed: float
    lead: float
    true_speed: float
    wander: float
    correlation: float
    hidden_roughness: str
    hidden_scale: float
    timed: bool
    start_error: float
    seed: int
    stated_hump: Hump | None = None
    hump: Hump | None = None
    road: Road | None = None
    parameters: dict[str, float] | None = None


@dataclass(frozen=True)
class Fault:
    """A plain mistake: its kind, the runs and the channel or sensors it concerns, and its size."""

    kind: str
    runs: tuple[str, ...] = ()
    items: tuple[str, ...] = ()
    size: float = 0.0


@dataclass(frozen=True)
class Case:
    """A case. `parameters` are the true vehicle's [SI]; `stated`: distances that the vehicle file gives otherwise than usual [m];
    `strength`: rms of what the effects change in the channels over the noise of the sensors."""

    name: str
    kind: str
    vehicle: str
    parameters: dict[str, float]
    sensors: tuple[SensorSpec, ...]
    runs: tuple[Run, ...]
    seed: int
    logger: Logger | None = None
    phones: tuple[Phone, ...] = ()
    effects: tuple[Effect, ...] = ()
    fault: Fault | None = None
    unseen: tuple[Run, ...] = ()
    stated: dict[str, float] = field(default_factory=dict)
    strength: float | None = None


@dataclass(frozen=True)
class Recording:
    """A recording: t [s] and channels, standard deviations of the sensors' noise in them, the measured profile, and facts of the run.

    `clean` are the channels without the sensors' noise and rounding.
    """

    run: Run
    at: float
    t: Array
    channels: dict[str, Array]
    clean: dict[str, Array]
    sigma: dict[str, float]
    profile: Profile | None
    facts: dict[str, float] = field(default_factory=dict)
