"""Sensors in one vehicle compared with each other, and with a model of it, on a rough road that nobody measured.

The road's level cancels in the ratio of two channels. The axles' delays do not, so that a model's ratio is computed at the speeds of the
drive. See docs/transmissibility.md for what the ratio can tell and what it cannot.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import ArgumentError, InputError, did_you_mean, shown
from vehgen.files.result_fields import rounded
from vehgen.fit.ratio_bands import compared_ratio, squares_outside
from vehgen.fit.rough_drives import Recordings, RoughDrive, as_exports, drive_of_phones, drive_of_run
from vehgen.fit.transmissibility_result import ChannelRatio, Resonance, Transmissibility
from vehgen.measure.shared_peaks import WIDTH_LINES, shared_peaks
from vehgen.measure.transmissibility import (
    FEWEST_AVERAGES,
    RatioEstimate,
    SegmentTransforms,
    estimate_ratio,
    model_ratio,
    segment_transforms,
)
from vehgen.mechanics import EquationsOfMotion
from vehgen.phones import PhoneSensor
from vehgen.phones.csv_table import ColumnMaps
from vehgen.simulate import Modes, natural_modes
from vehgen.simulate.rough_road import rough_road_spectra
from vehgen.vehicle import VehicleLike

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
DEFAULT_BANDS = ((0.5, 2.0), (2.0, 5.0), (5.0, 8.0), (8.0, 12.0), (12.0, 15.0), (15.0, 20.0))
"""Bands in which ratios are summed up [Hz]."""
MIN_MOVING_SPEED_M_S = 1.0
"""Segments in which a vehicle is slower are left out: no road moves it."""
MAX_MODEL_SPEEDS = 24
"""So many speeds stand for those of a drive."""
MAX_PASSING_SHARE = 0.25
"""Of a segment: the time from the first axle to the last, so that both see nearly the same road in it."""
DELAY_STEP_CYCLES = 0.1
"""Delays between clocks are tried so finely that the phase at the top of the band moves by so much."""
TOLD_SPEED_SIGMA = 0.01
"""Standard deviation of a told speed, relative ..."""
DRIVE_SPEED_SCALES = 1 + np.arange(-3, 3.01, 0.25) / 100
"""... and the factors on it among which the likeliest is sought."""
NEAR_MODE_SHARE = 0.25
"""A mode is named beside a peak that is no farther from it, relative."""
TELLS = (
    "the ratio of motions between the sensors' places, line by line, within its limits",
    "resonances that all sensors show; wheels out of balance and engines make such peaks too",
)
TELLS_OF_MODEL = "whether the model's ratio lies within the measured limits, band by band"
CANNOT_TELL = (
    "the scale of masses, stiffnesses and dampers: all of them times one number leave every ratio as it is",
    "how rough the road is",
    "any parameter that moves all sensors alike",
    "roll, which no model has: felt by one sensor it widens the limits, felt by both it shifts the ratio; lay phones on the centre line",
    "differences below about 2 %: phones' gains differ by so much",
)


def transmissibility(
    recordings: Recordings,
    *,
    vehicle: VehicleLike | None = None,
    sensors: Sequence[PhoneSensor] = (),
    reference: str | None = None,
    parameter_set: str | None = None,
    speed: float | None = None,
    forward: str | None = None,
    bands: Sequence[tuple[float, float]] | None = None,
    segment: float = 8.0,
    columns: ColumnMaps = None,
) -> Transmissibility:
    """Compare sensors in one vehicle with each other on a rough road, and a vehicle's model with both.

    Parameters
    ----------
    recordings
        Exports of the phones on one drive, one a phone; or a run with a recording, or its file.
    vehicle
        What the phones lay in, to compare with: itself, its file, or the name of a bundled model (default: none; of a run its own).
    sensors
        How each phone lay, in the exports' order; with a vehicle where, too (default without one: S1, S2, ... by gravity).
    reference
        The channel that all others are divided by, or its sensor (default: the first).
    parameter_set
        One of the vehicle's sets.
    speed
        Of the drive [m/s] (default: the phones' GPS, or the run's); only a model needs it.
    forward
        The phones' axis that pointed forward, where a sensor does not say; pitch rates are read where it is known.
    bands
        In which ratios are summed up [Hz], ascending (default: 0.5, 2, 5, 8, 12, 15, 20 Hz).
    segment
        Length of the averaged segments [s]; the lines are as far apart as its inverse.
    columns
        Which columns of plain CSV files hold what: of all, or of each export.

    Raises
    ------
    InputError
        For recordings that cannot be used, such as those of one channel alone; it says what to record instead.
    """
    chosen = _checked_bands(bands, segment)
    exports = as_exports(recordings)
    if exports is None:
        drive = drive_of_run(recordings, vehicle, parameter_set, sensors)
    else:
        drive = drive_of_phones(exports, vehicle, sensors, parameter_set, forward, chosen[-1][1], segment, columns)
    drive = drive.with_reference(_reference(drive, reference))
    transforms, speeds, notes = _usable(drive, segment, speed)
    lines = transforms.between(chosen[0][0], chosen[-1][1])
    return _compared(drive, lines, speeds, chosen, segment, notes)


def _compared(
    drive: RoughDrive,
    lines: SegmentTransforms,
    speeds: Array | None,
    bands: Sequence[tuple[float, float]],
    segment: float,
    notes: Sequence[str],
) -> Transmissibility:
    spectra, averages = lines.spectra(), lines.averages()
    estimates = [estimate_ratio(spectra, averages, 0, i) for i in range(1, len(drive.names))]
    expected, modes, scale = None, None, None
    if drive.model is not None:
        if speeds is None:
            raise ArgumentError("no GPS told how fast the drive was; a model needs `speed` in m/s, e.g. 15.0", "speed")
        expected, scale = _expected(drive, drive.model, lines.frequency, speeds, segment, estimates)
        modes = natural_modes(drive.model, drive.values)
    count = len(bands) * len(estimates)
    ratios: list[ChannelRatio] = []
    for i, estimate in enumerate(estimates, start=1):
        unit = f"({drive.units[i]})/({drive.units[0]})" if drive.units[i] != drive.units[0] else "1"
        ratios.append(compared_ratio(drive.names[i], unit, lines.frequency, estimate, bands, expected, i, count))
    densities = np.real(np.einsum("nii->ni", spectra))
    return Transmissibility(
        title=drive.title,
        channels=drive.names,
        units=drive.units,
        frequency=lines.frequency,
        densities=rounded(densities),
        ratios=tuple(ratios),
        resonances=_resonances(drive, lines.frequency, densities, averages, estimates, modes),
        averages=averages,
        segment=segment,
        duration=float(drive.time[-1] - drive.time[0]),
        speeds=None if speeds is None else (float(speeds.min()), float(np.median(speeds)), float(speeds.max())),
        speed_scale=scale,
        vehicle=drive.vehicle_title,
        tells=(*TELLS, TELLS_OF_MODEL) if drive.model is not None else TELLS,
        cannot_tell=CANNOT_TELL,
        notes=(*drive.notes, *notes),
        warnings=drive.warnings,
    )


def _expected(
    drive: RoughDrive, model: EquationsOfMotion, lines: Array, speeds: Array, segment: float, estimates: Sequence[RatioEstimate]
) -> tuple[Complex, float]:
    """Return the model's spectra at the speeds of the drive times one factor, and that factor, the likeliest."""
    shares = np.quantile(speeds, (np.arange(MAX_MODEL_SPEEDS) + 0.5) / MAX_MODEL_SPEEDS) if np.ptp(speeds) else speeds[:1]
    passing = float(model.wheel_offsets(drive.values).max(initial=0.0) / np.median(speeds))
    if passing > MAX_PASSING_SHARE * segment:
        raise ArgumentError(
            f"the last axle meets the road {passing:.3g} s after the first; `segment` must be {1 / MAX_PASSING_SHARE:g} times as long at "
            "least, or the drive faster",
            "segment",
        )
    delays = _delays(drive, model, lines, shares, segment, estimates)

    def misfit(scale: float) -> tuple[float, Complex]:
        expected = rough_road_spectra(model, lines, speeds=scale * shares, segment=segment, values=drive.values, delays=delays)
        pairs = [(estimate, model_ratio(expected, 0, i)) for i, estimate in enumerate(estimates, start=1)]
        squares = [squares_outside(estimate, model, estimate.common) for estimate, model in pairs]
        return float(np.sum(squares)) + ((scale - 1) / TOLD_SPEED_SIGMA) ** 2, expected

    found = {float(scale): misfit(float(scale)) for scale in DRIVE_SPEED_SCALES}
    best = min(found, key=lambda scale: found[scale][0])
    return found[best][1], best


