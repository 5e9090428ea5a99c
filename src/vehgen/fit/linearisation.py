"""A misfit linearised at a point: the derivatives of its whitened spectra, as a value that may serve again nearby.

Derivatives are differences of simulated responses. Those by what moves wheels along the road, or the road (start, speed, hump), each see
the road anew; they change little along a fit, so that one linearisation may take them from another. Those by the errors of sensors cost
next to nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vehgen.fit.misfit import Array, Complex, Misfit
from vehgen.fit.nuisances import Nuisance
from vehgen.fit.window import flatten

UNIT_DIFFERENCE = 1e-6
"""Step of the differences to each side, in the unit cube and in units of an error's uncertainty: so short that jumps of a response
seldom cross a sample."""
WINDOW_SHIFT_S = 1e-5
"""The same for the windows of channels that are late [s]."""
MOST_MISSED = 0.25
"""A share of what a step did; derivatives that miss more of it are computed anew, not corrected by it."""
DriveChange = tuple[str, str, float, float]
"""What changes how a run is driven: an error, an adjustment or a length between axles. Its name, its place, its knot in time [s], and what
a unit of the unknown is."""
Slopes = dict[DriveChange, Array]
"""Derivatives of a run's motions `shape (n_samples, n_channels)` by what changes its drive."""


@dataclass(frozen=True)
class Linearisation:
    """Derivatives of a misfit's whitened spectra at a point.

    `blocks` holds a trial's derivatives each, `shape (n_columns, n_lines, n_channels)`, by the unknowns that it depends on (`columns`);
    `slopes` those of its motions by what changes its drive; `n_priors` counts the errors of sensors and runs.
    """

    blocks: tuple[Complex, ...]
    columns: tuple[NDArray[np.intp], ...]
    slopes: tuple[Slopes, ...]
    n_unknowns: int
    n_priors: int

    @property
    def spectra(self) -> tuple[Complex, ...]:
        """A trial's derivatives each by all unknowns, `shape (n_unknowns, n_lines, n_channels)`."""
        found = []
        for block, columns in zip(self.blocks, self.columns, strict=True):
            whole = np.zeros((self.n_unknowns, *block.shape[1:]), dtype=np.complex128)
            whole[columns] = block
            found.append(whole)
        return tuple(found)

    @property
    def jacobian(self) -> Array:
        """The derivatives of :meth:`Misfit.residuals`, `shape (n_residuals, n_unknowns)`, the errors' priors last."""
        prior = np.zeros((self.n_priors, self.n_unknowns))
        prior[:, self.n_unknowns - self.n_priors :] = np.eye(self.n_priors)
        return np.vstack([*(flatten(lines, first=1).T for lines in self.spectra), prior])

    def rows(self, number: int) -> Array:
        """Return a trial's derivatives by the unknowns that it depends on as real numbers, `shape (n_columns, 2 n_lines n_channels)`."""
        return real_rows(self.blocks[number])

    def moved(self, step: Array, before: Sequence[Complex], after: Sequence[Complex]) -> Linearisation | None:
        """Return the linearisation after a step, by what the step did: the least change with which the derivatives foretell it.

        Unknowns count by how much they move the residuals (C. G. Broyden, Math. Comp. 19, 1965, doi:10.1090/S0025-5718-1965-0198670-6).
        None where the derivatives missed more than MOST_MISSED of what the step did: they say little about the next one.

        Parameters
        ----------
        step
            Of the unknowns, `shape (n_unknowns,)`.
        before, after
            Each trial's whitened residuals before and after it.
        """
        did = [new - old for old, new in zip(before, after, strict=True)]
        steps = [step[columns] for columns in self.columns]
        missed = [change - np.tensordot(own, block, axes=1) for change, own, block in zip(did, steps, self.blocks, strict=True)]
        if sum(np.linalg.norm(part) ** 2 for part in missed) > MOST_MISSED**2 * sum(np.linalg.norm(part) ** 2 for part in did):
            return None
        blocks = []
        for block, own, left in zip(self.blocks, steps, missed, strict=True):
            pull = own * (np.abs(block) ** 2).sum(axis=(1, 2))
            blocks.append(block + pull[:, None, None] * (left / max(float(own @ pull), 1e-300)))
        return replace(self, blocks=tuple(blocks))

    def normal(self, lines: list[Complex], x: Array) -> tuple[Array, Array]:
        """Return J'J `shape (n_unknowns, n_unknowns)` and J'r `shape (n_unknowns,)`, priors of the errors included.

        `lines` are each trial's whitened residuals at the unknowns x.
        """
        gradient = np.zeros(self.n_unknowns)
        for number, (columns, line) in enumerate(zip(self.columns, lines, strict=True)):
            gradient[columns] += 2 * self.rows(number) @ real_rows(line[None])[0]
        held = np.arange(self.n_unknowns - self.n_priors, self.n_unknowns)
        gradient[held] += x[held]
        return self.information(), gradient

    def information(self) -> Array:
        """Return J'J `shape (n_unknowns, n_unknowns)`, priors of the errors included."""
        found = np.zeros((self.n_unknowns, self.n_unknowns))
        for number, columns in enumerate(self.columns):
            rows = self.rows(number)
            found[np.ix_(columns, columns)] += 2 * rows @ rows.T
        held = np.arange(self.n_unknowns - self.n_priors, self.n_unknowns)
        found[held, held] += 1.0
        return found


