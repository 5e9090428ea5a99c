"""What vehgen does with a file of each format before any kernel is compiled: load, derive, write the kernel's source.

The only file here that knows vehgen's functions; imported by the worker alone.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path

from tests.fuzzing.healthy import ROOT
from tests.fuzzing.hostile import MARK
from vehgen.cargo import laden_text, load_cargo
from vehgen.cargo.frame_file import load_frame
from vehgen.cargo.module_model import cargo_text, module_model
from vehgen.codegen import write_kernel
from vehgen.effects import EffectLocator, library
from vehgen.effects import effects as all_effects
from vehgen.errors import InputError
from vehgen.fit.prior_data import load_prior_data
from vehgen.fit.problem import Problem, make_problem
from vehgen.fit.recording import read_recording
from vehgen.fit.trial import load_trials
from vehgen.mechanics import ElementOutput, EquationsOfMotion, derive, static_loads
from vehgen.phones import read_export
from vehgen.simulate import lint, load_run, make_scenario, natural_modes
from vehgen.simulate.warnings import spectral_nulls, step_too_coarse
from vehgen.vehicle import Vehicle, load_vehicle, parse_vehicle

STATEMENTS = {"Import", "ImportFrom", "FunctionDef", "Expr", "Assign"}
MODULES = {"math", "numba", "numpy", "vehgen"}


class OwnOutputError(Exception):
    """What vehgen made of a file that it accepted, it cannot read itself."""


class KernelTextError(Exception):
    """A generated kernel holds what it should not."""


def check_kernel(text: str) -> None:
    """Raise when a kernel's source holds a text of the file, or another statement than kernels have."""
    if MARK in text:
        raise KernelTextError("a text of the file stands in the generated kernel")
    for statement in ast.parse(text).body:
        if type(statement).__name__ not in STATEMENTS:
            raise KernelTextError(f"a {type(statement).__name__} stands in the generated kernel")
        names = [alias.name for alias in statement.names] if isinstance(statement, ast.Import) else []
        if isinstance(statement, ast.ImportFrom):
            names.append(statement.module or "")
        if any(name.partition(".")[0] not in MODULES for name in names):
            raise KernelTextError(f"the generated kernel imports {names}")
        if isinstance(statement, ast.Expr) and not isinstance(statement.value, ast.Constant):
            raise KernelTextError("an expression is computed where the generated kernel is imported")


def generate(model: EquationsOfMotion) -> None:
    """Write and check a model's kernel source."""
    check_kernel(write_kernel(model).text)


def vehicle(path: str) -> None:
    """Load a vehicle file, derive its equations, find its static loads and modes, write its kernel."""
    model = derive(load_vehicle(path))
    generate(model)
    static_loads(model)
    natural_modes(model)
    lint(model)


def run(path: str) -> None:
    """Load a run file, derive its vehicle with the run's outputs, build its scenario and inputs, write its kernel."""
    found = load_run(path)
    tyres = [ElementOutput(f"tyre force of {name}", name, "tyre_force") for name in found.vehicle.axles]
    model = derive(found.vehicle, (*found.outputs(), *tyres), found.forces())
    values = model.values(overrides=found.values())
    scenario = make_scenario(found, model, values)
    scenario.excitation(model.wheel_offsets(values))
    for doubts in (spectral_nulls, step_too_coarse):
        list(doubts(model, values, scenario))
    generate(model)


def table(path: str) -> None:
    """Read a run's tables: its scenario's, and its recording."""
    run(path)
    read_recording(load_run(path))


@cache
def tractor() -> Vehicle:
    """Return the bundled five-axle vehicle."""
    return load_vehicle("tractor5")


@cache
def problem() -> Problem:
    """Return a calibration of the bundled five-axle vehicle; facts are about one."""
    folder = ROOT / "tests" / "fuzzing" / "problem"
    return make_problem(load_trials([folder / "run.yaml"], tractor()))


def reread(text: str) -> Vehicle:
    """Return a vehicle from a text that vehgen wrote."""
    try:
        return parse_vehicle(text, "written.yaml")
    except InputError as error:
        raise OwnOutputError(str(error)) from error


def cargo(path: str) -> None:
    """Load a cargo file, put it on a vehicle, and go on with the laden vehicle."""
    model = derive(reread(laden_text(tractor(), load_cargo(path), Path("out"), "laden")))
    generate(model)
    static_loads(model)
    natural_modes(model)


def frame(path: str) -> None:
    """Load a frame file, solve its eigenvalues, and read the cargo file that comes of it."""
    text = cargo_text(module_model(load_frame(path)))
    written = Path("out") / "module_cargo.yaml"
    written.write_text(text, encoding="utf-8")
    try:
        load_cargo(written)
    except InputError as error:
        raise OwnOutputError(str(error)) from error


def facts(path: str) -> None:
    """Load a facts file about the five-axle vehicle."""
    load_prior_data(path, problem())


def effects(path: str) -> None:
    """Load an effects library, and put each new effect at its first place on a vehicle."""
    found = all_effects([path])
    model = derive(tractor())
    values = model.values()
    locator = EffectLocator(tractor(), values)
    for name in list(dict.fromkeys([*found]))[:20]:
        if name in library():
            continue
        for place in found[name].places(tractor(), ())[:1]:
            generate(derive(tractor().with_changes(found[name].change(locator.site(place)))))


def export(path: str) -> None:
    """Read a phone export."""
    read_export(path)


STAGES: dict[str, Callable[[str], None]] = {
    "vehicle": vehicle,
    "run": run,
    "table": table,
    "cargo": cargo,
    "frame": frame,
    "facts": facts,
    "effects": effects,
    "export": export,
}


def warm_up(folders: Iterable[tuple[str, str]]) -> None:
    """Do everything once with healthy files, so that nothing is imported later on; raises where one is refused."""
    problem()
    for format, path in folders:
        STAGES[format](path)
