"""From phone exports of one drive over a rough road to channels on one even clock: no hump, no profile and no vehicle is needed."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import ArgumentError
from vehgen.measure.transmissibility import FEWEST_AVERAGES
from vehgen.phones.csv_table import ColumnMaps
from vehgen.phones.importing import clipping_warnings, read_phones
from vehgen.phones.mutual_clocks import MAX_DRIFT, ClockMap, check_epochs, epoch_shift, find_drift, find_shift
from vehgen.phones.phone import Phone, speed_stream
from vehgen.phones.plan import PhoneSensor

Array = NDArray[np.float64]
GRID_RATE_HZ = 100.0
"""Rate of the channels [Hz]."""
TOP_SHARE = 0.4
"""Share of the grid's rate up to which a band may reach: above, its low-pass begins."""
WORLD_CLOCK_DOUBT_S = 5.0
"""World clocks that differ by more from what the recordings say deserve a warning; a long vehicle's rear meets a road some seconds late."""
AT_THE_END = 0.98
"""Share of the largest drift that is looked for from which on the true one may be larger."""
EDGE_S = 0.05
"""Left out at either end of what the phones recorded together [s]."""


@dataclass(frozen=True)
class RoughRoadChannel:
    """A channel: its name, its sensor, `acceleration` or `pitch_rate`, and its unit."""

    name: str
    sensor: str
    quantity: str
    unit: str


@dataclass(frozen=True, eq=False)
class RoughRoadDrive:
    """What phones recorded together on a drive.

    `time shape (n,)` [s] from 0, `values shape (n, n_channels)`; `gps` moments [s] and speeds [m/s], `shape (k,)` each, None where no phone
    recorded any; `holes` begin and end [s] of what some phone did not record: values there are made up; `notes` say what was found and
    assumed, `warnings` what is doubtful.
    """

    time: Array
    values: Array
    channels: tuple[RoughRoadChannel, ...]
    gps: tuple[Array, Array] | None
    holes: tuple[tuple[float, float], ...]
    notes: tuple[str, ...]
    warnings: tuple[str, ...]


def read_drive(
    exports: Sequence[str | os.PathLike[str]], sensors: Sequence[PhoneSensor], top: float, segment: float, columns: ColumnMaps = None
) -> RoughRoadDrive:
    """Read the exports of the phones in one vehicle, on one drive.

    Parameters
    ----------
    exports
        One a phone.
    sensors
        How each lay, in the exports' order. Its pitch rate is read where `forward` is said.
    top
        Top of the band that matters [Hz].
    segment
        Length of the half-overlapping segments that will be averaged [s]: the phones must have recorded together long enough for them.
    columns
        Which columns of plain CSV files hold what: of all, or of each export.

    Raises
    ------
    InputError
        For exports that cannot be read or used, or have nothing in common.
    """
    if not 1.0 <= top <= TOP_SHARE * GRID_RATE_HZ:
        raise ArgumentError(f"`bands`: they must end between 1 and {TOP_SHARE * GRID_RATE_HZ:g} Hz, found {top:g} Hz", "bands")
    phones = [_usable(phone) for phone in read_phones(exports, sensors, columns, top)]
    clocks, clock_notes, warnings = _clocks(phones, segment)
    begin = max(float(clock.inverse(np.array(phone.begin))) for phone, clock in zip(phones, clocks, strict=True)) + EDGE_S
    end = min(float(clock.inverse(np.array(phone.end))) for phone, clock in zip(phones, clocks, strict=True)) - EDGE_S
    grid = np.arange(begin, end, 1 / GRID_RATE_HZ)
    values, channels, notes, holes = [], [], [], list[tuple[float, float]]()
    for phone, clock in zip(phones, clocks, strict=True):
        own = clock.at(grid)
        upward, pitch, orientation = phone.turned(float(own[0]), float(own[-1]))
        values.append(phone.sampled((upward, pitch), own, bridge=np.inf))
        holes += [(float(a) - begin, float(b) - begin) for a, b in (clock.inverse(np.array(hole)) for hole in phone.holes())]
        channels.append(RoughRoadChannel(f"{phone.sensor.name}_az", phone.sensor.name, "acceleration", "m/s^2"))
        if pitch is not None:
            channels.append(RoughRoadChannel(f"{phone.sensor.name}_q", phone.sensor.name, "pitch_rate", "rad/s"))
        notes += _notes(phone, (*phone.notes, *(orientation.notes if orientation else ())))
        warnings += clipping_warnings(phone.name, phone.acceleration.between(float(own[0]), float(own[-1])))
        warnings += [f"{phone.name}: {text}" for text in (orientation.warnings if orientation else ())]
    gps = _gps(phones, clocks)
    return RoughRoadDrive(
        grid - begin,
        np.column_stack(values),
        tuple(channels),
        None if gps is None else (gps[0] - begin, gps[1]),
        tuple(holes),
        (*notes, *clock_notes),
        tuple(warnings),
    )


