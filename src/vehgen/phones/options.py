"""What a person says about a pass: where every phone lay, which road was crossed, how fast."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from vehgen.mechanics import Place, PointOutput
from vehgen.phones.csv_table import ColumnMap
from vehgen.road import Hump, MeasuredProfile, Profile
from vehgen.vehicle import Vehicle


@dataclass(frozen=True)
class PhoneSensor:
    """Where a phone lay: a place as in a run file, which of its axes point forward and up, its accelerations' sign where it must be given.

    `start` and `end` [s] on the phone's own clock cut its recording.
    """

    name: str
    place: Place
    forward: str | None = None
    up: str | None = None
    acceleration_sign: int | None = None
    start: float = -math.inf
    end: float = math.inf

    def outputs(self, pitch: bool) -> tuple[PointOutput, ...]:
        """Return the channels: NAME_az, and NAME_q where the pitch rate was recorded."""
        found = (PointOutput(f"{self.name}_az", self.place, "acceleration"),)
        return (*found, PointOutput(f"{self.name}_q", self.place, "pitch_rate")) if pitch else found


@dataclass(frozen=True)
class RoadOption:
    """A hump or a measured profile: how a run file writes it (all but `at`), what it is, and how long [m]."""

    kind: str
    entry: dict[str, Any]
    hump: Hump | None = None
    profile: MeasuredProfile | None = None

    @property
    def length(self) -> float:
        """Its length along the road [m]."""
        return self.hump.length if self.hump else self.profile.end if self.profile else 0.0

    def at(self, distance: float) -> Profile:
        """Return the road with its begin moved to `distance` [m]; a measured profile stays where it was measured."""
        if self.hump is not None:
            return Hump(distance, self.hump.length, self.hump.shape)
        assert self.profile is not None
        return self.profile


@dataclass(frozen=True)
class Plan:
    """What a person says about a pass.

    `speed` [m/s] where it is not the GPS's; `by_axles` to take the speed that the axles' marks fit best, near that; `lead` [m] from the
    front wheel at t = 0 to the hump; `rate` [Hz] of the recording; `top` [Hz] of the band that matters; `after` [s] recorded when the last
    wheel has left the hump; `footprint` [m] of the tyres.
    """

    vehicle: Vehicle
    road: RoadOption
    sensors: tuple[PhoneSensor, ...]
    parameter_set: str | None = None
    speed: float | None = None
    by_axles: bool = False
    lead: float | None = None
    rate: float = 100.0
    top: float = 25.0
    after: float = 3.0
    footprint: float = 0.0
    columns: ColumnMap | None = None
