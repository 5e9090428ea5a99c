"""What must hold for a run and its recording together; each failure says what would be right."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError
from vehgen.fit.recording import Recording
from vehgen.mechanics import EquationsOfMotion
from vehgen.mechanics.quantities import ELEMENT_QUANTITIES
from vehgen.simulate import Run, Scenario, Simulator
from vehgen.simulate.initial_state import initial_values
from vehgen.simulate.run_scenario import ground_links

Array = NDArray[np.float64]
FIRST_SAMPLES = 3
"""So many samples, on average, are what a recording begins with."""
ENDS_WITH = 10
"""What a motion reads on average in the last of so many parts of a recording counts as its sensor's zero."""
MOTIONS_OFF, FORCES_OFF = 0.5, 0.8
"""A motion, or a force, whose begin differs from the stated one by this share of the larger of both contradicts it: springs may be off."""
SHARE_OF_PEAK = 0.3
"""A difference below this share of a channel's peak is none."""
MAY_BE_LATE_S = 0.01
"""A recording may begin so long after the release [s]."""
SIGMAS = 4.0
"""An initial state with a tolerance may be off by so many standard deviations."""
OF_MOTION = ("displacement", "velocity", "pitch", "pitch_rate", "suspension_travel", "link_travel", "hinge_angle")


def check_hump_reached(run: Run, scenario: Scenario, offsets: Array, name: str) -> None:
    """Refuse a recording that ends before the last axle, `offsets` [m] behind the first, has met the hump, or begins when it has left."""
    humps = [entry.hump for entry in run.file.road if entry.hump is not None]
    travelled = float(scenario.speed.distance(np.array([scenario.start + scenario.duration]))[0])
    if humps and travelled < max(hump.at for hump in humps) + float(offsets.max(initial=0.0)):
        raise InputError(
            f"{name}: the recording ends after {travelled:.1f} m, before the last axle ({offsets.max(initial=0.0):.1f} m behind the first) "
            f"has met the hump at {max(hump.at for hump in humps):.1f} m: record until the vehicle has left it, or put the speed right",
            run.document.find(("recording",)),
        )
    begun = float(scenario.speed.distance(np.array([scenario.start]))[0])
    if scenario.over_humps_alone and begun > scenario.track.end + float(offsets.max(initial=0.0)):
        raise InputError(
            f"{name}: the recording begins at t = {scenario.start:.4g} s, {begun:.1f} m on the way, when the last axle has left the hump "
            f"at {max(hump.at for hump in humps):.1f} m: its times count from the run's start, not from when the recorder was switched on; "
            "take so much off them, or let `vehgen import` find the hump",
            run.document.find(("recording",)),
        )


def check_inputs_last(run: Run, scenario: Scenario, recording: Recording, model: EquationsOfMotion) -> None:
    """Refuse a measured force or displacement that begins after the recording or ends before it; a single row is a constant."""
    first, last = float(recording.time[0]), float(recording.time[-1])
    named = (("forces", model.forces, scenario.forces), ("displacements", ground_links(model), scenario.ground))
    for group, names, signals in named:
        for name, item in zip(names, signals, strict=True):
            if item is None or item.time is None or len(item.time) < 2:
                continue
            spacing = max(recording.dt, float(np.median(np.diff(item.time))))
            if item.time[0] <= first + spacing and item.time[-1] >= last - spacing:
                continue
            known, lasts = (f"from {begin:.4g} s to {end:.4g} s" for begin, end in ((item.time[0], item.time[-1]), (first, last)))
            raise InputError(
                f"the {group.removesuffix('s')} {name} is known {known}, the recording lasts {lasts}: record both together, or cut the "
                "recording to the time in which both are known",
                run.document.find((group, name, "file")),
            )


def check_initial(run: Run, recording: Recording, simulator: Simulator, scenario: Scenario, values: Mapping[str, float]) -> None:
    """Refuse a run whose stated begin its recording clearly contradicts: its first displacements, velocities, travels and forces."""
    if not run.file.initial or scenario.initial is None:
        return
    short = replace(scenario, duration=max(MAY_BE_LATE_S, recording.dt), chains={}, skipped=0)
    stated = initial_values(run, simulator.model)
    states = [scenario.initial]
    for item in stated:
        states.append(scenario.initial + np.eye(len(scenario.initial))[item.place] * item.tolerance)
    begins = np.array([_first(simulator, short, state, values) for state in states])
    slack = SIGMAS * np.abs(begins[1:, 0] - begins[0, 0]).sum(axis=0)
    low, high = begins[0].min(axis=0), begins[0].max(axis=0)
    of_motion = np.array([channel.quantity in OF_MOTION for channel in recording.channels])
    zero = recording.values[-max(len(recording.values) // ENDS_WITH, 1) :].mean(axis=0) * of_motion
    found = recording.values[:FIRST_SAMPLES].mean(axis=0) - zero
    peak = np.abs(recording.values - zero).max(axis=0)
    for i, channel in enumerate(recording.channels):
        if channel.quantity not in OF_MOTION and channel.quantity not in ELEMENT_QUANTITIES:
            continue
        share = MOTIONS_OFF if channel.quantity in OF_MOTION else FORCES_OFF
        off = abs(found[i] - np.clip(found[i], low[i], high[i])) - slack[i]
        if off > max(share * max(abs(found[i]), abs(begins[0, 0, i])), SHARE_OF_PEAK * peak[i]):
            said, read = (f"{number:.3g} {simulator.model.channels[i].unit}" for number in (begins[0, 0, i], found[i]))
            raise InputError(
                f"the run is said to begin with {channel.name} at {said}, but its recording begins at {read}: put `initial` right (it "
                "counts from static equilibrium), zero the channel there, or cut the recording to begin at the release",
                run.document.find(("initial",), key=True),
            )


def _first(simulator: Simulator, scenario: Scenario, state: Array, values: Mapping[str, float]) -> Array:
    """Return what the channels are as a run begins in a state, and shortly after, `shape (n_samples, n_channels)`."""
    return np.asarray(simulator.run(simulator.parameters(values), replace(scenario, initial=state)).responses[0])
