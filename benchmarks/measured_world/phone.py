"""Phones: a chip with its low-pass, sampling by a clock of its own, tilted axes, noise and rounding."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.hidden_effects.generator.setup import Reading
from benchmarks.hidden_effects.generator.system import GRAVITY
from benchmarks.measured_world.chain import Filter, Noise, quantised, sample
from benchmarks.measured_world.motion import PlaceMotion

Array = NDArray[np.float64]
LONGEST_START = 3.0
"""An app is started at most so long before the pass [s]."""
AHEAD = ("y", "x", "-y")
"""Which axis of the phone points forward: top edge ahead, to the left, to the rear."""
TURN = {"y": np.pi / 2.0, "x": 0.0, "-y": -np.pi / 2.0}
"""By how much the phone's x axis is turned to the right of the vehicle's forward axis [rad], seen from above."""


@dataclass(frozen=True)
class Device:
    """A kind of phone: app and platform, sampling rates [Hz], filters, noise, rounding, jitter of the time stamps [s] and delay of
    a sample against its time stamp [s]. `reversed`: its app gives accelerations with the opposite sign."""

    name: str
    app: str
    platform: str
    rate: float
    az_filter: Filter
    q_filter: Filter
    az_noise: Noise
    q_noise: Noise
    az_step: float
    q_step: float
    jitter: float
    delay: float
    reversed: bool = False


DEVICES = (
    Device("android_a", "phyphox", "android", 100.0, Filter("butterworth", 2, 40.5), Filter("butterworth", 2, 39.0),
           Noise(1.8e-3, 0.5), Noise(1.2e-4, 0.3), 0.0024, 2.66e-4, 3e-4, 4e-3),
    Device("android_b", "phyphox", "android", 200.0, Filter("butterworth", 3, 80.0), Filter("butterworth", 3, 75.0),
           Noise(1.2e-3, 0.3), Noise(0.9e-4, 0.2), 0.0012, 1.3e-4, 6e-4, 2e-3),
    Device("android_c", "sensor_logger", "android", 103.7, Filter("butterworth", 4, 47.0), Filter("butterworth", 4, 47.0),
           Noise(1.5e-3, 0.5), Noise(1.0e-4, 0.3), 0.0048, 1.07e-3, 8e-4, 5e-3),
    Device("iphone_a", "sensor_logger", "ios", 100.0, Filter("bessel", 4, 48.0), Filter("bessel", 4, 45.0),
           Noise(1.3e-3, 0.2), Noise(0.7e-4, 0.2), 1.5e-4, 1e-5, 1e-4, 6e-3, reversed=True),
    Device("iphone_b", "phyphox", "ios", 100.0, Filter("bessel", 4, 42.0), Filter("bessel", 4, 42.0),
           Noise(1.3e-3, 0.2), Noise(0.7e-4, 0.2), 1.5e-4, 1e-5, 1e-4, 6e-3),
)  # fmt: skip
"""After data sheets of usual chips (noise of 120 to 180 ug/sqrt(Hz), 0.004 to 0.007 deg/s/sqrt(Hz)) and what their streams show."""


@dataclass(frozen=True)
class Phone:
    """A phone as it lies: shift ahead of the noted place [m], axis that points forward, roll, pitch and yaw off it [rad], relative
    error of its clock, how long before the pass its app was started on every run [s], error of its world time on every run [s], its
    readings at rest [m/s^2], [rad/s], and relative gain errors by channel."""

    sensor: str
    device: Device
    shift: float
    forward: str
    angles: tuple[float, float, float]
    clock_error: float
    starts: tuple[float, ...]
    world_errors: tuple[float, ...]
    az_bias: tuple[float, float, float]
    q_bias: tuple[float, float, float]
    gains: Mapping[str, float]

    def axes(self) -> Array:
        """Return the rotation from the vehicle's axes (forward, left, up) to the phone's, `shape (3, 3)`."""
        roll, pitch, yaw = self.angles
        turn = TURN[self.forward] + yaw
        about_z = np.array([[np.cos(turn), -np.sin(turn), 0.0], [np.sin(turn), np.cos(turn), 0.0], [0.0, 0.0, 1.0]])
        about_y = np.array([[np.cos(pitch), 0.0, -np.sin(pitch)], [0.0, 1.0, 0.0], [np.sin(pitch), 0.0, np.cos(pitch)]])
        about_x = np.array([[1.0, 0.0, 0.0], [0.0, np.cos(roll), np.sin(roll)], [0.0, -np.sin(roll), np.cos(roll)]])
        return np.asarray(about_x @ about_y @ about_z)


@dataclass(frozen=True)
class Samples:
    """What a sensor of a phone gave: its time stamps [s since the app was started] and three axes; `clean`: the same without noise and
    rounding; `noise`: standard deviation in each axis."""

    t: Array
    xyz: Array
    clean: Array
    noise: float


def record(
    phone: Phone, place: PlaceMotion, known_from: float, start: float, end: float, reading: Reading, rng: np.random.Generator
) -> tuple[Samples, Samples]:
    """Return specific force [m/s^2] and rotation rates [rad/s] in the phone's axes, of an app that runs from `start` to `end` [s].

    `known_from` is when the motion of the place begins [s].
    """
    device = phone.device
    axes = phone.axes()
    fore, up = place.specific_force(reading.tilt)
    zero = np.zeros_like(up)
    force = np.column_stack([fore, zero, up]) * reading.gains["az"] * (1.0 + phone.gains["az"])
    turn = np.column_stack([zero, place.rate, zero]) * reading.gains["q"] * (1.0 + phone.gains["q"])
    found = []
    for values, filter, noise, bias, step, limit in (
        (force, device.az_filter, device.az_noise, phone.az_bias, device.az_step, 8.0 * GRAVITY),
        (turn, device.q_filter, device.q_noise, phone.q_bias, device.q_step, 35.0),
    ):
        stamps = _clock(end - start, device, rng)
        moments = start + stamps / (1.0 + phone.clock_error) - device.delay
        clean = sample(filter.apply(values @ axes.T), known_from, moments - reading.delay) + np.asarray(bias)
        own = sample(filter.apply(noise.draw(values.shape, rng)), known_from, moments)
        found.append(Samples(stamps, quantised(clean + own, step, limit), clean, float(np.std(own))))
    return found[0], found[1]


def _clock(duration: float, device: Device, rng: np.random.Generator) -> Array:
    count = int(duration * device.rate + 1e-6) - 1
    jitter = np.clip(rng.standard_normal(count), -2.5, 2.5) * device.jitter
    return np.asarray(rng.uniform(0.003, 0.8 / device.rate) + np.arange(count) / device.rate + jitter)


def draw_phone(sensor: str, runs: int, rng: np.random.Generator) -> Phone:
    """Return a phone that someone laid down with care: tilted by up to 4 degrees, its clock off by up to seconds."""
    device = DEVICES[int(rng.integers(len(DEVICES)))]
    return Phone(
        sensor=sensor,
        device=device,
        shift=float(rng.uniform(-0.02, 0.02)),
        forward=str(rng.choice(AHEAD)),
        angles=tuple(float(a) for a in np.radians(rng.uniform(-1.0, 1.0, 3) * (4.0, 4.0, 3.0))),
        clock_error=float(rng.normal(0.0, 3e-5)),
        starts=tuple(float(v) for v in rng.uniform(0.2, LONGEST_START, runs)),
        world_errors=tuple(float(v) for v in rng.normal(0.0, 0.015 if rng.random() < 0.7 else 1.0, runs)),
        az_bias=tuple(float(v) for v in rng.normal(0.0, 0.04, 3)),
        q_bias=tuple(float(v) for v in rng.normal(0.0, 0.003, 3)),
        gains={channel: float(rng.normal(0.0, 0.004)) for channel in ("az", "q")},
    )
