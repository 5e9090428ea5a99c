"""How much of a road reaches a vehicle's bodies, axles and tyres, by frequency: what the page of a build draws."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.mechanics import ElementOutput, EquationsOfMotion, Output, Place, PointOutput, all_values, derive
from vehgen.simulate.frequency import maxwell_branches
from vehgen.simulate.frequency_response import DEFAULT_SPEED_M_S, axle_delays, over_one_road
from vehgen.simulate.resonance_lines import oscillating_poles, with_peaks
from vehgen.vehicle import Vehicle

Array = NDArray[np.float64]
AMPLITUDE_BAND_HZ, AMPLITUDE_LINES = (0.2, 30.0), 600
"""Frequencies of the curves, evenly spaced on a logarithmic axis."""
CURVE_STEP = 0.25
"""Lines beside a peak are so many of its half widths apart, where it is narrower than the others see."""
LINES_OF_A_PEAK = 21
"""So many between the two lines beside a peak tell where it is."""
HEAVE, HOP, TYRE_LOAD = "body heave", "axle hop", "tyre load"


@dataclass(frozen=True, eq=False)
class RoadAmplitude:
    """|H| of one output per metre of road: `amplitude shape (n,)` [`unit`].

    `group` is what is shown together; `peak` is frequency [Hz] and |H| of the highest maximum inside the band, None where there is none.
    """

    name: str
    group: str
    unit: str
    amplitude: Array
    peak: tuple[float, float] | None


@dataclass(frozen=True, eq=False)
class RoadAmplitudes:
    """Curves over `frequency shape (n,)` [Hz] at a `speed` [m/s]: all axles meet one road, each later by its distance behind the first."""

    frequency: Array
    speed: float
    curves: tuple[RoadAmplitude, ...]

    def groups(self) -> dict[str, list[RoadAmplitude]]:
        """Return the curves by group, in order."""
        return {group: [item for item in self.curves if item.group == group] for group in dict.fromkeys(item.group for item in self.curves)}


def road_amplitudes(vehicle: Vehicle, values: Mapping[str, float], speed: float = DEFAULT_SPEED_M_S) -> RoadAmplitudes:
    """Return what one road under all wheels does to a vehicle, its force laws left out, but for relaxation.

    Parameters
    ----------
    vehicle
        One with axles.
    values
        Its free parameters [SI] by name.
    speed
        [m/s].

    Returns
    -------
    Heave of every body at its COG [m/m]; hop [m/m] and dynamic tyre load [N/m] of three axles at most: the first and the last on the road,
    and the one whose tyre load has the highest peak. An axle without a mass of its own has no hop.

    Raises
    ------
    InputError
        For a vehicle without axles, and a speed that cannot be.
    """
    wanted = _outputs(vehicle)
    model = derive(vehicle, [output for _, _, output in wanted])
    known = all_values(model, values)
    delays = axle_delays(model, known, speed)
    poles = oscillating_poles(model.numeric(known), maxwell_branches(model, known))
    frequency = with_peaks(np.geomspace(*AMPLITUDE_BAND_HZ, AMPLITUDE_LINES), poles, CURVE_STEP)
    found = np.abs(over_one_road(model, known, frequency, delays))
    lines = _peak_lines(found)
    loads = {name: found[lines[i], i] if lines[i] else 0.0 for i, (group, name, _) in enumerate(wanted) if group == TYRE_LOAD}
    axles = list(vehicle.axles)
    shown = {axles[int(delays.argmin())], axles[int(delays.argmax())], max(axles, key=lambda name: loads[name])}
    curves = []
    for i, ((group, name, _), channel) in enumerate(zip(wanted, model.channels, strict=True)):
        if group == HEAVE or name in shown:
            peak = _peak(model, known, delays, i, frequency[lines[i] - 1], frequency[lines[i] + 1]) if lines[i] else None
            curves.append(RoadAmplitude(name, group, f"{channel.unit}/m", found[:, i], peak))
    return RoadAmplitudes(frequency, speed, tuple(curves))


def _outputs(vehicle: Vehicle) -> list[tuple[str, str, Output]]:
    """Return outputs with the group that each is shown in, and whose they are; their channels have names of their own."""
    own = [name for name, axle in vehicle.axles.items() if axle.mass is not None]
    return [
        *((HEAVE, name, PointOutput(name, Place(name, name), "displacement")) for name in vehicle.bodies),
        *((HOP, name, ElementOutput(f"{name} hop", name, "displacement")) for name in own),
        *((TYRE_LOAD, name, ElementOutput(f"{name} tyre", name, "tyre_force")) for name in vehicle.axles),
    ]


def _peak_lines(amplitude: Array) -> list[int]:
    """Return the line of the highest inner maximum of every column, 0 where there is none."""
    inner = amplitude[1:-1]
    heights = np.where((inner > amplitude[:-2]) & (inner >= amplitude[2:]), inner, 0.0)
    return [int(line) + 1 if top > 0 else 0 for line, top in zip(heights.argmax(axis=0), heights.max(axis=0), strict=True)]


def _peak(
    model: EquationsOfMotion, values: Mapping[str, float], delays: Array, column: int, low: float, high: float
) -> tuple[float, float]:
    """Return frequency [Hz] and |H| of a channel's maximum between two frequencies [Hz]."""
    frequency = np.linspace(low, high, LINES_OF_A_PEAK)
    amplitude = np.abs(over_one_road(model, values, frequency, delays)[:, column])
    top = int(amplitude.argmax())
    return float(frequency[top]), float(amplitude[top])
