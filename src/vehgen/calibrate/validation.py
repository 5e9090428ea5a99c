"""Validation: simulated against measured on runs that took no part in the calibration."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Annotated, Any, ClassVar

import numpy as np
import scipy
from numpy.typing import NDArray
from pydantic import Field

from vehgen.errors import ArgumentError, InputError, did_you_mean, shown
from vehgen.files.result_fields import Array1D, Flags
from vehgen.files.results import Result, Table
from vehgen.fit.lead_in import lead_in
from vehgen.fit.trial import Trial, TrialLike, load_trials
from vehgen.measure import ARTICULATED_BANDS, SPECTRA, TWO_AXLE_BANDS, band_rms, record_psd, relative_errors, welch_psd
from vehgen.measure.astm import NOTE
from vehgen.measure.curves import ChannelCurves
from vehgen.measure.likeness import ALIKE_ABOVE, ONE_MOTION, UNLIKE_BELOW, Agreement, agreement
from vehgen.measure.quality import in_foreign_unit
from vehgen.vehicle import Vehicle, VehicleLike, as_vehicle

Array = NDArray[np.float64]
Bands = tuple[tuple[float, float], ...]
SEGMENT = 4.0
"""Length of Welch's segments [s], for runs over rough roads."""
LOUD = 2.0
NOISE_BAND_SHARES = (0.82, 0.94)
"""The top of the band, as shares of the highest frequency."""
REFERENCE_HZ = (1.0, 25.0)
"""Frequencies of a reference spectrum [Hz]."""
READ_AT_REST = ("acceleration", "fore_aft_acceleration", "pitch_rate", "pitch_acceleration")
"""What sensors read of these at rest is an offset of theirs."""
MAX_CHANNELS = 500
"""A file with more channels than this is refused: no figure could show them."""
LONGEST_RECORD = 3.0
"""A run without a hump that is longer than this many segments is averaged by Welch's method."""


@dataclass(frozen=True, eq=False)
class ChannelComparison:
    """One channel of one run, measured against simulated.

    `frequency shape (n,)` [Hz], `measured_psd` and `simulated_psd shape (n,)` [unit^2/Hz]; `measured_rms`, `simulated_rms`, `errors` `shape
    (n_bands,)`, errors as Eq. 32 of Wu & Li 2023; `audible` says in which bands the measured or the simulated RMS stands LOUD times above
    the noise that the top of the band shows, and above what shook the vehicle before a hump: errors elsewhere compare with those. `time`,
    `measured`, `simulated` are the histories; what an accelerometer or a gyroscope reads at rest is taken off; where a run has no
    rest, by how much its mean is another than the simulated one.
    """

    run: str
    channel: str
    quantity: str
    measured_rms: Array1D
    simulated_rms: Array1D
    errors: Annotated[Array1D, Field(alias="relative_errors")]
    audible: Annotated[Flags, Field(alias="above_noise")]
    frequency: Array1D
    measured_psd: Array1D
    simulated_psd: Array1D
    time: Array1D
    measured: Array1D
    simulated: Array1D

    def __post_init__(self) -> None:
        if not len(self.measured_rms) == len(self.simulated_rms) == len(self.errors) == len(self.audible):
            raise ValueError("a number a band was expected")

    @property
    def loudness(self) -> float:
        """The RMS of what was measured, over that of what was simulated, means taken off; infinite where nothing moves."""
        simulated = float(np.std(self.simulated))
        return float(np.std(self.measured)) / simulated if simulated > 0 else float("inf")

    @property
    def in_foreign_unit(self) -> bool:
        """Whether it stands above noise, and is so much louder or quieter than the vehicle's answer as only another unit makes it."""
        return bool(self.audible.any()) and in_foreign_unit(self.loudness)

    @property
    def agreement(self) -> Agreement:
        """How alike both histories are, as they are and with the measured one later by so much."""
        return agreement(self.measured, self.simulated, float(self.time[1] - self.time[0]))

    def doubt(self) -> str | None:
        """Say what a channel's unit, sign or clock may be, where its history is another than the vehicle's answer; None where it is not."""
        if not self.audible.any():
            return None
        what, alike = f"{self.run}: {self.channel}", self.agreement
        if self.in_foreign_unit:
            return f"{what} reads {self.loudness:.4g} times what the vehicle answers: is it in the unit that is stated, and not dead?"
        if alike.at_once < -ALIKE_ABOVE:
            return f"{what} reads the vehicle's answer the other way round (correlation {alike.at_once:.2f}): is its `sign` right?"
        if alike.at_best > ONE_MOTION and alike.at_once < UNLIKE_BELOW:
            when = "later" if alike.late > 0 else "earlier"
            said = f"{abs(alike.late):.2f} s {when} (correlation {alike.at_best:.2f}, as it is {alike.at_once:.2f})"
            return f"{what} is like the vehicle's answer {said}: is the road's place (a hump's `at`), the speed or the clock another?"
        if alike.at_best < UNLIKE_BELOW:
            return (
                f"{what} is nowhere like the vehicle's answer (correlation up to {alike.at_best:.2f}): is it of this run, over this road?"
            )
        return None

    @property
    def psds(self) -> ChannelCurves:
        """The PSDs as curves."""
        return ChannelCurves(self.run, self.channel, self.quantity, self.frequency, self.measured_psd, self.simulated_psd)

    @property
    def histories(self) -> ChannelCurves:
        """The histories as curves."""
        return ChannelCurves(self.run, self.channel, self.quantity, self.time, self.measured, self.simulated)


