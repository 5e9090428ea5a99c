"""Matrices and names as JSON and as NumPy's archive of arrays."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vehgen.export.matrix_data import MatrixData, matrix_data, plain
from vehgen.export.source import ExportSource

Arrays = dict[str, NDArray[Any]]


def write_json(source: ExportSource) -> dict[str, bytes]:
    """Return the JSON file."""
    return {f"{source.stem}.json": (_json_text(plain(matrix_data(source))) + "\n").encode()}


def write_npz(source: ExportSource) -> dict[str, bytes]:
    """Return the archive of arrays; texts are arrays of unicode, so that nothing needs to be unpickled."""
    source.refuse_laws("npz")
    stream = io.BytesIO()
    arrays = flat_arrays(matrix_data(source))
    np.savez_compressed(stream, allow_pickle=False, **arrays)
    return {f"{source.stem}.npz": stream.getvalue()}


def flat_arrays(data: MatrixData) -> Arrays:
    """Return all of the data (but force laws) as arrays by name: matrices of numbers, lists of texts."""
    found: Arrays = {name: getattr(data, name) for name in ("M", "C", "K", "P", "Q", "F", "weight")}
    for name, array in vars(data.output_matrices).items():
        found[f"output_{name}"] = array
    for kind in ("coordinate", "input", "force", "output"):
        items = getattr(data, f"{kind}s")
        found[f"{kind}_names"] = texts(item.name for item in items)
        found[f"{kind}_units"] = texts(item.unit for item in items)
    found["parameter_names"] = texts(item.name for item in data.parameters)
    found["parameter_values"] = np.array([item.value for item in data.parameters], dtype=np.float64)
    found["parameter_units"] = texts(item.unit for item in data.parameters)
    found["axle_names"] = texts(data.static.axles)
    found["axle_offsets"] = np.array(list(data.axle_offsets.values()), dtype=np.float64)
    found["static_axle_loads"] = np.array(list(data.static.axles.values()), dtype=np.float64)
    found["hinge_names"] = texts(data.static.hinges)
    found["static_hinge_forces"] = np.array(list(data.static.hinges.values()), dtype=np.float64)
    found["static_displacement"] = data.static.displacement
    found["static_outputs"] = data.static.outputs
    found["vehicle"] = np.array(data.vehicle.name)
    found["equation"] = np.array(data.equation)
    found["output_equation"] = np.array(data.output_equation)
    found["versions"] = texts(f"{name} {number}" for name, number in data.versions.items())
    return found


def texts(items: Any) -> NDArray[Any]:
    """Return texts as an array of unicode, also where there is none."""
    return np.array(list(items), dtype=np.str_).reshape(-1)


def _json_text(data: Any, indent: str = "") -> str:
    """Return JSON that people can read: rows of numbers, and mappings of plain values, on one line each."""
    parts = data.values() if isinstance(data, dict) else data if isinstance(data, list) else ()
    if not parts or (indent and not any(isinstance(item, (dict, list)) for item in parts)):
        return json.dumps(data, allow_nan=False)
    inner = indent + " "
    lines = list(_json_parts(data, inner))
    opening, closing = ("{", "}") if isinstance(data, dict) else ("[", "]")
    return f"{opening}\n" + ",\n".join(f"{inner}{line}" for line in lines) + f"\n{indent}{closing}"


def _json_parts(data: Any, indent: str) -> Iterator[str]:
    if isinstance(data, dict):
        for key, value in data.items():
            yield f"{json.dumps(key)}: {_json_text(value, indent)}"
    else:
        for value in data:
            yield _json_text(value, indent)
