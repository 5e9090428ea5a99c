"""From an unladen vehicle and a cargo to the laden vehicle's file, which extends the unladen one.

The cargo becomes a carried body (and, for a module, a link), so that parallel axes, the fore-aft share and the moved COG follow from the
energies. Wu & Li 2023 (doi:10.3390/s23249691), Eqs. 24-28, write them out by hand; docs/cargo.md says where the two differ.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from vehgen.cargo.cargo_file import Cargo, ModuleCargo, RigidCargo, load_cargo
from vehgen.errors import ArgumentError, InputError, did_you_mean, shown
from vehgen.files import check_results, write_text
from vehgen.files.atomic import temporary_file
from vehgen.files.names import MAX_NAME, as_name, is_identifier
from vehgen.vehicle import VehicleLike, as_vehicle, load_vehicle
from vehgen.vehicle.model import Vehicle
from vehgen.vehicle.writing import base_reference, yaml_text, yaml_title

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
    lines = [
        f"extends: {yaml_text(base_reference(vehicle, folder))}",
        f"name: {yaml_text(name)}",
        f"title: {yaml_title(f'{empty}, laden: {title}')}",
        *([f"source: {yaml_title(cargo.file.source)}"] if cargo.file.source else []),
        "parameters:",
    ]
    for item, value, unit, meaning in definitions:
        lines.append(f"  {prefix}{item}: {{value: {value!r} {unit}, meaning: {yaml_title(meaning)}}}")
    if isinstance(load, RigidCargo):
        lines += _rigid_bodies(prefix, body, title, cargo.file.on, x, z, load.pitch_inertia is not None)
    else:
        lines += _module_bodies(prefix, body, title, cargo.file.on, x, z, load.fixed_mass > 0)
    return "\n".join(lines) + "\n"


def _reference(vehicle: Vehicle, cargo: Cargo) -> tuple[str, str]:
    """Return what the cargo's distances start from, as expressions: x ahead of and z above the carrier's COG."""
    on, behind = cargo.file.on, cargo.file.behind
    if on not in vehicle.bodies:
        raise InputError(f"{vehicle.name} has no body {shown(on)}; {did_you_mean(on, vehicle.bodies)}", cargo.document.find(("on",)))
    hinges = {name: hinge.points[on] for name, hinge in vehicle.hinges.items() if on in hinge.points}
    axles = {name: axle for name, axle in vehicle.axles.items() if axle.body == on}
    if behind in hinges:
        return f"({hinges[behind].x})", f"({hinges[behind].z})"
    if behind in axles:
        return f"({axles[behind].x})", "0"
    if behind == on:
        return "0", "0"
    there = "; it is on another body" if behind in {**vehicle.hinges, **vehicle.axles, **vehicle.bodies} else ""
    raise InputError(
        f"{shown(behind)} is no hinge or axle of {on!r}, nor {on!r} itself{there}; {did_you_mean(behind, [*hinges, *axles, on])}",
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
            message = f"{vehicle.name} has a part named {clash!r} already; choose another name for the cargo"
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


def _rigid_bodies(prefix: str, body: str, title: str, on: str, x: str, z: str, has_inertia: bool) -> list[str]:
    return [
        "bodies:",
        f"  {body}:",
        f"    title: {yaml_title(title)}",
        f"    mass: {prefix}mass",
        f"    size: {{length: {prefix}length, height: {prefix}height}}",
        *([f"    pitch_inertia: {prefix}pitch_inertia"] if has_inertia else []),
        "    motions: []",
        f"    carried_by: {{body: {yaml_text(on)}, x: '{x} - {prefix}front - {prefix}length/2', "
        f"z: '{z} + {prefix}base + {prefix}height/2'}}",
    ]


def _module_bodies(prefix: str, body: str, title: str, on: str, x: str, z: str, has_fixed: bool) -> list[str]:
    behind = f"{x} - {prefix}front - {prefix}cog_behind_front"
    carried = f"    carried_by: {{body: {yaml_text(on)}, x: '{behind}', z: '{z} + {prefix}base + {prefix}cog_above_floor'}}"
    lines = [
        "bodies:",
        f"  {body}:",
        f"    title: {yaml_title(title)}",
        f"    mass: {prefix}mass",
        f"    pitch_inertia: {prefix}pitch_inertia",
    ]
    lines += ["    motions: [heave]", carried]
    if has_fixed:
        fixed_title = f"{title}, fixed part"
        lines += [f"  {body}_fixed:", f"    title: {yaml_title(fixed_title)}", f"    mass: {prefix}fixed_mass", "    motions: []", carried]
    mount = f"{{{yaml_text(on)}: {{x: '{behind}'}}, {body}: {{x: 0 m}}, k: {prefix}stiffness, c: {prefix}damping}}"
    return [*lines, "links:", f"  {body}_mount: {mount}"]
