"""Effects that add coordinates or change what is connected: cab, frame bending, walking beam, cargo, engine."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from benchmarks.hidden_effects.generator.effects.kind import EffectKind, Value, Values, front_body, long_body, tandems
from benchmarks.hidden_effects.generator.setup import Setup
from benchmarks.hidden_effects.generator.system import Element, Lump, Term

Array = NDArray[np.float64]


def spring(mass: float, frequency: float, damping: float) -> tuple[float, float]:
    """Return k [N/m] and c [N s/m] of a mass [kg] on a spring-damper of a natural frequency [Hz] and damping ratio."""
    w = 2.0 * math.pi * frequency
    return mass * w * w, 2.0 * damping * mass * w


def _cab(setup: Setup, place: str, p: Values) -> None:
    body = setup.layout.bodies[place]
    mass = p["mass_share"] * body.mass
    if mass == 0.0:
        return
    front = max(axle.x for axle in setup.layout.axles.values() if axle.body == place)
    x, z, inertia = front - p["behind"], p["height"], mass * p["gyration"] ** 2
    setup.system.lumps.append(Lump(place, x, z, -mass, -inertia))
    setup.system.add_body("cab", mass, inertia)
    setup.system.constraints["cab.fore"] = [Term("fore", "cab"), Term("fore", place, x, z, factor=-1.0)]
    k, c = spring(0.5 * mass, p["frequency"], p["damping"])
    for side in (1.0, -1.0):
        offset = side * p["half_base"]
        below, above = Term("heave", place, x + offset), Term("heave", "cab", offset, factor=-1.0)
        setup.system.elements[f"cab mount {side:+.0f}"] = Element([below, above], k, c)


def _bending(setup: Setup, place: str, p: Values) -> None:
    if p["participation"] == 0.0:
        return
    body = setup.layout.bodies[place]
    gyration2, amount = body.inertia / body.mass, p["participation"]

    def shape(x: float) -> float:
        return amount * (x * x / gyration2 - 1.0)

    def slope(x: float) -> float:
        return amount * 2.0 * x / gyration2

    name = f"{place}.bending"
    mass = p["modal_mass_share"] * body.mass
    setup.system.add_coordinate(name, mass, weightless=True)
    setup.system.shapes[place] = (name, shape, slope)
    k, c = spring(mass, p["frequency"], p["damping"])
    setup.system.elements[name] = Element([Term("coordinate", name)], k, c)


def _beam(setup: Setup, place: str, p: Values) -> None:
    if p["share"] == 0.0:
        return
    ahead, behind = place.split("+")
    one, two = setup.suspension(ahead), setup.suspension(behind)
    axle1, axle2 = setup.layout.axles[ahead], setup.layout.axles[behind]
    pivot = axle2.x + p["split"] * (axle1.x - axle2.x)
    terms = [
        Term("coordinate", ahead, factor=p["split"]),
        Term("coordinate", behind, factor=1.0 - p["split"]),
        Term("heave", axle1.body, pivot, factor=-1.0),
    ]
    setup.system.elements[f"beam:{place}"] = Element(terms, p["share"] * (one.k + two.k), p["share"] * (one.c + two.c))
    for element in (one, two):
        element.k *= 1.0 - p["share"]
        element.c *= 1.0 - p["share"]


def _cargo(setup: Setup, place: str, p: Values) -> None:
    mass = p["mass_share"] * setup.layout.bodies[place].mass
    if mass == 0.0:
        return
    setup.system.add_coordinate("cargo", mass)
    setup.system.lumps.append(Lump(place, p["x"], p["height"], mass, 0.0, heaves=False))
    k, c = spring(mass, p["frequency"], p["damping"])
    setup.system.elements["cargo mount"] = Element([Term("heave", place, p["x"]), Term("coordinate", "cargo", factor=-1.0)], k, c)


def _engine(setup: Setup, place: str, p: Values) -> None:
    setup.settle = max(setup.settle, 3.0)

    def force(t: Array, duration: float, rng: np.random.Generator) -> Array:
        turns = p["frequency"] * (t + 0.5 * p["drift"] * t * t / duration)
        return np.asarray(p["amplitude"] * np.sin(2.0 * np.pi * (turns + rng.uniform())))

    setup.forces.append(([Term("heave", place, p["x"])], force))


STRUCTURE = (
    EffectKind(
        "suspended_cab",
        "a part of the body (mass, inertia) stands on two spring-dampers half_base ahead of and behind its own COG; fore-aft it "
        "moves with the body. "
        "The whole is as heavy as before: infinitely stiff mounts give the vehicle without a cab",
        front_body,
        (
            Value("mass_share", "-", "cab mass over the body's", (0.03, 0.05), (0.1, 0.16), neutral=0.0),
            Value("frequency", "Hz", "heave frequency of the cab on the held body", (2.0, 4.0), (2.0, 4.0)),
            Value("damping", "-", "damping ratio in heave", (0.08, 0.2), (0.08, 0.2)),
            Value("half_base", "m", "mounts from the cab's COG", (0.6, 0.9), (0.6, 0.9)),
            Value("gyration", "m", "radius of gyration of the cab", (0.7, 0.9), (0.7, 0.9)),
            Value("behind", "m", "cab's COG behind the first axle", (0.0, 0.5), (0.0, 0.5)),
            Value("height", "m", "cab's COG above the body's", (0.5, 1.0), (0.5, 1.0)),
        ), _cab,
    ),
    EffectKind(
        "frame_bending",
        "a point x ahead of the COG rises by phi(x) eta and turns nose-down by -phi'(x) eta, phi = participation (x^2/r^2 - 1), "
        "r^2 = I/m (no coupling through inertia "
        "with heave and pitch of a symmetric body); modal mass modal_mass_share m on a spring-damper. Suspensions, hinge and "
        "phones feel it",
        long_body,
        (
            Value("frequency", "Hz", "of the body alone", (8.0, 12.0), (4.0, 7.0), "bending"),
            Value("damping", "-", "damping ratio", (0.01, 0.03), (0.01, 0.03)),
            Value("modal_mass_share", "-", "modal mass over the body's (uniform beam: 0.8)", (0.6, 1.0), (0.6, 1.0)),
            Value("participation", "-", "size of the shape", (1.0, 1.0), (1.0, 1.0), neutral=0.0),
        ), _bending,
    ),
    EffectKind(
        "walking_beam",
        "a light beam joins two axles and carries the body at a pivot that splits it: the share `share` of both k and c sits there, travel "
        "split z_ahead + (1 - split) z_behind - z_body(pivot), the rest stays at the axles",
        tandems,
        (
            Value("share", "-", "of stiffness and damping that the beam carries (1: a true walking beam)", (0.2, 0.4), (0.8,
            1.0), neutral=0.0),
            Value("split", "-", "share of the pivot force that the axle ahead carries", (0.45, 0.55), (0.45, 0.55)),
        ), _beam,
    ),
    EffectKind(
        "cargo_module", "an added mass on a spring-damper, free in heave, that moves fore-aft with the body at (x, height)", long_body,
        (
            Value("mass_share", "-", "added mass over the body's", (0.01, 0.03), (0.08, 0.2), neutral=0.0),
            Value("frequency", "Hz", "on the held body", (4.0, 8.0), (4.0, 8.0)),
            Value("damping", "-", "damping ratio", (0.02, 0.06), (0.02, 0.06)),
            Value("x", "m", "ahead of the body's COG", (-0.2, 0.2), (-0.2, 0.2), "length"),
            Value("height", "m", "above the body's COG", (0.2, 1.0), (0.2, 1.0)),
        ), _cargo,
    ),
    EffectKind(
        "engine_harmonic", "F = amplitude sin(2 pi (f t + drift f t^2/(2 T)) + random phase) upwards at x, running before the "
        "recording starts", front_body,
        (
            Value("amplitude", "N", "of the force", (0.006, 0.012), (0.02, 0.06), "weight", 0.0),
            Value("frequency", "Hz", "at the start", (18.0, 30.0), (18.0, 30.0)),
            Value("drift", "-", "relative change of the frequency over the run", (-0.02, 0.02), (-0.02, 0.02)),
            Value("x", "m", "ahead of the body's COG", (0.1, 0.3), (0.1, 0.3), "length"),
        ), _engine,
    ),
)  # fmt: skip
