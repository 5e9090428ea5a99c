"""The step of a kernel as functions of C99: constants once, a step, the outputs at an instant.

The statements come from the program that kernels are printed from, and hold numbered names only: no text of a vehicle file is in them.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from vehgen.codegen.kernel import UNCONVERGED
from vehgen.codegen.newmark import write_step
from vehgen.codegen.printing import C_HELPERS, CPrinter
from vehgen.codegen.program import SAMPLE_PHASE, STEP_PHASE, Node
from vehgen.codegen.step_program import StepProgram
from vehgen.errors import InputError
from vehgen.export.source import ExportSource
from vehgen.mechanics import GRAVITY
from vehgen.mechanics.equilibrium import equilibria


@dataclass(frozen=True)
class CProgram:
    """Bodies of functions, and the numbers that belong to them.

    Attributes
    ----------
    setup, step, outputs
        Lines that set `constants` from `parameters` and `dt`, advance `state`, and set `outputs`.
    helpers
        Functions that they call.
    n_constants, n_states
        Lengths of these arrays.
    static_travels
        Travels from the unloaded position to equilibrium, which follow the parameters in their array [m].
    offsets
        What is added to each output: the static load of a tyre or hinge whose whole load is asked for.
    residual
        The state that holds the worst residual of the force laws [N], None without laws.
    residual_limit
        Above it the laws did not converge [N].
    """

    setup: list[str]
    step: list[str]
    outputs: list[str]
    helpers: list[str]
    n_constants: int
    n_states: int
    static_travels: list[float]
    offsets: list[float]
    residual: int | None
    residual_limit: float

    @property
    def is_bound(self) -> bool:
        """Whether it holds numbers that were solved for the exported parameters, so that these cannot be changed afterwards."""
        return bool(self.static_travels) or any(self.offsets)


def c_program(source: ExportSource) -> CProgram:
    """Return the program of a model.

    Raises
    ------
    InputError
        Where no static equilibrium is found that its laws count from.
    """
    model, written = source.model, write_step(source.model)
    states = [node for _, node in written.states]
    printer = CPrinter(written.program, {STEP_PHASE: states, SAMPLE_PHASE: written.channels}, written.time_step)
    reader = _Reader(written, printer)
    constants = list(printer.constants)
    setup = printer.block(printer.setup, constants, "constants", reader.in_setup)
    step = printer.block(printer.needed[STEP_PHASE], states, "state", reader.in_step)
    outputs = printer.block(printer.needed[SAMPLE_PHASE], written.channels, "outputs", reader.at_sample)
    text = "\n".join((*setup, *step, *outputs))
    nonlinear = any(element.laws for element in model.elements)
    return CProgram(
        setup=setup,
        step=step,
        outputs=outputs,
        helpers=[line for name, line in C_HELPERS.items() if re.search(rf"\b{name}\(", text)],
        n_constants=len(constants),
        n_states=len(states),
        static_travels=_static_travels(source, written),
        offsets=source.static_outputs.tolist(),
        residual=len(states) - 1 if nonlinear else None,
        residual_limit=UNCONVERGED * GRAVITY * model.total_mass(source.values),
    )


class _Reader:
    """How a leaf or constant of the program is read in each function; None for the time step, a plain variable everywhere."""

    def __init__(self, written: StepProgram, printer: CPrinter) -> None:
        self.written, self.printer = written, printer
        parameters = [*written.parameters.values(), *written.static_travels.values()]
        self.parameters = {node: f"parameters[{i}]" for i, node in enumerate(parameters)}
        labels = written.program.labels
        self.states = {labels[leaf]: f"state[{i}]" for i, (leaf, _) in enumerate(written.states)}
        self.drives = {labels[node]: f"drives[{i}]" for i, node in enumerate(written.drives)}

    def in_setup(self, node: Node) -> str | None:
        """Return where a parameter stands."""
        return self.parameters.get(node)

    def in_step(self, node: Node) -> str | None:
        """Return where a constant, a state or a drive stands."""
        if node in self.printer.constants:
            return f"constants[{self.printer.constants[node]}]"
        if self.written.program.operations[node] != "leaf" or node == self.written.time_step:
            return None
        label = self.written.program.labels[node]
        return self.drives.get(label) or self.states[label]

    at_sample = in_step


def _static_travels(source: ExportSource, written: StepProgram) -> list[float]:
    """Return the travels from the unloaded position of the elements whose laws count from there."""
    if not written.static_travels:
        return []
    model = source.model
    rest = equilibria(model, np.array([[source.values[name] for name in model.parameters]], dtype=np.float64))
    if rest.failures:
        raise InputError(f"{model.vehicle.name}: {rest.failures[0]}", model.vehicle.position())
    return [float(value) for value in rest.travels[0, list(written.static_travels)]]
