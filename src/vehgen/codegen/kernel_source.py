"""The source of a kernel: a file that a person can read and numba compiles.

No text of a vehicle or run file stands in it, because it is imported: parameters, coordinates, inputs and channels are numbered, and what
the numbers mean stands in a legend beside it, which nothing reads but people. So vehicles that differ in names alone share one kernel in
the cache, as long as their names sort alike (the order of a sum follows its names).
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from itertools import accumulate
from typing import Any, Literal

import numpy as np

from vehgen.codegen.drive_reads import DriveReads, drive_reads
from vehgen.codegen.legend import kernel_legend
from vehgen.codegen.newmark import write_step
from vehgen.codegen.printing import PythonPrinter
from vehgen.codegen.program import SAMPLE_PHASE, STEP_PHASE, Node
from vehgen.codegen.residual import write_residual_step
from vehgen.codegen.residual_laws import takes_residual_form
from vehgen.codegen.step_program import StepProgram
from vehgen.mechanics.equations_of_motion import EquationsOfMotion

Precision = Literal["double", "single"]
VECTOR = 64
"""Bytes of what a lane's instructions compute at once, in the numbers of the loops: 8 lanes, or 16 in single precision."""
SHORT_STEP = 60
"""Instructions of a step up to which two vectors are computed side by side, one of which computes while the other one waits."""
MOST_HELD = 24
"""States that stay in registers, of which a machine has 16 or 32, if constants do not."""
MOST_REWRITTEN = 2500
"""A step of more operations is not tried in residual form: long chains of hinges couple all with all, and take seconds to write."""
MOST_UNKNOWNS = 40
"""Degrees of freedom up to which a step with laws is written in that form alone: to try both would take longer than is saved."""
STEPS_PER_SAMPLE = 10
"""Steps between kept samples that the choice of a step's form counts with."""


@dataclass(frozen=True)
class KernelSource:
    """A kernel's text with what it costs: operations in setup, per step and per sample.

    `legend` says to people what the numbered names in the text stand for; it is never imported. `static_travels` are the elements
    whose travel from the unloaded position to static equilibrium [m] follows the parameters as further columns. `from_rest` says that its
    states are no displacements and velocities, so that it can only start from rest; `single` that its loops are in single precision.
    `reads` are the drives that it reads.
    """

    text: str
    legend: str
    lanes: int
    operation_counts: dict[str, int]
    n_constants: int
    n_states: int
    nonlinear: bool
    from_rest: bool
    single: bool
    n_dof: int
    n_channels: int
    reads: DriveReads
    static_travels: tuple[int, ...] = ()

    @property
    def number(self) -> type[np.floating[Any]]:
        """The type of the numbers in its arrays."""
        return np.float32 if self.single else np.float64


