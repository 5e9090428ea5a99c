"""What runs and recorders do not know of themselves exactly: small errors with priors, fitted along with the parameters.

Of a run: when its recording began, its speed and how the driver strayed about it, height and form of its hump. Of the sensors: each one's
clock in each run, and, the same in all runs, gains, tilts, places, how late a gyroscope is behind the accelerometer beside it, and what
an unknown low-pass takes off. Every error counts in units of its standard deviation: the run file's (`uncertainty`), or the default.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace

import numpy as np
from numpy.typing import NDArray

from vehgen.files.quantities import Spread
from vehgen.fit.trial import Trial
from vehgen.mechanics import GRAVITY
from vehgen.road import Wander
from vehgen.simulate import Scenario
from vehgen.simulate.run_file.acquisition import channel_chains

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
READING = (*OF_TIME, "gain", "tilt", "position", "roll_off", "dispersion")
"""Errors that change what a sensor reads, not what the vehicle does; the first two say how late a channel is."""
LOW_PASS = ("roll_off", "dispersion")
"""Errors of what stands for an unknown recorder's low-pass."""
ERROR_UNITS = {"delay": "s", "wear": "mm^2", "clock": "s", "lag": "s", "tilt": "rad", "position": "m"}
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
    clock
        Of each sensor's clock against the first's, run by run [s].
    lag
        Of each gyroscope's delay against the accelerometer beside it [s]: chips filter the two in different ways.
    roll_off, dispersion
        Of how an unknown recorder's low-pass differs from the one that stands for it: at half the rate of the recording a part r of
        exp(-r - i d) (see :meth:`RunErrors.reading`). Declared recorders have neither.
    gain, tilt, position
        Of each channel's gain (relative), of each sensor's nose-down tilt [rad] and place along its body [m].
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
    clock: float = 0.01
    lag: float = 0.0015
    gain: float = 0.01
    tilt: float = 0.02
    position: float = 0.02
    roll_off: float = 0.3
    dispersion: float = 1.5
    asked: tuple[str, ...] = ()

    def of_run(self, trial: Trial) -> tuple[Nuisance, ...]:
        """Return the errors of one run: its own, then its sensors' clocks."""
        spread = self._stated(trial)
        has_road, has_humps = bool(trial.scenario.track.parts), bool(trial.scenario.humps)
        names = [Nuisance("delay", "", spread["delay"])]
        if has_road:
            names += [Nuisance("speed", "", spread["speed"]), Nuisance("height", "", spread["height"])]
        if has_humps:
            names += [Nuisance(name, "", spread[name]) for name in ("length", "form", "skew")]
            names += [Nuisance("wear", "", (1e3 * spread["wear"]) ** 2)]
        if has_road:
            names += [Nuisance("wander", f"{knot:.3g} s", spread["wander"], knot) for knot in wander_knots(trial)]
        sensors = list(dict.fromkeys(channel.sensor for channel in trial.recording.channels))
        names += [Nuisance("clock", sensor, spread["clock"]) for sensor in sensors[1:]]
        return tuple(item for item in names if item.sigma > 0)

    def of_sensors(self, trials: Sequence[Trial]) -> tuple[Nuisance, ...]:
        """Return the errors of channels and sensors that are the same in all runs."""
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
        return tuple(item for item in names.values() if item.sigma > 0)

    def _stated(self, trial: Trial) -> dict[str, float]:
        """Return the standard deviations by name: those asked for, else those that the run file states, else these; 0 stays out."""
        own = trial.run.file.uncertainty
        found: dict[str, float] = {}
        for name in (item.name for item in fields(self) if item.name != "asked"):
            default = getattr(self, name)
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
    def sigmas(self) -> float:
        """The value in standard deviations of its prior."""
        return self.value / self.sigma


def _size(trial: Trial, name: str) -> float:
    """Return what a run's stated deviation is a share of: its speed [m/s], or its hump's height or length [m]."""
    humps = trial.scenario.humps
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