def real_rows(lines: Complex) -> Array:
    """Return whitened lines `shape (n, n_lines, n_channels)` as real numbers, `shape (n, 2 n_lines n_channels)`: half of unit variance."""
    n, n_lines, n_channels = lines.shape
    return np.ascontiguousarray(lines).view(np.float64).reshape(n, 2 * n_lines * n_channels)


def linearise(misfit: Misfit, x: Array, *, one_sided: bool = False, slopes_of: Linearisation | None = None) -> Linearisation:
    """Return a misfit's linearisation at x, by differences.

    Parameters
    ----------
    misfit, x
        The misfit, and its unknowns `shape (n_unknowns,)`.
    one_sided
        Take differences to one side, which takes half of the time.
    slopes_of
        A linearisation nearby, with the same runs, whose derivatives by what changes drives serve again where it has all that are needed:
        from two points together, a speed that is off in all runs would seem to differ from each run's own (default: compute them).
    """
    found = [_Trial(misfit, x, t, one_sided).block(None if slopes_of is None else slopes_of.slopes[t]) for t in range(len(misfit.errors))]
    columns = tuple(misfit.columns(t) for t in range(len(misfit.errors)))
    return Linearisation(tuple(block for block, _ in found), columns, tuple(own for _, own in found), misfit.n_unknowns, misfit.n_errors)


class _Trial:
    """One trial of a misfit at unknowns x, for its derivatives.

    What moves wheels along the road - a length between axles, an adjustment or an error of the drive - is derived in one simulation of
    several individuals that all see the road alike: else a speed that is off in all runs would seem to do something else than each run's
    own, and a length between axles something else than an axle that stands elsewhere.
    """

    def __init__(self, misfit: Misfit, x: Array, number: int, one_sided: bool) -> None:
        self.misfit, self.number, self.one_sided = misfit, number, one_sided
        self.unit, self.numbers, self.error = misfit.split(x)[0], misfit.adjusted(x), misfit.errors_of(x, number)
        trial, n = misfit.problem.trials[number], misfit.n_parameters
        self.lengths = misfit.problem.lengths_between_axles(trial)
        still = [i for i in range(n) if i not in self.lengths]
        steps = np.eye(n)[still]
        moves = np.vstack([np.zeros((1, n)), steps, *(() if one_sided else (-steps,))]) * UNIT_DIFFERENCE
        responses = misfit.respond(number, misfit.problem.space.values(self.unit + moves), self.numbers, self.error)
        self.centre = responses[0]
        self.by_parameter = dict(zip(still, self._differences(responses), strict=True))

    def block(self, known: Slopes | None) -> tuple[Complex, Slopes]:
        """Return the trial's whitened derivatives by its columns, and those of its motions by what changes its drive."""
        misfit, items = self.misfit, self.misfit.errors[self.number].items
        slopes = self._slopes(known or {})
        by_length = {i: slopes[self._of_parameter(i)] for i in self.lengths}
        by_parameter = {**self.by_parameter, **by_length}
        by_shared = [slopes[self._of_shared(i)] if self._changes_drive(i) else self._by_shared(i) for i in range(len(misfit.shared))]
        by_error = [slopes[_of_error(item)] for item in items if item.moves_vehicle]
        motions = [self.centre, *(by_parameter[i] for i in sorted(by_parameter)), *by_shared, *by_error]
        unread = misfit.unread(self.number, np.stack(motions), self.error)
        lines = misfit.read(self.number, unread[1:], self.error)
        n = len(by_parameter) + len(by_shared)
        driven = iter(lines[n:])
        ahead, behind = (misfit.unread(self.number, self.centre, self.error, later) for later in (WINDOW_SHIFT_S, -WINDOW_SHIFT_S))
        frequency, later = misfit.frequency(self.number), (ahead - behind) / (2 * WINDOW_SHIFT_S)
        read = misfit.errors[self.number].read_slopes(frequency, self.error, unread[0], later)
        rows = [next(driven) if item.moves_vehicle else read[i] for i, item in enumerate(items)]
        return -misfit.whiten(self.number, np.concatenate([lines[:n], np.reshape(rows, (-1, *lines.shape[1:]))])), slopes

    def _slopes(self, known: Slopes) -> Slopes:
        """Return the derivatives of the motions by all that changes the drive: known ones, where none is missing."""
        items = self.misfit.errors[self.number].items
        shared = [i for i in range(len(self.misfit.shared)) if self._changes_drive(i)]
        errors = [i for i, item in enumerate(items) if item.moves_vehicle]
        lengths = [self._of_parameter(i) for i in self.lengths]
        wanted = [*lengths, *(self._of_shared(i) for i in shared), *(_of_error(items[i]) for i in errors)]
        if all(item in known for item in wanted):
            return known
        return dict(zip(wanted, self._by_moves(self.lengths, shared, errors), strict=True))

    def _of_parameter(self, place: int) -> DriveChange:
        space = self.misfit.problem.space
        return space.names[place], "", 0.0, float(space.slopes(space.start)[place])

    def _of_shared(self, place: int) -> DriveChange:
        item = self.misfit.shared[place]
        return type(item).__name__, item.place, 0.0, item.scale

    def _changes_drive(self, place: int) -> bool:
        """Return whether an adjustment changes what the trial drives through, in the same steps."""
        item, scenario = self.misfit.shared[place], self.misfit.problem.trials[self.number].scenario
        moved = item.scenario(scenario, float(self.numbers[place] + UNIT_DIFFERENCE * item.scale))
        return moved is not scenario and moved.same_samples(scenario)

    def _by_shared(self, place: int) -> Array:
        """Return the derivative of the motions by an adjustment of what sensors read, or of steps, in units of its scale."""
        step = UNIT_DIFFERENCE * self.misfit.shared[place].scale * np.eye(len(self.numbers))[place]
        values = self.misfit.problem.space.values(self.unit)[None]
        numbers = [self.numbers + step, *(() if self.one_sided else (self.numbers - step,))]
        moved = [self.misfit.respond(self.number, values, own, self.error)[0] for own in numbers]
        return np.asarray(self._differences(np.stack([self.centre, *moved]))[0])

    def _by_moves(self, parameters: Sequence[int], adjustments: Sequence[int], errors: Sequence[int]) -> Array:
        """Return the derivatives of the motions by these parameters, adjustments and errors in turn, all from one simulation."""
        sizes = len(self.unit), len(self.numbers), len(self.error)
        chosen = [*parameters, *(sizes[0] + i for i in adjustments), *(sizes[0] + sizes[1] + i for i in errors)]
        if not chosen:
            return np.zeros((0, *self.centre.shape))
        steps = UNIT_DIFFERENCE * np.eye(sum(sizes))[chosen]
        moves = np.vstack([np.zeros((1, sum(sizes))), steps, *(() if self.one_sided else (-steps,))])
        units, numbers, own = np.split(moves, np.cumsum(sizes)[:-1], axis=1)
        scales = np.array([item.scale for item in self.misfit.shared])
        values = self.misfit.problem.space.values(self.unit + units)
        return self._differences(self.misfit.respond_nearby(self.number, values, self.numbers + numbers * scales, self.error + own))

    def _differences(self, responses: Array) -> Array:
        """Return derivatives from the response itself and those after each move, then, if two-sided, after each to the other side."""
        if self.one_sided:
            return np.asarray((responses[1:] - responses[0]) / UNIT_DIFFERENCE)
        n = len(responses) // 2
        return np.asarray((responses[1 : n + 1] - responses[n + 1 :]) / (2 * UNIT_DIFFERENCE))


