"""From a case to recordings."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy import signal

from benchmarks.hidden_effects.generator.cases import SENSORS, Case, Hump, Recording, RunSpec, SensorSpec
from benchmarks.hidden_effects.generator.effects import EFFECTS
from benchmarks.hidden_effects.generator.integrate import Assembled, OutputRow, assemble, integrate
from benchmarks.hidden_effects.generator.laws import FREE_PLAY
from benchmarks.hidden_effects.generator.roads import HalfSine, Points, Road, random_road
from benchmarks.hidden_effects.generator.setup import Reading, Setup
from benchmarks.hidden_effects.generator.system import GRAVITY, System, Term, base_system
from benchmarks.hidden_effects.generator.vehicles import layout, perturbed

Array = NDArray[np.float64]

SAMPLE = 0.01


def true_parameters(case: Case) -> dict[str, float]:
    """Return the parameters the recordings are made with, SI units."""
    return perturbed(case.vehicle, case.seed) if case.parameters is None else dict(case.parameters)


def prepare(case: Case) -> Setup:
    """Return the vehicle of a case with its effects applied, lift-off last: it needs the static loads. Raises ValueError for an effect
    that does not fit the vehicle."""
    plan = layout(case.vehicle, true_parameters(case))
    readings = {sensor.name: Reading() for sensor in sensors_of(case)}
    setup = Setup(case.vehicle, plan, base_system(plan), readings, np.random.default_rng([case.seed, 7]))
    for effect in sorted(case.effects, key=lambda effect: effect.name == "tyre_liftoff"):
        kind = EFFECTS[effect.name]
        if effect.place not in kind.places(case.vehicle):
            raise ValueError(
                f"{effect.name} cannot sit at {effect.place!r} of {case.vehicle}; places: {', '.join(kind.places(case.vehicle))}"
            )
        missing = {value.name for value in kind.values} ^ set(effect.values)
        if missing:
            raise ValueError(f"{effect.name} takes the values {', '.join(v.name for v in kind.values)}; check {', '.join(sorted(missing))}")
        kind.apply(setup, effect.place, effect.values)
    return setup


def sensors_of(case: Case) -> tuple[SensorSpec, ...]:
    """Return the sensors of a case, by default two phones."""
    return SENSORS[case.vehicle] if case.sensors is None else case.sensors


def simulate_case(case: Case) -> list[Recording]:
    """Return what the phones record on every run of a case."""
    setup = prepare(case)
    model = assemble(setup.system, [terms for terms, _ in setup.forces])
    step = case.step or (0.5e-4 if np.any(model.dry > 0) or np.any(model.kind == FREE_PLAY) else 1e-4)
    outputs = [row for sensor in sensors_of(case) for row in sensor_rows(setup.system, setup.readings[sensor.name], sensor)]
    return [_simulate_run(case, setup, model, outputs, run, number, step) for number, run in enumerate(case.runs)]


def sensor_rows(system: System, reading: Reading, sensor: SensorSpec) -> list[OutputRow]:
    """Return the rows of a phone's acceleration and pitch rate.

    A phone tilted nose-down by alpha measures along its own normal; less its reading at rest: z'' cos(alpha) + x'' sin(alpha) - g theta
    sin(alpha), with z, x, theta the motion and pitch of its place.
    """
    x = system.layout.place(sensor.body, sensor.behind, sensor.distance) + reading.shift
    heave, fore = (system.row([Term(kind, sensor.body, x, sensor.height)]) for kind in ("heave", "fore"))
    pitch = system.row([Term("pitch", sensor.body, x)])
    zero = np.zeros_like(heave)
    cos, sin = math.cos(reading.tilt), math.sin(reading.tilt)
    gain = reading.gains
    return [
        OutputRow(-gain["az"] * GRAVITY * sin * pitch, zero, gain["az"] * (cos * heave + sin * fore)),
        OutputRow(zero, gain["q"] * pitch, zero),
    ]


def build_road(setup: Setup, run: RunSpec, rng: np.random.Generator, settle: float) -> tuple[Road, tuple[tuple[Array, Array], ...]]:
    """Return the true road under a run and the profiles as they were measured."""
    length = max(setup.layout.distances.values())
    end = run.speed * run.duration * 1.3 + 5.0
    parts: list[HalfSine | Points] = []
    measured = []
    for part in run.road:
        if isinstance(part, Hump):
            parts.append(HalfSine(part.length * (1.0 + run.hump_length_error), part.height * (1.0 + run.hump_height_error), part.at))
        else:
            profile = random_road(part.roughness, 0.0, end, np.random.default_rng([part.seed, 3]), taper=True)
            parts.append(profile)
            measured.append((profile.distance, profile.height + run.profile_noise * rng.standard_normal(len(profile.height))))
    if run.hidden_roughness is not None:
        start = -length - 1.3 * run.speed * (settle + abs(run.arrival_shift)) - 5.0
        parts.append(random_road(run.hidden_roughness, start, end, rng, taper=False, scale=run.hidden_scale))
    return Road(tuple(parts), setup.footprint), tuple(measured)


def wheel_inputs(setup: Setup, road: Road, speed: float, t: Array, spacing: float) -> Array:
    """Return heights [m] and their rates [m/s] under every wheel at times t `spacing` [s] apart, `shape (len(t), 2 n_axles)`; rates are
    central differences."""
    s = speed * t
    heights = []
    for axle, behind in setup.layout.distances.items():
        own = [shape(s) for name, shape in setup.runouts if name == axle]
        heights.append(road.heights(s - behind) + sum(own, np.zeros_like(s)))
    return np.column_stack(heights + [np.gradient(height, spacing) for height in heights])


def _simulate_run(
    case: Case, setup: Setup, model: Assembled, outputs: list[OutputRow], run: RunSpec, number: int, step: float
) -> Recording:
    rng = np.random.default_rng([case.seed, 5, number])
    settle = max(setup.settle, 3.0 if run.hidden_roughness is not None else 0.0)
    road, measured = build_road(setup, run, rng, settle)
    extra = 0.2
    n_lead = round((settle + extra) / step)
    n_steps = n_lead + round((run.duration + extra) / step)
    t = step * (0.5 * np.arange(2 * n_steps + 1) - n_lead)
    speed = run.speed * (1.0 + run.speed_error) * (1.0 + setup.speed_error)
    u = wheel_inputs(setup, road, speed, t - run.arrival_shift, 0.5 * step)
    if setup.forces:
        u = np.column_stack([u, *(history(t, run.duration, rng) for _, history in setup.forces)])
    if settle > 0:
        u *= (0.5 - 0.5 * np.cos(np.pi * np.clip((t - t[0]) / (0.5 * settle), 0.0, 1.0)))[:, None]
    fine = integrate(model, u, step, outputs)
    kept = SAMPLE * np.arange(round(run.duration / SAMPLE) + 1)
    names = [f"{sensor.name}_{channel}" for sensor in sensors_of(case) for channel in ("az", "q")]
    delays = [setup.readings[sensor.name].delay for sensor in sensors_of(case) for _ in range(2)]
    clean = {}
    for i, name in enumerate(names):
        history = _low_pass(fine[:, i], step) if case.sampling == "filtered" else fine[:, i]
        clean[name] = np.interp(kept - delays[i], t[::2], history)
    sigma = {name: _sigma(case, name, values) for name, values in clean.items()}
    noisy = {name: values + sigma[name] * coloured(len(values), case.noise.colour, rng) for name, values in clean.items()}
    return Recording(run, kept, noisy, clean, sigma, measured)


def _sigma(case: Case, name: str, values: Array) -> float:
    floor = case.noise.acceleration if name.endswith("_az") else case.noise.pitch_rate
    return float(np.hypot(floor, case.noise.relative * np.sqrt(np.mean(values**2))))


def _low_pass(values: Array, step: float) -> Array:
    """Low-pass with zero phase: flat to 40 Hz, 60 dB down from 50 Hz."""
    coarse = round(1e-3 / step)
    taps_1k = signal.firwin(401, 45.0, fs=1000.0, window=("kaiser", 5.65))
    box = np.ones(coarse) / coarse
    smooth = np.convolve(np.pad(values, coarse, mode="edge"), np.convolve(box, box), mode="same")[coarse:-coarse]
    at = np.arange(0, len(values), coarse)
    filtered = np.convolve(np.pad(smooth[at], 200, mode="edge"), taps_1k, mode="valid")
    return np.interp(np.arange(len(values)), at, filtered)


def coloured(n: int, exponent: float, rng: np.random.Generator) -> Array:
    """Return n samples of unit variance whose PSD goes as f^-exponent."""
    white = rng.standard_normal(n)
    if exponent == 0.0:
        return white
    spectrum = np.fft.rfft(white)
    spectrum[1:] *= np.arange(1, len(spectrum)) ** (-exponent / 2.0)
    spectrum[0] = 0.0
    shaped = np.fft.irfft(spectrum, n)
    return np.asarray(shaped / np.std(shaped))
