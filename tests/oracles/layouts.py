"""Random vehicles as plain numbers, and as vehicle files."""

from __future__ import annotations

import numpy as np


def random_layout(rng: np.random.Generator) -> dict:
    """Return a random vehicle: one or two groups of hinged bodies, axles of both kinds, links, modules, cabs, rigid loads."""
    n_main = int(rng.integers(1, 7))
    bodies, hinges, axles, links = {}, {}, {}, {}
    n_groups = 2 if n_main > 2 and rng.random() < 0.25 else 1
    group = [0 if i < n_main - (n_groups - 1) else 1 for i in range(n_main)]
    for i in range(n_main):
        mass = float(rng.uniform(2e3, 3e4))
        bodies[f"body{i}"] = {
            "mass": mass,
            "pitch_inertia": mass * float(rng.uniform(2, 9)),
            "motions": ["heave", "pitch"],
            "carried_by": None,
        }
        if i and group[i] == group[i - 1]:
            mates = [j for j in range(i) if group[j] == group[i]]
            mate = int(rng.choice(mates))
            points = [(f"body{mate}", tuple(rng.uniform(-4, 4, 2))), (f"body{i}", tuple(rng.uniform(-4, 4, 2)))]
            order = points if rng.random() < 0.7 else points[::-1]
            stiff = rng.random() < 0.3
            hinges[f"hinge{i}"] = {"points": dict(order), "k": float(rng.uniform(0, 1e5)) * stiff, "c": float(rng.uniform(0, 1e4)) * stiff}
        for _ in range(int(rng.integers(2, 4)) if i == 0 or len(axles) < 20 else 0):
            _add_axle(rng, axles, f"body{i}")
    for i in range(int(rng.integers(0, 4))):
        _add_extra(rng, bodies, links, axles, f"extra{i}", f"body{int(rng.integers(n_main))}")
    if rng.random() < 0.3:
        body = f"body{int(rng.integers(n_main))}"
        links["tether"] = {"points": {"ground": 0.0, body: float(rng.uniform(-3, 3))}, **_spring(rng, 1e5)}
    return {
        "bodies": bodies,
        "hinges": hinges,
        "axles": axles,
        "links": links,
        "second_group": f"body{n_main - 1}" if n_groups == 2 else None,
    }


def _spring(rng: np.random.Generator, k: float) -> dict:
    return {"k": float(k * rng.uniform(0.5, 2)), "c": float(0.01 * k * rng.uniform(0, 2))}


def _add_axle(rng: np.random.Generator, axles: dict, body: str) -> None:
    own = rng.random() < 0.75
    axles[f"axle{len(axles)}"] = {
        "body": body,
        "x": float(rng.uniform(-5, 5)),
        "mass": float(rng.uniform(200, 1200)) if own else None,
        "suspension": _spring(rng, 5e5) if own else None,
        "tyre": {**_spring(rng, 2e6), **({} if rng.random() < 0.5 else {"c": 0.0})},
    }


def _add_extra(rng: np.random.Generator, bodies: dict, links: dict, axles: dict, name: str, carrier: str) -> None:
    mass = float(rng.uniform(100, 5000))
    x, z = (float(item) for item in rng.uniform(-4, 4, 2))
    kind = rng.choice(["module", "cab", "load", "beam", "pitcher"])
    carried = {"body": carrier, "x": x, "z": z}
    motions = {"module": ["heave"], "cab": ["heave", "pitch"], "load": [], "beam": ["heave", "pitch"], "pitcher": ["pitch"]}[kind]
    bodies[name] = {"mass": mass, "pitch_inertia": mass * 1.5, "motions": motions, "carried_by": None if kind == "beam" else carried}
    if kind == "beam":
        links[f"{name}_mount"] = {"points": {name: float(rng.uniform(-0.5, 0.5)), carrier: x}, **_spring(rng, 1e6)}
        for offset in (-0.7, 0.7):
            axles[f"axle{len(axles)}"] = {"body": name, "x": offset, "mass": None, "suspension": None, "tyre": _spring(rng, 2e6)}
    elif kind != "load":
        for side, offset in (("front", 0.8), ("rear", -0.9)):
            if kind == "cab" or side == "front":
                links[f"{name}_{side}"] = {"points": {carrier: x + offset, name: offset}, **_spring(rng, 2e5)}


def to_yaml(layout: dict) -> str:
    """Write a layout as a vehicle file."""
    lines = ["name: random", "bodies:"]
    for name, body in layout["bodies"].items():
        carrier = body["carried_by"]
        extra = f", carried_by: {{body: {carrier['body']}, x: {carrier['x']!r} m, z: {carrier['z']!r} m}}" if carrier else ""
        extra += ", at: -30 m" if name == layout["second_group"] else ""
        motions = ", ".join(body["motions"])
        lines.append(
            f"  {name}: {{mass: {body['mass']!r} kg, pitch_inertia: {body['pitch_inertia']!r} kg m^2, motions: [{motions}]{extra}}}"
        )
    if layout["hinges"]:
        lines.append("hinges:")
    for name, hinge in layout["hinges"].items():
        points = ", ".join(f"{body}: {{x: {float(x)!r} m, z: {float(z)!r} m}}" for body, (x, z) in hinge["points"].items())
        lines.append(f"  {name}: {{{points}, k: {hinge['k']!r} N m/rad, c: {hinge['c']!r} N m s/rad}}")
    lines.append("axles:")
    for name, axle in layout["axles"].items():
        own = f", mass: {axle['mass']!r} kg, suspension: {_yaml_spring(axle['suspension'])}" if axle["mass"] is not None else ""
        lines.append(f"  {name}: {{body: {axle['body']}, x: {axle['x']!r} m{own}, tyre: {_yaml_spring(axle['tyre'])}}}")
    if layout["links"]:
        lines.append("links:")
    for name, link in layout["links"].items():
        points = ", ".join(f"{body}: {{x: {x!r} m}}" for body, x in link["points"].items())
        lines.append(f"  {name}: {{{points}, k: {link['k']!r} N/m, c: {link['c']!r} N s/m}}")
    return "\n".join(lines) + "\n"


def _yaml_spring(spring: dict) -> str:
    return f"{{k: {spring['k']!r} N/m, c: {spring['c']!r} N s/m}}"


def rigid_translation(coordinates: list[str]) -> np.ndarray:
    """Return the coordinate vector of a unit rise of everything."""
    return np.array([0.0 if name.startswith("pitch.") else 1.0 for name in coordinates])
