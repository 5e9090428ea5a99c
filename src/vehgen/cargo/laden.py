"""From an unladen vehicle and a cargo to the laden vehicle's file, which extends the unladen one.

The cargo becomes a carried body (and, for a module, a link), so that parallel axes, the fore-aft share and the moved COG follow from the
energies. Wu & Li 2023 (doi:10.3390/s23249691), Eqs. 24-28, write them out by hand; docs/cargo.md says where the two differ.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from vehgen.cargo.cargo_file import Cargo, ModuleCargo, RigidCargo, load_cargo
from vehgen.errors import ArgumentError, InputError, did_you_mean, shown
from vehgen.files import check_results, write_text
from vehgen.files.atomic import temporary_file
from vehgen.files.checks import check_known
from vehgen.files.expressions import Expression
from vehgen.files.names import MAX_NAME, as_name, is_identifier
from vehgen.files.yaml_writer import OneLine, even_text, yaml_document
from vehgen.vehicle import VehicleLike, as_vehicle, load_vehicle
from vehgen.vehicle.model import Vehicle
from vehgen.vehicle.parts import ZERO
from vehgen.vehicle.writing import base_reference

Definition = tuple[str, float, str, str]
"""A new parameter: its name without prefix, value [SI], unit and meaning."""


def laden(vehicle: VehicleLike, cargo: Cargo | str | os.PathLike[str], *, out: str | os.PathLike[str], name: str | None = None) -> Vehicle:
    """Put a cargo on a vehicle, write the laden vehicle's file, and return the laden vehicle as read from it.

    Parameters
    ----------
    vehicle
        The unladen vehicle: itself, its file, or the name of a bundled model.
    cargo
        What it carries, or its file.
    out
        The file to write; it extends the unladen vehicle's.
    name
        The laden vehicle's (default: that of its file).

    Raises
    ------
    InputError
        When the vehicle has no such body, hinge or axle, or the laden vehicle would not be valid; nothing is then left behind.
    """
    empty = as_vehicle(vehicle)
    load = cargo if isinstance(cargo, Cargo) else load_cargo(Path(cargo))
    path = Path(out)
    if not empty.files:
        raise ArgumentError(f"`vehicle`: {empty.name} was not read from a file, which the laden vehicle's could extend", "vehicle")
    check_results([path])
    text = laden_text(empty, load, path.parent, as_name(path.stem) if name is None else name)
    try:
        with temporary_file(path.parent) as draft:
            draft.write_text(text, encoding="utf-8")
            load_vehicle(draft)
    except InputError as error:
        raise InputError(f"the laden vehicle would not be valid: {error.message}") from error
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror}") from error
    write_text(path, text)
    return load_vehicle(path)


def laden_text(vehicle: Vehicle, cargo: Cargo, folder: Path, name: str) -> str:
    """Return the file of a vehicle with a cargo on it.

    Parameters
    ----------
    vehicle
        The unladen vehicle, read from a file; its parameters, ranges and sets stay as they are.
    cargo
        What it carries. Cargo on cargo is fine: each gets names of its own.
    folder
        Where the file will stand; `extends` is relative to it.
    name
        The laden vehicle's.

    Raises
    ------
    InputError
        When the vehicle has no such body, hinge or axle, or already uses the cargo's name.
    """
    x, z = _reference(vehicle, cargo)
    load, body = cargo.load, _body_name(vehicle, cargo)
    definitions = _rigid_parameters(load) if isinstance(load, RigidCargo) else _module_parameters(load, cargo.file.behind)
    prefix = _prefix(vehicle, body, [item[0] for item in definitions])
    title = cargo.file.title or ("rigid cargo" if isinstance(load, RigidCargo) else "module")
    empty = (vehicle.title or vehicle.name).removesuffix(", unladen")
    words = {"name": name, "title": even_text(f"{empty}, laden: {title}"), "source": even_text(cargo.file.source)}
    data: dict[str, Any] = {"extends": base_reference(vehicle, folder), **{key: text for key, text in words.items() if text}}
    data["parameters"] = {
        f"{prefix}{item}": {"value": f"{value!r} {unit}", "meaning": even_text(meaning)} for item, value, unit, meaning in definitions
    }
    symbols = {item[0]: Expression.symbol(f"{prefix}{item[0]}") for item in definitions}
    if isinstance(load, RigidCargo):
        data |= _rigid_parts(symbols, body, even_text(title), cargo.file.on, x, z)
    else:
        data |= _module_parts(symbols, body, even_text(title), cargo.file.on, x, z)
    return yaml_document(data)


def _reference(vehicle: Vehicle, cargo: Cargo) -> tuple[Expression, Expression]:
    """Return what the cargo's distances start from: x ahead of and z above the carrier's COG."""
    on, behind = cargo.file.on, cargo.file.behind
    check_known(on, vehicle.bodies, f"{vehicle.name} has no body", cargo.document, "on")
    hinges = {name: hinge.points[on] for name, hinge in vehicle.hinges.items() if on in hinge.points}
    axles = {name: axle for name, axle in vehicle.axles.items() if axle.body == on}
    if behind in hinges:
        return hinges[behind].x, hinges[behind].z
    if behind in axles:
        return axles[behind].x, ZERO
    if behind == on:
        return ZERO, ZERO
    there = "; it is on another body" if behind in {**vehicle.hinges, **vehicle.axles, **vehicle.bodies} else ""
    raise InputError(
        f"{shown(behind)} is no hinge or axle of {shown(on)}, nor {shown(on)} itself{there}; {did_you_mean(behind, [*hinges, *axles, on])}",
        cargo.document.find(("behind",)),
    )


def _body_name(vehicle: Vehicle, cargo: Cargo) -> str:
    taken = {*vehicle.bodies, *vehicle.hinges, *vehicle.axles, *vehicle.links}
    if cargo.file.name is not None:
        names = _names(cargo.file.name, cargo.load)
        if not all(is_identifier(name) for name in names):
            message = f"the cargo's parts would be called {' and '.join(names)}, longer than {MAX_NAME} characters; choose a shorter name"
            raise InputError(message, cargo.document.find(("name",)))
        clash = next((name for name in names if name in taken), None)
        if clash is not None:
            message = f"{vehicle.name} has a part named {shown(clash)} already; choose another name for the cargo"
            raise InputError(message, cargo.document.find(("name",)))
        return cargo.file.name
    base = "cargo" if isinstance(cargo.load, RigidCargo) else "module"
    return next(name for name in _numbered(base) if not taken.intersection(_names(name, cargo.load)))


def _names(body: str, load: RigidCargo | ModuleCargo) -> tuple[str, ...]:
    """Return the names of the parts that a cargo adds to a vehicle."""
    return (body,) if isinstance(load, RigidCargo) else (body, f"{body}_fixed", f"{body}_mount")


def _prefix(vehicle: Vehicle, body: str, items: Iterable[str]) -> str:
    names = list(items)
    return next(f"{base}_" for base in _numbered(body) if not any(f"{base}_{item}" in vehicle.parameters for item in names))


def _numbered(base: str) -> Iterable[str]:
    yield base
    number = 2
    while True:
        yield f"{base}{number}"
        number += 1


def _rigid_parameters(load: RigidCargo) -> list[Definition]:
    inertia: list[Definition] = []
    if load.pitch_inertia is not None:
        inertia = [("pitch_inertia", load.pitch_inertia, "kg m^2", "cargo pitch inertia about its COG")]
    return [
        ("mass", load.mass, "kg", "cargo mass"),
        ("length", load.length, "m", "cargo length"),
        ("height", load.height, "m", "cargo height"),
        ("front", load.front, "m", "front of the cargo behind its reference"),
        ("base", load.base, "m", "floor of the cargo above its reference"),
        *inertia,
    ]


def _module_parameters(load: ModuleCargo, behind: str) -> list[Definition]:
    fixed: list[Definition] = []
    if load.fixed_mass > 0:
        fixed = [("fixed_mass", load.fixed_mass, "kg", "mass of the module that moves with its carrier")]
    return [
        ("mass", load.mass, "kg", "module mass on its spring"),
        *fixed,
        ("stiffness", load.k0, "N/m", "vertical stiffness of the module"),
        ("damping", load.c0, "N s/m", "vertical damping of the module"),
        ("cog_behind_front", load.cog.behind_front, "m", "module COG behind its front"),
        ("cog_above_floor", load.cog.above_floor, "m", "module COG above its floor"),
        ("front", load.front, "m", f"front of the module behind {behind}"),
        ("base", load.base, "m", f"floor of the module above {behind}"),
        ("pitch_inertia", load.pitch_inertia, "kg m^2", "module pitch inertia about its COG"),
    ]


def _rigid_parts(symbols: Mapping[str, Expression], body: str, title: str, on: str, x: Expression, z: Expression) -> dict[str, Any]:
    """Return the body of a rigid cargo."""
    inertia = {"pitch_inertia": symbols["pitch_inertia"]} if "pitch_inertia" in symbols else {}
    return {
        "bodies": {
            body: {
                "title": title,
                "mass": symbols["mass"],
                "size": {"length": symbols["length"], "height": symbols["height"]},
                **inertia,
                "motions": [],
                "carried_by": {
                    "body": on,
                    "x": x - symbols["front"] - symbols["length"] / 2,
                    "z": z + symbols["base"] + symbols["height"] / 2,
                },
            }
        }
    }


def _module_parts(symbols: Mapping[str, Expression], body: str, title: str, on: str, x: Expression, z: Expression) -> dict[str, Any]:
    """Return the bodies of a module and its mount."""
    place = x - symbols["front"] - symbols["cog_behind_front"]
    carried = {"body": on, "x": place, "z": z + symbols["base"] + symbols["cog_above_floor"]}
    sprung = {
        "title": title,
        "mass": symbols["mass"],
        "pitch_inertia": symbols["pitch_inertia"],
        "motions": ["heave"],
        "carried_by": carried,
    }
    bodies = {body: {**sprung, "carried_by": carried}}
    if "fixed_mass" in symbols:
        fixed_title = even_text(f"{title}, fixed part")
        bodies[f"{body}_fixed"] = {"title": fixed_title, "mass": symbols["fixed_mass"], "motions": [], "carried_by": carried}
    mount = {on: {"x": place}, body: {"x": "0 m"}, "k": symbols["stiffness"], "c": symbols["damping"]}
    return {"bodies": bodies, "links": {f"{body}_mount": OneLine(mount)}}
