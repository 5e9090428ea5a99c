"""A step's program carried out number by number, without printing or compiling it."""

from __future__ import annotations

import math
import operator

import numpy as np

from vehgen.codegen.program import SETUP_PHASE, Node, Program
from vehgen.codegen.step_program import StepProgram

OPERATIONS = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv, "**": operator.pow, "neg": operator.neg,
    "min": min, "max": max, "abs": abs, "sqrt": math.sqrt,
}  # fmt: skip


def interpret(step: StepProgram, values: dict[str, float], excitation, keep: int) -> np.ndarray:
    """Return the response of a program in residual form, `shape (n_steps // keep + 1, n_channels)`."""
    program = step.program
    x: list[float] = [0.0] * len(program.operations)
    for name, node in step.parameters.items():
        x[node] = float(values[name])
    x[step.time_step] = excitation.dt
    everything = range(len(x))
    for node in everything:
        if program.value(node) is not None:
            x[node] = program.value(node)
    _run(program, x, [node for node in everything if program.phases[node] == SETUP_PHASE])
    drives = np.hstack([excitation.inputs, excitation.rates, excitation.forces])
    means = 0.5 * (drives + np.vstack([drives[1:], drives[-1:]]))
    sums = means + np.vstack([np.zeros((1, drives.shape[1])), means[:-1]])
    advance, sample = program.reach(node for _, node in step.states), program.reach(step.channels)
    found = []
    for n in range(len(drives)):
        _set(x, step.drives, sums[n])
        _run(program, x, advance)
        for leaf, value in [(leaf, x[node]) for leaf, node in step.states]:
            x[leaf] = value
        if n % keep == 0:
            _set(x, step.drives, drives[n])
            _set(x, step.sample_means, means[n])
            _run(program, x, sample)
            found.append([x[node] for node in step.channels])
    return np.array(found)


def _set(x: list[float], nodes: list[Node], values: np.ndarray) -> None:
    for node, value in zip(nodes, values.tolist(), strict=True):
        x[node] = value


def _run(program: Program, x: list[float], nodes: list[Node]) -> None:
    for node in nodes:
        operation = program.operations[node]
        if operation not in ("leaf", "number"):
            x[node] = OPERATIONS[operation](*(x[item] for item in program.arguments[node]))
