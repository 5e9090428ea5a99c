"""From phone exports of one pass to a run file and the recording that it names.

clean -> orientation -> hump -> speed -> the vehicle's answer laid over each recording -> quiet stretch -> even grid -> noise floor.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import ArgumentError, InputError
from vehgen.files.units import STANDARD_GRAVITY
from vehgen.measure.quality import FOREIGN_UNIT, NoiseFloor, find_clipping, in_foreign_unit, noise_floor
from vehgen.phones.clocks import Match
from vehgen.phones.csv_table import ColumnMaps, maps_of_exports
from vehgen.phones.detect import read_export
from vehgen.phones.export import Stream
from vehgen.phones.hump_event import HumpEvent
from vehgen.phones.locating import CLOCK_DOUBT, FoundSpeed, find_speed, locate
from vehgen.phones.orientation import Orientation
from vehgen.phones.phone import MARGIN, QUIET, Phone, make_phone
from vehgen.phones.plan import PhoneSensor, Plan
from vehgen.simulate import Simulator

Array = NDArray[np.float64]
LEAD_TIME = 3.0
"""Seconds before the hump with which a run begins, where there are so many."""
LEAST_LEAD = 0.5
"""Seconds that there must be."""
CLIPPED_IN_A_ROW = 3
"""Equal raw samples in a row at an axis's extreme that count as clipping: at a phone's rate an honest peak holds for one or two ..."""
CLIPPED_DEVIATION = 4.0
"""... where the extreme is so many standard deviations from the median, so that a coarse axis at rest is not taken for a clipped one."""
UNITS_TAKEN_AS_SI = (("g", 1 / STANDARD_GRAVITY), ("deg/s", 180 / np.pi))
"""A channel in a foreign unit is in one of these, an acceleration and a pitch rate, where that makes it about as loud as the answer."""
SPEED_DOUBT = 0.01
"""Relative difference of speeds that deserves a warning."""


@dataclass(frozen=True)
class ImportedPhone:
    """One phone of an import, on its own clock: the run's t = 0 at `zero` [s], how that was found, and what the phone recorded."""

    phone: Phone
    zero: float
    arrival: float
    found_by: str
    quiet: tuple[float, float]
    upward: Stream
    pitch: Stream | None
    orientation: Orientation | None
    event: HumpEvent | None
    match: Match
    noise: tuple[tuple[str, NoiseFloor], ...]
    notes: tuple[str, ...]


@dataclass(frozen=True)
class Imported:
    """An import: `time shape (n,)` [s], `values shape (n, n_channels)` of `channels` [m/s^2, rad/s], and all that was assumed.

    `at` [m] is where the hump begins (None for a measured profile), `fitted_speed` [m/s] what the axles' marks say, `wheels` the distance
    of every axle behind the front wheel [m].
    """

    plan: Plan
    phones: tuple[ImportedPhone, ...]
    time: Array
    values: Array
    channels: tuple[str, ...]
    speed: FoundSpeed
    fitted_speed: float | None
    at: float | None
    wheels: dict[str, float]
    warnings: tuple[str, ...]


def read_pass(exports: Sequence[str | os.PathLike[str]], plan: Plan) -> Imported:
    """Turn the exports of the phones in one vehicle, one pass, into channels on one even clock.

    Parameters
    ----------
    exports
        One per sensor of the plan, in its order.
    plan
        Vehicle, road and phones.

    Raises
    ------
    InputError
        For exports that cannot be read or used; it says what would help.
    """
    if not 1.0 <= plan.top <= 500.0:
        raise ArgumentError(f"`top`: the top of the band must be from 1 to 500 Hz, found {plan.top:g} Hz", "top")
    if not 2 * plan.top <= plan.rate <= 1000.0 or abs(1000 / plan.rate - round(1000 / plan.rate)) > 1e-9:
        reach = f"from {2 * plan.top:g} to 1000 Hz with a step of whole milliseconds"
        raise ArgumentError(f"`rate`: the rate must be {reach}, found {plan.rate:g} Hz", "rate")
    phones = read_phones(exports, plan.sensors, plan.columns, plan.top)
    outputs = [output for phone in phones for output in phone.sensor.outputs(phone.rotation is not None)]
    simulator = Simulator(plan.vehicle, outputs)
    values = plan.vehicle.values(plan.parameter_set)
    offsets = simulator.model.wheel_offsets(simulator.model.values(overrides=values))
    wheels = dict(zip(plan.vehicle.axles, map(float, offsets), strict=True))
    distance = max(wheels.values()) + plan.road.length
    speed, events = find_speed(phones, plan, distance)
    matches, arrivals = locate(phones, plan, simulator, simulator.parameters(values)[0], speed.value, distance, events)
    if plan.by_axles and all(item.is_trusted for item in matches):
        speed = replace(speed, value=speed.value * matches[0].scale, source=f"by the axles' marks; {speed.source}", deviation=None)
        matches = [replace(item, scale=1.0) for item in matches]
    elif plan.by_axles and speed.deviation is None:
        raise ArgumentError("the simulated response fits the recordings too badly to find the speed from its axles; give `speed`", "speed")
    stood_out = [item if isinstance(item, HumpEvent) else None for item in events]
    return _assemble(phones, plan, speed, stood_out, matches, arrivals, distance, wheels)


