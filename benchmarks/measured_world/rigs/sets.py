"""The set of rigs' cases, by seed: families in turn, what is hidden in a random order that holds each law."""

from __future__ import annotations

from dataclasses import replace
from types import ModuleType

import numpy as np

from benchmarks.measured_world.rigs import carriage, dyno, half_car
from benchmarks.measured_world.rigs.cases import Rig
from benchmarks.measured_world.rigs.hidden import draw_hidden, scales

KIND = "rigs"
STREAM = 4
"""Of random numbers, beside those of the other kinds."""
FAMILIES: dict[str, ModuleType] = {"half_car": half_car, "dyno": dyno, "carriage": carriage}


def draw_rig(stream: int, seed: int, number: int) -> Rig:
    """Return case `number` of the set with a stream of random numbers; it depends on nothing else."""
    names = list(FAMILIES)
    family = FAMILIES[names[number % len(names)]]
    turn, which = divmod(number // len(names), len(family.OPTIONS))
    order = np.random.default_rng([stream, seed, STREAM, 10**6 + number % len(names), turn]).permutation(len(family.OPTIONS))
    rng = np.random.default_rng([stream, seed, STREAM, number])
    rig = family.draw(f"{KIND}_{number:03d}", rng)
    option = family.OPTIONS[int(order[which])]
    if option == "nothing":
        return rig
    motions = [family.respond(rig, run, family.drive(rig, run))[1] for run in rig.runs]
    found = [scales(rig, motions, joint) for joint in range(len(family.PLACES))]
    return replace(rig, hidden=draw_hidden(option, family.PLACES, found, rng))
