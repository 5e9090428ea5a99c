"""What one core can do at best, measured, and what a kernel's step asks of it, counted."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numba
import numpy as np

from benchmarks.limits.worker import KEEP, models
from vehgen.codegen.kernel_source import cheapest_step
from vehgen.codegen.program import SETUP_PHASE
from vehgen.mechanics import EquationsOfMotion
from vehgen.simulate.benchmark import best_time

WIDTH, TIMES = 96, 1_000_000
"""Doubles that are worked on at once, twelve vectors of eight: enough to hide latency; and how often."""


@dataclass(frozen=True)
class Work:
    """What a step of one individual asks for, with its share of a kept sample.

    Instructions with products fused with sums; those among them that multiply; and the individual's own constants, which are read from the
    first cache: registers cannot hold them. States could stay in registers, and are not counted.
    """

    instructions: int
    products: int
    constants: int


@dataclass(frozen=True)
class Rates:
    """What one core does a ns: products fused with sums, these and as many sums side by side, numbers read from its first cache."""

    fused: float
    mixed: float
    read: float

    def better(self, other: Rates) -> Rates:
        """Return the faster of each."""
        return Rates(max(self.fused, other.fused), max(self.mixed, other.mixed), max(self.read, other.read))

    def arithmetic(self, work: Work) -> float:
        """Return what a step takes whose arithmetic is all that counts [ns]."""
        return max(work.products / self.fused, work.instructions / self.mixed)

    def reading(self, work: Work) -> float:
        """Return what a step takes whose constants are all that counts [ns]."""
        return work.constants / self.read


def _fused(x: Any, factor: float, times: int) -> float:
    for _ in range(times):
        for i in range(WIDTH):
            x[i] = x[i] * factor + factor
    return float(x[0])


def _mixed(x: Any, factor: float, times: int) -> float:
    for _ in range(times):
        for i in range(WIDTH):
            x[i] = x[i] * factor + factor
        for i in range(WIDTH, 2 * WIDTH):
            x[i] = x[i] + factor
    return float(x[0])


def _read(x: Any, factor: float, times: int) -> float:
    total = 0.0
    for _ in range(times):
        sums, products = 0.0, 0.0
        for i in range(8 * WIDTH):
            sums += x[i]
            products += x[i + 8 * WIDTH] * factor
        total = total * factor + sums + products
    return total


def rates() -> Rates:
    """Measure what one core can do."""
    return Rates(_rate(_fused, WIDTH), _rate(_mixed, 2 * WIDTH), _rate(_read, 16 * WIDTH))


def _rate(loop: Callable[..., float], length: int) -> float:
    """Return how many of an array's numbers a loop over them does a ns."""
    compiled: Any = numba.njit(loop, fastmath={"contract", "reassoc", "nsz"})
    raw = np.ones(length + 8)
    start = (-raw.ctypes.data // 8) % 8
    x, times = raw[start : start + length], TIMES * WIDTH // length
    compiled(x, 0.5, 10)
    return length * times / best_time(lambda: compiled(x, 0.5, times), 5) / 1e9


def work_of(names: Iterable[str]) -> dict[str, Work]:
    """Count what the linear ones of the worker's models ask for."""
    every = models()
    return {name: _work(every[name]) for name in names if not any(element.laws for element in every[name].elements)}


def _work(model: EquationsOfMotion) -> Work:
    step = cheapest_step(model)
    program = step.program
    instructions = products = numbers = 0.0
    for results, share in (([node for _, node in step.states], 1.0), (step.channels, 1 / KEEP)):
        nodes = [node for node in program.reach(results) if program.operations[node] != "leaf"]
        own = {item for node in nodes for item in program.arguments[node] if program.phases[item] == SETUP_PHASE}
        instructions += share * program.cost(results)[1]
        products += share * sum(program.operations[node] in "*/" for node in nodes)
        numbers += share * sum(program.operations[item] != "number" for item in own)
    return Work(round(instructions), round(products), round(numbers))
