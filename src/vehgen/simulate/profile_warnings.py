"""What makes a measured profile doubtful: it ends before the run, has a hole, is in mm, or its points hold too little of a road's waves."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.mechanics.equations_of_motion import EquationsOfMotion
from vehgen.road import MeasuredProfile
from vehgen.simulate.holes import holes, widest
from vehgen.simulate.modes import natural_modes
from vehgen.simulate.scenario import Scenario

Array = NDArray[np.float64]
BACK_ON_LEVEL = 0.01
"""A profile whose last height differs from its first by this share of its range is an obstacle on a level road, and what follows level."""
LEVEL_ENDS_M = 1.0
"""A long obstacle is level so far from both ends, too: roads that were levelled, or high-passed, also begin and end at one height."""
LONG_WAVE_M = 10.0
"""Waves of this length and longer shake bodies at the speeds of roads."""
SHORT_WAVES_M = (1.0, 4.0)
"""Waves that every way of measuring a profile holds."""
EIGHT_LONG_WAVES_M = 8 * LONG_WAVE_M
"""A profile of this length tells how strong its long waves are."""
LEAST_LONG_WAVES = 0.05
"""Roads of exponents 1.5 to 3 have 0.4 and more of the long waves that their short ones let expect with the exponent 2 of ISO 8608."""
MEASURED_POINTS = 50
"""A profile of fewer points was drawn, not measured, and its straight lines are meant, unless they are evenly spaced, as nobody draws."""
EVEN_POINTS = 8
"""So few points tell that they are evenly spaced."""
EVEN_SPACING = 0.1
"""Evenly spaced points lie no further than this share from their median spacing."""
DRAWN_LEVEL = 0.25
"""A profile that is level along this share of its lines was drawn."""
SAME_HEIGHT = 1e-3
"""A hole whose two sides differ by this share of the profile's range is a level piece of road."""
MM_RANGE_M = 2.0
"""A profile whose heights range over more, and that rises steeply, is read as m and was in mm."""
MM_AT_LEAST = 0.9
"""Not so large a share of the way is steep by a kerb alone."""
MM_WAY_M = 0.5
"""No vehicle climbs more than this way, over this way."""
MIN_END_GAP_M = 0.05
"""A profile that ends so little before the run is long enough."""


def doubtful_profiles(model: EquationsOfMotion, values: Mapping[str, float], scenario: Scenario) -> Iterator[str]:
    """Warn of measured profiles that end before the run, are in mm, have a hole, no long waves, or points too far apart for axle hop."""
    yield from profiles_that_end(scenario)
    behind = float(model.wheel_offsets(values).max(initial=0.0))
    for name, profile in _measured(scenario):
        yield from _in_mm(name, profile)
        yield from _with_holes(name, profile, scenario, behind)
        if not _is_obstacle(profile):
            yield from _without_long_waves(name, profile)
        yield from _too_coarse(name, profile, model, values, scenario)


def profiles_that_end(scenario: Scenario) -> Iterator[str]:
    """Warn of measured profiles that end before the run, but for obstacles on a level road."""
    for name, profile in _measured(scenario):
        if not _is_obstacle(profile):
            yield from _too_short(name, profile, scenario)


def _measured(scenario: Scenario) -> list[tuple[str, MeasuredProfile]]:
    profiles = [part for part in scenario.track.parts if isinstance(part, MeasuredProfile)]
    return [("the measured profile" if len(profiles) == 1 else f"measured profile {i + 1}", item) for i, item in enumerate(profiles)]


def _is_obstacle(profile: MeasuredProfile) -> bool:
    distance, heights = profile.distance, profile.heights
    ends = (distance < distance[0] + LEVEL_ENDS_M) | (distance > distance[-1] - LEVEL_ENDS_M)
    by_ends = distance[-1] - distance[0] < LONG_WAVE_M or _is_drawn(profile)
    looked_at = heights[[0, -1]] if by_ends else heights[ends]
    return bool(np.abs(looked_at - heights[0]).max() <= BACK_ON_LEVEL * np.ptp(heights))


def _is_drawn(profile: MeasuredProfile) -> bool:
    """Whether a profile's few points are where its straight lines meet, instead of where somebody measured."""
    if len(profile.distance) >= MEASURED_POINTS:
        return False
    gaps = np.diff(profile.distance)[1:] if len(profile.distance) > 2 else np.diff(profile.distance)  # the first may begin at the wheel
    even = np.abs(gaps / np.median(gaps) - 1).max() <= EVEN_SPACING
    return bool(len(profile.distance) < EVEN_POINTS or not even or np.mean(np.diff(profile.heights) == 0) >= DRAWN_LEVEL)


