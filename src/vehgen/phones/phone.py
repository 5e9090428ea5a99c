"""One phone's export made ready: cleaned, rates checked, turned to upward acceleration and pitch rate, still on the phone's clock."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import ArgumentError, InputError
from vehgen.phones.export import (
    ACCELERATION_STREAM,
    GRAVITY_STREAM,
    LINEAR_ACCELERATION_STREAM,
    PITCH_RATE_STREAM,
    ROTATION_STREAM,
    SPEED_STREAM,
    VERTICAL_ACCELERATION_STREAM,
    PhoneExport,
    Stream,
)
from vehgen.phones.orientation import Orientation, find_orientation
from vehgen.phones.plan import PhoneSensor
from vehgen.phones.resampling import check_rate, clean, gaps, resample, sampling_rate

Array = NDArray[np.float64]
LONGEST_GAP = 0.1
"""Longer holes within the time that is used [s] are refused."""
LONGEST_LOUD_GAP, NEAR_S = 0.035, 0.15
"""Where a pass moves the phone more than in its mean, from so long before a hole to so long after it [s], no longer hole is bridged: over
50 ms on a hump a quarter of what it felt was lost."""
SHORTEST_RECORDING_S, LONGEST_RECORDING_S = 2.0, 3600.0
"""How long a recording may be [s]."""
QUIET, MARGIN = 5.0, 0.25
"""The quiet stretch: so long at most, ending so long before the hump [s]."""


@dataclass(frozen=True)
class Phone:
    """A phone's cleaned streams, what they are called, and what was found on the way."""

    name: str
    sensor: PhoneSensor
    export: PhoneExport
    acceleration: Stream
    rotation: Stream | None
    gravity: Stream | None
    notes: tuple[str, ...]

    @property
    def begin(self) -> float:
        """The first moment at which all of its sensors recorded [s]."""
        return max(float(stream.time[0]) for stream in self._used())

    @property
    def end(self) -> float:
        """The last moment at which all of its sensors recorded [s]."""
        return min(float(stream.time[-1]) for stream in self._used())

    @property
    def rates(self) -> tuple[float, ...]:
        """Median sampling rates of acceleration and rotation [Hz]."""
        return tuple(sampling_rate(stream.time) for stream in self._used())

    def _used(self) -> list[Stream]:
        return [stream for stream in (self.acceleration, self.rotation) if stream is not None]

    @property
    def in_vehicle_axes(self) -> bool:
        """Whether the columns were already upward acceleration and pitch rate."""
        return self.acceleration.columns != ("x", "y", "z")

    def orientation(self, start: float, end: float) -> Orientation:
        """Return how it lay, by its gravity from `start` to `end` [s]; raises InputError where that leaves a sign open."""
        sensor = self.sensor
        if self.rotation is not None and sensor.forward is None:
            raise ArgumentError(
                f"{self.name}: say with `forward` which of its axes pointed forward, e.g. y where its top edge did; without that the "
                "pitch rate has no sign",
                "forward",
            )
        sign = sensor.acceleration_sign if sensor.acceleration_sign is not None else self.export.acceleration_sign
        if self.gravity is None:
            return find_orientation(None, self.name, sensor.up, sensor.forward, sign)
        values = self.gravity.between(start, end).values
        if len(values) < 10:
            raise InputError(f"{self.name}: no gravity was recorded from {start:.2f} to {end:.2f} s")
        return find_orientation(values.mean(axis=0), self.name, sensor.up, sensor.forward, sign)

    def turned(self, start: float, end: float) -> tuple[Stream, Stream | None, Orientation | None]:
        """Return upward acceleration and pitch rate, nose-down positive, each less its mean from `start` to `end` [s], and how it lay."""
        orientation = None if self.in_vehicle_axes else self.orientation(start, end)
        if orientation is None:
            upward, pitch = self.acceleration.scaled(self._plain_sign(start, end)), self.rotation
        else:
            upward = replace(self.acceleration, values=orientation.upward(self.acceleration.values)[:, None], columns=("up",))
            pitch = None
            if self.rotation is not None and orientation.left is not None:
                pitch = replace(self.rotation, values=orientation.pitch_rate(self.rotation.values)[:, None], columns=("pitch",))
        return _centred(upward, start, end), None if pitch is None else _centred(pitch, start, end), orientation

    def _plain_sign(self, start: float, end: float) -> float:
        if self.sensor.acceleration_sign is not None:
            return float(self.sensor.acceleration_sign)
        part = self.acceleration.between(start, end).values
        if len(part) and float(part.mean()) < -4.0:
            raise ArgumentError(
                f"{self.name}: at rest its acceleration reads {part.mean():.2f} m/s^2, so it points down; write -COLUMN in `columns`, or "
                "acceleration_sign=1 in `sensors` if it is upwards all the same",
                "columns",
                "sensors",
            )
        return 1.0

    def sampled(self, streams: tuple[Stream | None, ...], grid: Array, bridge: float = LONGEST_GAP) -> Array:
        """Return streams on an even grid `shape (n, n_streams)`, refusing holes.

        Raises
        ------
        InputError
            For a hole longer than `bridge` [s], or a grid beyond the recording.
        """
        columns = []
        for stream in streams:
            if stream is None:
                continue
            for start, length in gaps(stream.time):
                if start + length > grid[0] and start < grid[-1] and length > bridge:
                    raise InputError(
                        f"{self.name}: no {stream.unit} samples for {length:.2f} s from {start:.2f} s, within the pass; record again"
                    )
            columns.append(resample(stream.time, stream.values, grid)[:, 0])
        return np.column_stack(columns)

    def check_holes(self, streams: tuple[Stream | None, ...], start: float, end: float) -> None:
        """Refuse holes from `start` to `end` [s] that are bridged badly, as the phone is shaken there; raises InputError."""
        for stream in (item for item in streams if item is not None):
            whole = _rms(stream, start, end)
            for begin, length in gaps(stream.time):
                inside = begin + length > start and begin < end and length > LONGEST_LOUD_GAP
                if inside and _rms(stream, begin - NEAR_S, begin + length + NEAR_S) > whole:
                    raise InputError(
                        f"{self.name}: no {stream.unit} samples for {1e3 * length:.0f} ms from {begin:.2f} s, while it is shaken: what "
                        "would bridge them tells of another vehicle; record again, or leave this phone out"
                    )

    def holes(self) -> list[tuple[float, float]]:
        """Return begin and end of every hole longer than LONGEST_GAP [s]."""
        return [(start, start + length) for stream in self._used() for start, length in gaps(stream.time) if length > LONGEST_GAP]

    def short_gaps(self, start: float, end: float) -> tuple[str, ...]:
        """Return what to say of holes from `start` to `end` [s] that were bridged."""
        found = [gap for stream in self._used() for gap in gaps(stream.time) if start < gap[0] < end]
        return (f"{len(found)} short holes of up to {max(length for _, length in found):.3f} s were bridged",) if found else ()


