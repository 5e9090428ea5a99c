"""Plain mistakes of measuring: which run or sensor of a healthy case each concerns, and what it changes in the plan of a case."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from benchmarks.hidden_effects.generator.system import GRAVITY
from benchmarks.hidden_effects.generator.vehicles import perturbed
from benchmarks.measured_world.cases import Case, Fault, Recording, Run
from benchmarks.measured_world.chain import Filter
from benchmarks.measured_world.hump import Hump
from benchmarks.measured_world.logger import with_filter
from benchmarks.measured_world.plans import make_road_run
from benchmarks.measured_world.spoiling import Spoil, clipped, copied, dead, each, exchanged, late, moved

Plan = Callable[[Case, np.random.Generator], Case]
SLOW_FILTER = Filter("butterworth", 4, 8.0)


@dataclass(frozen=True)
class Kind:
    """A kind of mistake: what it changes in the plan of a case, noting the fault, and what in the recordings."""

    plan: Plan
    spoil: Spoil | None = None


def with_fault(case: Case, kind: str, rng: np.random.Generator) -> Case:
    """Return a case in which a mistake of a kind is made. Raises KeyError for an unknown kind."""
    planned = FAULTS[kind].plan(case, rng)
    assert planned.fault is not None
    return replace(planned, fault=replace(planned.fault, kind=kind))


def spoilt(case: Case, recordings: list[Recording]) -> list[Recording]:
    """Return the recordings of a case with its mistake."""
    if case.fault is None:
        return recordings
    spoil = FAULTS[case.fault.kind].spoil
    return recordings if spoil is None else spoil(case.fault, recordings)


def _channel(quantity: str = "", everywhere: bool = True, size: tuple[float, float] = (0.0, 1.0)) -> Plan:
    """Return a plan that concerns one channel, `quantity` az, q or either, in all runs or in one."""

    def plan(case: Case, rng: np.random.Generator) -> Case:
        sensor = str(rng.choice([item.name for item in case.sensors]))
        item = f"{sensor}_{quantity or rng.choice(['az', 'q'])}"
        names = tuple(run.name for run in case.runs)
        runs = names if everywhere else (str(rng.choice(names)),)
        return replace(case, fault=Fault("", runs, (item,), float(rng.uniform(*size))))

    return plan


def _exchanged_channels(case: Case, rng: np.random.Generator) -> Case:
    one, other = (item.name for item in case.sensors)
    pair = (f"{one}_az", f"{other}_az") if rng.random() < 0.5 else (f"{one}_az", f"{one}_q")
    return replace(case, fault=Fault("", tuple(run.name for run in case.runs), pair))


def _exchanged_sensors(case: Case, rng: np.random.Generator) -> Case:
    return replace(case, fault=Fault("", tuple(run.name for run in case.runs), tuple(item.name for item in case.sensors)))


def _clocks_apart(case: Case, rng: np.random.Generator) -> Case:
    apart = float(np.exp(rng.uniform(math.log(0.2), math.log(2.0))))
    runs = tuple(replace(run, lead=round(run.lead + apart, 1)) for run in case.runs)
    items = tuple(item.name for item in case.sensors)
    return replace(case, runs=runs, fault=Fault("", tuple(run.name for run in runs), items, apart))


def _change(case: Case, changes: dict[str, dict[str, Any]], size: float = 0.0) -> Case:
    runs = tuple(replace(run, **changes.get(run.name, {})) for run in case.runs)
    return replace(case, runs=runs, fault=Fault("", tuple(changes), (), size))


def _hump_runs(case: Case, rng: np.random.Generator, count: int) -> list[Run]:
    humps = [run for run in case.runs if run.stated_hump is not None]
    return [humps[int(i)] for i in rng.permutation(len(humps))[:count]]


def _restated(run: Run, speed: float) -> dict[str, Any]:
    """Return the changes that state another speed of the same pass; the mark on the road stays where a tape put it."""
    if run.timed:
        return {"speed": speed}
    return {"speed": speed, "lead": run.lead * run.speed / speed}


def _speed_unit(case: Case, rng: np.random.Generator) -> Case:
    run = case.runs[int(rng.integers(len(case.runs)))]
    return _change(case, {run.name: _restated(run, round(run.speed * 3.6, 2))}, 3.6)


def _speed_off(case: Case, rng: np.random.Generator) -> Case:
    run = case.runs[int(rng.integers(len(case.runs)))]
    factor = 1.0 + float(rng.uniform(0.06, 0.15) * rng.choice([-1.0, 1.0]))
    return _change(case, {run.name: _restated(run, round(run.speed * factor, 3))}, factor)


def _speeds_swapped(case: Case, rng: np.random.Generator) -> Case:
    one = _hump_runs(case, rng, 1)[0]
    other = max((run for run in case.runs if run.stated_hump is not None), key=lambda run: abs(run.speed - one.speed))
    return _change(case, {one.name: _restated(one, other.speed), other.name: _restated(other, one.speed)})


def _humps_swapped(case: Case, rng: np.random.Generator) -> Case:
    humps = [run for run in case.runs if run.stated_hump is not None]
    low, high = (pick(humps, key=lambda run: run.stated_hump.height) for pick in (min, max))
    return _change(case, {low.name: {"stated_hump": high.stated_hump}, high.name: {"stated_hump": low.stated_hump}})


def _other_hump(case: Case, rng: np.random.Generator) -> Case:
    run = _hump_runs(case, rng, 1)[0]
    assert run.stated_hump is not None
    shape = "trapezoid" if run.stated_hump.shape != "trapezoid" else "versine"
    factor = float(rng.choice([0.6, 1.6, 1.8]))
    other = Hump(shape, run.stated_hump.length * factor, run.stated_hump.height * float(rng.uniform(0.8, 1.2)))
    return _change(case, {run.name: {"hump": other}}, factor)


def _other_vehicle(case: Case, rng: np.random.Generator) -> Case:
    """Let another vehicle of the same make, laden and with other springs, make one of the runs."""
    run = case.runs[int(rng.integers(len(case.runs)))]
    other = perturbed(case.vehicle, int(rng.integers(2**31)), 0.25)
    laden = {"sedan2": ("mH", "IZ"), "tractor5": ("mS", "IS")}[case.vehicle]
    other |= {name: other[name] * 1.3 for name in laden}
    return _change(case, {run.name: {"parameters": other}})


def _wheelbase(case: Case, rng: np.random.Generator) -> Case:
    """State a distance between axles 20 to 50 cm wrong in the vehicle file."""
    name = "wheelbase" if case.vehicle == "sedan2" else str(rng.choice(["L12", "Lh4", "Lh5"]))
    off = float(rng.uniform(0.2, 0.5) * rng.choice([-1.0, 1.0]))
    stated = round(case.parameters[name] + off, 2)
    return replace(case, stated={name: stated}, fault=Fault("", tuple(run.name for run in case.runs), (name,), off))


def _profile_moved(case: Case, rng: np.random.Generator) -> Case:
    """Have a measured road among the runs, its profile moved by a metre."""
    runs = case.runs
    if all(run.road is None for run in runs):
        runs = (*runs[:3], make_road_run("road", case.vehicle, rng, runs[0].timed))
    concerned = tuple(run.name for run in runs if run.road is not None)
    return replace(case, runs=runs, fault=Fault("", concerned, (), float(rng.choice([-1.0, 1.0]))))


def _near_copies(case: Case, rng: np.random.Generator) -> Case:
    one, other = _hump_runs(case, rng, 2)
    return replace(case, fault=Fault("", (one.name, other.name), (), float(rng.random())))


def _low_passed(case: Case, rng: np.random.Generator) -> Case:
    assert case.logger is not None
    every = tuple(run.name for run in case.runs)
    return replace(case, logger=with_filter(case.logger, SLOW_FILTER), fault=Fault("", every, (), SLOW_FILTER.cutoff))


def _clock_fast(case: Case, rng: np.random.Generator) -> Case:
    assert case.logger is not None
    every = tuple(run.name for run in case.runs)
    return replace(case, logger=replace(case.logger, clock_error=0.1), fault=Fault("", every, (), 0.1))


FAULTS: dict[str, Kind] = {
    "unit_g": Kind(_channel("az"), each(lambda values, fault: values / GRAVITY)),
    "unit_degrees": Kind(_channel("q"), each(lambda values, fault: np.degrees(values))),
    "speed_unit": Kind(_speed_unit),
    "speed_off": Kind(_speed_off),
    "sign_reversed": Kind(_channel(), each(lambda values, fault: -values)),
    "channels_exchanged": Kind(_exchanged_channels, exchanged),
    "sensors_exchanged": Kind(_exchanged_sensors, exchanged),
    "dead_channel": Kind(_channel(), dead),
    "clipped": Kind(_channel(size=(0.35, 0.6)), each(clipped)),
    "low_passed": Kind(_low_passed),
    "clocks_apart": Kind(_clocks_apart, late),
    "speeds_swapped": Kind(_speeds_swapped),
    "humps_swapped": Kind(_humps_swapped),
    "other_hump": Kind(_other_hump),
    "other_vehicle": Kind(_other_vehicle),
    "wheelbase": Kind(_wheelbase),
    "gain_one_run": Kind(_channel(everywhere=False, size=(1.25, 1.25)), each(lambda values, fault: values * fault.size)),
    "profile_moved": Kind(_profile_moved, moved),
    "near_copies": Kind(_near_copies, copied),
    "clock_fast": Kind(_clock_fast),
}
"""The mistakes by name. Where one concerns a channel, its size is a share, a gain or of no meaning."""
