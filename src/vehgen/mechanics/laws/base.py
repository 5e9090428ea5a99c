"""What a force law is: an expression of travel, rate and own states, beside the linear k and c of a suspension, tyre, link or hinge.

A step of the kernels is an implicit midpoint rule, so a law says its mean force over a step from the travel `d` and rate `v` in the
middle of the step, and how its states move on. Travel and force are positive in compression and count from static equilibrium (travel
from the unloaded position where the vehicle file says so).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Literal

import sympy as sp

from vehgen.files.units import FORCE, LENGTH, MOMENT, NONE, TIME, Dimension

Kind = Literal["suspension", "tyre", "link", "hinge"]
EVERYWHERE: tuple[Kind, ...] = ("suspension", "tyre", "link", "hinge")


@dataclass(frozen=True)
class LawParameter:
    """A parameter of a law; its dimension is force^a travel^b time^c, so that it fits vertical springs and hinges alike.

    `low` and `high` bound what is physically usual for a heavy vehicle's suspension, in SI units; negative may be only what is `signed`,
    zero not what is `above_zero`, and nothing more than `most`.
    """

    name: str
    powers: tuple[int, int, int]
    meaning: str
    low: float
    high: float
    default: float | None = None
    signed: bool = False
    above_zero: bool = False
    most: float = math.inf

    def refusal(self, value: float) -> str | None:
        """Say what a value must be that it is not; None where it may stand."""
        if value > self.most:
            return f"must be at most {self.most:g}"
        if self.above_zero and value <= 0:
            return "must be above 0"
        return "must not be below 0" if value < 0 and not self.signed else None

    def dimension(self, kind: Kind) -> Dimension:
        """Return its dimension on a suspension, tyre, link (force and length) or hinge (moment and angle)."""
        force, travel = (MOMENT, NONE) if kind == "hinge" else (FORCE, LENGTH)
        result = NONE
        for unit, power in zip((force, travel, TIME), self.powers, strict=True):
            for _ in range(abs(power)):
                result = result * unit if power > 0 else result / unit
        return result


@dataclass(frozen=True)
class LawState:
    """What a law may use: travel d [m] and rate v [m/s] in mid-step, step h [s], the element's k, c and static force, its states.

    `beside` is what the element's other laws make of the step, without friction; only a law that limits the whole force asks for it.
    """

    d: sp.Expr
    v: sp.Expr
    h: sp.Expr
    k: sp.Expr
    c: sp.Expr
    static: sp.Expr
    states: Mapping[str, sp.Symbol] = field(default_factory=dict)
    beside: LawStep = field(default_factory=lambda: LawStep(slope=sp.S.Zero))


@dataclass(frozen=True)
class LawStep:
    """A law over one step.

    Attributes
    ----------
    force
        Mean force over the step [N], an expression of d, v and the states at its start.
    friction
        Bound F of a set-valued Coulomb force: whatever stops the slip, within +-F [N].
    friction_middle
        What that force is within +-F of [N]; 0 where friction is alike both ways.
    states
        The states at the end of the step.
    now
        Force at an instant, from the d, v and states of that instant (without friction).
    slope
        An upper bound of d force/d v in a step that depends on parameters and h alone, where one exists: it spares a division.
    """

    force: sp.Expr = sp.S.Zero
    friction: sp.Expr = sp.S.Zero
    friction_middle: sp.Expr = sp.S.Zero
    states: Mapping[str, sp.Expr] = field(default_factory=dict)
    now: sp.Expr = sp.S.Zero
    slope: sp.Expr | None = None


@dataclass(frozen=True)
class Law:
    """A force law of the library: what it is in words, its parameters and states, and its step.

    `write(motion, parameters)` returns the LawStep; `equation` is plain text; `strength` names the parameter that switches the law off:
    at `neutral` the law adds nothing, whatever its other parameters are. With `limits_all` it acts on what
    all other laws of its element make.
    """

    name: str
    title: str
    equation: str
    meaning: str
    source: str
    strength: str
    parameters: tuple[LawParameter, ...]
    write: Callable[[LawState, Mapping[str, sp.Expr]], LawStep]
    states: tuple[str, ...] = ()
    attaches_to: tuple[Kind, ...] = EVERYWHERE
    limits_all: bool = False
    neutral: float = 0.0


def positive(expression: sp.Expr) -> sp.Expr:
    """Return max(expression, 0)."""
    return sp.Max(expression, 0)


def custom_law(force: sp.Expr, own: Mapping[str, sp.Expr]) -> Law:
    """Return a law whose force is an expression of the symbols d [m], v [m/s] and its own parameters (given as symbols in `own`)."""

    def write(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
        values = {sp.Symbol("d", real=True): motion.d, sp.Symbol("v", real=True): motion.v}
        values |= {sp.Symbol(name, real=True): value for name, value in own.items()}
        found = force.subs(values, simultaneous=True)
        return LawStep(force=found, now=found)

    return Law("law", "Own law", str(force), "an expression in the vehicle file", "", "", (), write)
