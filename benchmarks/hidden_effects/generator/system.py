"""Newton and Euler for bodies in the pitch plane, with the pin forces kept explicit.

Every body has three coordinates (heave z, fore-aft x, pitch theta, nose-down positive), every axle one (heave). A point (xi, eta) of a
body moves by z - xi*theta and x + eta*theta. Springs, dampers and laws act along `Element`s of travel d = (lower - upper) point: a force
f in compression pushes the lower point down and the upper one up. Pins are constraints J q = 0, whose forces r follow with the
accelerations from

    [ M  J' ] [ a ]   [ applied forces ]
    [ J  0  ] [-r ] = [       0        ]

solved once for all right-hand sides (`mobility`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from benchmarks.hidden_effects.generator.vehicles import Layout

Array = NDArray[np.float64]
GRAVITY = 9.81


@dataclass(frozen=True)
class Term:
    """One signed part of a row over the coordinates: the heave, fore-aft motion or pitch of a body's point, or a coordinate itself."""

    kind: str  # heave, fore, pitch, coordinate
    owner: str
    x: float = 0.0
    z: float = 0.0
    factor: float = 1.0


@dataclass(frozen=True)
class Law:
    """A law of laws.py on an element: its kind, its parameters and how many states it has (with their start)."""

    kind: int
    parameters: tuple[float, ...]
    states: tuple[float, ...] = ()


@dataclass
class Element:
    """A spring, a damper and laws along one travel. `wheel`: the axle whose road input adds to the travel; `dry`: Coulomb force [N or N
    m]."""

    terms: list[Term]
    k: float = 0.0
    c: float = 0.0
    wheel: str | None = None
    inertance: float = 0.0
    laws: list[Law] = field(default_factory=list)
    dry: float = 0.0


@dataclass
class Lump:
    """A rigid piece of mass [kg] and inertia [kg m^2] that moves with (x, z) of a body; `heaves` False: fore-aft inertia alone."""

    body: str
    x: float
    z: float
    mass: float
    inertia: float
    heaves: bool = True


