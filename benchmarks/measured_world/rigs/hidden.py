"""What is hidden in a rig: laws drawn by the motions and forces that the bare rig shows, from clear ones to some too weak to see."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from benchmarks.measured_world.rigs.cases import Hidden, Rig
from benchmarks.measured_world.rigs.mechanism import Motion

SHARP = 0.06
"""Hysteresis that develops over a smaller share of the travel's rms is dry friction to any instrument."""


@dataclass(frozen=True)
class Scales:
    """What a joint of the bare rig shows over all runs: k [N/m], c [N s/m], largest travels in bump and rebound [m], their rms [m], the
    largest rate [m/s], and the rms of the force [N]."""

    k: float
    c: float
    bump: float
    rebound: float
    travel: float
    rate: float
    force: float


def scales(rig: Rig, motions: list[Motion], joint: int) -> Scales:
    """Return the scales of a joint; on a carriage the force is what drives it."""
    travel = np.concatenate([motion.travel[joint] for motion in motions])
    rate = np.concatenate([np.gradient(motion.travel[joint], motion.t) for motion in motions])
    force = np.concatenate([motion.force[joint] for motion in motions])
    size = rig.numbers["size"] if rig.family == "carriage" else float(np.std(force))
    k, c = _spring(rig, joint)
    rms = float(np.std(travel))
    return Scales(k, c, float(np.max(travel)), -float(np.min(travel)), rms, float(np.max(np.abs(rate))), size)


def _spring(rig: Rig, joint: int) -> tuple[float, float]:
    if rig.family == "half_car":
        return rig.true(f"k{joint + 1}"), rig.true(f"c{joint + 1}")
    return (rig.true("k") if "k" in rig.quantities else 0.0), rig.true("c")


def _log(low: float, high: float, rng: np.random.Generator) -> float:
    return math.exp(rng.uniform(math.log(low), math.log(high)))


Draw = Callable[[Scales, np.random.Generator], dict[str, float]]


def _friction(s: Scales, rng: np.random.Generator) -> dict[str, float]:
    return {"force": s.force * _log(0.03, 0.4, rng)}


def _directional(s: Scales, rng: np.random.Generator) -> dict[str, float]:
    force, apart = s.force * _log(0.05, 0.3, rng), float(rng.uniform(0.15, 0.5) * rng.choice([-1.0, 1.0]))
    return {"bump": force * (1.0 + apart), "rebound": force * (1.0 - apart)}


def _stops(s: Scales, rng: np.random.Generator) -> dict[str, float]:
    found = {"k": s.k * _log(2.0, 8.0, rng), "clearance": s.bump * float(rng.uniform(0.3, 0.9))}
    return found | {"rebound": s.rebound * float(rng.uniform(0.4, 1.3))}


def _progressive(s: Scales, rng: np.random.Generator) -> dict[str, float]:
    return {"k": s.k * _log(0.3, 2.0, rng), "start": s.bump * float(rng.uniform(0.1, 0.6))}


def _hysteresis(s: Scales, rng: np.random.Generator) -> dict[str, float]:
    return {"force": s.force * _log(0.05, 0.5, rng), "travel": s.travel * _log(0.03, 0.4, rng), "beta": float(rng.uniform(0.4, 0.9))}


LAWS: dict[str, Draw] = {
    "dry_friction": _friction,
    "directional_friction": _directional,
    "bump_stop": _stops,
    "asymmetric_damping": lambda s, rng: {"ratio": float(rng.uniform(0.25, 0.85))},
    "cubic_stiffness": lambda s, rng: {"k3": s.k / s.bump**2 * _log(0.1, 1.5, rng)},
    "progressive_stiffness": _progressive,
    "quadratic_damping": lambda s, rng: {"c2": s.c / s.rate * _log(0.15, 2.0, rng)},
    "hysteresis": _hysteresis,
    "damper_mount": lambda s, rng: {"k": s.c * 2.0 * math.pi * _log(3.0, 40.0, rng)},
    "free_play": lambda s, rng: {"gap": s.travel * _log(0.01, 0.15, rng)},
    "hidden_spring": lambda s, rng: {"k": s.force / s.travel * _log(0.03, 0.3, rng)},
}
OUTSIDE = ("free_play", "hidden_spring", "directional_friction")
"""No library holds these laws under a name of their own."""


def draw_hidden(option: str, places: tuple[str, ...], found: list[Scales], rng: np.random.Generator) -> tuple[Hidden, ...]:
    """Return what an option hides at one of the places, or in all of them (`... in both`); nothing for `nothing`."""
    if option == "nothing":
        return ()
    law, _, both = option.partition(" in ")
    chosen = range(len(places)) if both else [int(rng.integers(len(places)))]
    hidden = []
    for i in chosen:
        values = LAWS[law](found[i], rng)
        hidden.append(Hidden(law, places[i], values, law not in OUTSIDE, accepted(law, values, found[i])))
    return tuple(hidden)


def accepted(law: str, values: dict[str, float], s: Scales) -> dict[str, dict[str, float]]:
    """Return other laws that describe a hidden one as well as any recording can tell.

    Friction that differs by direction is dry friction of their mean beside a constant force of half their difference; hysteresis within
    a travel far below the joint's is dry friction.
    """
    if law == "directional_friction":
        return {"dry_friction": {"force": 0.5 * (values["bump"] + values["rebound"])}}
    if law == "hysteresis" and values["travel"] < SHARP * s.travel:
        return {"dry_friction": {"force": values["force"]}}
    return {}
