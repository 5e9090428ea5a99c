"""The variables of a co-simulation unit, in the order of their value references: parameters, drives, outputs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from vehgen.errors import escaped
from vehgen.export.c_program import CProgram
from vehgen.export.source import ExportSource
from vehgen.files.expressions import parse

Causality = Literal["parameter", "local", "input", "output"]


@dataclass(frozen=True)
class FmuVariable:
    """A variable: its name, unit (none for a plain number), start value (none for an output) and what it is.

    A `local` one is a parameter that cannot be changed, because the static equilibrium was solved for it.
    """

    name: str
    unit: str | None
    causality: Causality
    start: float | None
    meaning: str

    @property
    def variability(self) -> str:
        """How it may change."""
        return {"parameter": "fixed", "local": "constant"}.get(self.causality, "continuous")


def fmu_variables(source: ExportSource, program: CProgram) -> list[FmuVariable]:
    """Return all variables with names of their own; one that is taken is preceded by what it is of."""
    model = source.model
    vehicle, dimensions = model.vehicle, model.vehicle.dimensions
    found: list[FmuVariable] = []
    taken = {"time"}

    def add(kind: str, name: str, unit: str, causality: Causality, start: float | None, meaning: str) -> None:
        plain = escaped(name)
        while plain in taken:
            plain = f"{kind}.{plain}"
        taken.add(plain)
        found.append(FmuVariable(plain, None if unit == "no unit" else unit, causality, start, escaped(meaning)))

    for name in model.parameters:
        own = vehicle.parameters.get(name)
        bound = program.is_bound and own is not None
        meaning = f"moves {name.removesuffix('.shift')} forward" if own is None else own.meaning
        unit = "m" if own is None else str(dimensions[name])
        add("parameter", name, unit, "local" if bound else "parameter", source.values[name], meaning)
    for name in model.inputs:
        add("input", name, "m", "input", 0.0, "height")
    for name in model.inputs:
        add("input", f"{name}.rate", "m/s", "input", 0.0, f"rate at which {name} moves during the next step; at 0 it stays")
    for name in model.forces:
        add("input", f"force.{name}", "N", "input", 0.0, f"upward force at {name}")
    for channel in model.channels:
        add("output", channel.name, channel.unit, "output", None, f"{channel.quantity} of {channel.owner}")
    return found


def base_unit(unit: str) -> dict[str, str] | None:
    """Return the exponents of a unit's base units; None where one is no whole number."""
    radians = {"rad": 1} if unit.startswith("rad") else {}
    dimension = parse(f"1 {unit}").dimension({})
    powers = {"kg": dimension.mass, "m": dimension.length, "s": dimension.time}
    if any(power.denominator != 1 for power in powers.values()):
        return None
    return {name: str(power) for name, power in {**powers, **radians}.items() if power}