def make_phone(export: PhoneExport, sensor: PhoneSensor, name: str, top: float) -> Phone:
    """Clean an export's streams and check their rates.

    Parameters
    ----------
    export
        What a reader found.
    sensor
        Where the phone lay.
    name
        What errors call the phone.
    top
        The top of the band that matters [Hz].

    Raises
    ------
    InputError
        Without acceleration, or where a sensor was too slow.
    """
    notes = list(export.notes)

    def cleaned(key: str) -> Stream | None:
        stream = export.streams.get(key)
        if stream is None:
            return None
        found, remarks = clean(stream, f"{name}: {key.replace('_', ' ')}")
        notes.extend(remark.removeprefix(f"{name}: ") for remark in remarks)
        part = found.between(sensor.start, sensor.end)
        if len(part.time) < 2:
            raise InputError(f"{name}: nothing of the {key.replace('_', ' ')} is between from= and to=")
        return part

    key = next(
        (key for key in (VERTICAL_ACCELERATION_STREAM, ACCELERATION_STREAM, LINEAR_ACCELERATION_STREAM) if key in export.streams), None
    )
    if key is None:
        raise InputError(f"{name} holds no acceleration")
    acceleration = cleaned(key)
    assert acceleration is not None
    rotation = cleaned(PITCH_RATE_STREAM if key == VERTICAL_ACCELERATION_STREAM else ROTATION_STREAM)
    gravity = acceleration if key == ACCELERATION_STREAM else cleaned(GRAVITY_STREAM) if key == LINEAR_ACCELERATION_STREAM else None
    if key == LINEAR_ACCELERATION_STREAM and gravity is not None:
        notes.append("gravity taken from the phone's own fusion of sensors")
    check_rate(acceleration.time, top, f"{name}: acceleration")
    if rotation is None:
        notes.append("no gyroscope: no pitch rate")
    else:
        check_rate(rotation.time, top, f"{name}: rotation")
    phone = Phone(name, sensor, export, acceleration, rotation, gravity, tuple(notes))
    if not SHORTEST_RECORDING_S <= phone.end - phone.begin <= LONGEST_RECORDING_S:
        raise InputError(
            f"{name}: its sensors recorded together from {phone.begin:.6g} to {phone.end:.6g} s; "
            f"a pass takes {SHORTEST_RECORDING_S:g} s to an hour: is it the time column? A longer recording is cut with from= and to="
        )
    return phone


def speed_stream(export: PhoneExport) -> Stream | None:
    """Return the GPS speed, None where there is none."""
    return export.streams.get(SPEED_STREAM)


def _centred(stream: Stream, start: float, end: float) -> Stream:
    part = stream.between(start, end).values
    return replace(stream, values=stream.values - (part.mean(axis=0) if len(part) else 0.0))


def _rms(stream: Stream, start: float, end: float) -> float:
    values = stream.between(start, end).values
    return float(np.sqrt(np.mean(values**2))) if len(values) else 0.0
