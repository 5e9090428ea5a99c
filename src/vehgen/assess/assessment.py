"""Assess a run: every number that a standard makes of its motions."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from vehgen.assess.motion import Array, AssessedChannel, AssessedMotion, recorded_motion, simulated_motion
from vehgen.assess.result import (
    Assessment,
    ChannelStatistics,
    LevelComparison,
    LoadCycles,
    RideComfort,
    ShockSpectrum,
    TransportVibration,
    TyreLoad,
)
from vehgen.errors import ArgumentError, did_you_mean
from vehgen.files.provenance import file_hashes, versions
from vehgen.files.result_fields import rounded
from vehgen.files.units import STANDARD_GRAVITY
from vehgen.measure import SPECTRA, band_rms, welch_psd
from vehgen.measure.rainflow import equivalent_range, exceedances, rainflow_cycles
from vehgen.measure.ride_comfort import WEIGHTINGS, WeightedVibration, evaluate_vibration, likely_reaction, reasons_to_doubt_rms
from vehgen.measure.shock_response import USUAL_QUALITY, shock_response, spectrum_frequencies
from vehgen.measure.tyre_loads import load_statistics
from vehgen.simulate import RunLike, as_run
from vehgen.simulate.run_file.files_read import files_read
from vehgen.vehicle import VehicleLike

VERTICAL_WEIGHTINGS = ("Wk", "Wb")
FORE_AFT_WEIGHTING = "Wd"
CYCLED = ("suspension_travel", "link_travel", "suspension_force", "link_force", "tyre_force", "tyre_load", "hinge_force", "hinge_load")
"""Quantities whose cycles are counted."""
ALWAYS_TOLD = ("hinge_force",)
"""Quantities whose RMS, peak and crest factor are told, beside those of vertical accelerations, though the run does not ask for them."""
TRANSPORT_BAND_HZ = (1.0, 200.0)
"""Where the truck levels of ASTM D4169 are defined."""
EXCEEDANCE_LEVELS = 40
LEAST_COUNTED = 0.01
"""Cycles below this share of the largest range are not counted; the equivalent range has them all."""
HIGHEST_WEIGHTED_HZ = 80.0
"""ISO 2631-1 weighs vibration up to here."""


def assess(
    run: RunLike,
    *,
    vehicle: VehicleLike | None = None,
    recorded: bool = False,
    weighting: str = "Wk",
    slope: float = 5.0,
    start: float = 0.0,
) -> Assessment:
    """Tell what a run means to people, roads and cargo.

    Parameters
    ----------
    run
        A run or its file.
    vehicle
        In place of the one that the run names: itself, its file, or the name of a bundled model.
    recorded
        Assess the run's recording (default: its simulation).
    weighting
        Of vertical accelerations: Wk, or Wb of trains; fore-aft ones are weighted by Wd.
    slope
        m of the S-N line by which cycles are made one equivalent range, from 1 to 20.
    start
        How many seconds are left out at the beginning.

    Raises
    ------
    InputError
        For a run that cannot be simulated or has no recording, and arguments that cannot be.
    """
    if weighting not in VERTICAL_WEIGHTINGS:
        known = did_you_mean(str(weighting), VERTICAL_WEIGHTINGS)
        raise ArgumentError(f"`weighting`: unknown frequency weighting {str(weighting)[:40]!r}; {known}", "weighting")
    if not 1 <= slope <= 20:
        raise ArgumentError(f"`slope`: a number from 1 to 20 was expected, found {slope:g}", "slope")
    run = as_run(run, vehicle)
    motion = (recorded_motion(run) if recorded else simulated_motion(run)).after(start)
    accelerations = [item for item in motion.channels if item.on_body and item.quantity in ("acceleration", "fore_aft_acceleration")]
    vertical = [item for item in accelerations if item.quantity == "acceleration"]
    ride = tuple(_ride(item, motion.dt, weighting) for item in accelerations)
    return Assessment(
        title=run.file.title or f"{run.vehicle.title or run.vehicle.name}, {motion.duration:.4g} s",
        vehicle=run.vehicle.name,
        source="recording" if recorded else "simulation",
        start=float(start),
        duration=motion.duration,
        rate=1 / motion.dt,
        channels=tuple(_statistics(item) for item in motion.channels if item.is_asked or item in vertical or item.quantity in ALWAYS_TOLD),
        ride=ride,
        tyres=tuple(_tyres(motion)),
        transport=tuple(_transport(item, motion.dt) for item in vertical),
        shock=tuple(_shock(item, motion.dt) for item in vertical),
        cycles=tuple(_cycles(item, motion.duration, slope) for item in _cycled(motion)),
        notes=(*motion.warnings, *_notes(motion, ride)),
        versions=versions(),
        inputs=file_hashes(files_read([run], recordings=recorded, inputs=not recorded)),
    )


def _statistics(item: AssessedChannel) -> ChannelStatistics:
    moved = item.values - item.values.mean()
    rms, peak = float(np.sqrt(np.mean(moved**2))), float(np.abs(moved).max())
    return ChannelStatistics(item.name, item.quantity, item.unit, rms, peak, peak / rms if rms else 0.0)


def _ride(item: AssessedChannel, dt: float, vertical: str) -> RideComfort:
    name = vertical if item.quantity == "acceleration" else FORE_AFT_WEIGHTING
    found = evaluate_vibration(item.values, dt, WEIGHTINGS[name])
    return RideComfort(item.name, name, found.rms, found.mtvv, found.vdv, found.crest, likely_reaction(found.rms))


def _tyres(motion: AssessedMotion) -> Iterator[TyreLoad]:
    """Yield the tyres whose forces are known, each once, where the vehicle rests on them."""
    known: set[str] = set()
    for item in motion.channels:
        if item.quantity in ("tyre_force", "tyre_load") and item.owner not in known and motion.loads.get(item.owner, 0.0) > 0:
            known.add(item.owner)
            static = motion.loads[item.owner]
            found = load_statistics(item.values - (static if item.quantity == "tyre_load" else 0.0), static)
            yield TyreLoad(item.owner, static, found.coefficient, found.high, found.least, found.road_stress, found.fourth_power)


def _transport(item: AssessedChannel, dt: float) -> TransportVibration:
    frequency, density = welch_psd(item.values / STANDARD_GRAVITY, dt)
    low, high = TRANSPORT_BAND_HZ[0], min(TRANSPORT_BAND_HZ[1], float(frequency[-1]))
    inside = (frequency >= low) & (frequency <= high)
    rms = float(band_rms(frequency, density, [(low, high)])[0])
    f, own = frequency[inside], density[inside]
    levels = []
    for spectrum in SPECTRA.values():
        share = own / (spectrum.at(f) / STANDARD_GRAVITY**2)
        worst = int(share.argmax())
        excess = 10 * np.log10(max(float(share[worst]), 1e-12))
        levels.append(LevelComparison(spectrum.name, spectrum.rms_within(low, high), float(excess), float(f[worst])))
    return TransportVibration(item.name, rms, (low, high), tuple(levels), rounded(f, 7), rounded(own))


def _shock(item: AssessedChannel, dt: float) -> ShockSpectrum:
    frequency = spectrum_frequencies(1 / dt)
    found = shock_response(item.values - item.values.mean(), dt, frequency)
    worst = int(found.argmax())
    return ShockSpectrum(item.name, USUAL_QUALITY, float(found[worst]), float(frequency[worst]), rounded(frequency), rounded(found))


def _cycled(motion: AssessedMotion) -> Iterator[AssessedChannel]:
    """Yield the channels whose cycles are counted; the force and the load of a tyre or a hinge are one and the same."""
    known: set[tuple[str, str]] = set()
    for item in motion.channels:
        key = item.owner, item.quantity.replace("_load", "_force")
        if item.quantity in CYCLED and key not in known:
            known.add(key)
            yield item


def _cycles(item: AssessedChannel, duration: float, slope: float) -> LoadCycles:
    ranges, counts = rainflow_cycles(item.values)
    largest = float(ranges.max(initial=0.0))
    levels: Array = largest * np.arange(1, EXCEEDANCE_LEVELS + 1) / EXCEEDANCE_LEVELS
    equivalent = equivalent_range(ranges, counts, duration, slope)
    cumulative = exceedances(ranges, counts, levels)
    counted = float(exceedances(ranges, counts, np.array([LEAST_COUNTED * largest]))[0])
    return LoadCycles(item.name, item.quantity, item.unit, counted, largest, slope, equivalent, rounded(levels), cumulative)


def _notes(motion: AssessedMotion, ride: tuple[RideComfort, ...]) -> Iterator[str]:
    top = 0.5 / motion.dt
    if ride and top < HIGHEST_WEIGHTED_HZ:
        yield f"sampled at {2 * top:.4g} Hz: nothing above {top:.4g} Hz counts; ISO 2631-1 goes up to 80 Hz, ASTM D4169 up to 200 Hz"
    for item in ride:
        found = WeightedVibration(item.rms, item.mtvv, item.vdv, item.crest)
        yield from (f"{item.name}: {text}" for text in reasons_to_doubt_rms(found, motion.duration))
