"""From a case to recordings: the true way over the true road, the vehicle's motion, and what the instruments make of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from benchmarks.hidden_effects.generator.cases import Case as Mechanics
from benchmarks.hidden_effects.generator.setup import Setup
from benchmarks.hidden_effects.generator.simulate import prepare
from benchmarks.measured_world.cases import AFTER, Case, Recording, Run
from benchmarks.measured_world.driver import Drive, wandering
from benchmarks.measured_world.motion import MARGIN, SETTLE, Motion, move
from benchmarks.measured_world.phone import LONGEST_START, Samples
from benchmarks.measured_world.phone import record as record_phone
from benchmarks.measured_world.roads import Profile, joined, random_road

Array = NDArray[np.float64]
BEFORE = MARGIN + SETTLE + LONGEST_START + 3.0
"""Driven before a recording begins, at least [s]."""


@dataclass(frozen=True)
class Pass:
    """What truly happened on a run: the drive, the road, when the recording begins and ends [s], where the mark is [m before the hump
    or the measured road, as stated], the profile as measured, and the vehicle that drove."""

    drive: Drive
    height: Callable[[Array], Array]
    start: float
    end: float
    at: float
    profile: Profile | None
    setup: Setup


def prepared(case: Case, run: Run) -> Setup:
    """Return the true vehicle of a run with its effects."""
    parameters = case.parameters if run.parameters is None else run.parameters
    return prepare(Mechanics(case.vehicle, parameters, case.effects, seed=case.seed))


def true_lead(run: Run) -> float:
    """Return how long before the hump or the measured road the recording truly begins, at the mean speed [s]."""
    return run.lead if run.timed else run.lead * run.speed / run.true_speed


def duration_of(run: Run, length: float) -> float:
    """Return how long a run's recording is [s] for a vehicle whose axles are `length` [m] apart, to a tenth of a second."""
    if run.road is not None:
        return round(true_lead(run) + run.road.duration, 1)
    assert run.hump is not None
    return round(true_lead(run) + (length + run.hump.length) / run.true_speed + AFTER, 1)


def drive_past(case: Case, run: Run) -> Pass:
    """Return the true way, road and clock of a run."""
    setup = prepared(case, run)
    way, land, profiling = (np.random.default_rng([run.seed, i]) for i in (1, 2, 3))
    length = max(setup.layout.distances.values())
    duration = duration_of(run, length)
    mean = run.true_speed * (1.0 + setup.speed_error)
    first, last = -1.5 * true_lead(run) - BEFORE - 1.0, 1.5 * duration + 3.0
    drive = wandering(mean, run.wander, run.correlation, first, last, way)
    beginning, end = 1.2 * run.true_speed * first - length - 5.0, 1.2 * run.true_speed * last + 5.0
    level = random_road(run.hidden_roughness, beginning, end, land, run.hidden_scale)
    profile = None
    if run.road is not None:
        section = random_road(run.road.roughness, -1.0, end, land)
        road = joined(level, section)
        height = road.heights
        profile = run.road.profiler.measure(road, end, profiling)
    else:
        hump = run.hump
        assert hump is not None
        s, y = hump.points()

        def height(at: Array) -> Array:
            return np.asarray(level.heights(at) + np.interp(at, s, y))

    at = round(run.lead * run.speed, 3)
    start = (-run.lead if run.timed else drive.passes(-at)) + run.start_error
    return Pass(drive, height, start, start + duration, at, profile, setup)


def motion_of(case: Case, run: Run, true: Pass) -> Motion:
    """Return how the sensors' places move on a run; with phones from LONGEST_START before the pass on."""
    early = LONGEST_START if case.phones else 0.0
    shifts = {name: reading.shift for name, reading in true.setup.readings.items()}
    mounts = {phone.sensor: phone.shift for phone in case.phones}
    if case.logger is not None:
        mounts = {name: mount.shift for name, mount in case.logger.mounts.items()}
    total = {place.name: shifts.get(place.name, 0.0) + mounts.get(place.name, 0.0) for place in case.sensors}
    rng = np.random.default_rng([run.seed, 4])
    return move(true.setup, case.sensors, total, true.height, true.drive, true.start - early, true.end, rng)


def record_run(case: Case, run: Run) -> Recording:
    """Return what the recorder of a case wrote of a run."""
    assert case.logger is not None
    true = drive_past(case, run)
    motion = motion_of(case, run, true)
    rng = np.random.default_rng([run.seed, 5])
    t, channels, clean, sigma = case.logger.record(motion, true.start, true.end - true.start, true.setup.readings, rng)
    return Recording(run, true.at, t, channels, clean, sigma, true.profile, facts(true, motion))


def record_phones(case: Case, number: int) -> tuple[Pass, dict[str, tuple[Samples, Samples]], dict[str, float]]:
    """Return the pass of run `number`, what every phone gave (force, turn), and facts of the run."""
    run = case.runs[number]
    true = drive_past(case, run)
    motion = motion_of(case, run, true)
    found = {}
    for i, phone in enumerate(case.phones):
        rng = np.random.default_rng([run.seed, 6, i])
        start = true.start - phone.starts[number]
        reading = true.setup.readings[phone.sensor]
        found[phone.sensor] = record_phone(phone, motion.places[phone.sensor], motion.start, start, true.end, reading, rng)
    return true, found, facts(true, motion)


def facts(true: Pass, motion: Motion) -> dict[str, float]:
    """Return what is worth knowing of a run: mean speed over the recording [m/s], its start [s before the hump], lowest tyre load."""
    way = true.drive.distance(np.array([true.start, true.end]))
    mean = float(way[1] - way[0]) / (true.end - true.start)
    return {"mean_speed": mean, "start": true.start, "lowest_tyre_load": motion.unloaded}


def strength(case: Case) -> float:
    """Return the rms of what the hidden effects change in the recorded channels over the noise of the sensors; 0 without effects."""
    bare = replace(case, effects=())
    squares = []
    for number, run in enumerate(case.runs):
        if case.logger is not None:
            one, other = record_run(case, run), record_run(bare, run)
            squares += [np.mean((one.clean[name] - other.clean[name]) ** 2) / other.sigma[name] ** 2 for name in one.clean]
            continue
        _, with_effects, _ = record_phones(case, number)
        _, without, _ = record_phones(bare, number)
        for name, pair in with_effects.items():
            squares += [np.mean(np.sum((a.clean - b.clean) ** 2, axis=1)) / b.noise**2 for a, b in zip(pair, without[name], strict=True)]
    return float(np.sqrt(np.mean(squares)))
