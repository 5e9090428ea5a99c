"""The vehicle struct of VBI-2D and VEqMon2D (D. Cantero), programs of MATLAB for vehicles on bridges, as a MAT-file.

They count x to the rear, y upwards and a body's rotation so that y(x) = y + x theta: what is pitch nose-down here. The coordinates are the
same in the same order (bodies, then axles, heaves of hinged bodies eliminated), so that the matrices need no change. They apply gravity at
the wheels as static loads, and the road as forces of the tyres: `SysM.N2w` takes the coordinates to the wheels' displacements.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError
from vehgen.export.data_files import texts
from vehgen.export.matlab import mat_bytes
from vehgen.export.source import ExportSource
from vehgen.files.provenance import versions
from vehgen.mechanics import Coordinate

_LETTERS = {"heave": "yB", "pitch": "thetaB", "bending": "etaB", "hop": "yG"}


def write_vbi2d(source: ExportSource) -> dict[str, bytes]:
    """Return the MAT-file with the struct `Veh`.

    Raises
    ------
    InputError
        For a force law, and for a link to the ground: a vehicle of VBI-2D is held by its wheels alone.
    """
    source.refuse_laws("vbi2d")
    model = source.model
    for name in model.inputs:
        kind, _, owner = name.partition(".")
        if kind == "ground":
            raise InputError(
                f"{model.vehicle.name}: the link {owner} to the ground cannot be carried by vbi2d, whose vehicles stand on wheels alone",
                model.vehicle.position("links", owner, key=True),
            )
    return {f"{source.stem}.mat": mat_bytes({"Veh": vehicle_struct(source)})}


def vehicle_struct(source: ExportSource) -> dict[str, Any]:
    """Return the fields of `Veh`: SysM, DOF, Static, Prop, and where they come from."""
    model, numeric = source.model, source.numeric
    vehicle = model.vehicle
    loads = np.array([list(source.loads.axles.values())])
    tyres = [element for element in model.elements if element.kind == "tyre"]
    entries = {(i, j): -value for i, element in enumerate(tyres) for j, value in element.row.items()}
    wheels = model.evaluate_matrix(entries, (len(tyres), model.n_dof), source.values)
    return {
        "SysM": {"M": numeric.M, "C": numeric.C, "K": numeric.K, "N2w": wheels},
        "DOF": degrees_of_freedom(model.coordinates, list(vehicle.bodies), list(vehicle.axles)),
        "Static": {"load": loads, "check": model.total_weight(source.values) - loads.sum()},
        "Prop": {
            "num_wheels": float(len(tyres)),
            "kTk": np.array([model.evaluate_list((element.k for element in tyres), source.values)]),
            "cTk": np.array([model.evaluate_list((element.c for element in tyres), source.values)]),
            "ax_dist": model.wheel_offsets(source.values)[None],
        },
        "name": vehicle.name,
        "source": {
            "coordinates": texts(item.name for item in model.coordinates).astype(object),
            "versions": texts(f"{name} {number}" for name, number in versions().items()).astype(object),
        },
    }


def degrees_of_freedom(coordinates: tuple[Coordinate, ...], bodies: list[str], axles: list[str]) -> NDArray[Any]:
    """Return a struct for each independent coordinate, named as VBI-2D names them: yB1, thetaB1, thetaB2, yG1 ..."""
    found = np.zeros((1, len(coordinates)), dtype=[("name", object), ("type", object), ("dependency", object)])
    for place, item in enumerate(coordinates):
        number = (axles if item.motion == "hop" else bodies).index(item.owner) + 1
        kind = "Rotational" if item.motion == "pitch" else "Displacement"
        found[0, place] = (f"{_LETTERS[item.motion]}{number}", kind, "Independent")
    return found
