"""What a trial consists of: a vehicle with its true parameters, hidden effects, runs, sensors and noise."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Effect:
    """A hidden effect: its name, where it sits, and its values (SI units)."""

    name: str
    place: str
    values: Mapping[str, float]


@dataclass(frozen=True)
class Hump:
    """A half-sine hump as the experimenter measured it [m]."""

    length: float
    height: float
    at: float


@dataclass(frozen=True)
class RandomRoad:
    """A random road of a class of ISO 8608, of which the experimenter has a measured profile."""

    roughness: str = "B"
    seed: int = 0


@dataclass(frozen=True)
class RunSpec:
    """A run as the experimenter believes it was, and by how much the truth differs.

    speed [m/s] and duration [s] are believed. Truth: humps `hump_height_error` higher and `hump_length_error` longer (relative), the
    speed `speed_error` faster (relative), everything `arrival_shift` [s] later, a road of class `hidden_roughness` (heights times
    `hidden_scale`) under it all that nobody measured, and measured profiles that are off by white noise of `profile_noise` [m].
    """

    road: tuple[Hump | RandomRoad, ...]
    speed: float
    duration: float
    name: str = "run"
    hump_height_error: float = 0.0
    hump_length_error: float = 0.0
    speed_error: float = 0.0
    arrival_shift: float = 0.0
    hidden_roughness: str | None = None
    hidden_scale: float = 1.0
    profile_noise: float = 0.0


@dataclass(frozen=True)
class SensorSpec:
    """A phone on a body, `distance` [m] behind an axle or pin and `height` [m] above the body's COG; it records NAME_az [m/s^2] and
    NAME_q [rad/s]."""

    name: str
    body: str
    behind: str
    distance: float
    height: float = 0.0


@dataclass(frozen=True)
class Noise:
    """Noise of standard deviation floor + relative * rms, combined as root sum of squares; `colour` p shapes its PSD as f^-p (0: white)."""

    acceleration: float = 0.01
    pitch_rate: float = 0.0005
    relative: float = 0.01
    colour: float = 0.0


SILENT = Noise(0.0, 0.0, 0.0)

SENSORS: dict[str, tuple[SensorSpec, ...]] = {
    "sedan2": (SensorSpec("F", "body", "front", 0.0), SensorSpec("R", "body", "rear", 0.0)),
    "tractor5": (SensorSpec("L1", "tractor", "axle1", -0.29), SensorSpec("L2", "semitrailer", "fifth_wheel", 9.115)),
}

REFERENCE_RUN: dict[str, RunSpec] = {
    "sedan2": RunSpec((Hump(0.5, 0.03, 3.0),), 3.0, 5.0, "hump"),
    "tractor5": RunSpec((Hump(0.5, 0.03, 4.0),), 2.0, 12.0, "hump"),
}
"""The hump run of a vehicle on which effects are scaled and tested."""

SHARP_RUN: dict[str, RunSpec] = {
    "sedan2": RunSpec((Hump(0.4, 0.06, 3.0),), 5.0, 4.0, "sharp"),
    "tractor5": RunSpec((Hump(0.4, 0.05, 4.0),), 2.5, 10.0, "sharp"),
}
"""A hump run that lifts tyres off the road."""


@dataclass(frozen=True)
class Case:
    """A trial. `parameters` None: nominal ones with every calibratable one off by a random 5 %, from the seed.

    `sampling`: "point" keeps the value at every 10 ms; "filtered" passes a zero-phase low-pass (flat to 40 Hz) first. `step` [s]
    None: 0.1 ms, with dry friction or free play 0.05 ms.
    """

    vehicle: str
    parameters: Mapping[str, float] | None = None
    effects: tuple[Effect, ...] = ()
    runs: tuple[RunSpec, ...] = ()
    sensors: tuple[SensorSpec, ...] | None = None
    noise: Noise = field(default_factory=Noise)
    seed: int = 0
    sampling: str = "point"
    step: float | None = None


@dataclass(frozen=True)
class Recording:
    """What the phones recorded on one run: t [s] `shape (n,)`, channels with noise and without, and the standard deviation of that
    noise."""

    run: RunSpec
    t: Array
    channels: dict[str, Array]
    clean: dict[str, Array]
    sigma: dict[str, float]
    profiles: tuple[tuple[Array, Array], ...] = ()
