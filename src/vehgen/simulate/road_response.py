"""What a rough road does to a vehicle at a speed, by frequency: responses to one road under all wheels, PSDs and RMS values.

The road's PSD is that of an ISO 8608 class, Gd(n) = Gd(n0) (n/n0)^-2 from 0.011 to 2.83 cycles/m; at the speed v it is G(f) = Gd(f/v)/v.
A linear output's PSD is |H|^2 G, its RMS the root of the integral over all the standard's frequencies.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from numbers import Real
from typing import ClassVar

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.errors import ArgumentError, InputError, did_you_mean, shown
from vehgen.files.limits import SPEED_LIMIT
from vehgen.files.provenance import file_hashes, versions
from vehgen.files.result_fields import Array1D, Array2D, Number, rounded
from vehgen.files.results import Cell, Result, Table
from vehgen.measure.ride_comfort import WEIGHTINGS
from vehgen.mechanics import ElementOutput, Output, Place, PointOutput, all_values, derive
from vehgen.road.iso8608 import CLASSES, SPATIAL_BAND_CYCLES_PER_M, displacement_psd
from vehgen.simulate.frequency import maxwell_branches
from vehgen.simulate.frequency_response import DEFAULT_SPEED_M_S, frequency_response
from vehgen.simulate.resonance_lines import oscillating_poles, undamped_notes, with_peaks
from vehgen.vehicle import Vehicle, VehicleLike, as_vehicle
from vehgen.vehicle.loading import vehicle_files

Array = NDArray[np.float64]
DEFAULT_CLASS = "B"
LEAST_LINES, WIDEST_STEP_HZ = 4000, 0.02
"""Lines over the standard's frequencies, by which RMS values are integrated: at least so many, at most so far apart, and more at peaks."""
LINES_KEPT, PEAK_STEP_KEPT = 1200, 0.25
"""Evenly spaced on a logarithmic axis a result holds so many of them at most, and at peaks those so far apart: see :func:`with_peaks`."""
FREQUENCY_DIGITS = 9
"""Frequencies are rounded to what a CSV file tells of them."""


@dataclass(frozen=True)
class RoadOutput:
    """What comes out: `group` is what is shown together; RMS in `unit`, `weighted_rms` by Wk of ISO 2631-1 (NaN where it is no motion)."""

    name: str
    group: str
    unit: str
    rms: float
    weighted_rms: Number


@dataclass(frozen=True, eq=False)
class RoadResponse(Result):
    """Responses of a vehicle to one road under all its wheels.

    Attributes
    ----------
    title, speed, roughness
        Of the vehicle, its speed [m/s], and the class of ISO 8608.
    outputs
        What comes out, with its RMS.
    frequency
        `shape (n,)` [Hz].
    amplitude, phase
        Of each output per metre of road under the first axle that arrives `shape (n_outputs, n)` [unit/m; degrees].
    psd
        Of each output on the road `shape (n_outputs, n)` [unit^2/Hz].
    road_psd
        Of the road's height over time `shape (n,)` [m^2/Hz].
    notes
        Which numbers mean nothing, since hardly any damping bounds them.
    versions, inputs
        Of packages; names of the vehicle's files with their SHA-256.
    """

    KIND: ClassVar[str] = "road response"
    DRAWING: ClassVar[str] = "vehgen.report.plots.road_response_plot:plot_road_response"

    title: str
    speed: float
    roughness: str
    outputs: tuple[RoadOutput, ...]
    frequency: Array1D
    amplitude: Array2D
    phase: Array2D
    psd: Array2D
    road_psd: Array1D
    versions: dict[str, str]
    inputs: dict[str, str]
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        shape = len(self.outputs), len(self.frequency)
        if not self.amplitude.shape == self.phase.shape == self.psd.shape == shape or self.road_psd.shape != shape[1:]:
            raise ValueError("a number for every output and frequency was expected")

    def table(self) -> Table:
        """Return a row an output: RMS, weighted RMS, where its amplitude and its PSD are largest."""
        columns = ("output", "unit", "RMS", "Wk RMS", "largest |H| [unit/m]", "at [Hz]", "PSD peak at [Hz]")
        rows: list[tuple[Cell, ...]] = []
        for item, amplitude, psd in zip(self.outputs, self.amplitude, self.psd, strict=True):
            first, second = int(amplitude.argmax()), int(psd.argmax())
            weighted = item.weighted_rms if np.isfinite(item.weighted_rms) else None
            largest = float(amplitude[first]), float(self.frequency[first]), float(self.frequency[second])
            rows.append((item.name, item.unit, item.rms, weighted, *largest))
        return columns, rows

    def curves(self) -> Table:
        """Return a row a frequency: the road's PSD, then amplitude, phase and PSD of every output."""
        columns = ["frequency [Hz]", "road PSD [m^2/Hz]"]
        parts = [self.frequency, self.road_psd]
        for item, *found in zip(self.outputs, self.amplitude, self.phase, self.psd, strict=True):
            columns += [f"{item.name} |H| [{item.unit}/m]", f"{item.name} phase [deg]", f"{item.name} PSD [({item.unit})^2/Hz]"]
            parts += found
        return tuple(columns), [tuple(row) for row in np.column_stack(parts).tolist()]


