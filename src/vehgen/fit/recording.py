"""A run's recording as numbers: the channels of its sensors, in SI units, on an even clock."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError, shown
from vehgen.files.tables import TableColumns, read_columns
from vehgen.files.tables.headings import MissingColumnError
from vehgen.measure.acquisition import AcquisitionChain
from vehgen.measure.quality import find_clipping, has_cut
from vehgen.mechanics import GRAVITY
from vehgen.mechanics.outputs import Output
from vehgen.simulate import Run
from vehgen.simulate.budgets import placed
from vehgen.simulate.run_file.acquisition import channel_chains, check_nyquist
from vehgen.simulate.run_file.checks import TIME_COLUMN
from vehgen.simulate.run_file.sensors import SensorEntry

Array = NDArray[np.float64]
FEWEST_SAMPLES = 16
"""Fewer samples are no recording: a run has hundreds."""
LOWEST_RATE = 50.0
"""Below this sampling rate [Hz] a recording cannot show the axles' hop."""
LATEST_BEGIN = 86400.0
"""Times of a recording that begin later [s] are those of a clock on the wall."""
FINE_STEPS_SHARE, FINEST_STEP = 0.25, 0.5
"""A recording is finer than its recorder where so many of the steps between its values are below so much of the resolution."""
REFUSED_IN_A_ROW = 5
"""So many equal samples in a row at a channel's extreme are refused as clipped, if they have cut something off: the round top of a slow
motion, in the steps of a resolution, has as many."""


@dataclass(frozen=True)
class RecordedChannel:
    """One recorded channel: its name, the sensor it belongs to and what it measures.

    `noise` is the standard deviation of its white noise [SI] where the run file states it.
    """

    name: str
    sensor: str
    quantity: str
    output: Output
    noise: float | None = None


@dataclass(frozen=True)
class Recording:
    """What a run's sensors recorded: `time shape (n_samples,)` [s] from `time[0]` by `dt`, `values shape (n_samples, n_channels)` [SI]."""

    time: Array
    values: Array
    channels: tuple[RecordedChannel, ...]

    @property
    def dt(self) -> float:
        """Spacing of the samples [s]."""
        return float((self.time[-1] - self.time[0]) / (len(self.time) - 1))

    def of_sensors(self, names: tuple[str, ...]) -> Recording:
        """Return the channels of some sensors only."""
        kept = [i for i, channel in enumerate(self.channels) if channel.sensor in names]
        return replace(self, values=self.values[:, kept], channels=tuple(self.channels[i] for i in kept))


def read_recording(run: Run) -> Recording:
    """Read the recording that a run file names.

    Raises
    ------
    InputError
        Without a recording or sensor, for a missing column, samples that are missing, unevenly spaced or too far apart, for clipped
        acceleration, and for a unit that does not fit the quantity; each says what would be right.
    """
    document, file = run.document, run.file
    if file.recording is None:
        raise InputError("this run has no `recording`, the CSV file of what its sensors measured", document.position)
    if not file.sensors:
        raise InputError("this run has a recording but no `sensors`", document.position)
    channels, units, signs, columns = [], [], [], []
    for sensor_name, sensor in file.sensors.items():
        for quantity, entry in sensor.channels.items():
            channel = replace(_channel(sensor_name, sensor, quantity), noise=sensor.noise(quantity))
            channels.append(channel)
            columns.append(sensor.column(sensor_name, quantity))
            stated = None if isinstance(entry, str) else entry.unit
            units.append(
                (sensor.quantities[quantity], quantity, stated, document.find(("sensors", sensor_name, "channels", quantity, "unit")))
            )
            signs.append(1 if isinstance(entry, str) else entry.sign)
    with placed(run, "recording"), _other_headings():
        table = read_columns(run.folder / file.recording, (TIME_COLUMN, *columns)).in_si(0, "s", "time")
    for number, unit in enumerate(units, 1):
        table = table.in_si(number, *unit)
    values = np.column_stack(table.values[1:]) * np.array(signs, dtype=np.float64)
    _check_clock(table)
    rate = 1 / float(np.median(np.diff(table.values[0])))
    check_nyquist(run, rate)
    chains = channel_chains(run, rate)
    for i, channel in enumerate(channels):
        _check_samples(table, i + 1, values[:, i], channel)
        _check_recorder(table, i + 1, values[:, i], channel, chains[channel.name])
    return Recording(table.values[0], values, tuple(channels))


