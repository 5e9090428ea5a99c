"""State space as a MAT-file, in which C is the output matrix."""

from __future__ import annotations

import warnings

import numpy as np

from vehgen.errors import ModelWarning
from vehgen.export.data_files import texts
from vehgen.export.matlab import mat_bytes
from vehgen.export.source import ExportSource
from vehgen.files.provenance import versions
from vehgen.simulate.state_space import state_space


def write_state_space(source: ExportSource) -> dict[str, bytes]:
    """Return the MAT-file; rates of inputs are inputs of their own."""
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