@dataclass(frozen=True)
class RunErrors:
    """The errors of one run: those of the sensors in all runs (`sensors`), then its own (`own`).

    Numbers of errors `shape (size,)` count in standard deviations, the sensors' first. `channels` holds name, sensor and quantity of every
    channel; `known` errors of sensors [units], by name and place, that stand; `rate` is the recording's [Hz].
    """

    sensors: tuple[Nuisance, ...]
    own: tuple[Nuisance, ...]
    channels: tuple[tuple[str, str, str], ...]
    known: Mapping[tuple[str, str], float] = field(default_factory=dict)
    rate: float = 100.0

    @classmethod
    def of(
        cls, trial: Trial, sensors: tuple[Nuisance, ...], own: tuple[Nuisance, ...], known: Mapping[tuple[str, str], float]
    ) -> RunErrors:
        """Return the errors of a trial."""
        channels = tuple((item.name, item.sensor, item.quantity) for item in trial.recording.channels)
        return cls(sensors, own, channels, known, 1 / trial.recording.dt)

    @property
    def items(self) -> tuple[Nuisance, ...]:
        """All errors, the sensors' first."""
        return (*self.sensors, *self.own)

    def scenario(self, scenario: Scenario, numbers: Array) -> Scenario:
        """Return the scenario with the errors."""
        found = dict.fromkeys(("delay", "speed", "height", "length", "form", "skew", "wear"), 0.0)
        knots, strayed = [], []
        for item, number in zip(self.items, numbers, strict=True):
            value = float(number) * item.sigma
            if item.name == "wander":
                knots.append(item.knot)
                strayed.append(value)
            elif item.name in found:
                found[item.name] = value
        mean = sum(strayed) / max(len(strayed), 1)
        form = 1 + found["length"], math.exp(found["form"]), found["skew"], 1e-6 * found["wear"]
        return scenario.adjusted(
            found["delay"],
            1 + found["speed"],
            1 + found["height"],
            anchor=scenario.first_arrival,
            wander=Wander(tuple(knots), tuple(value - mean for value in strayed)) if any(strayed) else None,
            deformation=form if scenario.humps else None,
        )

    def _values(self, numbers: Array) -> dict[tuple[str, str], float]:
        own = {(item.name, item.place): float(number) * item.sigma for item, number in zip(self.items, numbers, strict=True)}
        return {**self.known, **own}

    def clocks(self, numbers: Array) -> Array:
        """Return how late every channel's clock is [s], `shape (n_channels,)`."""
        return self._late(self._values(numbers))

    def _late(self, values: Mapping[tuple[str, str], float]) -> Array:
        lags = [values.get(("lag", sensor), 0.0) if quantity == "pitch_rate" else 0.0 for _, sensor, quantity in self.channels]
        return np.asarray(np.array([values.get(("clock", sensor), 0.0) for _, sensor, _ in self.channels]) + lags, dtype=np.float64)

    def read(self, motion: Array, dt: float, numbers: Array) -> Array:
        """Return what the sensors read, `shape (n_samples, n_channels)`, where they should read `motion` at samples `dt` [s] apart."""
        length = 2 * len(motion)
        reading = self.reading(np.asarray(np.fft.rfftfreq(length, dt), dtype=np.float64), numbers)
        if reading is None:
            return motion
        lines = (reading @ np.fft.rfft(motion, length, axis=0)[..., None])[..., 0]
        return np.asarray(np.fft.irfft(lines, length, axis=0)[: len(motion)])

    def reading(self, frequency: Array, numbers: Array) -> Complex | None:
        """Return what the channels read of what they should, line by line, `shape (n_lines, n_channels, n_channels)`; None: all of it.

        A sensor tilted nose-down by t reads a cos t - g pitch sin t, one that sits d further forward a - d pitch''; a late clock turns
        phases. What a low-pass takes off more than supposed is exp(-r x^2 - i d x^3) at x times half the rate.
        """
        values = self._values(numbers)
        if not any(value for (name, _), value in values.items() if name in READING):
            return None
        omega, x = 2 * np.pi * frequency, 2 * frequency / self.rate
        pitch = np.divide(1.0, omega, out=np.zeros_like(omega), where=omega > 0)
        columns = {(sensor, quantity): i for i, (_, sensor, quantity) in enumerate(self.channels)}
        found = np.zeros((len(frequency), len(self.channels), len(self.channels)), dtype=np.complex128)
        late = self._late(values)
        for i, (name, sensor, quantity) in enumerate(self.channels):
            own = np.exp(-1j * (late[i] * omega + values.get(("dispersion", sensor), 0.0) * x**3))
            own *= np.exp(-values.get(("roll_off", sensor), 0.0) * x**2) * (1 + values.get(("gain", name), 0.0))
            found[:, i, i] = own
            if quantity == "acceleration" and (sensor, "pitch_rate") in columns:
                tilt, shift = values.get(("tilt", sensor), 0.0), values.get(("position", sensor), 0.0)
                found[:, i, i] *= math.cos(tilt)
                found[:, i, columns[sensor, "pitch_rate"]] = own * 1j * (GRAVITY * math.sin(tilt) * pitch - shift * omega)
        return found
