"""Runs that nobody has driven yet, and sensors that nobody has mounted: what an experiment can choose among.

The humps have the shape and length of the highest one used, from half to twice its height; the speeds reach from 0.6 of the slowest over a
hump to twice the fastest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from vehgen.fit.trial import Trial
from vehgen.mechanics import Place
from vehgen.mechanics.outputs import PointOutput
from vehgen.road import ConstantSpeed, Hump, Track
from vehgen.simulate import Scenario

HEIGHTS = (0.5, 1.0, 1.5, 2.0)
MAX_HUMP_HEIGHT_M, MIN_HUMP_HEIGHT_M = 0.12, 0.01
"""Heights of a hump that one lays out [m]."""
MAX_SPEED_M_S, MIN_SPEED_M_S = 8.0, 0.5
"""Speeds over it, unless the runs were faster or slower [m/s]."""
USUAL = (0.05, 2.0)
"""Height [m] and speed [m/s] from which to begin where no run has a hump."""
LEAD_TIME_S, AFTER_LAST_AXLE_S = 1.5, 3.0
"""Seconds recorded before the hump and after it."""
NEAREST_HEIGHT_RATIO = 0.15
"""A sensor within this share of the body's length of an end is at that end."""


@dataclass(frozen=True)
class CandidateRun:
    """A hump of a height and length [m] at a speed [m/s], and its scenario; `same` where the runs had a hump of that shape already."""

    height: float
    length: float
    speed: float
    scenario: Scenario
    same: bool = True

    @property
    def name(self) -> str:
        """Its name."""
        return f"{self.height:.3g} m at {self.speed:.3g} m/s"


def list_runs(trials: Sequence[Trial]) -> list[CandidateRun]:
    """Return the runs to choose among, gentlest first: by height, then by speed.

    Parameters
    ----------
    trials
        The runs driven so far; the first gives clock, footprint and other inputs.
    """
    known = [(part, trial.scenario.top_speed) for trial in trials for part in trial.scenario.track.parts if isinstance(part, Hump)]
    shape = Hump.from_shape("half_sine", 0.0, 0.5, USUAL[0])
    hump = max((hump for hump, _ in known), key=_height, default=shape)
    top = _height(hump)
    speeds = [speed for _, speed in known] or [USUAL[1]]
    slow, fast = min(speeds), max(speeds)
    heights = sorted({min(max(round(200 * factor * top) / 200, MIN_HUMP_HEIGHT_M), max(MAX_HUMP_HEIGHT_M, top)) for factor in HEIGHTS})
    wanted = {
        max(0.6 * slow, min(MIN_SPEED_M_S, slow)),
        slow,
        fast,
        *(min(factor * fast, max(MAX_SPEED_M_S, fast)) for factor in (1.5, 2.0)),
    }
    return [
        CandidateRun(height, hump.length, speed, _scenario(trials[0], hump, height / top, speed), bool(known))
        for height in heights
        for speed in sorted({round(10 * item) / 10 for item in wanted})
    ]


def _height(hump: Hump) -> float:
    return float(np.abs(hump.shape(np.linspace(0.0, hump.length, 401))).max())


def _scenario(trial: Trial, hump: Hump, scale: float, speed: float) -> Scenario:
    old = trial.scenario
    at = LEAD_TIME_S * speed + old.track.footprint
    behind = float(trial.simulator.model.wheel_offsets(trial.values).max(initial=0.0))
    track = Track((replace(hump, at=at),), old.track.footprint, scale)
    duration = (at + hump.length + behind) / speed + AFTER_LAST_AXLE_S
    return replace(old, track=track, speed=ConstantSpeed(speed), duration=duration, start=0.0, skipped=0)


def free_places(trial: Trial) -> list[PointOutput]:
    """Return sensors that could be added: of acceleration at each end of a body that has none there, of pitch rate on one without."""
    vehicle, model = trial.run.vehicle, trial.simulator.model
    layout, outputs = model.layout, [item.output for item in trial.recording.channels if isinstance(item.output, PointOutput)]
    names = (*vehicle.axles, *vehicle.hinges)
    known = dict(zip(names, model.evaluate_list((layout.place(vehicle, name) for name in names), trial.values), strict=True))
    own = (item.place.locate(vehicle, layout) + layout.bodies[item.place.body][0] for item in outputs)
    mounted = list(zip(outputs, model.evaluate_list(own, trial.values), strict=True))
    found = []
    for body in vehicle.bodies:
        supports = [name for name, axle in vehicle.axles.items() if axle.body == body]
        supports += [name for name, hinge in vehicle.hinges.items() if body in hinge.points]
        x = {name: place for name, place in known.items() if name in supports}
        if not x:
            continue
        ends = dict.fromkeys((max(x, key=lambda name: x[name]), min(x, key=lambda name: x[name])))
        reach = NEAREST_HEIGHT_RATIO * max(max(x.values()) - min(x.values()), 1.0)
        taken = [place for item, place in mounted if item.place.body == body and item.quantity == "acceleration"]
        free = [end for end in ends if all(abs(x[end] - place) > reach for place in taken)]
        found += [PointOutput(f"{body}_{end}_acceleration", Place(f"{body}_{end}", body, behind=end), "acceleration") for end in free]
        if not any(item.place.body == body and item.quantity == "pitch_rate" for item in outputs):
            end = next(iter(ends))
            found.append(PointOutput(f"{body}_{end}_pitch_rate", Place(f"{body}_{end}", body, behind=end), "pitch_rate"))
    return found
