"""What runs and recorders do not know of themselves exactly: small errors with priors, fitted along with the parameters.

Of a run: when its recording began, its speed and how the driver strayed about it, height and form of its hump, and how it was released
where the file gives that a tolerance. Of the vehicle: where its axles are along it. Of the sensors: each one's clock in each run, and, the
same in all runs, gains, tilts, places, how late a gyroscope is behind the accelerometer beside it, and what an unknown low-pass takes off.
Of what drives a rig: gains and offsets.
Every error counts in units of its standard deviation: the run file's (`uncertainty`, `tolerance`), or the default.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from vehgen.files.quantities import Spread
from vehgen.fit.trial import Trial
from vehgen.simulate.initial_state import initial_values
from vehgen.simulate.run_file.acquisition import channel_chains
from vehgen.simulate.run_scenario import ground_links

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
KNOT_SPACING_S = 1.0
"""Between the knots of a driver's wander about the speed lies at most so long [s]."""
MOST_INTERVALS = 15
"""A long run's knots lie farther apart, so that there are no more intervals than this."""
SHORTEST_WANDER_S = 1.0
"""Over a shorter pass [s] a speed does not change."""
ON_ROAD_MARGIN_S = 0.3
"""The speed matters from so long before the first wheel meets the hump until so long after the last has left it [s]."""
OF_TIME = ("clock", "lag")
LOW_PASS = ("roll_off", "edge", "dispersion", "edge_dispersion")
"""Errors of what stands for an unknown recorder's low-pass."""
READING = (*OF_TIME, "gain", "tilt", "position", *LOW_PASS)
"""Errors that change what a sensor reads, not what the vehicle does; the first two say how late a channel is."""
OF_INPUTS = ("force_gain", "force_offset", "displacement_gain")
"""Errors of measured forces and displacements that drive a run."""
ERROR_UNITS = {
    "delay": "s",
    "wear": "mm^2",
    "clock": "s",
    "lag": "s",
    "tilt": "rad",
    "position": "m",
    "axle_position": "m",
    "force_offset": "N",
}
ERROR_UNITS |= {"initial_displacement": "m", "initial_velocity": "m/s", "initial_pitch": "rad", "initial_pitch_rate": "rad/s"}
"""Units of the errors; all others are relative."""


