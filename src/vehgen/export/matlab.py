"""Matrices and names for MATLAB and GNU Octave: MAT-files, one of them of the state space, and a function file that people can read."""

from __future__ import annotations

import io
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import ArgumentError, ModelWarning, escaped, shown
from vehgen.export.data_files import Arrays, flat_arrays, texts
from vehgen.export.identifiers import identifier, is_matlab_identifier, matlab_text
from vehgen.export.matrix_data import MatrixData, matrix_data
from vehgen.export.source import ExportSource
from vehgen.files.provenance import versions
from vehgen.simulate.state_space import state_space

MAT_TITLE_BYTES = 116
"""Length of the text at the head of a MAT-file."""


def write_mat(source: ExportSource) -> dict[str, bytes]:
    """Return the MAT-file (level 5)."""
    source.refuse_laws("mat")
    return {f"{source.stem}.mat": mat_bytes(flat_arrays(matrix_data(source)))}


def write_state_space(source: ExportSource) -> dict[str, bytes]:
    """Return state space as a MAT-file, in which C is the output matrix; rates of inputs are inputs of their own."""
    source.refuse_laws("state-space")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)  # that laws are left out was asked for
        system = state_space(source.model, values=source.values)
    names = {
        "state": (system.states, system.state_units),
        "input": (system.inputs, system.input_units),
        "output": (system.outputs, system.units),
    }
    variables = {"A": system.A, "B": system.B, "C": system.C, "D": system.D, "static_outputs": source.static_outputs}
    for kind, (named, units) in names.items():
        variables |= {f"{kind}_names": texts(named), f"{kind}_units": texts(units)}
    variables["vehicle"] = np.array(source.model.vehicle.name)
    variables["versions"] = texts(f"{name} {number}" for name, number in versions().items())
    return {f"{source.stem}.mat": mat_bytes(variables)}


def mat_bytes(variables: dict[str, Any]) -> bytes:
    """Return a MAT-file; arrays of texts become cell arrays, one-dimensional arrays columns. Equal variables are equal bytes."""
    from scipy.io import savemat

    stream = io.BytesIO()
    savemat(stream, {name: _cells(value) for name, value in variables.items()}, oned_as="column", long_field_names=True)
    title = f"MATLAB 5.0 MAT-file, written by vehgen {versions(())['vehgen']}".encode().ljust(MAT_TITLE_BYTES)
    return title + stream.getvalue()[MAT_TITLE_BYTES:]


def _cells(value: Any) -> Any:
    if isinstance(value, np.ndarray) and value.dtype.kind == "U":
        return value.astype(object) if value.ndim else str(value)
    return value


def write_m(source: ExportSource) -> dict[str, bytes]:
    """Return the function file.

    Raises
    ------
    InputError
        For a force law, and for a file that cannot be called as a function.
    """
    source.refuse_laws("m")
    if not is_matlab_identifier(source.stem):
        raise ArgumentError(
            f"`out`: MATLAB calls a function by its file's name, a letter, then letters, digits and underscores, and no keyword; "
            f"found {shown(source.stem)}, try {identifier(source.stem)}.m",
            "out",
        )
    data = matrix_data(source)
    lines = [*_head(source.stem, data), *_fields(flat_arrays(data)), "end"]
    return {f"{source.stem}.m": ("\n".join(lines) + "\n").encode()}


def _head(name: str, data: MatrixData) -> list[str]:
    """Return the function's first line and its help: what the struct holds and every parameter."""
    return [
        f"function model = {name}()",
        f"%{name.upper()}  Equations of motion of a vehicle about static equilibrium, in SI units:",
        f"%   {data.equation}",
        f"%   {data.output_equation}",
        "% q are the coordinates, w the heights of the road and of ground ends, f forces; z up, pitch nose-down.",
        f"% Written by vehgen {data.versions['vehgen']} from the vehicle {escaped(data.vehicle.name)}. Parameters:",
        *(f"%   {escaped(item.name)} = {item.value!r} {item.unit}{f': {escaped(item.meaning)}' if item.meaning else ''}"
          for item in data.parameters),
        "",
    ]  # fmt: skip


def _fields(arrays: Arrays) -> list[str]:
    lines = []
    for name, array in arrays.items():
        if array.dtype.kind == "U":
            lines += _text_lines(name, array)
        else:
            lines += _number_lines(name, array if array.ndim == 2 else array[:, None])
    return lines


def _text_lines(name: str, array: NDArray[Any]) -> list[str]:
    if array.ndim == 0:
        return [f"  model.{name} = {matlab_text(str(array))};"]
    if not array.size:
        return [f"  model.{name} = cell(0, 1);"]
    return [f"  model.{name} = {{", *(f"    {matlab_text(text)}" for text in array.tolist()), "  };"]


def _number_lines(name: str, matrix: NDArray[np.float64]) -> list[str]:
    if not matrix.size:
        return [f"  model.{name} = zeros({matrix.shape[0]}, {matrix.shape[1]});"]
    return [f"  model.{name} = [", *("    " + ", ".join(repr(value) for value in row) for row in matrix.tolist()), "  ];"]
