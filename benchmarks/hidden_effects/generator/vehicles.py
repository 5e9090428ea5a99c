"""The two vehicles of the trials: nominal parameters, ranges, tape measures, and their layout as rigid bodies, a pin and axles.

The numbers are those of models/sedan2.yaml and models/tractor5.yaml (Wu & Li 2023, doi:10.3390/s23249691), copied so that nothing of
vehgen runs here; a test compares the copies with the files.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

VEHICLES = ("sedan2", "tractor5")


@dataclass(frozen=True)
class Parameter:
    """A nominal value in SI units and, for one that a calibration may search, its range."""

    value: float
    range: tuple[float, float] | None = None


def _sedan2() -> dict[str, Parameter]:
    m = 1500.0
    return {
        "mH": Parameter(m),
        "wheelbase": Parameter(2.8),
        "Lf": Parameter(1.18, (0.9, 1.9)),
        "mf": Parameter(0.06 * m, (20.0, 250.0)),
        "mr": Parameter(0.10 * m, (20.0, 300.0)),
        "IZ": Parameter(1.76 * m, (1200.0, 4500.0)),
        "kf": Parameter(41.67 * m, (20e3, 150e3)),
        "kr": Parameter(47.77 * m, (20e3, 150e3)),
        "cf": Parameter(2.18 * m, (0.5e3, 10e3)),
        "cr": Parameter(2.97 * m, (0.5e3, 10e3)),
        "ktf": Parameter(448.76 * m, (300e3, 2e6)),
        "ktr": Parameter(408.65 * m, (300e3, 2e6)),
    }


def _tractor5() -> dict[str, Parameter]:
    m = 8000.0
    table = {
        "mT": Parameter(m),
        "mS": Parameter(4.77 * m, (12e3, 48e3)),
        "IT": Parameter(45.75 * m, (10e3, 500e3)),
        "IS": Parameter(95.89 * m, (100e3, 1200e3)),
        "a1": Parameter(0.97, (0.0, 1.5)),
        "a2": Parameter(0.82, (-1.5, 1.5)),
        "L12": Parameter(3.46),
        "L13": Parameter(4.80),
        "L1h": Parameter(3.75),
        "Lh4": Parameter(8.50),
        "Lh5": Parameter(9.73),
        "b1": Parameter(1.32, (0.8, 2.2)),
        "b6": Parameter(4.14, (3.5, 7.5)),
    }
    rows = zip(
        (0.11, 0.40, 0.48, 0.57, 0.34),
        (198.83, 93.02, 869.88, 537.26, 1313.27),
        (12.57, 33.04, 6.80, 36.52, 23.60),
        (1460.53, 4488.70, 4360.85, 2689.24, 808.00),
        strict=True,
    )
    for i, (mass, k, c, kt) in enumerate(rows, start=1):
        steer = i == 1
        table[f"m{i}"] = Parameter(mass * m, (160.0, 3200.0 if steer else 6400.0))
        table[f"k{i}"] = Parameter(k * m, (200e3, 3e6) if steer else (100e3, 15e6))
        table[f"c{i}"] = Parameter(c * m, (5e3, 200e3) if steer else (10e3, 400e3))
        table[f"kt{i}"] = Parameter(kt * m, (2e6, 20e6) if steer else (2e6, 50e6))
    return table


NOMINAL: dict[str, dict[str, Parameter]] = {"sedan2": _sedan2(), "tractor5": _tractor5()}


def nominal(vehicle: str) -> dict[str, float]:
    """Return the nominal parameters of a vehicle, SI units."""
    return {name: parameter.value for name, parameter in NOMINAL[vehicle].items()}


def perturbed(vehicle: str, seed: int, spread: float = 0.05) -> dict[str, float]:
    """Return parameters whose calibratable ones are off by a random factor exp(N(0, spread)), cut at 2.5 spreads and at the range."""
    rng = np.random.default_rng([seed, 11])
    values = {}
    for name, parameter in NOMINAL[vehicle].items():
        values[name] = parameter.value
        if parameter.range is not None:
            factor = np.exp(spread * np.clip(rng.standard_normal(), -2.5, 2.5))
            values[name] = float(np.clip(parameter.value * factor, *parameter.range))
    return values


@dataclass(frozen=True)
class Body:
    """A rigid body: mass [kg], pitch inertia about its COG [kg m^2], and where its COG lies ahead of the front axle [m] (negative:
    behind)."""

    mass: float
    inertia: float
    along: float


@dataclass(frozen=True)
class Axle:
    """An unsprung mass [kg] under a body at x [m] ahead of its COG, with suspension k, c and tyre kt [N/m, N s/m, N/m]."""

    body: str
    x: float
    mass: float
    k: float
    c: float
    kt: float


@dataclass(frozen=True)
class Pin:
    """The fifth wheel: one point, (x, z) from the COG of each of the two bodies [m]."""

    front: str
    front_at: tuple[float, float]
    rear: str
    rear_at: tuple[float, float]


@dataclass(frozen=True)
class Layout:
    """What a vehicle consists of. `distances` are how far each axle runs behind the first [m]."""

    bodies: dict[str, Body]
    axles: dict[str, Axle]
    pins: dict[str, Pin]

    @property
    def distances(self) -> dict[str, float]:
        """How far every axle runs behind the first [m]."""
        along = {name: self.bodies[axle.body].along + axle.x for name, axle in self.axles.items()}
        first = max(along.values())
        return {name: first - x for name, x in along.items()}

    def place(self, body: str, behind: str, distance: float) -> float:
        """Return x from the body's COG [m] of the place `distance` behind an axle or pin of that body."""
        if behind in self.axles and self.axles[behind].body == body:
            return self.axles[behind].x - distance
        pin = self.pins[behind]
        return (pin.front_at if pin.front == body else pin.rear_at)[0] - distance


def layout(vehicle: str, p: Mapping[str, float]) -> Layout:
    """Return the layout of a vehicle with the parameters p (SI units)."""
    if vehicle == "sedan2":
        return Layout(
            {"body": Body(p["mH"], p["IZ"], -p["Lf"])},
            {
                "front": Axle("body", p["Lf"], p["mf"], p["kf"], p["cf"], p["ktf"]),
                "rear": Axle("body", p["Lf"] - p["wheelbase"], p["mr"], p["kr"], p["cr"], p["ktr"]),
            },
            {},
        )
    if vehicle != "tractor5":
        raise ValueError(f"unknown vehicle {vehicle!r}; one of {', '.join(VEHICLES)}")
    x = {1: p["b1"], 2: p["b1"] - p["L12"], 3: p["b1"] - p["L13"], 4: p["b6"] - p["Lh4"], 5: p["b6"] - p["Lh5"]}
    axles = {
        f"axle{i}": Axle("tractor" if i < 4 else "semitrailer", x[i], p[f"m{i}"], p[f"k{i}"], p[f"c{i}"], p[f"kt{i}"]) for i in range(1, 6)
    }
    return Layout(
        {"tractor": Body(p["mT"], p["IT"], -p["b1"]), "semitrailer": Body(p["mS"], p["IS"], -p["L1h"] - p["b6"])},
        axles,
        {"fifth_wheel": Pin("tractor", (p["b1"] - p["L1h"], p["a1"]), "semitrailer", (p["b6"], p["a2"]))},
    )
