"""Which effects a vehicle can have, where, and of what size: the menu from which trials are drawn by seed."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from benchmarks.hidden_effects.generator.cases import REFERENCE_RUN, SHARP_RUN, Case, Effect, RunSpec
from benchmarks.hidden_effects.generator.effects import EFFECTS
from benchmarks.hidden_effects.generator.integrate import OutputRow, assemble, integrate
from benchmarks.hidden_effects.generator.setup import Reading, Setup
from benchmarks.hidden_effects.generator.simulate import build_road, simulate_case, wheel_inputs
from benchmarks.hidden_effects.generator.system import GRAVITY, base_system
from benchmarks.hidden_effects.generator.vehicles import Layout, layout, nominal

Range = tuple[float, float]


@dataclass(frozen=True)
class EffectOption:
    """An effect at a place: ranges of every value, SI units, for a weak and a visible effect. `listed`: whether a library of candidates
    should hold it; `run`: a run on which it shows (lift-off needs a sharper hump than the others).
    """

    name: str
    place: str
    listed: bool
    equation: str
    weak: dict[str, Range]
    visible: dict[str, Range]
    neutral: dict[str, float]
    run: RunSpec

    def draw(self, rng: np.random.Generator, level: str = "visible") -> Effect:
        """Return the effect with values drawn from the ranges of a level, "weak" or "visible": logarithmically where both ends are
        positive."""
        values = {}
        for name, (low, high) in getattr(self, level).items():
            log = low > 0 and high > low
            values[name] = float(np.exp(rng.uniform(np.log(low), np.log(high))) if log else rng.uniform(low, high))
        return Effect(self.name, self.place, values)

    def middle(self, level: str = "visible") -> Effect:
        """Return the effect with values in the middle of the ranges of a level."""
        return Effect(self.name, self.place, {name: 0.5 * (low + high) for name, (low, high) in getattr(self, level).items()})


def list_effects(vehicle: str) -> list[EffectOption]:
    """Return every effect at every place of a vehicle."""
    scales = Scales(vehicle)
    options = []
    for kind in EFFECTS.values():
        run = (SHARP_RUN if kind.name == "tyre_liftoff" else REFERENCE_RUN)[vehicle]
        for place in kind.places(vehicle):
            size = {value.name: scales.scale(value.scale, place) for value in kind.values}
            weak, visible = (
                {v.name: (getattr(v, level)[0] * size[v.name], getattr(v, level)[1] * size[v.name]) for v in kind.values}
                for level in ("weak", "visible")
            )
            options.append(EffectOption(kind.name, place, kind.listed, kind.equation, weak, visible, kind.neutral, run))
    return options


def visibility(case: Case) -> float:
    """Return sqrt(1 + mean of (change by the effects/noise sigma)^2) over all runs and channels, before any refit: 1 is invisible."""
    base = replace(case, effects=())
    squares = []
    for one, other in zip(simulate_case(case), simulate_case(base), strict=True):
        squares += [np.mean((one.clean[name] - other.clean[name]) ** 2) / max(other.sigma[name], 1e-12) ** 2 for name in one.clean]
    return float(np.sqrt(1.0 + np.mean(squares)))


class Scales:
    """Sizes of a nominal vehicle by which the ranges of effects are scaled."""

    def __init__(self, vehicle: str) -> None:
        self.vehicle = vehicle
        self.layout = layout(vehicle, nominal(vehicle))
        self.static = base_system(self.layout).static_forces()
        self.travel = _reference_travel(vehicle)

    def scale(self, name: str, place: str) -> float:
        """Return the size called `name` at a place, SI units. Raises KeyError for an unknown one."""
        sedan = self.vehicle == "sedan2"
        plain = {"one": lambda: 1.0, "bending": lambda: 2.2 if sedan else 1.0, "wheel": lambda: 0.6 if sedan else 1.0}
        at_axle = {
            "load": lambda: self.static[f"tyre:{place}"],
            "k": lambda: self.layout.axles[place].k,
            "c": lambda: self.layout.axles[place].c,
            "d": lambda: self.travel[place][0],
            "k/d2": lambda: self.layout.axles[place].k / self.travel[place][0] ** 2,
            "c/v": lambda: self.layout.axles[place].c / self.travel[place][1],
            "axle mass": lambda: self.layout.axles[place].mass,
        }
        at_body = {
            "weight": lambda: self.layout.bodies[place].mass * GRAVITY,
            "length": lambda: _span(self.layout, place),
            "weight length": lambda: self.layout.bodies[place].mass * GRAVITY * _span(self.layout, place),
        }
        at_pin = {
            "hinge moment": lambda: 0.3 * self._pin_load(place),
            "hinge stiffness": lambda: self._pin_stiffness(place),
            "1/k": lambda: 1.0 / sum(axle.k for axle in self.layout.axles.values() if axle.body == self.layout.pins[place].front),
        }
        return float((plain | at_axle | at_body | at_pin)[name]())

    def _pin_load(self, place: str) -> float:
        front = self.layout.pins[place].front
        carried = sum(self.static[f"suspension:{name}"] for name, axle in self.layout.axles.items() if axle.body == front)
        return carried - self.layout.bodies[front].mass * GRAVITY

    def _pin_stiffness(self, place: str) -> float:
        pin = self.layout.pins[place]
        own = [
            sum(axle.k * (axle.x - at[0]) ** 2 for axle in self.layout.axles.values() if axle.body == body)
            for body, at in ((pin.front, pin.front_at), (pin.rear, pin.rear_at))
        ]
        return 1.0 / sum(1.0 / k for k in own)


def _span(plan: Layout, body: str) -> float:
    """Return the distance between the outermost axles and pins of a body [m]."""
    x = [axle.x for axle in plan.axles.values() if axle.body == body]
    for pin in plan.pins.values():
        x += [at[0] for name, at in ((pin.front, pin.front_at), (pin.rear, pin.rear_at)) if name == body]
    return max(x) - min(x)


@lru_cache
def _reference_travel(vehicle: str) -> dict[str, Range]:
    """Return the largest suspension travel [m] and rate [m/s] of every axle of the nominal linear vehicle on its reference run."""
    plan = layout(vehicle, nominal(vehicle))
    system = base_system(plan)
    run, h = REFERENCE_RUN[vehicle], 5e-4
    setup = Setup(vehicle, plan, system, {"": Reading()}, np.random.default_rng(0))
    road, _ = build_road(setup, run, np.random.default_rng(0), 0.0)
    t = 0.5 * h * np.arange(2 * round(run.duration / h) + 1)
    rows = [system.row(system.elements[f"suspension:{axle}"].terms) for axle in plan.axles]
    zero = np.zeros(len(system.coordinates))
    outputs = [OutputRow(row, zero, zero) for row in rows] + [OutputRow(zero, row, zero) for row in rows]
    largest = np.max(np.abs(integrate(assemble(system, []), wheel_inputs(setup, road, run.speed, t, 0.5 * h), h, outputs)), axis=0)
    n = len(rows)
    return {axle: (float(largest[i]), float(largest[n + i])) for i, axle in enumerate(plan.axles)}
