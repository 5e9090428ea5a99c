"""Vehicles that exports are tried on: damped tyres and a ground link, force laws, names that look like code."""

from __future__ import annotations

from vehgen.mechanics import EquationsOfMotion, Place, PointOutput, derive
from vehgen.vehicle import load_vehicle, parse_vehicle

TRUCK = """
name: truck
parameters:
  mB: {value: 6 t, meaning: sprung mass}
  half: {equals: mB/2}
bodies: {body: {mass: mB, pitch_inertia: 20 t m^2}}
axles:
  front: {body: body, x: 2.1 m, mass: 400 kg, suspension: {k: 300 kN/m, c: 12 kN s/m}, tyre: {k: 1.6 MN/m, c: 3 kN s/m}}
  rear: {body: body, x: -1.7 m, mass: 700 kg, suspension: {k: 500 kN/m, c: 18 kN s/m}, tyre: {k: 3.2 MN/m}}
links:
  rope: {body: {x: 0.3 m}, ground: {}, k: 20 kN/m, c: 500 N s/m}
sets:
  heavy: {mB: 9 t}
"""
"""A truck with one damped tyre and a damped link to the ground: two inputs whose rates count."""
FRICTION = "{dry_friction: {force: 800 N}}"
LAWS = {
    "dry_friction": ("suspension", "{force: 800 N}"),
    "asymmetric_friction": ("suspension", "{force: 800 N, ratio: 1.6}"),
    "elasto_plastic": ("suspension", "{force: 300 N, k: 180 kN/m}"),
    "cubic_stiffness": ("suspension", "{k3: 1.0e8 N/m^3}"),
    "quadratic_stiffness": ("suspension", "{k2: 4.0e5 N/m^2}"),
    "progressive_stiffness": ("suspension", "{k: 90 kN/m, start: 4 mm}"),
    "bump_stop": ("suspension", "{k: 450 kN/m, clearance: 10 mm, rebound: 12 mm}"),
    "asymmetric_damping": ("suspension", "{c: 4.5 kN s/m, ratio: 0.4, blow_off: 0.1 m/s, relief: 0.5}"),
    "quadratic_damping": ("suspension", "{c2: 9 kN s^2/m^2}"),
    "damper_free_play": ("suspension", "{c: 4.5 kN s/m, play: 6 mm}"),
    "relaxation": ("suspension", "{k: 45 kN/m, time: 30 ms}"),
    "hysteresis": ("suspension", "{force: 900 N, travel: 3 mm, beta: 0.6}"),
    "tyre_liftoff": ("tyre", "{}"),
    "law": ("suspension", "{force: a*d*abs(d) + b*v*sqrt(abs(v/(1 m/s))), parameters: {a: 2.0e6 N/m^2, b: 100 N s/m}}"),
}
"""Every law of the library and an own one: where it sits on the sedan, and its parameters."""
TEXT = "*/ int x; /* \"; system(\"touch PWNED\"); // \\ ??/\n%{\n'); system('touch PWNED'); ${HOME} </fmiModelDescription> @STEP@\u2028"
"""A text that would become code in a comment or a text of C, MATLAB or XML, were it not held back."""


def truck():
    """Return the truck with damped tyres."""
    return parse_vehicle(TRUCK, "truck")


def sedan_with(*laws: str):
    """Return the sedan with force laws on both axles; `static` travels unless the text says otherwise."""
    parts: dict[str, list[str]] = {}
    for law in laws:
        part, text = LAWS[law]
        parts.setdefault(part, []).append(f"{{{law}: {text}}}")
    own = ", ".join(f"{part}: {{laws: [{', '.join(texts)}]}}" for part, texts in parts.items())
    return parse_vehicle(f"extends: sedan2\nname: sedan\naxles: {{front: {{{own}}}, rear: {{{own}}}}}\n")


def hostile() -> EquationsOfMotion:
    """Return equations of motion whose names no file could bring: made in Python, past the check of names."""
    vehicle = load_vehicle("quarter_car").model_copy(update={"name": TEXT, "title": TEXT, "source": TEXT})
    return derive(vehicle, (PointOutput(TEXT, Place(TEXT, "body"), "acceleration"),), (Place(TEXT + "2", "body"),))
