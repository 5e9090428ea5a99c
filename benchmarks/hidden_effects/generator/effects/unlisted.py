"""Physically real effects that stand for everything a library of candidates does not hold: the right verdict names their place, not a
law."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from benchmarks.hidden_effects.generator import laws
from benchmarks.hidden_effects.generator.effects.kind import EffectKind, Value, Values, front_body, pins, suspensions
from benchmarks.hidden_effects.generator.effects.structure import spring
from benchmarks.hidden_effects.generator.setup import Setup
from benchmarks.hidden_effects.generator.system import Element, Term

Array = NDArray[np.float64]
AIR_PRESSURE = 6e5


def _fluid_mount(setup: Setup, place: str, p: Values) -> None:
    if p["inertance"] == 0.0:
        return
    name = f"{place}.fluid"
    setup.system.add_coordinate(name, p["inertance"], weightless=True)
    k, c = spring(p["inertance"], p["frequency"], p["damping"])
    setup.system.elements[f"{place}.bulge"] = Element([*setup.suspension(place).terms, Term("coordinate", name, factor=-1.0)], k)
    setup.system.elements[f"{place}.channel"] = Element([Term("coordinate", name)], c=c)


def _position_damping(setup: Setup, place: str, p: Values) -> None:
    setup.add_law(place, laws.POSITION_DAMPING, p["c"], p["travel"])


def _air_spring(setup: Setup, place: str, p: Values) -> None:
    if p["stiffness"] == 0.0:
        return
    area = p["stiffness"] * p["height"] / (laws.KAPPA * AIR_PRESSURE)
    volume = area * p["height"]
    parameters = (area, AIR_PRESSURE, volume, volume * p["volume_ratio"], p["flow_time"], p["heat_time"])
    setup.add_law(place, laws.AIR_SPRING, *parameters, states=(AIR_PRESSURE, AIR_PRESSURE, 0.0))


def _brakes(setup: Setup, place: str, p: Values) -> None:
    def moment(t: Array, duration: float, rng: np.random.Generator) -> Array:
        n = max(round(p["pulses"]), 1)
        starts = (np.arange(n) + rng.uniform(0.1, 0.6, n)) * duration / n
        shares = rng.uniform(0.6, 1.0, n)
        pulses = [share * np.sin(np.pi * np.clip((t - start) / p["length"], 0.0, 1.0)) for start, share in zip(starts, shares, strict=True)]
        return np.asarray(p["moment"] * np.sum(pulses, axis=0))

    setup.forces.append(([Term("pitch", place)], moment))


def _hanger(setup: Setup, place: str, p: Values) -> None:
    mass = p["mass_share"] * setup.layout.axles[place].mass
    if mass == 0.0:
        return
    name = f"{place}.hanger"
    setup.system.add_coordinate(name, mass)
    k, c = spring(mass, p["frequency"], p["damping"])
    setup.system.elements[name] = Element([Term("coordinate", place), Term("coordinate", name, factor=-1.0)], k, c)


def _hinge_compliance(setup: Setup, place: str, p: Values) -> None:
    if p["compliance"] == 0.0:
        return
    terms = setup.system.constraints.pop(f"{place}.heave")
    k = 1.0 / p["compliance"]
    setup.system.elements[f"{place}.heave"] = Element(terms, k, k * p["time"])


UNLISTED = (
    EffectKind(
        "fluid_mount", "a spring kb in series with fluid in a channel: f = kb (d - y), inertance y'' + r y' = kb (d - y); kb, r "
        "from frequency and damping ratio", suspensions,
        (
            Value("inertance", "kg", "fluid inertia times the squared area ratio", (0.15, 0.4), (1.0, 3.0), "axle mass", 0.0),
            Value("frequency", "Hz", "of the fluid against the bulge stiffness", (4.0, 9.0), (4.0, 9.0)),
            Value("damping", "-", "damping ratio of the channel", (0.1, 0.3), (0.1, 0.3)),
        ), _fluid_mount, listed=False,
    ),
    EffectKind(
        "position_damping", "a damper with a bypass groove, weak near ride height: f = c (d/travel)^2 v", suspensions,
        (
            Value("c", "N s/m", "damping added at `travel`", (0.3, 0.8), (2.0, 6.0), "c", 0.0),
            Value("travel", "m", "where it is added", (1.0, 1.0), (1.0, 1.0), "d"),
        ), _position_damping, listed=False,
    ),
    EffectKind(
        "two_chamber_air_spring",
        "an air spring and a tank joined by an orifice, both exchanging heat with their walls: f = A (P1 - p0), gas laws in "
        "laws.py, flow with the root of the pressure difference; "
        f"p0 = {AIR_PRESSURE:g} Pa, A = stiffness height/(1.4 p0)",
        suspensions,
        (
            Value("stiffness", "N/m", "fast (adiabatic, closed orifice) stiffness", (0.15, 0.3), (0.8, 2.0), "k", 0.0),
            Value("height", "m", "of the spring's air column, volume over area", (4.0, 8.0), (4.0, 8.0), "d"),
            Value("volume_ratio", "-", "tank over spring volume", (1.0, 4.0), (1.0, 4.0)),
            Value("flow_time", "s", "time scale of the orifice", (0.1, 0.6), (0.1, 0.6)),
            Value("heat_time", "s", "time scale of the heat exchange", (0.3, 1.5), (0.3, 1.5)),
        ), _air_spring, listed=False,
    ),
    EffectKind(
        "brake_pulses", "half-sine moments on the body, nose-down, at random times, of random size up to `moment`: a driver who "
        "dabs the brakes", front_body,
        (
            Value("moment", "N m", "of the largest pulse", (0.008, 0.015), (0.04, 0.12), "weight length", 0.0),
            Value("length", "s", "of a pulse", (0.3, 0.6), (0.3, 0.6)),
            Value("pulses", "-", "in a run", (2.0, 5.0), (2.0, 5.0)),
        ), _brakes, listed=False,
    ),
    EffectKind(
        "axle_hanger", "a mass on a spring-damper that hangs on an axle, free in heave: brake gear, a lift-axle bracket, a loose "
        "wheel carrier", suspensions,
        (
            Value("mass_share", "-", "mass over the axle's", (0.04, 0.1), (0.25, 0.5), neutral=0.0),
            Value("frequency", "Hz", "on the held axle", (7.0, 16.0), (7.0, 16.0)),
            Value("damping", "-", "damping ratio", (0.02, 0.06), (0.02, 0.06)),
        ), _hanger, listed=False,
    ),
    EffectKind(
        "hinge_compliance", "the pin gives vertically: a spring 1/compliance and a damper time/compliance in place of the rigid "
        "joint; fore-aft it stays pinned", pins,
        (
            Value("compliance", "m/N", "1/stiffness", (0.05, 0.15), (0.5, 2.0), "1/k", 0.0),
            Value("time", "s", "damping over stiffness", (0.002, 0.006), (0.002, 0.006)),
        ), _hinge_compliance, listed=False,
    ),
)  # fmt: skip