@dataclass(frozen=True)
class Nuisances:
    """Standard deviations of what is not known exactly; 0 leaves it out.

    Attributes
    ----------
    delay
        Of the moment at which a recording began [s].
    speed, wander
        Relative, of a run's speed, and of how it changes along the run.
    height, length, form, skew
        Relative, of a road's height, and of a hump's length and form (see :meth:`vehgen.road.Hump.deformed`).
    wear
        Root of the mean square by which the edges of a hump are rounded [m]: worn edges, and tyres that bridge them.
    odometer
        Relative, of how long the way over a run's measured profile is: a profiler's odometer counts a little too much or too little. The
        speed makes up for that but for how late one axle follows the other.
    clock
        Of each sensor's clock against the first's, run by run [s].
    lag
        Of each gyroscope's delay against the accelerometer beside it [s]: chips filter the two in different ways.
    axle_position
        Of how far each axle runs behind the first to arrive [m], where no parameter with a range says it: a tape measures between hubs
        that nobody sees both of. The way its road is late counts, not the lever at which it pushes, of which this is a few thousandths.
    roll_off, edge, dispersion, edge_dispersion
        Of how an unknown recorder's low-pass differs from the one that stands for it: at half the rate of the recording a factor of
        exp(-r - s - i (d + e)) (see :mod:`vehgen.fit.reading`). Declared recorders have none.
    gain, tilt, position
        Of each channel's gain (relative), of each sensor's nose-down tilt [rad] and place along its body [m].
    force_gain, force_offset
        Of each measured force's gain, relative, and of a constant force beside it, relative to its root mean square in the
        loudest run. A force sensor's zero matters where springs hold the rig too: the simulation begins with it as a step.
    displacement_gain
        Of each measured displacement's gain, relative. It has no offset: a damper feels none, and what it would shift of a spring's force
        has settled.
    asked
        Names of those that hold whatever run files state of theirs.
    """

    delay: float = 0.2
    speed: float = 0.01
    wander: float = 0.01
    height: float = 0.03
    length: float = 0.03
    form: float = 0.05
    skew: float = 0.03
    wear: float = 0.008
    odometer: float = 0.002
    clock: float = 0.01
    lag: float = 0.0015
    gain: float = 0.01
    tilt: float = 0.02
    position: float = 0.02
    axle_position: float = 0.005
    roll_off: float = 0.3
    edge: float = 1.0
    dispersion: float = 1.5
    edge_dispersion: float = 1.0
    force_gain: float = 0.01
    force_offset: float = 0.1
    displacement_gain: float = 0.01
    asked: tuple[str, ...] = ()

    def of_run(self, trial: Trial) -> tuple[Nuisance, ...]:
        """Return the errors of one run: its own, then its sensors' clocks."""
        spread = self._stated(trial)
        has_road, has_humps = bool(trial.scenario.track.parts), bool(trial.scenario.humps)
        driven = has_road or bool(trial.scenario.forces) or any(item is not None for item in trial.scenario.ground)
        names = [Nuisance("delay", "", spread["delay"])] if driven else []
        if has_road:
            names += [Nuisance("speed", "", spread["speed"]), Nuisance("height", "", spread["height"])]
        if has_humps:
            names += [Nuisance(name, "", spread[name]) for name in ("length", "form", "skew")]
            names += [Nuisance("wear", "", (1e3 * spread["wear"]) ** 2)]
        if has_road:
            names += [Nuisance("wander", f"{knot:.3g} s", spread["wander"], knot) for knot in wander_knots(trial)]
        if trial.scenario.over_measured_road:
            names.append(Nuisance("odometer", "", spread["odometer"]))
        sensors = list(dict.fromkeys(channel.sensor for channel in trial.recording.channels))
        late = sensors[1:] if driven else sensors  # a release starts no clock
        names += [Nuisance("clock", sensor, spread["clock"]) for sensor in late]
        stated = initial_values(trial.run, trial.simulator.model)
        names += [Nuisance(f"initial_{item.key}", item.owner, item.tolerance) for item in stated]
        return tuple(item for item in names if item.sigma > 0)

    def of_all_runs(self, trials: Sequence[Trial]) -> tuple[Nuisance, ...]:
        """Return the errors that are the same in all runs: those of readings first, then those of axles and of what drives a rig."""
        names: dict[tuple[str, str], Nuisance] = {}
        for trial in trials:
            spread = self._stated(trial)
            quantities = {(channel.sensor, channel.quantity) for channel in trial.recording.channels}
            declared = channel_chains(trial.run, 1 / trial.recording.dt)
            for channel in trial.recording.channels:
                chain = declared.get(channel.name)
                if chain is not None and not chain.is_known:
                    for name in LOW_PASS:
                        names.setdefault((name, channel.sensor), Nuisance(name, channel.sensor, spread[name]))
                names.setdefault(("gain", channel.name), Nuisance("gain", channel.name, spread["gain"]))
                if {(channel.sensor, "acceleration"), (channel.sensor, "pitch_rate")} <= quantities:
                    for name in ("lag", "tilt", "position"):
                        names.setdefault((name, channel.sensor), Nuisance(name, channel.sensor, spread[name]))
        for trial in trials:
            spread = self._stated(trial)
            for force, rms in measured_forces(trial).items():
                names.setdefault(("force_gain", force), Nuisance("force_gain", force, spread["force_gain"]))
                known = names.get(("force_offset", force))
                sigma = max(self._offset(trial, rms), 0.0 if known is None else known.sigma)  # of the loudest run
                names["force_offset", force] = Nuisance("force_offset", force, sigma)
            for link in measured_displacements(trial):
                names.setdefault(("displacement_gain", link), Nuisance("displacement_gain", link, spread["displacement_gain"]))
            for axle in stated_axles(trial):
                names.setdefault(("axle_position", axle), Nuisance("axle_position", axle, spread["axle_position"]))
        found = [item for item in names.values() if item.sigma > 0]
        return (*(item for item in found if not item.moves_vehicle), *(item for item in found if item.moves_vehicle))

    def speed_spread(self, trial: Trial) -> float:
        """Return the standard deviation of a run's speed at any moment, relative: the driver's wander is part of it."""
        spread = self._stated(trial)
        return math.hypot(spread["speed"], spread["wander"])

    def _offset(self, trial: Trial, rms: float) -> float:
        """Return the standard deviation of a constant force beside a measured one [N], of that root mean square [N]."""
        own = trial.run.file.uncertainty
        stated = None if own is None or "force_offset" in self.asked else own.force_offset
        if isinstance(stated, Spread) and not stated.is_share and self.force_offset > 0:
            return stated.value
        return rms * self._stated(trial)["force_offset"]

    def _stated(self, trial: Trial) -> dict[str, float]:
        """Return the standard deviations by name: those asked for, else those that the run file states, else these; 0 stays out."""
        own = trial.run.file.uncertainty
        found: dict[str, float] = {}
        for name in (item.name for item in fields(self) if item.name != "asked"):
            default = getattr(self, name)
            if name == "delay" and not trial.scenario.track.parts:
                default = min(default, trial.recording.dt)  # one recorder keeps what pushes and what answers
            stated = getattr(own, name, None) if own is not None and name not in self.asked else None
            if isinstance(stated, Spread):
                stated = stated.share_of(_size(trial, name))
            found[name] = default if stated is None or default == 0 else stated
        return found


