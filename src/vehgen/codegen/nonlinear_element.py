"""What the generated step of a vehicle with force laws knows of each element that carries them."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from vehgen.codegen.program import Node
from vehgen.mechanics.energies import Element
from vehgen.mechanics.laws import LawStep


@dataclass
class NonlinearElement:
    """A nonlinear element in the program: its rows, compliance, laws and states."""

    number: int
    element: Element
    row: dict[int, Node]
    input_row: dict[int, Node]
    steps: list[LawStep]
    static: Node | None
    rest: Node | None
    states: dict[sp.Symbol, str]
    smooth: bool
    bounded: bool
    friction: bool


@dataclass(frozen=True)
class NonlinearStep:
    """What the laws add to a step: the velocity in its middle, and further states (leaf, value after the step)."""

    middle: list[Node]
    states: list[tuple[Node, Node]]


@dataclass(frozen=True)
class ElementAtBegin:
    """An element as a step begins: its travel, the ground's part of its rate, its rate without the laws, and the slip of its ends."""

    travel: Node
    ground: Node
    free_rate: Node
    moving: Node