@contextmanager
def _other_headings() -> Iterator[None]:
    """Tell what to do with a recording whose times have another heading."""
    try:
        yield
    except MissingColumnError as error:
        if error.column != TIME_COLUMN:
            raise
        cure = f"head the times {shown(TIME_COLUMN)}, or let `vehgen import` read the file: it is told which columns are which"
        raise InputError(f"{error.message}; {cure}", error.position) from error


def _channel(sensor_name: str, sensor: SensorEntry, quantity: str) -> RecordedChannel:
    return RecordedChannel(sensor.channel(sensor_name, quantity), sensor_name, quantity, sensor.output(sensor_name, quantity))


def _check_clock(table: TableColumns) -> None:
    table.check_ascending(FEWEST_SAMPLES, "; `vehgen import` sets a clock right that stood still or went back")
    time = table.values[0]
    steps = np.diff(time)
    dt = float(np.median(steps))
    rate = 1 / dt
    if 1000 * rate >= LOWEST_RATE > 50 * rate:
        raise InputError(
            f"logged at {rate:.3g} Hz, if {shown(table.names[0])} is in s: if it is in ms, head the column `{TIME_COLUMN} [ms]`",
            table.heading(0),
        )
    if abs(time[0]) > LATEST_BEGIN:
        raise InputError(
            f"{shown(table.names[0])} begins at {time[0]:.12g} s, but a run's time counts from where its way does: take so much off all "
            "times, or let `vehgen import` find the hump",
            table.place(0),
        )
    if rate < LOWEST_RATE * 0.99:
        raise InputError(
            f"logged at {rate:.3g} Hz; at least {LOWEST_RATE:g} Hz is needed (100 Hz is usual): log again, faster", table.place(1)
        )
    if np.abs(time - time[0] - dt * np.arange(len(time))).max() > 0.25 * dt:
        raise InputError(
            f"an uneven clock (steps of {steps.min():.4g} to {steps.max():.4g} s, most {dt:.4g} s); `vehgen import` puts it on an even one",
            table.place(int(np.argmax(np.abs(steps - dt))) + 1),
        )


def _check_samples(table: TableColumns, column: int, values: Array, channel: RecordedChannel) -> None:
    if np.ptp(values) == 0:
        raise InputError(f"{channel.name} is constant; the sensor recorded nothing", table.heading(column))
    for item in (top for top in find_clipping(values, REFUSED_IN_A_ROW) if has_cut(values, top)):
        raise InputError(
            f"{channel.name} is clipped at {item.level:.4g} from t = {table.values[0][item.first]:.4g} s: use a sensor with a larger "
            "range, a lower speed or a lower hump",
            table.place(item.first, column),
        )


def _check_recorder(table: TableColumns, column: int, values: Array, channel: RecordedChannel, chain: AcquisitionChain) -> None:
    """Refuse a recording that its recorder cannot have made: beyond its range, gravity taken off, or in steps finer than its resolution."""
    reach = math.inf if chain.range is None else chain.range + (GRAVITY if channel.quantity == "acceleration" else 0.0)
    if np.abs(values).max() > reach:
        worst = int(np.argmax(np.abs(values)))
        raise InputError(
            f"{channel.name} is {values[worst]:.4g}, beyond the range of {chain.range:.4g} that `acquisition` states (SI units): "
            "state the recorder's true range",
            table.place(worst, column),
        )
    steps = np.diff(np.unique(values))
    if chain.resolution is not None and np.quantile(steps, FINE_STEPS_SHARE) < FINEST_STEP * chain.resolution:
        raise InputError(
            f"{channel.name} has steps of {np.quantile(steps, FINE_STEPS_SHARE):.3g}, finer than the resolution of {chain.resolution:.4g} "
            "that `acquisition` states (SI units): state the recorder's true resolution, none where the recording was resampled",
            table.heading(column),
        )
