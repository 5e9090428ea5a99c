"""Whether runs over humps agree on the vehicle, and all runs on what its sensors read.

A base model that fits all runs within the noise may hide what is missing: recalibrated parameters and the errors of runs share it out
among them. A run that was made with another load, or in which an effect that grows with travel shows most, asks for other parameters than
the rest; a sensor that was changed for one run reads more in it. To the first order about the fit to all runs it can be told by how much
-2 ln L would fall if only that run had parameters, or only one of its channels a gain, of its own. Errors of recorders and drivers hardly
look like it: healthy runs gain about as many as there are numbers.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from vehgen.diagnose.detect.all_runs import AllRuns, OwnNumbers
from vehgen.diagnose.detect.road_error import measured_profiles

if TYPE_CHECKING:
    from vehgen.diagnose.detect.detection import Detection

ODD_AMONG = 3
"""So many runs there must be: of two nobody can say which is odd."""
ODD_FACTOR, ODD_MARGIN = 8.0, 60.0
"""So many times what chance gives, and so much more, an odd run gains at least; of 58 healthy vehicles one gained 205, a truck."""
OTHERS_AGREE = 3.0
"""Runs agree that gain at most so many times what chance gives: healthy ones gained 2.9 times that at most."""
ODD_CHANNEL = 36.0
"""So much an odd channel gains at least, six standard deviations: healthy ones gained 15 at most."""
ODD_READING = 0.08
"""By so much an odd channel reads more or less at least; healthy ones that gained more than 6 read 3 % more at most."""


@dataclass(frozen=True)
class OddRun:
    """A run that asks for a vehicle of its own: -2 ln L would fall by `gain`, where chance gives about `by_chance`.

    `others_agree` is whether the other runs over humps agree on the vehicle once this one has its own: an effect would show in them, too,
    unless something touches in this run only.
    """

    run: str
    gain: float
    by_chance: float
    others_agree: bool


@dataclass(frozen=True)
class OddChannel:
    """A channel that reads `factor` times, give or take `sigma`, in one run what it reads in the others."""

    run: str
    channel: str
    factor: float
    sigma: float


def disagreement(detection: Detection) -> OddRun | OddChannel | None:
    """Return what disagrees most: one channel of one run, if that is all, or else a run over humps; None where all agree.

    Measured roads have errors of their own, which no gain of one channel looks like, but a vehicle may. Rigs are left out.
    """
    if len(detection.trials) < ODD_AMONG or not any(trial.scenario.track.parts for trial in detection.trials):
        return None
    runs = AllRuns(detection)
    driven = [number for number, trial in enumerate(runs.trials) if trial.scenario.track.parts]
    vehicles = [runs.own_parameters(number) for number in driven if not measured_profiles(runs.trials[number])]
    gains = {(number, c): runs.own_gain(number, c) for number in driven for c in range(len(runs.trials[number].channels))}
    return _odd_channel(runs, gains, vehicles) or (_odd_run(runs, vehicles) if vehicles else None)


def _is_odd(vehicle: OwnNumbers) -> bool:
    return vehicle.gain > ODD_MARGIN + ODD_FACTOR * len(vehicle.pull)


def _odd_run(runs: AllRuns, vehicles: list[OwnNumbers]) -> OddRun | None:
    worst = max(vehicles, key=lambda item: item.gain)
    if not _is_odd(worst):
        return None
    by_chance = len(worst.pull)
    agree = all(runs.beside(item, worst).gain <= OTHERS_AGREE * by_chance for item in vehicles if item is not worst)
    return OddRun(runs.trials[worst.run].name, worst.gain, by_chance, agree)


def _odd_channel(runs: AllRuns, gains: dict[tuple[int, int], OwnNumbers], vehicles: list[OwnNumbers]) -> OddChannel | None:
    """Return a channel beside which no other one is odd, and no run; `gains` are theirs, by run and channel."""
    (run, channel), best = max(gains.items(), key=lambda item: item[1].gain)
    more = float(best.values[0])
    if best.gain < ODD_CHANNEL or abs(more) < ODD_READING:
        return None
    others = [runs.beside(own, best) for key, own in gains.items() if key != (run, channel)]
    if any(own.gain > ODD_CHANNEL for own in others) or any(_is_odd(runs.beside(vehicle, best)) for vehicle in vehicles):
        return None
    trial = runs.trials[run]
    return OddChannel(trial.name, trial.channels[channel], 1 + more, float(best.information[0, 0] ** -0.5))