def write_kernel(
    model: EquationsOfMotion,
    lanes: int | None = None,
    sweeps: int | None = None,
    precision: Precision = "double",
    from_rest: bool = True,
    own_drives: bool = False,
) -> KernelSource:
    """Print the Newmark kernel of a model.

    Parameters
    ----------
    model
        A derived model.
    lanes
        Individuals side by side (default: a vector of them, or two where a step is short).
    sweeps
        How often a step solves for the forces of the laws (default: 2 or 3, as the laws need).
    precision
        Of the arrays and of all arithmetic in the loops; what depends on parameters alone is computed in double and rounded.
    from_rest
        Whether runs start from rest; else the state is displacements and velocities.
    own_drives
        Whether each lane has drives of its own; else all share theirs.
    """
    nonlinear = any(element.laws for element in model.elements)
    step = cheapest_step(model, sweeps) if from_rest else write_step(model, sweeps)
    vector = VECTOR // (4 if precision == "single" else 8)
    lanes = lanes or (vector * 2 if step.step_cost()[1] <= SHORT_STEP else vector)
    widths = tuple(sorted({lanes, min(lanes, vector), min(lanes, vector if nonlinear else vector // 2)}, reverse=True))
    printer = PythonPrinter(
        step.program, {STEP_PHASE: [node for _, node in step.states], SAMPLE_PHASE: step.channels}, step.time_step, precision == "single"
    )
    work = _WorkArray(step, printer, widths, len(model.inputs), own_drives)
    lines = [_header(model, printer, bool(step.sample_means)), *_code(step, printer, work)]
    text = _fold("\n".join(lines) + "\n")
    return KernelSource(
        text,
        kernel_legend(model),
        lanes,
        printer.operation_counts,
        len(printer.constants),
        len(step.states),
        nonlinear,
        bool(step.sample_means),
        printer.single,
        model.n_dof,
        len(step.channels),
        work.reads,
        tuple(step.static_travels),
    )


def cheapest_step(model: EquationsOfMotion, sweeps: int | None = None) -> StepProgram:
    """Return the form of a step that takes fewer instructions; none has more operations than one in displacements and velocities.

    Steps of force laws are written in residual form wherever they can.
    """
    if any(element.laws for element in model.elements):
        fits = takes_residual_form(model) and model.n_dof <= MOST_UNKNOWNS
        return write_residual_step(model, sweeps) if fits else write_step(model, sweeps)
    plain = write_step(model)
    if plain.step_cost()[0] > MOST_REWRITTEN:
        return plain
    residual = write_residual_step(model)
    (operations, instructions), (most, usual) = residual.step_cost(), plain.step_cost()
    saved = usual - instructions + (plain.sample_cost()[1] - residual.sample_cost()[1]) / STEPS_PER_SAMPLE
    return residual if saved > 0 and operations <= most else plain


def _header(model: EquationsOfMotion, printer: PythonPrinter, residual: bool) -> str:
    counts = printer.operation_counts
    state = "State: what is left to be balanced (r) and twice the forces of springs (e, o), the residual form.\n" if residual else ""
    return f'''"""Newmark kernel, generated by vehgen; what its numbered names mean stands in the legend that is written beside it.

Coordinates (u displacement, v velocity): {model.n_dof}.
{state}Parameters (p_): {len(model.parameters)}; those that follow from them (q_): {len(model.definitions)}.
Inputs (w_ displacement, dw_ rate): {len(model.inputs)}. Forces (f_): {len(model.forces)}. Channels: {len(model.channels)}.
Arithmetic operations: {counts["setup"]} once per individual, {counts["step"]} per step, {counts["sample"]} per kept sample.
"""

import math
{chr(10) + "from numba import float32, float64" + chr(10) if printer.single else ""}
from vehgen.codegen.emit_llvm import emit_llvm, entry'''


class _WorkArray:
    """Where the values of a kernel stand in its one array, in rows of lanes."""

    def __init__(self, step: StepProgram, printer: PythonPrinter, widths: tuple[int, ...], n_inputs: int, own: bool) -> None:
        self.step, self.printer, self.widths, self.lanes, self.own = step, printer, widths, widths[0], own
        self.parameters = {node: i for i, node in enumerate([*step.parameters.values(), *step.static_travels.values()])}
        self.states = {step.program.labels[leaf]: i for i, (leaf, _) in enumerate(step.states)}
        used = [set(printer.needed[STEP_PHASE]), set(printer.needed[SAMPLE_PHASE])]
        groups = [(step.drives, used[0]), (step.drives, used[1]), (step.sample_means, used[1])]
        numbers = [[number for number, node in enumerate(nodes) if node in needed] for nodes, needed in groups]
        self.reads = drive_reads(numbers, n_inputs, bool(step.sample_means))
        self.drives = [
            {nodes[number]: self.reads.place(group, number) for number in numbers[group]} for group, (nodes, _) in enumerate(groups)
        ]

    def place(self, section: str, row: int) -> str:
        """Return a row of a section, as it is read and written."""
        return f"work[{section} + {row * self.lanes} + j]"

    def setup_read(self, node: Node) -> str | None:
        """Return how a leaf is read before the first step; None for what is already a variable."""
        if node not in self.parameters:
            return None
        text = self.place("PARAMETERS", self.parameters[node])
        return f"float64({text})" if self.printer.single else text

    def step_read(self, node: Node) -> str | None:
        """Return how a leaf or a constant is read in a step; None for what is already a variable."""
        return self._loop_read(node, self.drives[0], 0)

    def sample_read(self, node: Node) -> str | None:
        """Return how a leaf or a constant is read at a sample; None for what is already a variable."""
        return self._loop_read(node, {**self.drives[1], **self.drives[2]}, self.reads.step_row)

    def _loop_read(self, node: Node, drives: dict[Node, int], before: int) -> str | None:
        if node in self.printer.constants:
            return self.place("CONSTANTS", self.printer.constants[node])
        if node in drives:
            place = drives[node] - before
            return f"drives[{place * self.lanes} + j]" if self.own else f"drives[{place}]"
        name = self.step.program.labels.get(node, "")
        if self.step.program.operations[node] == "leaf" and name in self.states:
            return self.place("STATE", self.states[name])
        return None

    def body(self, nodes: list[Node], results: list[Node], section: str, read: Callable[[Node], str | None]) -> list[str]:
        """Return the body of the loop that computes nodes and stores results in a section."""
        lines, texts = self.printer.statements(nodes, results, read)
        return [*lines, *(f"{self.place(section, row)} = {texts[node]}" for row, node in enumerate(results))]


def _code(step: StepProgram, printer: PythonPrinter, work: _WorkArray) -> list[str]:
    """Return the lines of a kernel after its imports: sections of the work array, bodies of its loops over lanes, and what joins them."""
    constants, states, lanes = list(printer.constants), [node for _, node in step.states], work.lanes
    each, reread = lanes if work.own else 1, len(states) <= MOST_HELD
    when = "after" if work.reads.ends else "before"
    calls = ["        advance(work, active, dt, drives, steps)", "        sample(work, active, dt, kept, 1)"]
    return [
        "",
        "LANES = " + str(lanes),
        *(
            f"{name} = {start * lanes}"
            for name, start in _sections(len(work.parameters), len(constants), len(states), len(step.channels)).items()
        ),
        *_function("constants", work.body(printer.setup, constants, "CONSTANTS", work.setup_read)),
        *_function("step", work.body(printer.needed[STEP_PHASE], states, "STATE", work.step_read)),
        *_function("sample", work.body(printer.needed[SAMPLE_PHASE], step.channels, "KEPT", work.sample_read)),
        "",
        "",
        f"setup = emit_llvm(constants_lane, widths=({VECTOR // 8},), row=0)",
        f"advance = emit_llvm(step_lane, widths={work.widths}, row={work.reads.step_row * each}, reread={reread})",
        f"sample = emit_llvm(sample_lane, widths={work.widths}, row={work.reads.sample_row * each})",
        "",
        "",
        f'@entry("{"f4" if printer.single else "f8"}")',
        "def run(phase, work, active, dt, drives, steps, kept):",
        f'    """Compute what follows from parameters alone (phase 0), or so many steps with the channels of a sample {when} them (1)."""',
        "    if phase == 0:",
        "        setup(work, active, dt, kept, 1)",
        "    else:",
        *(calls if work.reads.ends else reversed(calls)),
    ]


def _function(name: str, body: list[str]) -> list[str]:
    """Return a function of one lane."""
    return ["", "", f"def {name}_lane(work, j, dt, drives):", *(f"    {line}" for line in body or ["pass"])]


def _fold(text: str) -> str:
    """Write `work[STATE + 96 + j]` as `work[1248 + j]`, the one form of it that :func:`vehgen.codegen.emit_llvm.emit_llvm` reads."""
    starts = {name: int(value) for name, value in re.findall(r"^(PARAMETERS|CONSTANTS|STATE|KEPT) = (\d+)$", text, re.M)}
    return re.sub(r"work\[([A-Z]+) \+ (\d+) \+ j\]", lambda match: f"work[{starts[match[1]] + int(match[2])} + j]", text)


def _sections(n_parameters: int, n_constants: int, n_states: int, n_channels: int) -> dict[str, int]:
    """Return where each section of the work array starts, in rows of lanes; WORK is its whole length.

    One array instead of several lets the compiler see from constant distances that no two accesses overlap.
    """
    sizes = (n_parameters, n_constants, n_states, n_channels)
    return dict(zip(("PARAMETERS", "CONSTANTS", "STATE", "KEPT", "WORK"), accumulate(sizes, initial=0), strict=True))
