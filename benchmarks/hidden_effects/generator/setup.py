"""What an effect may edit: the system, the sensors, the tyres' footprint, the speed, and forces and road inputs of its own."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from benchmarks.hidden_effects.generator.system import Element, Law, System, Term
from benchmarks.hidden_effects.generator.vehicles import Layout

Array = NDArray[np.float64]
History = Callable[[Array, float, np.random.Generator], Array]
"""(times [s], duration of the run [s], the run's random numbers) -> force [N] or moment [N m]."""


@dataclass
class Reading:
    """How a phone reads: gains of its two channels, shift along x [m], pitch tilt [rad, nose-down], delay of its clock [s]."""

    gains: dict[str, float] = field(default_factory=lambda: {"az": 1.0, "q": 1.0})
    shift: float = 0.0
    tilt: float = 0.0
    delay: float = 0.0


@dataclass
class Setup:
    """A vehicle about to be simulated."""

    vehicle: str
    layout: Layout
    system: System
    readings: dict[str, Reading]
    rng: np.random.Generator
    footprint: float = 0.0
    speed_error: float = 0.0
    settle: float = 0.0
    forces: list[tuple[list[Term], History]] = field(default_factory=list)
    runouts: list[tuple[str, Callable[[Array], Array]]] = field(default_factory=list)

    def suspension(self, axle: str) -> Element:
        """Return the suspension of an axle."""
        return self.system.elements[f"suspension:{axle}"]

    def tyre(self, axle: str) -> Element:
        """Return the tyre of an axle."""
        return self.system.elements[f"tyre:{axle}"]

    def hinge(self, pin: str) -> Element:
        """Return the turning of a pin."""
        return self.system.elements[f"hinge:{pin}"]

    def axles(self, place: str) -> list[str]:
        """Return the axles a place names: one, several joined by a plus sign, or all."""
        return list(self.layout.axles) if place == "all" else place.split("+")

    def add_law(self, axle: str, kind: int, *parameters: float, states: tuple[float, ...] = ()) -> None:
        """Add a law to an axle's suspension."""
        self.suspension(axle).laws.append(Law(kind, parameters, states))