@dataclass
class System:
    """The vehicle as a list of coordinates, masses, elements and constraints; effects edit it before `assemble`."""

    layout: Layout
    coordinates: list[str] = field(default_factory=list)
    point_masses: dict[str, float] = field(default_factory=dict)
    weightless: set[str] = field(default_factory=set)
    lumps: list[Lump] = field(default_factory=list)
    elements: dict[str, Element] = field(default_factory=dict)
    constraints: dict[str, list[Term]] = field(default_factory=dict)
    shapes: dict[str, tuple[str, Callable[[float], float], Callable[[float], float]]] = field(default_factory=dict)

    def row(self, terms: list[Term], rigid: bool = False) -> Array:
        """Return terms as one row over the coordinates, `shape (n,)`; `rigid` leaves out bending."""
        out = np.zeros(len(self.coordinates))
        at = {name: i for i, name in enumerate(self.coordinates)}
        for t in terms:
            if t.kind == "coordinate":
                out[at[t.owner]] += t.factor
                continue
            if t.kind == "heave":
                out[at[f"{t.owner}.z"]] += t.factor
                out[at[f"{t.owner}.theta"]] -= t.factor * t.x
            elif t.kind == "fore":
                out[at[f"{t.owner}.x"]] += t.factor
                out[at[f"{t.owner}.theta"]] += t.factor * t.z
            else:
                out[at[f"{t.owner}.theta"]] += t.factor
            if t.owner in self.shapes and not rigid:
                name, shape, slope = self.shapes[t.owner]
                if t.kind == "heave":
                    out[at[name]] += t.factor * shape(t.x)
                elif t.kind == "pitch":
                    out[at[name]] -= t.factor * slope(t.x)
        return out

    def add_body(self, name: str, mass: float, inertia: float) -> None:
        """Add a free rigid body with its three coordinates."""
        self.coordinates += [f"{name}.z", f"{name}.x", f"{name}.theta"]
        self.lumps.append(Lump(name, 0.0, 0.0, mass, inertia))

    def add_coordinate(self, name: str, mass: float, weightless: bool = False) -> None:
        """Add a single vertical coordinate with its own mass."""
        self.coordinates.append(name)
        self.point_masses[name] = mass
        if weightless:
            self.weightless.add(name)

    def mass_matrix(self) -> Array:
        """Return M over all coordinates, before the constraints, `shape (n, n)`."""
        n = len(self.coordinates)
        M = np.zeros((n, n))
        for name, mass in self.point_masses.items():
            i = self.coordinates.index(name)
            M[i, i] += mass
        for lump in self.lumps:
            fore = self.row([Term("fore", lump.body, lump.x, lump.z)], rigid=True)
            M += lump.mass * np.outer(fore, fore)
            if lump.heaves:
                heave = self.row([Term("heave", lump.body, lump.x, lump.z)], rigid=True)
                pitch = self.row([Term("pitch", lump.body)], rigid=True)
                M += lump.mass * np.outer(heave, heave) + lump.inertia * np.outer(pitch, pitch)
        for element in self.elements.values():
            if element.inertance:
                row = self.row(element.terms)
                M += element.inertance * np.outer(row, row)
        return M

    def constraint_matrix(self) -> Array:
        """Return J of the pins and guides, `shape (n_constraints, n)`."""
        rows = [self.row(terms) for terms in self.constraints.values()]
        return np.array(rows).reshape(len(rows), len(self.coordinates))

    def mobility(self) -> tuple[Array, Array]:
        """Return accelerations per applied force `shape (n, n)` and pin forces per applied force `shape (n_constraints, n)`."""
        M, J = self.mass_matrix(), self.constraint_matrix()
        n, m = len(M), len(J)
        block = np.block([[M, J.T], [J, np.zeros((m, m))]])
        solved = np.linalg.solve(block, np.vstack([np.eye(n), np.zeros((m, n))]))
        return solved[:n], -solved[n:]

    def weights(self) -> Array:
        """Return the gravity forces on the coordinates [N, N m], `shape (n,)`."""
        out = np.zeros(len(self.coordinates))
        for name, mass in self.point_masses.items():
            if name not in self.weightless:
                out[self.coordinates.index(name)] -= mass * GRAVITY
        for lump in self.lumps:
            if lump.heaves:
                out -= lump.mass * GRAVITY * self.row([Term("heave", lump.body, lump.x, lump.z)])
        return out

    def static_forces(self) -> dict[str, float]:
        """Return the static compression force of every element [N]: gravity on the linear springs, relaxed where all springs are
        relaxed."""
        n = len(self.coordinates)
        K = np.zeros((n, n))
        for element in self.elements.values():
            row = self.row(element.terms)
            K += element.k * np.outer(row, row)
        J = self.constraint_matrix()
        fore = [i for i, name in enumerate(self.coordinates) if name.endswith(".x")][:1]
        hold = np.eye(n)[fore]
        J = np.vstack([J, hold]) * np.max(K)
        m = len(J)
        solved = np.linalg.solve(np.block([[K, J.T], [J, np.zeros((m, m))]]), np.concatenate([self.weights(), np.zeros(m)]))
        return {name: element.k * float(self.row(element.terms) @ solved[:n]) for name, element in self.elements.items()}


def base_system(layout: Layout) -> System:
    """Return the linear vehicle: bodies, pins, and per axle the elements `suspension:NAME` and `tyre:NAME`; per pin `hinge:NAME`."""
    system = System(layout)
    for name, body in layout.bodies.items():
        system.add_body(name, body.mass, body.inertia)
    for name, axle in layout.axles.items():
        system.add_coordinate(name, axle.mass)
        below, above = Term("coordinate", name), Term("heave", axle.body, axle.x, factor=-1.0)
        system.elements[f"suspension:{name}"] = Element([below, above], axle.k, axle.c)
        system.elements[f"tyre:{name}"] = Element([Term("coordinate", name, factor=-1.0)], axle.kt, wheel=name)
    for name, pin in layout.pins.items():
        for kind in ("heave", "fore"):
            front = Term(kind, pin.front, *pin.front_at)
            rear = Term(kind, pin.rear, *pin.rear_at, factor=-1.0)
            system.constraints[f"{name}.{kind}"] = [front, rear]
        turn = [Term("pitch", pin.front, pin.front_at[0]), Term("pitch", pin.rear, pin.rear_at[0], factor=-1.0)]
        system.elements[f"hinge:{name}"] = Element(turn)
    return system