def _too_short(name: str, profile: MeasuredProfile, scenario: Scenario) -> Iterator[str]:
    along = scenario.speed.distance(scenario.time)
    if profile.end < along[-1] - MIN_END_GAP_M:
        when = float(np.interp(profile.end, along, scenario.time))
        yield (
            f"{name} ends at {profile.end:.4g} m, the run at {along[-1]:.4g} m: from {when:.4g} s on the first wheel stays "
            "at its last height; shorten `duration`, or measure a longer profile"
        )


def _in_mm(name: str, profile: MeasuredProfile) -> Iterator[str]:
    """Warn where heights seem to be in mm: a road in mm that is read as m has slopes of several."""
    rises = np.abs(np.interp(profile.distance + MM_WAY_M, profile.distance, profile.heights) - profile.heights)
    rise = float(np.quantile(rises, MM_AT_LEAST))  # not at a kerb alone
    if rise > MM_WAY_M and np.ptp(profile.heights) > MM_RANGE_M:
        yield (
            f"{name} rises or falls by {rise:.3g} m over {MM_WAY_M:g} m, its heights range over {np.ptp(profile.heights):.4g} m: "
            "are the heights in mm? Then state `unit: mm`"
        )


def _with_holes(name: str, profile: MeasuredProfile, scenario: Scenario, behind: float) -> Iterator[str]:
    """Warn of holes that wheels cross; the last of them runs so far behind the first [m]."""
    found = holes(profile.distance, -behind, float(scenario.speed.distance(scenario.time)[-1]))
    steps = np.abs(np.diff(profile.heights))[found]
    found = found[steps > SAME_HEIGHT * np.ptp(profile.heights)]
    if found.size:
        yield f"{name} {widest(profile.distance, found, 'm', 'points')}: wheels cross it on a straight line"


def _without_long_waves(name: str, profile: MeasuredProfile) -> Iterator[str]:
    length = float(np.ptp(profile.distance))
    if length < LONG_WAVE_M:
        yield (
            f"{name} is {length:.3g} m long and can hold no wave of {LONG_WAVE_M:g} m, as shake bodies: "
            "measure a longer one, or state the obstacle alone as a hump"
        )
    elif length >= EIGHT_LONG_WAVES_M and (share := long_wave_share(profile)) < LEAST_LONG_WAVES:
        yield (
            f"{name} holds {share:.1%} of the waves of {LONG_WAVE_M:g} m and longer that its short ones let expect: was it measured "
            "against a straightedge, or high-passed? Bodies are hardly shaken by it"
        )


def long_wave_share(profile: MeasuredProfile) -> float:
    """Return how strong a profile's waves of 10 m and longer are over what those of 1 to 4 m let expect (power, exponent 2 of ISO 8608)."""
    step = SHORT_WAVES_M[0] / 4
    even = np.arange(profile.distance[0], profile.distance[-1], step)
    heights = np.interp(even, profile.distance, profile.heights)
    n, density = scipy.signal.periodogram(heights, 1 / step, window="hann", detrend="linear")
    slope_density = density * n**2
    long = (n > 0) & (n <= 1 / LONG_WAVE_M)
    short = (n >= 1 / SHORT_WAVES_M[1]) & (n <= 1 / SHORT_WAVES_M[0])
    expected = float(slope_density[short].mean())
    return float(slope_density[long].mean()) / expected if expected > 0 else 1.0


def _too_coarse(
    name: str, profile: MeasuredProfile, model: EquationsOfMotion, values: Mapping[str, float], scenario: Scenario
) -> Iterator[str]:
    spacing = float(np.median(np.diff(profile.distance)))
    hop = np.array([item.motion == "hop" for item in model.coordinates])
    hops = [mode.undamped_hz for mode in natural_modes(model, values) if hop.any() and mode.energy[hop].sum() >= 0.5]
    if _is_drawn(profile) or not hops:
        return
    highest = scenario.top_speed / (2 * spacing)
    if highest < min(hops):
        yield (
            f"{name} has a point every {spacing:.3g} m, no wave shorter than {2 * spacing:.3g} m: at {scenario.top_speed:.3g} m/s "
            f"it excites nothing above {highest:.3g} Hz, and the axles hop at {min(hops):.3g} Hz"
        )