def read_phones(exports: Sequence[str | os.PathLike[str]], sensors: Sequence[PhoneSensor], columns: ColumnMaps, top: float) -> list[Phone]:
    """Read the phones of one vehicle for a band up to `top` [Hz]; raises InputError, also where exports and sensors do not match."""
    if len(exports) != len(sensors) or not exports:
        count = f"{len(exports)} exports and {len(sensors)} sensors"
        raise ArgumentError(f"{count}: give one of `sensors` for each export, in the same order", "sensors")
    names = [sensor.name for sensor in sensors]
    if len(set(names)) < len(names):
        raise ArgumentError(f"`sensors`: two sensors have one name ({', '.join(names)}); each needs its own", "sensors")
    maps = maps_of_exports(columns, len(exports))
    phones = [
        make_phone(read_export(Path(path), own), sensor, Path(path).name, top)
        for path, sensor, own in zip(exports, sensors, maps, strict=True)
    ]
    for one, other in combinations(phones, 2):
        if np.array_equal(one.acceleration.values, other.acceleration.values):
            pair = f"{one.sensor.name} ({one.name}) and {other.sensor.name} ({other.name})"
            raise ArgumentError(f"{pair} recorded the same numbers: give each sensor the export of its own phone", "exports")
    return phones


def _assemble(
    phones: list[Phone],
    plan: Plan,
    found_speed: FoundSpeed,
    events: list[HumpEvent | None],
    matches: list[Match],
    arrivals: list[tuple[float, str]],
    distance: float,
    wheels: dict[str, float],
) -> Imported:
    """Choose t = 0, sample every channel, and warn of what is doubtful."""
    speed = found_speed.value
    is_hump = plan.road.hump is not None
    lead = _lead(phones, plan, speed, [moment for moment, _ in arrivals]) if is_hump else 0.0
    zeros = [moment - lead / speed for moment, _ in arrivals]
    available = min(phone.end - zero for phone, zero in zip(phones, zeros, strict=True))
    crossing = (lead + distance) / speed
    if is_hump and available < crossing + 0.5:
        raise InputError(
            f"the recording ends {available:.1f} s after t = 0; the last wheel crosses at {crossing:.1f} s, and half a second more is "
            "needed: record longer"
        )
    wanted = crossing + plan.after if is_hump else min(crossing, plan.road.length / speed)
    count = int(min(wanted, available - 0.05) * plan.rate)
    time = np.arange(count + 1) / plan.rate
    done, columns, channels, warnings = [], [], [], []
    for phone, zero, (arrival, found_by), event, item in zip(phones, zeros, arrivals, events, matches, strict=True):
        quiet = (max(phone.begin, arrival - QUIET), arrival - MARGIN)
        if quiet[1] - quiet[0] < LEAST_LEAD:
            quiet = (zero, zero + float(time[-1]))
        upward, pitch, orientation = phone.turned(*quiet)
        phone.check_holes((upward, pitch), zero, zero + float(time[-1]))
        columns.append(phone.sampled((upward, pitch), time + zero))
        names = [output.name for output in phone.sensor.outputs(pitch is not None)]
        channels += names
        noise = _noise(phone, (upward, pitch), names, quiet, plan.rate) if quiet[1] < arrival else ()
        notes = [*phone.notes, *phone.short_gaps(zero, zero + float(time[-1])), *(orientation.notes if orientation else ())]
        used = phone.acceleration.between(zero, zero + float(time[-1]))
        warnings += clipping_warnings(phone.name, used)
        warnings += [f"{phone.name}: {text}" for text in (orientation.warnings if orientation else ())]
        warnings += event.warnings if event else ()
        warnings += _loudness_warnings(names, item) if item.is_trusted else []
        if is_hump and not item.is_trusted:
            warnings.append(
                f"{phone.name}: the vehicle's answer fits badly (correlation {item.correlation:.2f}), so its clock is set by {found_by}: "
                "check vehicle, place and forward axis"
            )
        for channel, floor in noise:
            if quiet[1] - quiet[0] > 3.0 and floor.sigma > 1.3 * floor.band_sigma:
                notes.append(
                    f"{channel}: the lead-in is {floor.sigma / floor.band_sigma:.1f} times as loud as the top of its band: road or engine"
                )
        done.append(ImportedPhone(phone, zero, arrival, found_by, quiet, upward, pitch, orientation, event, item, noise, tuple(notes)))
    fitted = speed * matches[0].scale if all(item.is_trusted for item in matches) else None
    warnings += [*_speed_warnings(plan, found_speed, fitted), *_clock_warnings(done)]
    at = lead if is_hump else None
    values = np.column_stack(columns)
    return Imported(plan, tuple(done), time, values, tuple(channels), found_speed, fitted, at, wheels, tuple(warnings))


