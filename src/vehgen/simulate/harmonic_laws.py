"""What force laws do to harmonic travels: the stiffness that stands for a law at one amplitude, and how it follows the parameters.

A law whose travel is A cos(w t) answers with a periodic force. Its first harmonic over A, a complex stiffness, is the law's describing
function (A. Gelb, W. E. Vander Velde, Multiple-Input Describing Functions and Nonlinear System Design, McGraw-Hill, 1968). Over several
amplitudes it depends on all parameters of a law that some motion shows.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from vehgen.mechanics.energies import Element
from vehgen.mechanics.equations_of_motion import EquationsOfMotion
from vehgen.mechanics.equilibrium import equilibria
from vehgen.mechanics.evaluation import ExpressionSteps
from vehgen.mechanics.law_terms import RATE, REST, STATIC, TIME_STEP, TRAVEL, element_steps
from vehgen.simulate.last_used import LastUsed
from vehgen.simulate.sensitivity import chain_of, total_derivative

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
TRAVELS = (0.001, 0.005, 0.02, 0.06, 0.12, 0.2, 0.3)
"""Amplitudes at which laws are seen [m, rad]: friction and short loops show at the least, stops at more than one of the largest."""
CYCLE_STEPS = 16
"""Steps of a cycle; how many changes numbers, but not which parameters they show."""
CYCLES = 2
"""The last of them counts: memories have begun by then."""
DIFFERENCES = ((1, 4 / 5), (2, -1 / 5), (3, 4 / 105), (4, -1 / 280))
"""Central differences of eighth order (B. Fornberg, Math. Comp. 51 (1988) 699-706): exact to rounding for steps of 1 %."""


@dataclass(frozen=True)
class HarmonicLaw:
    """An element's laws at one amplitude, or their derivative by a parameter: a force of `numbers shape (n,)` [N/m] times the travel.

    Its travel is `row` times the coordinates `shape (n_dof,)` plus `input_row` times the displacement inputs `shape (n_inputs,)`; `read
    shape (n_channels,)` is what channels read of its force. `omega shape (n,)` [rad/s] are the angular frequencies, ascending.
    """

    omega: Array
    numbers: Complex
    row: Array
    input_row: Array
    read: Array

    def stiffness(self, omega: Array) -> Complex:
        """Return its force over its travel at some of its angular frequencies [rad/s], `shape (n, 1, 1)`."""
        return self.numbers[np.searchsorted(self.omega, omega), None, None]


@dataclass(frozen=True)
class LawResponse:
    """The laws of one element at one amplitude, and their derivatives by parameters, in the order of these."""

    law: HarmonicLaw
    derivatives: tuple[HarmonicLaw, ...]


def harmonic_laws(
    model: EquationsOfMotion, values: Mapping[str, float], frequency: Array, names: tuple[str, ...] = ()
) -> list[tuple[LawResponse, ...]]:
    """Return the laws of all elements at each of TRAVELS, with their derivatives by parameters; one empty tuple where there are no laws.

    Parameters
    ----------
    model, values
        The vehicle, and the value of every one of its parameters [SI].
    frequency
        `shape (n,)` [Hz], ascending.
    names
        Parameters of `model.parameters`.
    """
    carrying = [number for number, element in enumerate(model.elements) if element.laws]
    if not carrying:
        return [()]
    omega, rest = 2 * np.pi * frequency, _rest(model, values, names)
    return list(zip(*(_responses(model, values, omega, names, number, rest[:, :, number]) for number in carrying), strict=True))


def _responses(
    model: EquationsOfMotion, values: Mapping[str, float], omega: Array, names: tuple[str, ...], number: int, rest: Array
) -> list[LawResponse]:
    """Return an element's laws at each of TRAVELS."""
    laws = _known.find((id(model), names, number), model, lambda: _ElementLaws(model, names, number))
    parts = laws.rows(values)
    found = []
    for travel in TRAVELS:
        numbers = laws.first_harmonic([values[name] for name in model.parameters], travel, omega, rest) / travel
        law, *moved = (HarmonicLaw(omega, item, *rows) for item, rows in zip(numbers, parts, strict=True))
        found.append(LawResponse(law, tuple(moved)))
    return found


def _rest(model: EquationsOfMotion, values: Mapping[str, float], names: Sequence[str]) -> Array:
    """Return static force and travel of all elements and their derivatives by parameters, `shape (2, 1 + len(names), n_elements)`.

    They are 0 where no law asks for them, or nothing weighs anything.
    """
    found = np.zeros((2, 1 + len(names), len(model.elements)))
    asked = any(term.origin == "unloaded" or term.asks_static for element in model.elements for term in element.laws)
    if not asked or not model.vehicle.gravity:
        return found
    here = np.array([values[name] for name in model.parameters])
    rows, steps = [here], []
    for name in names:
        step = np.zeros(len(here))
        place = model.parameters.index(name)
        step[place] = 0.01 * (abs(here[place]) or 1.0)
        steps.append(step[place])
        rows += [here + sign * count * step for count, _ in DIFFERENCES for sign in (1, -1)]
    standing = equilibria(model, np.array(rows))
    weights = np.array([weight for _, weight in DIFFERENCES])
    for part, at in enumerate((standing.forces, standing.travels)):
        pairs = at[1:].reshape(len(names), len(DIFFERENCES), 2, len(model.elements))
        found[part, 0] = at[0]
        found[part, 1:] = np.einsum("d,pde->pe", weights, pairs[:, :, 0] - pairs[:, :, 1]) / np.reshape(steps, (-1, 1))
    return np.nan_to_num(found)


