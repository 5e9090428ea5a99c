"""When and how fast the vehicle crossed, from all phones of one pass together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import ArgumentError, InputError
from vehgen.phones.clocks import COARSE_SCALES, Match, Range, match, predictor
from vehgen.phones.gps import CrossingSpeed, crossing_speed
from vehgen.phones.hump_event import HumpEvent, expected_onset, find_hump
from vehgen.phones.phone import Phone, speed_stream
from vehgen.phones.plan import Plan
from vehgen.road import ConstantSpeed, Track
from vehgen.simulate import Scenario, Simulator

Array = NDArray[np.float64]
LONGEST_PASS = 2000.0
"""No pass over a hump or profile is longer [s]."""
CLOCK_DOUBT = 0.5
"""Difference of two phones' world clocks over one event [s] that deserves a warning."""
ROUGH_CORRELATION, ONSET_TOLERANCE_S = 0.4, 0.15
"""A match of this correlation tells when a wheel arrived, if energy set in within this time [s] of that: one of 0.54 erred by 5 ms;
by the onset of energy 15 passes of vehicles with laws that their files lack erred by 45 ms (rms), by world clocks by 230 ms.
"""


FoundHump = HumpEvent | InputError | None
"""When a phone's energy set in, or why that tells nothing; None of a measured profile, which has no one moment."""


@dataclass(frozen=True)
class FoundSpeed:
    """The speed of a pass [m/s], where it is from, its standard deviation [m/s] if that is a GPS, and whether a GPS tells one at all.

    `told` is what a GPS tells of it between the wheels' arrivals, if these stand out.
    """

    value: float
    source: str
    deviation: float | None = None
    gps_tells: bool = False
    told: CrossingSpeed | None = None

    @classmethod
    def by_gps(cls, told: CrossingSpeed, name: str, in_pass: bool = False) -> FoundSpeed:
        """Return the speed that the GPS of the phone of a name tells, `in_pass` or of all that was recorded."""
        deviation = told.deviation_in_pass if in_pass else told.deviation
        return cls(told.median, f"{name}: {told}", deviation, gps_tells=True, told=told if in_pass else None)


def find_speed(phones: list[Phone], plan: Plan, distance: float) -> tuple[FoundSpeed, list[FoundHump]]:
    """Return the speed, and when every phone recorded the hump, or why that does not stand out."""
    told: CrossingSpeed | None = None
    teller = next((phone for phone in phones if speed_stream(phone.export) is not None), phones[0])
    speed = plan.speed
    if speed is None and plan.by_axles and speed_stream(teller.export) is None:
        message = f"{teller.name} recorded no GPS speed, near which the axles' marks would tell it; give `speed` in m/s, e.g. 2.0"
        raise ArgumentError(message, "speed")
    if speed is None:
        speed = crossing_speed(speed_stream(teller.export), teller.begin, teller.end, teller.name, moving=True).median
    if plan.road.hump is None:
        if plan.speed is not None:
            return FoundSpeed(plan.speed, "given"), [None] * len(phones)
        told = crossing_speed(speed_stream(teller.export), teller.begin, teller.end, teller.name, moving=True)
        return FoundSpeed.by_gps(told, teller.name), [None] * len(phones)
    events = [_event(phone, distance / speed) for phone in phones]
    event = events[phones.index(teller)]
    begin, end, stands_out = teller.begin, teller.end, isinstance(event, HumpEvent)
    if isinstance(event, HumpEvent):
        begin, end = event.onset - 0.5, event.onset + distance / speed + 0.5
    if speed_stream(teller.export) is not None:
        try:
            told = crossing_speed(speed_stream(teller.export), begin, end, teller.name)
        except InputError:
            if plan.speed is None:
                raise
    if plan.speed is not None:
        return FoundSpeed(
            plan.speed,
            "given" + (f"; {teller.name}: {told}" if told else ""),
            gps_tells=told is not None,
            told=told if stands_out else None,
        ), events
    assert told is not None
    return FoundSpeed.by_gps(told, teller.name, stands_out), events