def clipping_warnings(name: str, acceleration: Stream) -> list[str]:
    """Say which axes of a phone's acceleration are clipped."""
    return [
        f"{name}: acceleration {axis} is clipped at {item.level:.4g} m/s^2 from {acceleration.time[item.first]:.2f} s: "
        "take a phone of larger range, a lower speed or a lower hump"
        for axis, values in zip(acceleration.columns, acceleration.values.T, strict=True)
        for item in find_clipping(values, CLIPPED_IN_A_ROW, min_deviation=CLIPPED_DEVIATION, rest=None)
    ]


def _loudness_warnings(channels: list[str], found: Match) -> list[str]:
    """Say which channels are so much louder or quieter than the vehicle's answer as only another unit makes them."""
    warnings = []
    for (unit, worth), channel, ratio in zip(UNITS_TAKEN_AS_SI, channels, found.loudness, strict=False):
        if in_foreign_unit(ratio):
            is_that = 1 / FOREIGN_UNIT < ratio / worth < FOREIGN_UNIT
            cause = f"as if in {unit}" if is_that else "check the units of the recording and of the road"
            warnings.append(f"{channel}: {ratio:.2g} times as loud as the vehicle's answer, {cause}")
    return warnings


def _lead(phones: list[Phone], plan: Plan, speed: float, arrivals: list[float]) -> float:
    available = min(arrival - phone.begin for phone, arrival in zip(phones, arrivals, strict=True))
    if plan.lead is not None:
        if not LEAST_LEAD * speed <= plan.lead <= available * speed:
            reach = f"{LEAST_LEAD * speed:.2f} to {available * speed:.2f} m"
            raise ArgumentError(f"`lead`: the lead must be {reach} in this recording, found {plan.lead:g} m", "lead")
        return plan.lead
    lead = float(np.floor(10 * min(LEAD_TIME, available - 0.05) * speed) / 10)
    if lead < LEAST_LEAD * speed:
        raise InputError(
            f"only {available:.2f} s were recorded before the hump; at least {LEAST_LEAD:g} s are needed: start recording earlier"
        )
    return lead


def _noise(
    phone: Phone, streams: tuple[Stream | None, Stream | None], names: list[str], quiet: tuple[float, float], rate: float
) -> tuple[tuple[str, NoiseFloor], ...]:
    present = [stream for stream in streams if stream is not None]
    grid = np.arange(quiet[0], quiet[1], 1 / rate)
    values = phone.sampled(streams, grid)
    return tuple(
        (name, noise_floor(values[:, i], 1 / rate, sampling))
        for i, (name, sampling) in enumerate(zip(names, phone.rates[: len(present)], strict=True))
    )


def _speed_warnings(plan: Plan, found: FoundSpeed, fitted: float | None) -> list[str]:
    """Say where the axles' marks contradict the speed, and where the speed was to be found from them and is not."""
    warnings = []
    if found.told is not None and found.told.changes:
        warnings.append(
            f"the speed changed in the pass ({found.told.low:.2f} to {found.told.high:.2f} m/s): a run has one speed, about which a driver "
            "may wander a little; record a steady pass, or state a table of speeds"
        )
    if fitted is not None and abs(fitted / found.value - 1) > SPEED_DOUBT:
        given = "axles" if found.gps_tells else f"{fitted:.3f}"
        better = f"the axles' marks fit {fitted:.3f} m/s better than {found.value:.3f} m/s ({found.source})"
        warnings.append(f"{better}; give `{given}` as the speed to take that")
    if plan.by_axles and found.deviation is not None:
        warnings.append(
            "the vehicle's answer fits too badly to find the speed from its axles, so the GPS's stands, give or take "
            f"{found.deviation:.2g} m/s: check vehicle, place and forward axis, or `diagnose` what the vehicle lacks"
        )
    return warnings


def _clock_warnings(done: list[ImportedPhone]) -> list[str]:
    found = []
    for other in done[1:]:
        late = clock_difference(done[0], other)
        if late is not None and abs(late) > CLOCK_DOUBT:
            found.append(
                f"by the apps' clocks {other.phone.name} crossed {late:+.2f} s after {done[0].phone.name}; these clocks were not used, the "
                "axles' marks were: are both of one pass?"
            )
    return found


def clock_difference(first: ImportedPhone, other: ImportedPhone) -> float | None:
    """Return how much later [s] the other phone's world clock puts the front wheel at the hump, None where either phone has none."""
    its, others = first.phone.export.epoch, other.phone.export.epoch
    return None if its is None or others is None else others.at(other.arrival) - its.at(first.arrival)


def with_forward(sensors: Sequence[PhoneSensor], forward: str | None) -> tuple[PhoneSensor, ...]:
    """Return sensors with the forward axis of those that name none."""
    return tuple(sensor if sensor.forward else replace(sensor, forward=forward) for sensor in sensors)
