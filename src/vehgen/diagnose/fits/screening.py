"""Which of many candidates are worth fitting: the first-order gain of each, found without a fit.

At each of a candidate's starts the whitened residual moves by d. What the base parameters and nuisances can do by themselves is projected
out of d and of the residual r; along d, scaled freely, r then falls by (r.d)^2/(d.d). This ranks, it does not judge: it sees no curvature.
A law without a memory needs no simulation of its own (see first_order.py); what changes the vehicle's structure, and friction that sticks,
is simulated.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.fits.candidate import Candidate, build_problem, carried
from vehgen.diagnose.fits.first_order import ProbeMotion
from vehgen.diagnose.fits.model_fit import NUISANCES, CurrentModel, ModelFit
from vehgen.diagnose.fits.projection import Projection
from vehgen.effects import EffectLocator, RunEffect
from vehgen.effects.evidence import Residual
from vehgen.effects.kinds import ShakingEffect
from vehgen.effects.locator import base_parameters
from vehgen.fit.misfit import Misfit
from vehgen.fit.problem import Problem
from vehgen.fit.window import flatten
from vehgen.simulate import SimulatorPool
from vehgen.vehicle import Vehicle

Array = NDArray[np.float64]
MAX_CANDIDATES, MAX_BESIDE = 14, 8
"""So many candidates that are forces are kept; so many beside effects that were found before."""
MOST_BEHIND = 8
"""So many laws of tyres at most are fitted that an axle's parameters at their bounds may stand in for."""
LEAST_OF_LINES, LEAST_EACH, LEAST_OF_BEST = 25.0, 2.0, 0.25
"""What shakes the vehicle is fitted where it gains so much, as its lines are sought where noise is highest, and so much more for each of
its numbers, twice what chance takes off, and such a share of what it gains at the best place."""
INSIDE = 0.01
"""A number begins so far within its range, of 1."""


def screen(candidates: Sequence[Candidate], gains: FirstOrderGains, kept_at: str = "", nowhere: bool = False) -> list[Candidate]:
    """Return the candidates worth fitting: all that leave the vehicle alone, of the others those with the largest first-order gain.

    A first order scales what it moves: it says nothing of candidates without a number of their own, which are kept, nor of laws that the
    base's parameters at their bounds may stand in for. What holds another candidate as a special case is kept with it, and takes no place
    of its own. A frame that bends is kept where no single force explains the gap, whatever a base says that has bent to it.

    Parameters
    ----------
    candidates, gains
        What to choose from, and what each gains beside a fit.
    kept_at
        A place all of whose candidates are kept, whatever their first order says.
    nowhere
        Whether a single force explains the gap at no place.
    """
    always = [item for item in candidates if not _is_scaled(item)]
    forces = [item for item in candidates if _is_scaled(item) and not any(map(item.holds, candidates))]
    most = MAX_BESIDE if gains.base.effects else MAX_CANDIDATES
    if len(forces) <= most:
        return list(candidates)
    ranked = sorted(forces, key=lambda item: -gains.of(item)[0])
    placed = [item for item in forces if item.place == kept_at or (nowhere and reaches_a_body(item))]
    held = () if gains.base.effects else gains.base.least_squares.on_bound
    behind = [item for item in ranked[most:] if hides_behind(item, set(held), gains.locator.vehicle)]
    return chosen_with_holders(candidates, [*always, *placed, *ranked[:most], *behind[:MOST_BEHIND]])


def shaking_in_earnest(candidates: Sequence[Candidate], gains: FirstOrderGains) -> list[Candidate]:
    """Return candidates without what shakes the vehicle by no more than chance, or far less than the same effect does at another place.

    Its amplitudes follow linearly from what the rest leaves, so that the first order says what it gains; and it takes long to fit.
    """
    n_runs = len(gains.misfit.problem.trials)
    shaking = [item for item in candidates if isinstance(item.effect, ShakingEffect)]
    best = {item.effect.name: max(gains.of(own)[0] for own in shaking if own.effect.name == item.effect.name) for item in shaking}

    def gains_enough(item: Candidate) -> bool:
        least = max(LEAST_OF_LINES + LEAST_EACH * item.effect.n_numbers(n_runs), LEAST_OF_BEST * best[item.effect.name])
        return gains.of(item)[0] >= least

    return [item for item in candidates if not isinstance(item.effect, ShakingEffect) or gains_enough(item)]


def reaches_a_body(item: Candidate) -> bool:
    """Return whether a candidate is a law that is no single force, but acts on a body or its axles at several places."""
    return item.effect.changes_vehicle and item.effect.is_global and item.effect.attaches != "tyre"


def hides_behind(item: Candidate, held: set[str], vehicle: Vehicle) -> bool:
    """Return whether parameters that the base leaves at their bounds may stand in for a law of a tyre."""
    of_tyre = item.effect.changes_vehicle and item.effect.attaches == "tyre"
    return of_tyre and not held.isdisjoint(base_parameters(vehicle, item.place, ("m", "kt")))


