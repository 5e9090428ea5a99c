"""What a vehicle does on a road: the equations of benchmarks/hidden_effects, integrated along the true way."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.hidden_effects.generator.cases import SensorSpec
from benchmarks.hidden_effects.generator.integrate import Assembled, OutputRow, assemble, integrate
from benchmarks.hidden_effects.generator.laws import FREE_PLAY
from benchmarks.hidden_effects.generator.setup import Setup
from benchmarks.hidden_effects.generator.system import GRAVITY, Term
from benchmarks.measured_world.chain import RATE
from benchmarks.measured_world.driver import Drive

Array = NDArray[np.float64]
SETTLE = 4.0
"""Driven before anything is recorded [s]: the vehicle arrives in motion."""
MARGIN = 0.5
"""Known beyond both ends of a recording [s], for late clocks."""


@dataclass(frozen=True)
class PlaceMotion:
    """The motion of a place at RATE: upward and forward acceleration [m/s^2], pitch [rad, nose-down] and its rate [rad/s]."""

    up: Array
    fore: Array
    pitch: Array
    rate: Array

    def specific_force(self, tilt: float = 0.0) -> tuple[Array, Array]:
        """Return what an accelerometer that turns with the place and is tilted nose-down by `tilt` [rad] reads along its own forward
        and upward axis [m/s^2]: at rest -g sin(tilt) and g cos(tilt)."""
        angle = self.pitch + tilt
        cos, sin = np.cos(angle), np.sin(angle)
        gravity = self.up + GRAVITY
        return self.fore * cos - gravity * sin, self.fore * sin + gravity * cos


@dataclass(frozen=True)
class Motion:
    """The motions of all places by name, from the time `start` [s] on; `unloaded`: lowest tyre load over its static load."""

    start: float
    places: dict[str, PlaceMotion]
    unloaded: float


def steps_per_sample(model: Assembled) -> int:
    """Return how many steps of integration go to one sample at RATE: more where the forces jump."""
    if np.any(model.dry > 0) or np.any(model.kind == FREE_PLAY):
        return 5
    return 2 if len(model.kind) else 1


def _rows(setup: Setup, place: SensorSpec, shift: float) -> list[OutputRow]:
    system = setup.system
    x = system.layout.place(place.body, place.behind, place.distance) + shift
    heave, fore = (system.row([Term(kind, place.body, x, place.height)]) for kind in ("heave", "fore"))
    pitch = system.row([Term("pitch", place.body, x)])
    zero = np.zeros_like(heave)
    return [OutputRow(zero, zero, heave), OutputRow(zero, zero, fore), OutputRow(pitch, zero, zero), OutputRow(zero, pitch, zero)]


def inputs(setup: Setup, height: Callable[[Array], Array], drive: Drive, t: Array) -> Array:
    """Return heights [m] and their rates [m/s] under every wheel at even times t [s], `shape (len(t), 2 n_axles)`."""
    s = drive.distance(t)
    heights = []
    for axle, behind in setup.layout.distances.items():
        own = sum((shape(s) for name, shape in setup.runouts if name == axle), np.zeros_like(s))
        at = s - behind
        if setup.footprint > 0.0:
            offsets = setup.footprint * (np.arange(15) - 7.0) / 15.0
            heights.append(own + np.mean([height(at + offset) for offset in offsets], axis=0))
        else:
            heights.append(own + height(at))
    return np.column_stack(heights + [np.gradient(one, t[1] - t[0]) for one in heights])


def move(
    setup: Setup,
    places: tuple[SensorSpec, ...],
    shifts: Mapping[str, float],
    height: Callable[[Array], Array],
    drive: Drive,
    start: float,
    end: float,
    rng: np.random.Generator,
) -> Motion:
    """Return how the places move between `start` and `end` [s], and MARGIN beyond.

    Parameters
    ----------
    shifts
        How far each place is ahead of where it is believed [m].
    height
        The road: heights [m] at distances [m].
    rng
        Of forces that act on the vehicle besides.
    """
    model = assemble(setup.system, [terms for terms, _ in setup.forces])
    fine = steps_per_sample(model)
    h = 1.0 / (RATE * fine)
    first = start - MARGIN - max(SETTLE, setup.settle)
    n_steps = fine * round((end + MARGIN - first) * RATE)
    t = first + 0.5 * h * np.arange(2 * n_steps + 1)
    u = inputs(setup, height, drive, t)
    if setup.forces:
        u = np.column_stack([u, *(history(t - start, end - start, rng) for _, history in setup.forces)])
    ramp = 0.5 - 0.5 * np.cos(np.pi * np.clip((t - first) / (0.5 * SETTLE), 0.0, 1.0))
    u *= ramp[:, None]
    zero = np.zeros(len(setup.system.coordinates))
    outputs = [row for place in places for row in _rows(setup, place, shifts.get(place.name, 0.0))]
    wheels = [OutputRow(setup.system.row([Term("coordinate", axle)]), zero, zero) for axle in setup.layout.axles]
    out = integrate(model, u, h, outputs + wheels)
    unloaded = _unloaded(setup, out[:, len(outputs) :], u[::2])
    kept = np.ascontiguousarray(out[fine * round((start - MARGIN - first) * RATE) :: fine])
    known = start - MARGIN + np.arange(len(kept)) / RATE
    surge = drive.acceleration(known)
    found = {}
    for i, place in enumerate(places):
        up, fore, pitch, rate = kept[:, 4 * i : 4 * i + 4].T
        found[place.name] = PlaceMotion(up, fore + surge, pitch, rate)
    return Motion(start - MARGIN, found, unloaded)


def _unloaded(setup: Setup, wheels: Array, u: Array) -> float:
    """Return the lowest tyre load over its static load: below nought the tyre pulls at the road."""
    static = setup.system.static_forces()
    lowest = 1.0
    for i, (name, axle) in enumerate(setup.layout.axles.items()):
        dynamic = axle.kt * (u[:, i] - wheels[:, i])
        lowest = min(lowest, float(1.0 + np.min(dynamic) / static[f"tyre:{name}"]))
    return lowest