def _usable(phone: Phone) -> Phone:
    """Return a phone without its gyroscope where nobody said which of its axes pointed forward: its pitch rate would have no axis."""
    if phone.rotation is None or phone.sensor.forward is not None or phone.in_vehicle_axes:
        return phone
    return replace(phone, rotation=None, notes=(*phone.notes, "its pitch rate is left out: nobody said which of its axes pointed forward"))


def _clocks(phones: Sequence[Phone], segment: float) -> tuple[list[ClockMap], list[str], list[str]]:
    """Return every phone's clock against the first's, what was found of them, and what is doubtful."""
    first, clocks, notes, warnings = phones[0], [ClockMap()], list[str](), list[str]()
    step = 1 / GRID_RATE_HZ
    for other in phones[1:]:
        names = f"{first.name} and {other.name}"
        check_epochs(first.export, (first.begin, first.end), other.export, (other.begin, other.end), names)
        own, theirs = (np.arange(phone.begin, phone.end, step) for phone in (first, other))
        signals = [_upward(phone, grid) for phone, grid in ((first, own), (other, theirs))]
        least = segment * FEWEST_AVERAGES / 2
        shift = find_shift((own, signals[0]), (theirs, signals[1]), least, (first.name, other.name))
        begin, end = max(first.begin, other.begin - shift), min(first.end, other.end - shift)
        time = np.arange(begin, end, step)
        drift = find_drift(time, _upward(first, time), _upward(other, time + shift), segment)
        clock = ClockMap(shift, drift, float(begin + end) / 2)
        shift += find_shift((time, _upward(first, time)), (time, _upward(other, clock.at(time))), least / 2, (first.name, other.name))
        clocks.append(replace(clock, shift=shift))
        if abs(drift) > AT_THE_END * MAX_DRIFT:
            warnings.append(
                f"{names}: their clocks differ by {1e6 * abs(drift):.0f} millionths or more, the most that is looked for: are the "
                "times of one made of a nominal rate? What both recorded fits less and less in time"
            )
        notes.append(
            f"{other.name}: its clock is {shift:+.3f} s ahead of that of {first.name} and runs {1e6 * drift:+.0f} millionths faster"
        )
        told = epoch_shift(first.export, other.export, float(begin), float(begin + shift))
        if told is not None and abs(told - shift) > WORLD_CLOCK_DOUBT_S:
            warnings.append(
                f"{names}: the apps' world clocks are {told - shift:+.2f} s off the shift at which the recordings agree best, which was "
                "taken: are both of one drive?"
            )
    return clocks, notes, warnings


def _upward(phone: Phone, grid: Array) -> Array:
    upward, _, _ = replace(phone, rotation=None).turned(float(grid[0]), float(grid[-1]))
    return np.asarray(np.interp(grid, upward.time, upward.values[:, 0]))


def _notes(phone: Phone, remarks: Sequence[str]) -> list[str]:
    rates = " and ".join(f"{rate:.2f} Hz" for rate in phone.rates)
    return [f"{phone.name} ({phone.export.app}): sampled at {rates}", *(f"{phone.name}: {remark}" for remark in remarks)]


def _gps(phones: Sequence[Phone], clocks: Sequence[ClockMap]) -> tuple[Array, Array] | None:
    """Return the moments on the first phone's clock [s] and the speeds [m/s] of the first GPS that has any."""
    for phone, clock in zip(phones, clocks, strict=True):
        stream = speed_stream(phone.export)
        if stream is None:
            continue
        known = np.isfinite(stream.time) & np.isfinite(stream.values[:, 0]) & (stream.values[:, 0] >= 0)
        if known.sum() >= 2:
            order = np.argsort(stream.time[known], kind="stable")
            return clock.inverse(stream.time[known][order]), stream.values[known, 0][order]
    return None
