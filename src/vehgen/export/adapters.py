"""Linear equations of motion as objects of other libraries: scipy.signal, python-control, pyyeti."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from importlib import import_module
from typing import Any

import numpy as np

from vehgen.errors import ArgumentError, InputError, did_you_mean, shown
from vehgen.mechanics import ModelLike, all_values, as_model
from vehgen.simulate import StateSpace


def to_scipy(system: StateSpace, inputs: Iterable[str] | None = None) -> Any:
    """Return a system as scipy.signal.StateSpace.

    Parameters
    ----------
    system
        A state space.
    inputs
        Names of the inputs to keep (default: all); scipy.signal.step and impulse want one.

    Raises
    ------
    InputError
        For an input that the system lacks.
    """
    columns = _columns(system, inputs)
    return import_module("scipy.signal").StateSpace(system.A, system.B[:, columns], system.C, system.D[:, columns])


def to_control(system: StateSpace, inputs: Iterable[str] | None = None) -> Any:
    """Return a system as control.StateSpace of python-control, with its names; dots in them become underscores, as it asks.

    Raises
    ------
    InputError
        For an input that the system lacks, and where python-control is not installed.
    """
    columns = _columns(system, inputs)
    kept = [system.inputs[i] for i in columns]
    names = {"inputs": kept, "outputs": list(system.outputs), "states": list(system.states)}
    plain = {key: [name.replace(".", "_") for name in items] for key, items in names.items()}
    return _library("control", "python-control").ss(system.A, system.B[:, columns], system.C, system.D[:, columns], **plain)


def to_pyyeti(model: ModelLike, step: float, values: Mapping[str, float] | None = None, parameter_set: str | None = None) -> Any:
    """Return the second-order equations as a solver of pyyeti, `ode.SolveExp2`: exact for loads that are linear within a step.

    Its `tsolve` takes the load P w + Q w' + F f `shape (n_dof, n_steps)`; :meth:`EquationsOfMotion.numeric` has P, Q and F.

    Parameters
    ----------
    model
        Equations of motion, or a vehicle.
    step
        Time step [s].
    values, parameter_set
        Parameters as in :func:`vehgen.export.export`.

    Raises
    ------
    InputError
        For a vehicle with force laws, and where pyyeti is not installed.
    """
    found = as_model(model)
    if any(element.laws for element in found.elements):
        raise ArgumentError(f"`model`: {found.vehicle.name} has force laws, which pyyeti's linear equations do not carry", "model")
    numeric = found.numeric(all_values(found, values, parameter_set))
    _library("pyyeti", "pyyeti")
    return import_module("pyyeti.ode").SolveExp2(numeric.M, numeric.C, numeric.K, step)


def _columns(system: StateSpace, inputs: Iterable[str] | None) -> list[int]:
    wanted = list(system.inputs if inputs is None else inputs)
    for name in wanted:
        if name not in system.inputs:
            raise ArgumentError(f"`inputs`: no input {shown(name)}; {did_you_mean(str(name), system.inputs)}", "inputs")
    return [system.inputs.index(name) for name in wanted]


def _library(module: str, title: str) -> Any:
    try:
        with np.printoptions():  # pyYeti makes numpy print as of old
            return import_module(module)
    except ModuleNotFoundError as error:
        raise InputError(f"{title} is not installed: pip install 'vehgen[export]'") from error
