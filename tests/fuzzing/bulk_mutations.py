"""Files that are large, circular or costly by what they declare, format by format."""

from __future__ import annotations

import json
from dataclasses import replace
from random import Random
from typing import Any

from tests.fuzzing.cases import Case
from tests.fuzzing.hostile import SIZES
from tests.fuzzing.tree_mutations import read_tree

HEAVE = {"mass": "100 kg", "motions": ["heave"]}


def carried(count: int, circle: bool) -> dict[str, Any]:
    """Return a vehicle of bodies of which each carries the next, or all each other."""
    bodies: dict[str, Any] = {"b0": {"mass": "1 t", "pitch_inertia": "1 t m^2"}}
    for i in range(1, count):
        bodies[f"b{i}"] = {"mass": "1 kg", "motions": [], "carried_by": {"body": f"b{i - 1}", "z": "1 mm"}}
    if circle:
        bodies["b0"]["carried_by"] = {"body": f"b{count - 1}"}
    return {
        "bodies": bodies,
        "axles": {"a": {"body": "b0", "x": "1 m", "tyre": {"k": "1 MN/m"}}, "b": {"body": "b0", "tyre": {"k": "1 MN/m"}}},
    }


def chained(count: int) -> dict[str, Any]:
    """Return a road train of hinged bodies."""
    bodies = {f"b{i}": {"mass": "1 t", "pitch_inertia": "1 t m^2"} for i in range(count)}
    hinges = {f"h{i}": {f"b{i}": {"x": "-1 m"}, f"b{i + 1}": {"x": "1 m"}} for i in range(count - 1)}
    axles = {f"a{i}": {"body": f"b{i}", "x": "0.1 m", "tyre": {"k": "1 MN/m"}} for i in range(count)}
    axles["first"] = {"body": "b0", "x": "1 m", "tyre": {"k": "1 MN/m"}}
    return {"bodies": bodies, "hinges": hinges, "axles": axles}


def doubling(count: int, power: bool) -> dict[str, Any]:
    """Return a vehicle whose parameters each use the one before twice: written out they are 2^count long."""
    parameters: dict[str, Any] = {"p0": {"value": "1"}}
    for i in range(1, count):
        parameters[f"p{i}"] = {"equals": f"p{i - 1}**2" if power else f"p{i - 1}*p{i - 1} + p{i - 1}/(1 + p{i - 1})"}
    return {
        "parameters": parameters,
        "bodies": {"b": {"mass": f"1 kg*p{count - 1}", "motions": ["heave"]}},
        "axles": {"a": {"body": "b", "tyre": {"k": "1 kN/m"}}},
    }


def many(count: int) -> dict[str, Any]:
    """Return a vehicle of many axles on one body, linked bodies and sets."""
    bodies: dict[str, Any] = {"b": {"mass": "10 t", "pitch_inertia": "10 t m^2"}, **{f"s{i}": HEAVE for i in range(count)}}
    spring = {"k": "100 kN/m", "c": "1 kN s/m"}
    axles = {
        f"a{i}": {"body": "b", "x": f"{i} mm", "mass": "100 kg", "suspension": spring, "tyre": {"k": "1 MN/m"}} for i in range(count + 2)
    }
    links = {f"l{i}": {"b": {"x": f"{i} mm"}, f"s{i}": {}, "k": "10 kN/m"} for i in range(count)}
    return {
        "bodies": bodies,
        "axles": axles,
        "links": links,
        "parameters": {"p": {"value": 1}},
        "sets": {f"t{i}": {"p": i} for i in range(count)},
    }


def bulk_vehicle(random: Random, case: Case) -> Case:
    """Put a vehicle in place of the file that is large or circular."""
    count = random.choice((2, 10, 40, 100, 1000))
    kind = random.choice(("carried", "circle", "chain", "doubling", "powers", "many", "extends"))
    if kind == "extends":
        names = [f"e{i}.yaml" for i in range(count)]
        last = random.choice((case.main, "sedan2.yaml", names[-1]))
        files = {name: f"extends: {names[i + 1] if i + 1 < count else last}\n".encode() for i, name in enumerate(names)}
        return replace(
            case, files={**case.files, **files, case.main: b"extends: e0.yaml\n"}, mutations=(*case.mutations, f"{kind} {count}")
        )
    data = {
        "carried": lambda: carried(count, False),
        "circle": lambda: carried(count, True),
        "chain": lambda: chained(count),
        "doubling": lambda: doubling(count, False),
        "powers": lambda: doubling(count, True),
        "many": lambda: many(min(count, 300)),
    }[kind]()
    return case.with_text(json.dumps(data, indent=1), (f"{kind} {count}",))


def bulk_run(random: Random, case: Case) -> Case:
    """Add humps, roads, forces or outputs by the hundred, or sizes that multiply."""
    data = read_tree(case)
    if data is None:
        return case
    count = random.choice((10, 100, 1000))
    kind = random.choice(("humps", "sensors", "outputs", "forces", "iso", "rates", "scales"))
    hump = {
        "shape": random.choice(("half_sine", "versine", "trapezoid", "rectangle")),
        "length": random.choice(SIZES) + " m",
        "height": "1 cm",
    }
    body = "block" if "rig" in case.main else "body"
    if kind == "humps":
        data["road"] = [{"hump": {**hump, "length": "0.5 m", "at": f"{i} m"}} for i in range(count)]
    elif kind == "scales":
        data["road"] = [{"hump": {**hump, "at": random.choice(SIZES) + " m"}}]
        data["speed"] = random.choice(SIZES) + " m/s"
    elif kind == "sensors":
        data["sensors"] = {f"s{i}": {"body": body, "channels": {"acceleration": f"c{i}"}} for i in range(count)}
    elif kind == "outputs":
        data["outputs"] = {f"o{i}": {"axle": "front", "quantity": "tyre_force"} for i in range(count)}
    elif kind == "forces":
        data["forces"] = {
            f"f{i}": {"body": body, "harmonic": {"amplitude": "1 N", "frequency": random.choice(SIZES) + " Hz"}} for i in range(count)
        }
    elif kind == "iso":
        data["road"] = [{"iso8608": {"class": random.choice("ABCDEFGHIX"), "seed": random.choice((-1, 0, 2**64, 10**30, 1.5, "1"))}}] * min(
            count, 100
        )
        data["speed"] = random.choice(SIZES) + " m/s"
    else:
        data |= {"step": random.choice(SIZES) + " s", "sample": random.choice(SIZES) + " s", "duration": random.choice(SIZES) + " s"}
    return case.with_text(json.dumps(data, indent=1), (f"{kind} {count}",))


def bulk_entries(random: Random, case: Case) -> Case:
    """Copy every entry below the sections of a file many times."""
    data = read_tree(case)
    if data is None:
        return case
    count = random.choice((10, 100, 1000))
    for value in data.values():
        if isinstance(value, dict) and value:
            first = next(iter(value.values()))
            value.update({f"n{i}": first for i in range(count)})
    return case.with_text(json.dumps(data, indent=1), (f"entries {count}",))
