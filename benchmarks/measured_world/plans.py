"""Which runs an experimenter plans, and how they come out."""

from __future__ import annotations

import numpy as np

from benchmarks.measured_world.cases import Road, Run
from benchmarks.measured_world.hump import Hump, as_it_lies
from benchmarks.measured_world.roads import draw_profiler

SPEEDS = {"sedan2": ((1.8, 2.6), (3.0, 4.2)), "tractor5": ((1.6, 2.2), (2.5, 3.5))}
"""Slow and fast over a hump [m/s]."""
ROAD_SPEEDS = {
    "sedan2": {"A": (8.0, 20.0), "B": (6.0, 15.0), "C": (4.0, 9.0)},
    "tractor5": {"A": (8.0, 20.0), "B": (5.0, 11.0), "C": (2.0, 5.0)},
}
"""Over a measured road [m/s]: rough ones slower, so that no tyre leaves them."""
CALIBRATION_SPEEDS = {"sedan2": (1.5, 2.5, 4.0), "tractor5": (2.0, 3.0, 1.6)}
WANDER = (0.004, 0.015)
SURFACES = {"sedan2": (("A", 0.4, 1.0), ("B", 0.4, 0.7)), "tractor5": (("A", 0.25, 0.6), ("A", 0.6, 1.0))}
"""Where humps lie: class of the road, and limits of the factor of its heights, since people choose smooth places; the second for a
quarter of the runs. Trucks cross lower humps, on smoother yards."""


def _rounded(rng: np.random.Generator, low: float, high: float, digits: int) -> float:
    return round(float(rng.uniform(low, high)), digits)


def make_run(
    name: str,
    vehicle: str,
    speed: float,
    rng: np.random.Generator,
    hump: tuple[Hump, Hump] | None = None,
    road: Road | None = None,
    timed: bool = False,
) -> Run:
    """Return a run at a stated speed [m/s] over a hump (as stated, as it lies) or a measured road; the true speed is 0.5 to 2 % off."""
    error = float(rng.uniform(0.005, 0.02) * rng.choice([-1.0, 1.0]))
    roughness, smoother, full = SURFACES[vehicle][int(rng.random() < 0.25)]
    start = rng.normal(0.0, 0.0005) if timed else np.clip(rng.normal(0.0, 0.01), -0.025, 0.025)
    return Run(
        name=name,
        speed=speed,
        lead=_rounded(rng, 1.8, 3.0, 1),
        true_speed=speed * (1.0 + error),
        wander=float(rng.uniform(*WANDER)),
        correlation=float(rng.uniform(2.0, 4.0)),
        hidden_roughness=roughness,
        hidden_scale=float(rng.uniform(smoother, full)),
        timed=timed,
        start_error=float(start),
        seed=int(rng.integers(2**31)),
        stated_hump=None if hump is None else hump[0],
        hump=None if hump is None else hump[1],
        road=road,
    )


def make_road_run(name: str, vehicle: str, rng: np.random.Generator, timed: bool) -> Run:
    """Return a run of 12 s over a road of class A, B or C whose profile was measured; the approach is of class A."""
    roughness = str(rng.choice(["A", "B", "C"]))
    speed = _rounded(rng, *ROAD_SPEEDS[vehicle][roughness], 1)
    run = make_run(name, vehicle, speed, rng, road=Road(roughness, 12.0, draw_profiler(rng)), timed=timed)
    return Run(**{**vars(run), "hidden_roughness": "A", "hidden_scale": 1.0})


def draw_humps(rng: np.random.Generator, sharp: bool) -> tuple[tuple[Hump, Hump], tuple[Hump, Hump]]:
    """Return a low and a high hump, each as stated and as it lies; `sharp`: the high one is short, so that tyres leave it."""
    shape = str(rng.choice(["half_sine", "versine", "trapezoid"], p=[0.7, 0.15, 0.15]))
    low = Hump(shape, _rounded(rng, 0.45, 0.6, 2), _rounded(rng, 0.025, 0.035, 3))
    high = Hump(shape, 0.4, 0.06) if sharp else Hump(shape, _rounded(rng, 0.45, 0.6, 2), _rounded(rng, 0.045, 0.055, 3))
    return (low, as_it_lies(low, rng)), (high, as_it_lies(high, rng))


def diagnosis_runs(vehicle: str, sharp: bool, rng: np.random.Generator) -> tuple[Run, ...]:
    """Return four runs: two humps at two speeds each, or three passes over humps and a measured road."""
    low, high = draw_humps(rng, sharp)
    slow, fast = (_rounded(rng, *limits, 1) for limits in SPEEDS[vehicle])
    if sharp:
        fast = 5.0 if vehicle == "sedan2" else 3.0
    timed = bool(rng.random() < 0.4)
    plan = [("low_slow", slow, low), ("low_fast", fast, low), ("high_slow", slow, high), ("high_fast", fast, high)]
    if rng.random() < 0.5:
        return tuple(make_run(name, vehicle, speed, rng, hump, timed=timed) for name, speed, hump in plan)
    passes = [make_run(name, vehicle, speed, rng, hump, timed=timed) for name, speed, hump in (plan[0], plan[1], plan[3])]
    return (*passes, make_road_run("road", vehicle, rng, timed))


def calibration_runs(vehicle: str, rng: np.random.Generator) -> tuple[Run, ...]:
    """Return passes over one hump at two or three speeds."""
    hump, _ = draw_humps(rng, False)
    speeds = CALIBRATION_SPEEDS[vehicle][: int(rng.choice([2, 3]))]
    timed = bool(rng.random() < 0.4)
    return tuple(make_run(f"hump{i}", vehicle, speed, rng, hump, timed=timed) for i, speed in enumerate(speeds, start=1))