def seem_exchanged(one: ChannelComparison, other: ChannelComparison) -> bool:
    """Whether two channels of a run, of one quantity, are each like the vehicle's answer at the other's place, and not at their own."""
    if (one.run, one.quantity) != (other.run, other.quantity) or not (one.audible.any() and other.audible.any()):
        return False
    dt = float(one.time[1] - one.time[0])
    own = [agreement(item.measured, item.simulated, dt).at_once for item in (one, other)]
    across = [agreement(one.measured, other.simulated, dt).at_once, agreement(other.measured, one.simulated, dt).at_once]
    return max(own) < UNLIKE_BELOW and min(across) > ALIKE_ABOVE


@dataclass(frozen=True, eq=False)
class ReferenceSpectrum:
    """A standard's spectrum of acceleration to draw beside the measured ones: `frequency` [Hz], `psd` [m^2/s^4/Hz], both `shape (n,)`."""

    name: str
    frequency: Array1D
    psd: Array1D


@dataclass(frozen=True, eq=False)
class Validation(Result):
    """All channels of all runs of a vehicle, in bands [Hz]; `reference` is a spectrum to draw beside them."""

    KIND: ClassVar[str] = "validation"
    DRAWING: ClassVar[str] = "vehgen.report.plots.validation_plots:plot_validation"

    vehicle: str
    bands: Annotated[Bands, Field(alias="bands_hz")]
    channels: Annotated[tuple[ChannelComparison, ...], Field(max_length=MAX_CHANNELS)]
    reference: ReferenceSpectrum | None = None

    def __post_init__(self) -> None:
        if any(len(item.errors) != len(self.bands) for item in self.channels):
            raise ValueError("a number a band was expected of every channel")

    def doubtful_channels(self) -> tuple[str, ...]:
        """Say which channels seem to be exchanged, and what the unit, sign or clock of others may be."""
        pairs = [pair for pair in combinations(self.channels, 2) if seem_exchanged(*pair)]
        places = [
            f"{one.run}: {one.channel} and {other.channel} each read what the vehicle answers at the other's place" for one, other in pairs
        ]
        known = [id(item) for pair in pairs for item in pair]
        others = [doubt for item in self.channels if id(item) not in known and (doubt := item.doubt())]
        return (*(f"{text}: are they exchanged?" for text in places), *others)

    @property
    def worst(self) -> float:
        """The largest magnitude of a relative band-RMS error of an acceleration, in bands above the noise."""
        errors = [np.abs(item.errors[item.audible]) for item in self.channels if item.quantity == "acceleration"]
        every = np.concatenate(errors) if errors else np.zeros(0)
        return float(np.nanmax(every)) if every.size else float("nan")

    def _packed(self, data: dict[str, Any]) -> dict[str, Any]:
        return {**data, "worst_acceleration_error": None if np.isnan(self.worst) else self.worst}

    def table(self) -> Table:
        """Return the band RMS, a row a run, channel and band."""
        columns = ("run", "channel", "from [Hz]", "to [Hz]", "measured rms", "simulated rms", "relative error", "above noise")
        return columns, [
            (item.run, item.channel, *band, float(measured), float(simulated), float(error), bool(audible))
            for item in self.channels
            for band, measured, simulated, error, audible in zip(
                self.bands, item.measured_rms, item.simulated_rms, item.errors, item.audible, strict=True
            )
        ]


