"""The sets of cases: what is drawn for each kind, by seed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from benchmarks.hidden_effects.generator.cases import SENSORS, SensorSpec
from benchmarks.hidden_effects.generator.library import EffectOption, list_effects
from benchmarks.hidden_effects.generator.vehicles import VEHICLES, perturbed
from benchmarks.measured_world.cases import Case, Run
from benchmarks.measured_world.faults import FAULTS, with_fault
from benchmarks.measured_world.gentle import gentle
from benchmarks.measured_world.logger import draw_logger
from benchmarks.measured_world.phone import draw_phone
from benchmarks.measured_world.plans import calibration_runs, diagnosis_runs
from benchmarks.measured_world.unseen import unseen_runs
from benchmarks.measured_world.world import strength

SETS = {"trial": 1, "sealed": 2}
"""Trial cases may be looked at while something is built; sealed ones judge it, once."""
TAPES = {"sedan2": ("wheelbase",), "tractor5": ("L12", "L13", "L1h", "Lh4", "Lh5")}
TAPE_ERROR = 0.003
"""Standard deviation of what a tape measure says [m]."""
SPREADS = (0.05, 0.10)
"""Standard deviation of the true parameters about the file's, relative: drawn between these for every vehicle."""
NONSENSE = {("sedan2", "suspended_cab")}
"""A sedan has no suspended cab."""
UNDONE = ("sensor_tilt", "sensor_delay", "speed_error")
"""What an import of phones sets right: it turns them upright, sets their clocks and takes the speed from satellites."""
UNLISTED = 0.15
"""Share of hidden effects that stand for what no library holds."""
STRONG = 3.0
"""A hidden effect changes the channels by at least so many standard deviations of the sensors' noise, rms."""
DRAWS = 20
RECORDERS = ("logger", "logger", "phones")
"""Of which one is drawn for a case, where both are wanted."""


def draw_case(set_name: str, seed: int, kind: str, number: int, recorder: str = "mixed") -> Case:
    """Return case `number` of a set; it depends on nothing else. Raises ValueError for an unknown kind, set or recorder."""
    if kind not in KINDS or set_name not in SETS or recorder not in ("logger", "phones", "mixed"):
        raise ValueError(f"no such cases: set {set_name!r}, kind {kind!r}, recorder {recorder!r}")
    rng = np.random.default_rng([SETS[set_name], seed, list(KINDS).index(kind), number])
    vehicle = VEHICLES[number % len(VEHICLES)]
    chosen = str(rng.choice(RECORDERS)) if recorder == "mixed" else recorder
    return KINDS[kind](f"{kind}_{number:03d}", vehicle, chosen, number, rng)


def true_parameters(vehicle: str, rng: np.random.Generator) -> dict[str, float]:
    """Return a true vehicle: searched parameters off by a random 5 to 10 %, taped distances by millimetres."""
    found = perturbed(vehicle, int(rng.integers(2**31)), float(rng.uniform(*SPREADS)))
    for name in TAPES[vehicle]:
        found[name] += float(np.clip(rng.normal(0.0, TAPE_ERROR), -2.0 * TAPE_ERROR, 2.0 * TAPE_ERROR))
    return found


def _sensors(vehicle: str, rng: np.random.Generator) -> tuple[SensorSpec, ...]:
    return tuple(replace(sensor, height=float(rng.uniform(-0.2, 0.6))) for sensor in SENSORS[vehicle])


def _base(name: str, kind: str, vehicle: str, recorder: str, runs: tuple[Run, ...], rng: np.random.Generator) -> Case:
    sensors = _sensors(vehicle, rng)
    names = tuple(sensor.name for sensor in sensors)
    case = Case(name, kind, vehicle, true_parameters(vehicle, rng), sensors, runs, int(rng.integers(2**31)))
    if recorder == "logger":
        return replace(case, logger=draw_logger(names, rng))
    return replace(case, phones=tuple(draw_phone(sensor, len(runs), rng) for sensor in names))


def _healthy(name: str, vehicle: str, recorder: str, number: int, rng: np.random.Generator) -> Case:
    return gentle(_base(name, "healthy", vehicle, recorder, diagnosis_runs(vehicle, False, rng), rng))


def _coverage(name: str, vehicle: str, recorder: str, number: int, rng: np.random.Generator) -> Case:
    case = gentle(_base(name, "coverage", vehicle, recorder, calibration_runs(vehicle, rng), rng))
    return replace(case, unseen=unseen_runs(vehicle, rng))


def _options(vehicle: str, recorder: str, listed: bool) -> dict[str, list[EffectOption]]:
    found: dict[str, list[EffectOption]] = {}
    for option in list_effects(vehicle):
        undone = recorder == "phones" and option.name in UNDONE
        if option.listed == listed and not undone and (vehicle, option.name) not in NONSENSE:
            found.setdefault(option.name, []).append(option)
    return found


def _effects(name: str, vehicle: str, recorder: str, number: int, rng: np.random.Generator) -> Case:
    """Hide one effect: kinds in turn, so that a set of some dozens holds each; the strongest of DRAWS where none is strong enough.

    Humps keep their full height, since many effects show at large travels only; tyres that would leave the road pull at it there,
    unless lift-off is the effect.
    """
    options = _options(vehicle, recorder, rng.random() >= UNLISTED)
    places = options[list(options)[(number // 2) % len(options)]]
    drawn = []
    for _ in range(DRAWS):
        option = places[int(rng.integers(len(places)))]
        sharp = option.name == "tyre_liftoff"
        case = _base(name, "effects", vehicle, recorder, diagnosis_runs(vehicle, sharp, rng), rng)
        case = replace(case, effects=(option.draw(rng, "visible"),))
        found = strength(case)
        drawn.append((found, replace(case, strength=found)))
        if found > STRONG:
            break
    return max(drawn, key=lambda item: item[0])[1]


def _faults(name: str, vehicle: str, recorder: str, number: int, rng: np.random.Generator) -> Case:
    """Make one plain mistake, kinds in turn, each on either vehicle.

    Only recorders' files are spoilt: exports of phones say what their units are.
    """
    case = gentle(_base(name, "faults", vehicle, "logger", diagnosis_runs(vehicle, False, rng), rng))
    return with_fault(case, list(FAULTS)[(number // 2) % len(FAULTS)], rng)


KINDS: dict[str, Callable[[str, str, str, int, np.random.Generator], Case]] = {
    "healthy": _healthy,
    "effects": _effects,
    "faults": _faults,
    "coverage": _coverage,
}