def _of_error(item: Nuisance) -> DriveChange:
    return item.name, item.place, item.knot, item.sigma


class Lineariser:
    """Linearises a misfit again and again, as a fit asks for it.

    Parameters
    ----------
    misfit
        What is linearised.
    refresh
        Every how many linearisations the derivatives by the runs' errors are computed anew; beyond 1 all derivatives are one-sided, too.
    nearby
        A linearisation whose derivatives by the runs' errors serve first.
    secants
        So many linearisations between computed ones follow from the step that led there (:meth:`Linearisation.moved`).
    """

    def __init__(self, misfit: Misfit, refresh: int = 1, nearby: Linearisation | None = None, secants: int = 0) -> None:
        self.misfit, self.refresh, self.secants = misfit, refresh, secants
        self._last, self._age, self._moves = nearby, 1 if nearby is not None else 0, 0
        self._begun: tuple[Array, list[Complex]] | None = None

    @property
    def last(self) -> Linearisation | None:
        """The last linearisation, if there has been one."""
        return self._last

    def __call__(self, x: Array, lines: list[Complex] | None = None) -> Linearisation:
        """Return the linearisation at unknowns x `shape (n_unknowns,)`; without the whitened residuals `lines` there it is computed."""
        moved = None
        if self._last is not None and self._begun is not None and lines is not None and self._moves < self.secants:
            moved = self._last.moved(x - self._begun[0], self._begun[1], lines)
        if moved is not None:
            self._last, self._moves = moved, self._moves + 1
        else:
            known = self._last if self._age % self.refresh else None
            self._last = linearise(self.misfit, x, one_sided=self.refresh > 1, slopes_of=known)
            self._age, self._moves = self._age + 1, 0
        self._begun = None if lines is None else (x, lines)
        return self._last

    def linearise_anew(self, x: Array, lines: list[Complex] | None = None) -> Linearisation:
        """Return the linearisation at unknowns x with all derivatives computed there."""
        self._age, self._begun = 0, None
        return self(x, lines)