class _ElementLaws:
    """The laws of one element as a program: force, states at the end of a step, where both act, and the derivatives of all of that."""

    def __init__(self, model: EquationsOfMotion, names: tuple[str, ...], number: int) -> None:
        self.model = model
        element = model.elements[number]
        chains = [chain_of(model, name) for name in names]
        read = [channel.laws.get(number, sp.S.Zero) for channel in model.channels]
        acting = [_entries(element.row, model.n_dof), _entries(element.input_row, len(model.inputs)), read]
        self._widths = np.cumsum([len(part) for part in acting])[:-1]
        whole = [item for part in acting for item in part]
        self._rows = [whole, *([total_derivative(item, chain) for item in whole] for chain in chains)]
        states, step = _written(element)
        expressions, symbols = list(step), [*_symbols(model), TRAVEL, RATE, TIME_STEP, STATIC, REST, *states]
        for i, chain in enumerate(chains):
            own = {symbol: sp.Symbol(f"{symbol.name}_by{i}", real=True) for symbol in (STATIC, REST, *states)}
            symbols += own.values()
            shown = set().union(*(item.free_symbols for item in step)) & {*chain, STATIC, REST}
            known: dict[sp.Expr, sp.Expr] = {}
            expressions += [_derivative(item, {**chain, **own}, known) if shown else sp.S.Zero for item in step]
        self._shape = 1 + len(names), len(step)
        self._steps = ExpressionSteps(expressions, symbols, model.definitions)

    def rows(self, values: Mapping[str, float]) -> list[list[Array]]:
        """Return what is shown of travel and force: row, input row and reading; then their derivatives, parameter by parameter."""
        return [np.split(np.array(self.model.evaluate_list(item, values)), self._widths) for item in self._rows]

    def first_harmonic(self, given: Sequence[float], travel: float, omega: Array, rest: Array) -> Complex:
        """Return the first harmonic of the force on a harmonic travel, and its derivatives, `shape (1 + n_names, n)`.

        Parameters
        ----------
        given
            The values of the model's parameters.
        travel
            Amplitude.
        omega
            `shape (n,)` [rad/s].
        rest
            Static force and travel, and their derivatives, `shape (2, 1 + n_names)`.
        """
        sides, width = self._shape
        memory = np.zeros((sides, width - 1, len(omega)))
        found = np.zeros((sides, len(omega)), dtype=np.complex128)
        for step in range(CYCLES * CYCLE_STEPS):
            angle = 2 * np.pi * (step + 0.5) / CYCLE_STEPS
            motion = travel * np.cos(angle) + 0 * omega, -travel * omega * np.sin(angle), 2 * np.pi / (omega * CYCLE_STEPS)
            resting = [item for side in range(sides) for item in (*rest[:, side], *memory[side])]
            values = np.array([np.broadcast_to(item, omega.shape) for item in self._steps([*given, *motion, *resting])])
            values = values.reshape(sides, width, len(omega))
            memory = values[:, 1:]
            if step >= (CYCLES - 1) * CYCLE_STEPS:
                found += values[:, 0] * (2 / CYCLE_STEPS * np.exp(-1j * angle))
        return found


_known: LastUsed[_ElementLaws] = LastUsed(lambda _: 100_000)


def _written(element: Element) -> tuple[list[sp.Symbol], list[sp.Expr]]:
    """Return the states of an element's laws, and the force over a step with the states at its end; friction slips all along."""
    states: list[sp.Symbol] = []
    force, ends = sp.S.Zero, []
    named = [{name: sp.Symbol(f"_{name}_{place}", real=True) for name in term.law.states} for place, term in enumerate(element.laws)]
    for step, own in zip(element_steps(element.laws, element.k, element.c, named), named, strict=True):
        states += own.values()
        force += step.force + step.friction_middle + step.friction * sp.sign(RATE)
        ends += [step.states[name] for name in own]
    return states, [force, *ends]


def _entries(row: Mapping[int, sp.Expr], width: int) -> list[sp.Expr]:
    return [row.get(i, sp.S.Zero) for i in range(width)]


def _symbols(model: EquationsOfMotion) -> list[sp.Symbol]:
    return [sp.Symbol(name, real=True) for name in model.parameters]


def _derivative(expression: sp.Expr, rates: Mapping[sp.Expr, sp.Expr], known: dict[sp.Expr, sp.Expr]) -> sp.Expr:
    """Return an expression's derivative along those of its symbols, without impulses at jumps, which no step meets.

    sympy's own cannot tell that quotients are real, and leaves |x| and sign(x) of them to be differentiated.
    """
    if expression in known:
        return known[expression]
    inner = [_derivative(item, rates, known) for item in expression.args]
    found: sp.Expr = sp.S.Zero
    if not expression.args:
        found = rates.get(expression, sp.S.Zero)
    elif isinstance(expression, sp.Add):
        found = sp.Add(*inner)
    elif isinstance(expression, sp.Mul):
        rest = [sp.Mul(*expression.args[:i], *expression.args[i + 1 :]) for i in range(len(inner))]
        found = sp.Add(*(one * other for one, other in zip(inner, rest, strict=True)))
    elif isinstance(expression, sp.Pow):
        base, exponent = expression.args
        found = exponent * base ** (exponent - 1) * inner[0]
    elif isinstance(expression, sp.Abs):
        found = sp.sign(expression.args[0]) * inner[0]
    elif isinstance(expression, sp.Max | sp.Min):
        towards = 1 if isinstance(expression, sp.Max) else -1
        last, found = expression.args[0], inner[0]
        for item, moved in zip(expression.args[1:], inner[1:], strict=True):
            taken = sp.Heaviside(towards * (item - last), 0)
            last, found = expression.func(last, item), found + taken * (moved - found)
    known[expression] = found
    return found