def _delays(
    drive: RoughDrive, model: EquationsOfMotion, lines: Array, speeds: Array, segment: float, estimates: Sequence[RatioEstimate]
) -> Array:
    """Return how much later than the reference's each channel's clock is read `shape (n_channels,)` [s], by the model's phases.

    Clocks that were put on one another by what the phones recorded are off by the way from axle to axle: in slow, long vehicles by a good
    part of a segment.
    """
    spectra = rough_road_spectra(model, lines, speeds=speeds, values=drive.values)
    tried = np.arange(-segment / 2, segment / 2, DELAY_STEP_CYCLES / lines[-1])
    turns = np.exp(2j * np.pi * lines * tried[:, None])
    delays = np.zeros(len(drive.names))
    for sensor in set(drive.sensors) - {drive.sensors[0]}:
        own = [i for i, name in enumerate(drive.sensors) if name == sensor]
        phases = (np.exp(1j * (estimates[i - 1].phase - np.angle(spectra[:, 0, i]))) * estimates[i - 1].coherence for i in own)
        delays[own] = tried[np.argmax((turns @ sum(phases)).real)]
    return delays


def _usable(drive: RoughDrive, segment: float, speed: float | None) -> tuple[SegmentTransforms, Array | None, list[str]]:
    """Return the segments that were recorded whole while the vehicle moved, their speeds [m/s] where known, and what was left out."""
    if speed is not None and not MIN_MOVING_SPEED_M_S <= speed <= 100.0:
        raise ArgumentError(f"`speed`: from {MIN_MOVING_SPEED_M_S:g} to 100 m/s was expected, found {speed:g} m/s", "speed")
    step = float(drive.time[-1] - drive.time[0]) / (len(drive.time) - 1)
    transforms = segment_transforms(drive.values_by_channel, step, segment)
    middle = transforms.middle
    whole = np.full(len(middle), True)
    for begin, end in drive.holes:
        whole &= (middle + segment / 2 < begin) | (middle - segment / 2 > end)
    gps = None if drive.speed is None else np.interp(middle, *drive.speed)
    moving = np.full(len(middle), True) if gps is None else gps >= MIN_MOVING_SPEED_M_S
    used = whole & moving
    if used.sum() < FEWEST_AVERAGES:
        raise InputError(
            f"{int(used.sum())} of {len(used)} half-overlapping segments of {segment:g} s were recorded whole, while the vehicle moved; at "
            f"least {FEWEST_AVERAGES} are needed: record a longer drive, or take shorter segments"
        )
    notes = [f"{int((~whole).sum())} of {len(used)} segments are left out: a phone did not record throughout"] if not whole.all() else []
    if (standing := int((whole & ~moving).sum())) > 0:
        notes.append(f"{standing} of {len(used)} segments are left out: slower than {MIN_MOVING_SPEED_M_S:g} m/s")
    speeds = np.full(int(used.sum()), speed) if speed is not None else None if gps is None else gps[used]
    return transforms.kept(used), speeds, notes