class FirstOrderGains:
    """What -2 ln of the likelihood of the training runs would fall by with each of several candidates, to the first order.

    Parameters
    ----------
    base, current
        The fit they are added to, and the same fit as the current model.
    locator, simulators
        As for :func:`vehgen.diagnose.fits.candidate.build_problem`.
    residual
        What the fit leaves, for candidates whose starts are read from it.
    """

    def __init__(
        self, base: ModelFit, current: CurrentModel, locator: EffectLocator, simulators: SimulatorPool, residual: Residual | None = None
    ) -> None:
        self.base, self.current, self.locator, self.simulators, self.residual = base, current, locator, simulators, residual
        self.misfit = base.least_squares.misfit
        self._known: dict[tuple[str, str], tuple[float, tuple[float, ...]]] = {}

    @cached_property
    def projection(self) -> Projection:
        """The residuals of the fit, without what its unknowns can do about them."""
        return Projection.of(self.misfit, self.base.least_squares.x, self.base.effects)

    @cached_property
    def motion(self) -> ProbeMotion:
        """How springs and dampers move under the fit."""
        return ProbeMotion(self.misfit, self.base.least_squares.x)

    @cached_property
    def residuals(self) -> Array:
        """The whitened residuals of the fit, `shape (n_residuals,)`."""
        return np.concatenate([flatten(item) for item in self.misfit.whitened_spectrum(self.base.least_squares.x)])

    def of(self, candidate: Candidate) -> tuple[float, tuple[float, ...]]:
        """Return a candidate's gain, the largest over its starts and, of a force, over a smaller one, and where its numbers end by it.

        Along its first number, which says how large it is: that is the start, scaled, as it is or as it differs from what changes nothing.
        What was found of a candidate is remembered.
        """
        key = candidate.effect.name, candidate.place
        if key not in self._known:
            self._known[key] = self._found(candidate)
        return self._known[key]

    def _found(self, candidate: Candidate) -> tuple[float, tuple[float, ...]]:
        current = self.current
        problem = build_problem(candidate, current.problem, self.locator, self.simulators)
        begun, n, own = carried(current.unit, current.problem.space, problem.space), len(current.unit), len(candidate.parameters)
        exact: Misfit | None = None
        starts = [np.array(item) for item in candidate.effect.starts(candidate.place, self.locator, self.residual)]
        smaller = [_smaller(starts, problem.space.lower[n:])] if _is_scaled(candidate) and starts else []
        best, end = 0.0, tuple(starts[0].tolist()) if starts else ()
        for number, start in enumerate([*starts, *smaller]):
            point = problem.space.start.copy()
            point[n:] = start[:own]
            unit = np.concatenate([begun, problem.space.unit(point)[n:]])
            moved = self.motion.moved(problem, problem.space.values(unit)) if exact is None and not candidate.shared else None
            if moved is not None and number == len(starts):
                break  # it would be the same
            if moved is None:
                shared = (*current.shared, *candidate.shared)
                exact = exact or Misfit(problem, self.misfit.noises, problem.space.start, NUISANCES, self.misfit.band, shared)
                numbers = [(value - item.neutral) / item.scale for item, value in zip(candidate.shared, start, strict=False)]
                own_lines = exact.whitened_spectrum(np.concatenate([unit, np.zeros(len(current.shared)), numbers, current.errors]))
                moved = np.concatenate([flatten(item) for item in own_lines]) - self.residuals
            if not np.all(np.isfinite(moved)):
                continue
            gain, scale = self._gain(moved, bool(own or candidate.shared))
            if gain > best:
                best, end = gain, self._scaled(candidate, problem, start, scale)
        return best, end

    def _scaled(self, candidate: Candidate, problem: Problem, start: Array, scale: float) -> tuple[float, ...]:
        """Return a start whose first number is scaled, within its bounds."""
        found = start.tolist()
        if candidate.parameters:
            n, point = len(self.current.unit), problem.space.start.copy()
            point[n] = np.clip(scale * found[0], problem.space.lower[n], problem.space.upper[n])
            found[0] = float(problem.space.values(np.clip(problem.space.unit(point), INSIDE, 1 - INSIDE))[n])
        elif isinstance(candidate.effect, RunEffect):
            neutral = candidate.effect.neutral
            found[0] = neutral + scale * (found[0] - neutral)
        return tuple(found)

    def _gain(self, moved: Array, scaled: bool) -> tuple[float, float]:
        """Return the gain along a change of the residuals, and the scale of the change: free, or 1 of a candidate without a number."""
        free = self.projection.remainder(moved)
        along, squared = float(self.projection.left @ free), max(float(free @ free), 1e-12)
        if along >= 0:
            return 0.0, 1.0
        return (along**2 / squared, -along / squared) if scaled else (max(-2 * along - squared, 0.0), 1.0)


def _is_scaled(candidate: Candidate) -> bool:
    return candidate.effect.changes_vehicle and bool(candidate.parameters)


def _smaller(starts: Sequence[Array], lower: Array) -> Array:
    """Return a start whose first number, the size, is between its lower bound and the smallest start, on a logarithmic scale.

    Friction that holds what truly slips moves the residual nowhere useful: where it is small, so is its first order.
    """
    smallest = min(starts, key=lambda item: item[:1].tolist()).copy()
    smallest[:1] = np.where(lower[:1] > 0, np.sqrt(np.maximum(lower[:1], 0.0) * smallest[:1]), smallest[:1])
    return smallest


def chosen_with_holders(candidates: Sequence[Candidate], chosen: Sequence[Candidate]) -> list[Candidate]:
    """Return the candidates, in their order, that are chosen or hold a chosen one as a special case."""
    kept = {id(item) for item in chosen}
    return [item for item in candidates if id(item) in kept or any(map(item.holds, chosen))]