def _event(phone: Phone, crossing: float) -> FoundHump:
    upward, _, _ = phone.turned(phone.begin, phone.end)
    grid = np.arange(phone.begin, phone.end, 0.01)
    try:
        return find_hump(grid, np.interp(grid, upward.time, upward.values[:, 0]), crossing, phone.name)
    except InputError as error:
        return error


def locate(
    phones: list[Phone], plan: Plan, simulator: Simulator, parameters: Array, speed: float, distance: float, events: list[FoundHump]
) -> tuple[list[Match], list[tuple[float, str]]]:
    """Return for each phone how the simulated response matches its recording, and when the front wheel reached the road's begin.

    A low hump need not stand out from the road before it: where the response is like the recording all the same, that tells.

    Raises
    ------
    InputError
        Where neither tells when a phone crossed.
    """
    step = 1 / plan.rate
    lead = 1.0 * speed if plan.road.hump else 0.0
    track = Track((plan.road.at(lead),), plan.footprint)
    length = (lead + distance) / (speed * COARSE_SCALES[0]) + 1.5
    if length > LONGEST_PASS:
        raise InputError(
            f"the pass would take {length:.4g} s at {speed:.3g} m/s over {distance:.4g} m; at most {LONGEST_PASS:g} s were expected"
        )
    answer = predictor(simulator, parameters, Scenario(track, ConstantSpeed(speed), length, 1e-3, round(1000 * step)))
    recordings, columns, first = [], [], 0
    near: list[Range | None] = []
    for phone, event in zip(phones, events, strict=True):
        upward, pitch, _ = phone.turned(phone.begin, phone.end)
        grid = np.arange(phone.begin, phone.end, step)
        if isinstance(event, HumpEvent):
            grid = np.arange(max(phone.begin, event.onset - distance / speed - 4.0), min(phone.end, event.onset + length + 2.0), step)
        recorded = [np.interp(grid, item.time, item.values[:, 0]) for item in (upward, pitch) if item is not None]
        recordings.append((grid, np.column_stack(recorded)))
        columns.append(slice(first, first + len(recorded)))
        first += len(recorded)
        if isinstance(event, HumpEvent):
            near.append((event.onset - (distance + lead) / speed - 1.0, event.onset - lead / speed + 0.4))
        else:
            near.append(None if event is None else (phone.begin, phone.end))
    found = match(recordings, answer, columns, step, near)
    arrivals: list[tuple[float, str]] = []
    for i, (item, event) in enumerate(zip(found, events, strict=True)):
        if item.is_trusted:
            arrivals.append(
                (item.shift + lead / (speed * item.scale), f"the vehicle's answer laid over it (correlation {item.correlation:.2f})")
            )
        elif isinstance(event, InputError):
            raise event
        elif event is None:
            raise InputError(
                f"{phones[i].name} fits the answer of {plan.vehicle.name} to the road badly (correlation {item.correlation:.2f}): are "
                "vehicle, sensor, road and speed those of this recording? Does the profile's 0 m lie where the drive over it begins, and "
                "is the recording cut to that drive (`from`, `to`)?"
            )
        else:
            set_in = event.onset - expected_onset(answer(1.0)[:, columns[i].start], step, event.contrast) + lead / speed
            arrivals.append(_doubtful((set_in, event.onset), item.shift + lead / (speed * item.scale), item.correlation))
    return found, arrivals


def _doubtful(set_in: tuple[float, float], laid: float, correlation: float) -> tuple[float, str]:
    """Return the arrival of a phone that the simulated response matches badly: as it is laid over, if its energy set in about then.

    `set_in` is when the front wheel arrived if energy set in as in the response (of a phone at the rear, with the rear wheel's arrival),
    and if it set in at once.
    """
    if correlation >= ROUGH_CORRELATION and min(abs(laid - moment) for moment in set_in) <= ONSET_TOLERANCE_S:
        return laid, f"the vehicle's answer laid roughly over it (correlation {correlation:.2f})"
    return set_in[0], "when its energy set in, less the time that the vehicle's answer takes to reach it"
