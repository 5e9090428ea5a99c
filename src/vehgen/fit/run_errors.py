"""The errors of one run applied: what they make of its scenario, and of what its sensors read."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from vehgen.fit.nuisances import OF_INPUTS, OF_TIME, READING, Nuisance
from vehgen.fit.reading import Reading
from vehgen.fit.trial import Trial
from vehgen.road import Wander
from vehgen.simulate import Scenario
from vehgen.simulate.initial_state import initial_values
from vehgen.simulate.run_scenario import ground_links

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class RunErrors:
    """The errors of one run: those that are the same in all runs (`common`), then its own (`own`).

    Numbers of errors `shape (size,)` count in standard deviations, the common ones first. `channels` holds name, sensor and quantity of
    every channel; `known` common errors [units], by name and place, that stand; `rate` is the recording's [Hz]; `forces` names the forces
    that act, `ground` the links whose ground ends move, `axles` the axles, in the model's order, and `behind` how far each runs behind the
    first to arrive [m]; `begin` tells the place of an initial displacement or velocity in the state, by its error's name and place.
    """

    common: tuple[Nuisance, ...]
    own: tuple[Nuisance, ...]
    channels: tuple[tuple[str, str, str], ...]
    known: Mapping[tuple[str, str], float] = field(default_factory=dict)
    rate: float = 100.0
    forces: tuple[str, ...] = ()
    ground: tuple[str, ...] = ()
    axles: tuple[str, ...] = ()
    behind: tuple[float, ...] = ()
    begin: Mapping[tuple[str, str], int] = field(default_factory=dict)

    @classmethod
    def of(cls, trial: Trial, common: tuple[Nuisance, ...], own: tuple[Nuisance, ...], known: Mapping[tuple[str, str], float]) -> RunErrors:
        """Return the errors of a trial."""
        channels = tuple((item.name, item.sensor, item.quantity) for item in trial.recording.channels)
        model = trial.simulator.model
        begin = {(f"initial_{item.key}", item.owner): item.place for item in initial_values(trial.run, model)}
        axles, behind = tuple(model.layout.axles), tuple(model.wheel_offsets(trial.values).tolist())
        return cls(common, own, channels, known, 1 / trial.recording.dt, model.forces, ground_links(model), axles, behind, begin)

    @property
    def items(self) -> tuple[Nuisance, ...]:
        """All errors, the common ones first."""
        return (*self.common, *self.own)

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
        return self._begun(scenario, numbers).adjusted(
            found["delay"],
            1 + found["speed"],
            1 + found["height"],
            anchor=scenario.first_arrival,
            wander=Wander(tuple(knots), tuple(value - mean for value in strayed)) if any(strayed) else None,
            deformation=form if scenario.humps else None,
            forces=self._forces(numbers),
            displacements=self._displacements(numbers),
            farther=self._farther(numbers),
        )

    def steady(self, scenario: Scenario, numbers: Array) -> Scenario:
        """Return the scenario with the errors but for how the driver strays: at the run's mean speed."""
        return self.scenario(scenario, np.where([item.name == "wander" for item in self.items], 0.0, numbers))

    def _farther(self, numbers: Array) -> tuple[float, ...]:
        """Return how much farther behind the first each axle runs, by the road's odometer [m]; nothing where all run as the file says."""
        values = self._values(numbers)
        longer = values.get(("odometer", ""), 0.0)
        found = tuple(values.get(("axle_position", axle), 0.0) + longer * way for axle, way in zip(self.axles, self.behind, strict=True))
        return found if any(found) else ()

    def _begun(self, scenario: Scenario, numbers: Array) -> Scenario:
        """Return the scenario released with the errors of its initial state."""
        if scenario.initial is None:
            return scenario
        state = scenario.initial.copy()
        for item, number in zip(self.items, numbers, strict=True):
            if (item.name, item.place) in self.begin:
                state[self.begin[item.name, item.place]] += float(number) * item.sigma
        return replace(scenario, initial=state)

    def _forces(self, numbers: Array) -> list[tuple[float, float]]:
        """Return gain and offset [N] of every force; nothing where no input has errors."""
        values = self._of_inputs(numbers) if self.forces else {}
        return [(1 + values.get(("force_gain", name), 0.0), values.get(("force_offset", name), 0.0)) for name in self.forces if values]

    def _displacements(self, numbers: Array) -> list[float]:
        """Return the gain of every displacement of the ground; nothing where no input has errors."""
        values = self._of_inputs(numbers) if self.ground else {}
        return [1 + values.get(("displacement_gain", name), 0.0) for name in self.ground if values]

    def _of_inputs(self, numbers: Array) -> dict[tuple[str, str], float]:
        return {key: value for key, value in self._values(numbers).items() if key[0] in OF_INPUTS}

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
        lines = reading.apply(np.asarray(np.fft.rfft(motion, length, axis=0)))
        return np.asarray(np.fft.irfft(lines, length, axis=0)[: len(motion)])

    def reading(self, frequency: Array, numbers: Array) -> Reading | None:
        """Return what the channels read of what they should at lines of frequencies `shape (n_lines,)` [Hz]; None: all of it."""
        values = self._values(numbers)
        if not any(value for (name, _), value in values.items() if name in READING):
            return None
        return Reading.of(frequency, self.rate, self.channels, values, self._late(values))

    def read_slopes(self, frequency: Array, numbers: Array, lines: Complex, later: Complex) -> dict[int, Complex]:
        """Return the derivatives of what is read by the errors that change readings alone, by their number, `shape (n_lines, n_channels)`.

        Of lines of motions `shape (n_lines, n_channels)`, whose derivatives by how late each channel's window is [1/s] are `later`: a late
        clock moves the window, too, and along the valley in which clocks and a sensor's delay make up for each other even that counts.
        """
        values = self._values(numbers)
        reading = Reading.of(frequency, self.rate, self.channels, values, self._late(values))
        read = reading.apply(lines)
        found = {}
        for i, item in enumerate(self.items):
            if item.name in READING:
                found[i] = item.sigma * reading.slope(item.name, item.place, lines, read)
            if item.name in OF_TIME:
                found[i] += reading.apply(later * self._late({(item.name, item.place): item.sigma}))
        return found