def _resonances(
    drive: RoughDrive, frequency: Array, densities: Array, averages: float, estimates: Sequence[RatioEstimate], modes: Modes | None
) -> tuple[Resonance, ...]:
    turning = np.array(["rate" in quantity for quantity in drive.quantities])
    accelerations = densities * np.where(turning, (2 * np.pi * frequency[:, None]) ** 2, 1.0)
    found = []
    for peak in shared_peaks(frequency, accelerations, averages):
        near = min(modes, key=lambda mode: abs(mode.damped_hz - peak.frequency)) if modes else None
        if near is not None and abs(near.damped_hz - peak.frequency) > NEAR_MODE_SHARE * peak.frequency:
            near = None
        at = np.abs(frequency - peak.frequency) <= WIDTH_LINES * (frequency[1] - frequency[0])
        coherence = min(float(estimate.coherence[at].max()) for estimate in estimates)
        mode = (near.name, near.damped_hz) if near else (None, None)
        found.append(Resonance(peak.frequency, peak.prominence, coherence, *mode))
    return tuple(found)


def _reference(drive: RoughDrive, wanted: str | None) -> int:
    if wanted is None or wanted in drive.names:
        return 0 if wanted is None else drive.names.index(wanted)
    if wanted in drive.sensors:
        return drive.sensors.index(wanted)
    raise ArgumentError(
        f"`reference`: no channel {shown(wanted)}; {did_you_mean(wanted, dict.fromkeys((*drive.names, *drive.sensors)))}", "reference"
    )


def _checked_bands(bands: Sequence[tuple[float, float]] | None, segment: float) -> tuple[tuple[float, float], ...]:
    chosen = DEFAULT_BANDS if bands is None else tuple((float(low), float(high)) for low, high in bands)
    if not 0.2 <= segment <= 120.0:
        raise ArgumentError(f"`segment`: from 0.2 to 120 s was expected, found {segment:g} s", "segment")
    if not chosen or any(not 0 < low < high < np.inf for low, high in chosen) or any(a[1] > b[0] for a, b in pairwise(chosen)):
        raise ArgumentError("`bands`: two frequencies or more above 0 Hz, ascending, were expected", "bands")
    if any((high - low) * segment < 3 for low, high in chosen) or chosen[0][0] * segment < 2:
        raise ArgumentError(
            f"`bands`: with lines {1 / segment:.3g} Hz apart, each must hold three and the first begin at two; widen them, or lengthen "
            "`segment`",
            "bands",
            "segment",
        )
    return chosen