def asked_nuisances(speed: float | None = None, height: float | None = None) -> Nuisances:
    """Return the default errors, those that are not None as they are asked for, whatever run files state of them."""
    found = Nuisances()
    if speed is not None:
        found = replace(found, speed=speed, asked=("speed",))
    return found if height is None else replace(found, height=height, asked=(*found.asked, "height"))


@dataclass(frozen=True)
class Nuisance:
    """One error: its name, the sensor, channel or moment it is of, and its standard deviation; `knot` is the time of a wander [s]."""

    name: str
    place: str
    sigma: float
    knot: float = 0.0

    @property
    def unit(self) -> str:
        """Its unit; empty for relative errors."""
        return ERROR_UNITS.get(self.name, "")

    @property
    def moves_vehicle(self) -> bool:
        """Whether it changes what the vehicle does, not only what a sensor reads of it."""
        return self.name not in READING


@dataclass(frozen=True)
class Condition:
    """What a fit supposes of a run, a channel or a sensor: an error's `value` [unit], and `sigma`, its prior's standard deviation.

    `run` is empty for what holds in all runs; `place` names a sensor or a channel, or says when.
    """

    run: str
    name: str
    place: str
    value: float
    unit: str
    sigma: float

    @property
    def key(self) -> tuple[str, str, str]:
        """Run, name and place, by which conditions of several fits are compared."""
        return self.run, self.name, self.place

    @property
    def sigmas(self) -> float:
        """The value in standard deviations of its prior."""
        return self.value / self.sigma


def measured_forces(trial: Trial) -> dict[str, float]:
    """Return the root mean square [N] of a run's measured forces, by name."""
    named = zip(trial.simulator.model.forces, trial.scenario.forces, strict=True)
    return {name: float(np.sqrt(np.mean(item.values**2))) for name, item in named if item.values is not None}


def measured_displacements(trial: Trial) -> tuple[str, ...]:
    """Return the links to the ground whose ground ends move as was measured in a run."""
    named = zip(ground_links(trial.simulator.model), trial.scenario.ground, strict=True)
    return tuple(name for name, item in named if item is not None and item.values is not None)


def stated_axles(trial: Trial) -> tuple[str, ...]:
    """Return the axles that follow the first over a run's road, at distances that no parameter with a range decides."""
    if not trial.scenario.track.parts:
        return ()
    decided, searched = trial.simulator.distance_parameters, trial.run.vehicle.ranges().keys()
    offsets = dict(zip(decided, trial.simulator.model.wheel_offsets(trial.values).tolist(), strict=True))
    first = min(offsets, key=lambda axle: offsets[axle])
    return tuple(axle for axle in offsets if axle != first and not (decided[axle] | decided[first]) & searched)


def _size(trial: Trial, name: str) -> float:
    """Return what a run's stated deviation is a share of: its speed [m/s], its hump's height or length [m], its largest force [N]."""
    humps = trial.scenario.humps
    if name == "force_offset":
        return max(measured_forces(trial).values(), default=0.0) or 1.0
    if name in ("speed", "wander"):
        return trial.scenario.top_speed
    if name == "length" and humps:
        return max(hump.length for hump in humps)
    along = trial.scenario.speed.distance(trial.scenario.time)
    return max(float(np.abs(trial.scenario.track.height(along)).max()), 1e-6)


def wander_knots(trial: Trial) -> list[float]:
    """Return the times between which the speed of a run may change [s]: while its wheels are on humps, or all along."""
    scenario = trial.scenario
    first, last = scenario.start, scenario.start + scenario.duration
    if scenario.over_humps_alone:
        offsets = trial.simulator.model.wheel_offsets(trial.values)
        along = scenario.speed.distance(scenario.time)
        left = float(np.interp(scenario.track.end + float(offsets.max(initial=0.0)), along, scenario.time))
        first, last = max(first, scenario.first_arrival - ON_ROAD_MARGIN_S), min(last, left + ON_ROAD_MARGIN_S)
    if last - first < SHORTEST_WANDER_S:
        return []
    intervals = min(math.ceil((last - first) / KNOT_SPACING_S), MOST_INTERVALS)
    return [round(float(knot), 9) for knot in np.linspace(first, last, intervals + 1)]
