"""A rig's recorder: one clock, accelerometers and gyroscopes in the vehicle's axes, an anti-alias filter, decimation, 16 bits."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from benchmarks.hidden_effects.generator.setup import Reading
from benchmarks.hidden_effects.generator.system import GRAVITY
from benchmarks.measured_world.chain import Filter, Noise, quantised, sample
from benchmarks.measured_world.motion import Motion, PlaceMotion

Array = NDArray[np.float64]
BITS = 16


@dataclass(frozen=True)
class Mount:
    """How one sensor is mounted: shift ahead of where it is believed [m], tilt [rad, nose-down], relative gain errors by channel."""

    shift: float
    tilt: float
    gains: Mapping[str, float]


@dataclass(frozen=True)
class Logger:
    """A recorder. `rate` [Hz]; `filter`: before decimation; `az_filter`, `q_filter`: the sensors' own bandwidths; ranges [m/s^2],
    [rad/s]; `clock_error`: by how much its clock is fast."""

    rate: float
    filter: Filter
    az_filter: Filter
    q_filter: Filter
    az_noise: Noise
    q_noise: Noise
    az_range: float
    q_range: float
    clock_error: float
    mounts: Mapping[str, Mount]

    def record(
        self, motion: Motion, start: float, duration: float, readings: Mapping[str, Reading], rng: np.random.Generator
    ) -> tuple[Array, dict[str, Array], dict[str, Array], dict[str, float]]:
        """Return t [s], the channels NAME_az [m/s^2, zeroed at rest] and NAME_q [rad/s], the same without noise and rounding, and
        the noise's standard deviations, of a recording from `start` [s] on."""
        t = np.arange(math.floor(duration * self.rate + 1e-6) + 1) / self.rate
        moments = start + t / (1.0 + self.clock_error)
        channels, clean, sigma = {}, {}, {}
        for name, place in motion.places.items():
            reading = readings.get(name, Reading())
            for channel, values in self._seen(place, self.mounts[name], reading).items():
                key = f"{name}_{channel}"
                noise_of = self.az_noise if channel == "az" else self.q_noise
                noise = sample(self.filter.apply(noise_of.draw(values.shape, rng)), motion.start, moments)
                clean[key] = sample(self.filter.apply(values), motion.start, moments - reading.delay)
                limit = self.az_range if channel == "az" else self.q_range
                channels[key] = quantised(clean[key] + noise, 2.0 * limit / 2**BITS, limit)
                sigma[key] = float(np.std(noise))
        return t, channels, clean, sigma

    def _seen(self, place: PlaceMotion, mount: Mount, reading: Reading) -> dict[str, Array]:
        tilt = mount.tilt + reading.tilt
        _, upward = place.specific_force(tilt)
        upward = upward - GRAVITY * math.cos(tilt)
        seen = {"az": self.az_filter.apply(upward), "q": self.q_filter.apply(place.rate)}
        return {name: values * (1.0 + mount.gains[name]) * reading.gains[name] for name, values in seen.items()}


def draw_logger(sensors: tuple[str, ...], rng: np.random.Generator) -> Logger:
    """Return a recorder with the small errors that a careful user cannot see."""
    rate = float(rng.choice([100.0, 200.0]))
    kind = str(rng.choice(["butterworth", "bessel"]))
    order = int(rng.choice([2, 4, 6, 8]))
    cutoff = float(rng.uniform(0.40, 0.46)) * rate
    mounts = {}
    for name in sensors:
        gains = {channel: float(rng.uniform(0.005, 0.01) * rng.choice([-1.0, 1.0])) for channel in ("az", "q")}
        mounts[name] = Mount(float(rng.uniform(-0.02, 0.02)), float(np.radians(rng.uniform(-1.0, 1.0))), gains)
    return Logger(
        rate=rate,
        filter=Filter(kind, order, cutoff),
        az_filter=Filter("butterworth", 2, float(rng.uniform(200.0, 500.0))),
        q_filter=Filter("butterworth", 2, float(rng.uniform(110.0, 250.0))),
        az_noise=Noise(float(rng.uniform(0.5e-3, 2e-3)), float(rng.uniform(0.1, 1.0))),
        q_noise=Noise(float(rng.uniform(0.5e-4, 1.5e-4)), float(rng.uniform(0.05, 0.5))),
        az_range=float(rng.choice([4.0, 8.0])) * GRAVITY,
        q_range=math.radians(250.0),
        clock_error=float(rng.normal(0.0, 2e-5)),
        mounts=mounts,
    )


def with_filter(logger: Logger, filter: Filter) -> Logger:
    """Return the same recorder with another low-pass."""
    return replace(logger, filter=filter)
