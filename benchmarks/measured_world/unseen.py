"""Road runs that no calibration sees: what the true vehicle does on them, without instruments."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.measured_world.cases import Case, Recording, Road, Run
from benchmarks.measured_world.chain import Filter, sample
from benchmarks.measured_world.files import copy_vehicle, write_recording
from benchmarks.measured_world.plans import ROAD_SPEEDS, make_run
from benchmarks.measured_world.roads import Profile, Profiler
from benchmarks.measured_world.world import drive_past, motion_of

EXACT = Profiler(0.0, 0.0, 0.0, 0.0, 0.01)
RATE = 100.0
SMOOTH = Filter("butterworth", 8, 45.0)
"""A low-pass in place of a recorder's: it is the same for every vehicle, and bands are compared well below."""


def unseen_runs(vehicle: str, rng: np.random.Generator) -> tuple[Run, ...]:
    """Return two runs of 20 s at steady speed over roads of class A and B, known exactly."""
    runs = []
    for roughness in ("A", "B"):
        speed = round(float(rng.uniform(*ROAD_SPEEDS[vehicle][roughness])), 1)
        run = make_run(f"unseen_{roughness}", vehicle, speed, rng, road=Road(roughness, 20.0, EXACT), timed=True)
        runs.append(replace(run, true_speed=speed, wander=0.0, start_error=0.0, hidden_roughness="A"))
    return tuple(runs)


def write_unseen(case: Case, folder: Path) -> None:
    """Write the true vehicle's response on the unseen roads as run files with recordings, the roads as they are from the start on."""
    copy_vehicle(case, folder)
    for run in case.unseen:
        true = drive_past(case, run)
        motion = motion_of(replace(case, logger=None, phones=()), run, true)
        t = np.arange(round((true.end - true.start) * RATE)) / RATE
        channels = {}
        for name, place in motion.places.items():
            for channel, values in (("az", place.up), ("q", place.rate)):
                channels[f"{name}_{channel}"] = sample(SMOOTH.apply(values), motion.start, true.start + t)
        length = max(true.setup.layout.distances.values())
        s = np.arange(-true.at - length - 5.0, run.speed * (true.end + 1.0), 0.01)
        road = Profile(s, true.height(s))
        write_recording(case, Recording(run, true.at, t, channels, channels, {}, road), folder)
