"""What a law would do to the recordings, to first order, without a kernel of its own.

A law's force follows from the motion that a fitted model has without it, and the model's frequency response carries the force to the
sensors. That holds for small forces; for ranking it holds well enough.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from vehgen.codegen import Kernel
from vehgen.fit.misfit import Misfit
from vehgen.fit.problem import Problem
from vehgen.fit.window import flatten, transform
from vehgen.mechanics import EquationsOfMotion, static_loads
from vehgen.mechanics.energies import Element
from vehgen.mechanics.equations_of_motion import Channel
from vehgen.mechanics.evaluation import evaluate_array
from vehgen.mechanics.law_terms import RATE, REST, STATIC, TRAVEL
from vehgen.simulate.acquired import initial_states
from vehgen.simulate.frequency import force_response

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


class ProbeMotion:
    """How every spring and damper moves under a fit, and what the sensors show of a force there.

    Parameters
    ----------
    misfit, x
        The fit: laws that it has already are in its motion, not in what the sensors show.
    """

    def __init__(self, misfit: Misfit, x: Array) -> None:
        self.misfit, self.x = misfit, x
        values = misfit.problem.space.values(misfit.split(x)[0])
        kernels: dict[int, tuple[EquationsOfMotion, Kernel]] = {}
        self.values = [misfit.problem.values_of(values, trial) for trial in misfit.problem.trials]
        self.motions: list[Array] = []
        self._responses: dict[tuple[int, int], Complex] = {}
        self._added: dict[int, tuple[EquationsOfMotion, dict[int, sp.Expr] | None]] = {}
        for t, (trial, known) in enumerate(zip(misfit.problem.trials, self.values, strict=True)):
            model = trial.simulator.model
            if id(model) not in kernels:
                probe = _probe(model)
                kernels[id(model)] = probe, Kernel(probe)
            probe, kernel = kernels[id(model)]
            scenario = misfit.scenario(x, t)
            population = np.array([[known[name] for name in probe.parameters]])
            run = kernel.run(population, scenario.excitation(probe.wheel_offsets(known)), scenario.decimation, initial_states(scenario, 1))
            self.motions.append(np.asarray(run.responses[0, scenario.skipped :].T.reshape(len(model.elements), 2, -1)))

    def moved(self, problem: Problem, values: Array) -> Array | None:
        """Return by how much a candidate's residuals differ from the fit's, without the nuisances' priors.

        Parameters
        ----------
        problem
            The candidate's, on the same runs.
        values
            Its searched parameters `shape (n_parameters,)` [SI].

        Returns
        -------
        None for a candidate that is more than a force of travel and rate at springs and dampers that the fit's model has; and for dry
        friction, which changes the motion so much that its first order says little.
        """
        parts = []
        for t, trial in enumerate(problem.trials):
            forces = self._forces(t, trial.simulator.model, problem.values_of(values, trial))
            if forces is None:
                return None
            lines: Complex = np.zeros((len(self.misfit.frequency(t)), len(trial.channels)), dtype=np.complex128)
            inside = np.isin(np.fft.rfftfreq(len(trial.recording.time), trial.recording.dt), self.misfit.frequency(t))
            for number, force in forces.items():
                lines += transform(force[:, None], trial.recording.dt, inside, seen=trial.window) * self._response(t, number)
            parts.append(flatten(self.misfit.whiten(t, self.misfit.read_at(t, lines, self.x))))
        return np.concatenate(parts)

    def _forces(self, t: int, model: EquationsOfMotion, values: Mapping[str, float]) -> dict[int, Array] | None:
        """Return what a model adds at the elements of the fit's model, by number, each `shape (n_samples,)`."""
        own = self.misfit.problem.trials[t].simulator.model
        if id(model) not in self._added:
            self._added[id(model)] = model, _added_forces(model, own)
        added = self._added[id(model)][1]
        if added is None:
            return None
        found = {}
        for number, force in added.items():
            symbols = sorted(force.free_symbols - {TRAVEL, RATE, STATIC}, key=str)
            known = {symbol: np.array(value) for symbol, value in zip(symbols, model.evaluate_list(symbols, values), strict=True)}
            travel, rate = self.motions[t][number]
            known |= {TRAVEL: travel, RATE: rate}
            if STATIC in force.free_symbols:
                new = model.elements[number]
                known[STATIC] = np.array(static_loads(model, values).elements[new.kind, new.name])
            found[number] = np.broadcast_to(evaluate_array(force, known), travel.shape)
        return found

    def _response(self, t: int, number: int) -> Complex:
        """Return the channels per unit of force that resists the travel of an element, `shape (n_lines, n_channels)`."""
        if (t, number) not in self._responses:
            trial, frequency = self.misfit.problem.trials[t], self.misfit.frequency(t)
            model = trial.simulator.model
            answer = force_response(model, self.values[t], (model.elements[number].row,), frequency, number)[:, :, 0]
            self._responses[t, number] = answer * trial.channel_factors(frequency)
        return self._responses[t, number]


def _added_forces(model: EquationsOfMotion, own: EquationsOfMotion) -> dict[int, sp.Expr] | None:
    """Return what a model adds at the elements of another one, as forces of travel and rate, by number; None if it adds more."""
    alike = len(model.elements) == len(own.elements) and model.mass_entries == own.mass_entries and not model.is_preloaded
    if not alike:
        return None
    pairs = list(zip(model.elements, own.elements, strict=True))
    if any(term.law.states for new, old in pairs for term in new.laws[len(old.laws) :]) or not all(
        _extends(new, old) for new, old in pairs
    ):
        return None
    found = {}
    for number, (new, old) in enumerate(pairs):
        added = new.laws[len(old.laws) :]
        steps = [term.step(new.k, new.c) for term in added]
        if any(step.friction != 0 for step in steps):
            return None
        force = (new.k - old.k) * TRAVEL + (new.c - old.c) * RATE + sp.Add(*(step.now for step in steps))
        if force != 0:
            found[number] = force
    return found


def _probe(model: EquationsOfMotion) -> EquationsOfMotion:
    """Return the model with the travel and the rate of every element as its channels."""
    channels = []
    for item in model.elements:
        channels.append(Channel(f"{item.name} travel", "displacement", "", displacement=item.row, input=item.input_row))
        channels.append(Channel(f"{item.name} rate", "velocity", "", velocity=item.row, input_rate=item.input_row))
    return replace(model, channels=tuple(channels))


def _extends(new: Element, old: Element) -> bool:
    """Whether an element is another with laws added, or another stiffness or damping."""
    same = (new.kind, new.name, new.row, new.input_row) == (old.kind, old.name, old.row, old.input_row)
    return same and new.laws[: len(old.laws)] == old.laws and all(REST not in term.step().now.free_symbols for term in new.laws)