def road_response(
    vehicle: VehicleLike,
    *,
    speed: float = DEFAULT_SPEED_M_S,
    roughness: str = DEFAULT_CLASS,
    places: Iterable[Place] = (),
    parameter_set: str | None = None,
) -> RoadResponse:
    """Return the linear response of bodies, axles, tyres, hinges and links to a rough road.

    Parameters
    ----------
    vehicle
        Itself, its file, or the name of a bundled model.
    speed
        [m/s]; every axle meets the same road, later by its distance behind the first.
    roughness
        The road's class by ISO 8608, A to H: its geometric mean.
    places
        Further places on bodies whose vertical acceleration is wanted.
    parameter_set
        One of the vehicle's sets.

    Raises
    ------
    InputError
        For a vehicle without axles, two places of one name, names that it lacks, a speed that cannot be, and a class that there is none of.
    """
    if roughness not in CLASSES:
        raise ArgumentError(
            f"`roughness`: unknown road class {str(roughness)[:40]!r}; {did_you_mean(str(roughness), CLASSES)}", "roughness"
        )
    vehicle = as_vehicle(vehicle)
    free = vehicle.values(parameter_set)
    wanted = _wanted(vehicle, tuple(places))
    names = [output.name for _, output in wanted]
    if len(set(names)) < len(names):
        raise InputError(f"two outputs are called {next(name for name in names if names.count(name) > 1)!r}; name the place differently")
    model = derive(vehicle, [output for _, output in wanted])
    if not isinstance(speed, Real):
        raise ArgumentError(f"`speed`: a number in m/s was expected, found {shown(speed)}", "speed")
    values = all_values(model, free)
    poles = oscillating_poles(model.numeric(values), maxwell_branches(model, values))
    frequency = np.unique(rounded(with_peaks(_even_lines(speed), poles), FREQUENCY_DIGITS))
    curves = frequency_response(model, frequency, values=values, speed=speed).values[:, :, 0].T
    found = dict(zip((channel.name for channel in model.channels), curves, strict=True))
    units = {channel.name: channel.unit for channel in model.channels}
    rows = [(output.name, group, units[output.name], found[output.name]) for group, output in wanted]
    notes = tuple(undamped_notes(model, values, poles, frequency, found))
    return _result(vehicle, rows, frequency, poles, speed, roughness, notes)


def _wanted(vehicle: Vehicle, places: tuple[Place, ...]) -> list[tuple[str, Output]]:
    """Return outputs with the group that each is shown in."""
    points = [*(Place(name, name) for name in vehicle.bodies), *places]
    found: list[tuple[str, Output]] = [("body acceleration", PointOutput(place.name, place, "acceleration")) for place in points]
    own = [name for name, axle in vehicle.axles.items() if axle.mass is not None]
    found += [("axle acceleration", ElementOutput(f"{name} hop", name, "acceleration")) for name in own]
    found += [("suspension travel", ElementOutput(f"{name} travel", name, "suspension_travel")) for name in own]
    found += [("tyre force", ElementOutput(f"{name} tyre", name, "tyre_force")) for name in vehicle.axles]
    found += [("hinge force", ElementOutput(f"hinge {name}", name, "hinge_force")) for name in vehicle.hinges]
    found += [("link travel", ElementOutput(f"link {name} travel", name, "link_travel")) for name in vehicle.links]
    found += [("link force", ElementOutput(f"link {name}", name, "link_force")) for name in vehicle.links]
    return found


def _even_lines(speed: float) -> Array:
    """Return the frequencies [Hz] that the standard's roads have at a speed; one line where the speed is none, which others refuse."""
    low, high = (n * max(speed, 0.0) for n in SPATIAL_BAND_CYCLES_PER_M)
    if not 0 < speed <= SPEED_LIMIT.high:
        return np.ones(1)
    return np.linspace(low, high, max(LEAST_LINES, int(min((high - low) / WIDEST_STEP_HZ, 1e5))) + 1)


def _lines_kept(frequency: Array, poles: NDArray[np.complex128], responses: NDArray[np.complex128], psds: Array) -> NDArray[np.intp]:
    """Return which lines a result holds: even ones on a logarithmic axis, those beside poles, and where each output is largest."""
    wanted = with_peaks(np.geomspace(frequency[0], frequency[-1], LINES_KEPT), poles, PEAK_STEP_KEPT)
    near = np.searchsorted(frequency, np.clip(wanted * (1 - 1e-12), frequency[0], frequency[-1]))
    return np.unique(np.concatenate([near, np.abs(responses).argmax(axis=1), psds.argmax(axis=1)]))


def _result(
    vehicle: Vehicle,
    rows: list[tuple[str, str, str, NDArray[np.complex128]]],
    frequency: Array,
    poles: NDArray[np.complex128],
    speed: float,
    roughness: str,
    notes: tuple[str, ...],
) -> RoadResponse:
    """Return the result of outputs (name, group, unit, response) over frequencies."""
    road = displacement_psd(roughness, frequency / speed) / speed
    ear = np.abs(WEIGHTINGS["Wk"].response(frequency)) ** 2
    responses = np.array([response for *_, response in rows])
    psds = np.abs(responses) ** 2 * road
    outputs = []
    for (name, group, unit, _), psd in zip(rows, psds, strict=True):
        weighted = float(np.sqrt(scipy.integrate.trapezoid(psd * ear, frequency))) if group == "body acceleration" else np.nan
        outputs.append(RoadOutput(name, group, unit, float(np.sqrt(scipy.integrate.trapezoid(psd, frequency))), weighted))
    kept = _lines_kept(frequency, poles, responses, psds)
    return RoadResponse(
        title=vehicle.title or vehicle.name,
        speed=speed,
        roughness=roughness,
        outputs=tuple(outputs),
        frequency=frequency[kept],
        amplitude=rounded(np.abs(responses[:, kept]), 6),
        phase=rounded(np.degrees(np.angle(responses[:, kept])), 6),
        psd=rounded(psds[:, kept], 6),
        road_psd=rounded(road[kept], 6),
        versions=versions(),
        inputs=file_hashes(vehicle_files(vehicle)),
        notes=notes,
    )