def validate(
    vehicle: VehicleLike, runs: TrialLike | Sequence[TrialLike], *, bands: Bands | None = None, reference: str | None = None
) -> Validation:
    """Compare simulated with measured on every channel.

    Runs over rough roads are compared by Welch's PSD, hump runs as one record. The vehicle's own values are used: calibrate writes a
    vehicle file that holds them.

    Parameters
    ----------
    vehicle
        Itself, its file (such as a calibration wrote), or the name of a bundled model.
    runs
        Runs with recordings: their files, runs, or trials.
    bands
        Frequency bands [Hz] (default: the paper's, for two axles or for articulated vehicles).
    reference
        A standard's spectrum to draw beside the accelerations, such as `level II`.

    Raises
    ------
    InputError
        For bands or a spectrum that are none, and for runs that cannot be used.
    """
    spectrum = None if reference is None else reference_spectrum(reference)
    own = as_vehicle(vehicle)
    used = _bands(bands, own)
    channels = [item for trial in load_trials(runs, own) for item in compare_trial(trial, used)]
    return Validation(own.name, used, tuple(channels), spectrum)


def _bands(bands: Bands | None, vehicle: Vehicle) -> Bands:
    if bands is None:
        return ARTICULATED_BANDS if vehicle.hinges else TWO_AXLE_BANDS[:5]
    if not bands or not all(len(band) == 2 and 0 <= band[0] < band[1] for band in bands):
        raise ArgumentError(f"`bands`: frequencies [Hz] that ascend were expected, found {shown(bands)}", "bands")
    return tuple((float(low), float(high)) for low, high in bands)


def compare_trial(trial: Trial, bands: Bands) -> list[ChannelComparison]:
    """Return every channel of a trial, measured against simulated at the trial's own values."""
    found = []
    model = trial.simulator.model
    population = np.array([[trial.values[name] for name in model.parameters]])
    result = trial.simulator.run(population, trial.scenario)
    if result.failures:
        raise InputError(f"{trial.name}: {result.failures[0]}")
    rough = not any(entry.hump is not None for entry in trial.run.file.road)
    dt, before = trial.recording.dt, lead_in(trial)
    for i, channel in enumerate(trial.recording.channels):
        measured, simulated = trial.recording.values[:, i], result.responses[0, :, i]
        if channel.quantity in READ_AT_REST:
            measured = measured - (measured.mean() - simulated.mean() if before is None else before.recording.values[:, i].mean())
        densities = []
        for values in (measured, simulated):
            averaged = rough and len(values) * dt > LONGEST_RECORD * SEGMENT
            frequency, density = welch_psd(values, dt, SEGMENT) if averaged else record_psd(values, dt)
            densities.append(density)
        rms = [band_rms(frequency, density, bands) for density in densities]
        noise = _noise_rms(frequency, densities[0], bands, len(measured) * dt / SEGMENT if averaged else 0.5)
        if before is not None:
            still = before.recording.values[len(before.recording.time) % 2 :, i]  # an even count reaches the highest frequency
            noise = np.maximum(noise, band_rms(*record_psd(still - still.mean(), dt), bands))
        found.append(
            ChannelComparison(
                run=trial.name,
                channel=channel.name,
                quantity=channel.quantity,
                measured_rms=rms[0],
                simulated_rms=rms[1],
                errors=relative_errors(rms[1], rms[0]),
                audible=np.maximum(rms[0], rms[1]) > LOUD * noise,
                frequency=frequency,
                measured_psd=densities[0],
                simulated_psd=densities[1],
                time=trial.recording.time,
                measured=measured,
                simulated=simulated,
            )
        )
    return found


def reference_spectrum(name: str) -> ReferenceSpectrum:
    """Return a standard's spectrum, of :data:`vehgen.measure.SPECTRA`, as figures of a validation show it.

    Raises
    ------
    InputError
        For a name that no spectrum has.
    """
    if name not in SPECTRA:
        raise ArgumentError(f"`reference`: no spectrum {shown(name)}; {did_you_mean(name, SPECTRA)}", "reference")
    frequency = np.geomspace(*REFERENCE_HZ, 200)
    return ReferenceSpectrum(f"{SPECTRA[name].name} ({NOTE})", frequency, SPECTRA[name].at(frequency))


def _noise_rms(frequency: Array, density: Array, bands: Bands, segments: float) -> Array:
    """Return the RMS that white noise of the level at the top of the band would have in bands, `shape (n_bands,)`.

    The level is told by the median of lines, each the mean of as many squares as so many half-overlapping `segments` have: of a single
    record two, of many about 3.8 a segment (P. D. Welch, IEEE Trans. Audio Electroacoust. 15, 1967, doi:10.1109/TAU.1967.1161901).
    """
    inside = (frequency >= NOISE_BAND_SHARES[0] * frequency[-1]) & (frequency <= NOISE_BAND_SHARES[1] * frequency[-1])
    freedom = 2.0 if segments < 1 else 36 * (count := 2 * segments - 1) ** 2 / (19 * count - 1)
    level = float(np.median(density[inside]) * freedom / scipy.stats.chi2.median(freedom))
    return np.sqrt(level * np.array([high - low for low, high in bands]))
