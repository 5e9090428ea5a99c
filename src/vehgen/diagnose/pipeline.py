"""The diagnosis in five stages: detect, localise, name, add, verify. Each can be used by itself; each leaves its evidence."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from vehgen.diagnose import thresholds as limit
from vehgen.diagnose.candidate import Candidate, list_candidates
from vehgen.diagnose.fitting import NUISANCES, Fit, fit_base, fit_candidate, narrow, p_value
from vehgen.diagnose.noise_floor import NoiseFloor, find_noise_floor
from vehgen.diagnose.place_test import Place, PlaceResult, list_places, test_places
from vehgen.diagnose.verdict import Gap, NamedEffect, NamedParameter, Verdict, VerdictName, sentence
from vehgen.effects import Effect, Surveyor, library
from vehgen.effects.places import ALL_TYRES
from vehgen.errors import InputError
from vehgen.identify.problem import Problem, make_problem
from vehgen.identify.trial import Trial
from vehgen.simulate import Simulator

Array = NDArray[np.float64]
BAND = (0.5, 40.0)
"""Frequencies compared [Hz]."""
Progress = Callable[[str, int, int, str], None]
"""Called with the stage, how many of how many, and the best so far."""
APART = "a run with another hump height and speed tells them apart"
GLOBAL = ("speed_error", "tyre_footprint", "tyre_damping", "tyre_liftoff", "frame_bending", "suspended_cab", "cargo_module", "walking_beam")
"""Effects that no single place explains, or that reach several: they are tried whatever the place test says."""


@dataclass(frozen=True)
class Detection:
    """Stage 1: the noise floor and how far the recalibrated base model is above it."""

    problem: Problem
    held_out: tuple[Trial, ...]
    floor: NoiseFloor
    base: Fit

    @property
    def chi(self) -> float:
        """The base model's chi over all runs."""
        counts = self.base.counts
        return float(np.sqrt(sum(self.base.runs[name] * counts[name] for name in counts) / sum(counts.values())))


@dataclass(frozen=True)
class Diagnosis:
    """A finished diagnosis with the evidence of all stages: `fits` are the candidates tried, best first; `chosen` the effects added."""

    trials: tuple[Trial, ...]
    detection: Detection
    places: tuple[PlaceResult, ...]
    passed: tuple[PlaceResult, ...]
    fits: tuple[Fit, ...]
    chosen: tuple[Fit, ...]
    verdict: Verdict
    stopped: bool = False


def split_runs(trials: Sequence[Trial]) -> tuple[list[Trial], list[Trial]]:
    """Return training runs and untouched ones: of three runs or more, every second one between the gentlest and the roughest."""
    ordered = sorted(trials, key=_kind)
    held = ordered[1:-1:2]
    return [trial for trial in ordered if trial not in held], held


def _kind(trial: Trial) -> tuple[float, ...]:
    """Return what a run is like, whatever it is called: its humps' height, its speed, what was measured."""
    heights = [entry.hump.height or 0.0 for entry in trial.run.file.road if entry.hump is not None]
    return (max(heights, default=0.0), trial.scenario.top_speed, float(np.sum(trial.measurement.values**2)))


def detect(trials: Sequence[Trial]) -> Detection:
    """Stage 1: find the noise floor, recalibrate the base model on the training runs, and measure the gap."""
    training, held_out = split_runs(trials)
    floor = find_noise_floor(trials, BAND)
    problem = narrow(make_problem(training))
    return Detection(problem, tuple(held_out), floor, fit_base(problem, held_out, floor.noises, BAND))


def localise(detection: Detection) -> tuple[list[PlaceResult], list[PlaceResult]]:
    """Stage 2: test every place; returns all results, best first, and the smallest hypotheses that reach the floor."""
    misfit = detection.base.polished.misfit
    results = test_places(misfit, detection.base.polished.x, list_places(misfit))
    results.sort(key=lambda item: (item.chi, item.unknowns))
    nowhere = next(item for item in results if item.place.kind == "none")
    excess = max(nowhere.chi**2 - 1, 0.0)
    reached = [
        item
        for item in results
        if item.place.kind != "none" and (item.chi <= limit.PLACE_PASSES or item.chi**2 - 1 <= limit.PLACE_SHARE * excess)
    ]
    fewest = min((item.unknowns for item in reached), default=0)
    return results, [item for item in reached if item.unknowns == fewest]


def shortlist(candidates: Sequence[Candidate], places: Sequence[PlaceResult], passed: Sequence[PlaceResult]) -> list[Candidate]:
    """Return the candidates worth fitting: those that live at the places left, and those that no single force explains.

    A sensor's effects are tried where leaving out the sensor or one of its channels helps; effects of the whole vehicle where one unknown
    force at one place does not suffice.
    """
    if not passed:
        return list(candidates)
    names = {_owner(item.place) for item in passed if item.place.rows}
    excess = max(max(item.chi for item in places) ** 2 - 1, 1e-9)
    silenced = {
        part
        for item in places
        if item.place.channels and (item.chi <= limit.PLACE_PASSES or item.chi**2 - 1 <= limit.PLACE_SHARE * excess)
        for part in (item.place.name, *item.place.channels)
    }
    single = bool(names) and passed[0].unknowns == 1
    found = []
    for candidate in candidates:
        if candidate.effect.attaches == "sensor":
            wanted = candidate.place in silenced or any(part.rpartition("_")[0] == candidate.place for part in silenced)
        elif candidate.place == ALL_TYRES:
            wanted = not single or any(item.place.kind == "tyre" for item in passed)
        elif candidate.effect.name in GLOBAL and candidate.place not in names:
            wanted = not single
        else:
            wanted = any(part in names for part in candidate.place.split("+"))
        if wanted:
            found.append(candidate)
    return found


def _owner(place: Place) -> str:
    return place.name.partition(" (")[0]


def name(
    detection: Detection,
    passed: Sequence[PlaceResult],
    candidates: Sequence[Candidate],
    tell: Progress | None = None,
) -> list[Fit]:
    """Stage 3: fit every candidate together with the base parameters, to equal effort; returns the fits, best first."""
    trial = detection.problem.trials[0]
    surveyor = Surveyor(trial.run.vehicle, dict(trial.values))
    simulators: dict[object, Simulator] = {}
    misfit = detection.base.polished.misfit
    space = detection.problem.space
    nominal = space.unit(space.start), np.zeros(len(misfit.problem.trials) * len(NUISANCES.names))
    single = passed and passed[0].place.rows and passed[0].unknowns == 1
    unit, errors = misfit.split(passed[0].x) if single else nominal
    fits: list[Fit] = []
    for done, candidate in enumerate(candidates, start=1):
        fit = fit_candidate(
            candidate,
            detection.problem,
            detection.held_out,
            detection.floor.noises,
            BAND,
            surveyor,
            np.clip(nominal[0] if candidate.effect.attaches == "run" else unit, 0.01, 0.99),
            (nominal[1] if candidate.effect.attaches == "run" else errors).ravel(),
            simulators,
            detection.base.train,
        )
        fits.append(fit)
        if tell is not None:
            best = min(fits, key=_merit)
            tell("name", done, len(candidates), f"{best.label}, chi {np.sqrt(best.train):.3f}")
    return sorted(fits, key=_merit)


def _merit(fit: Fit) -> float:
    """Return what ranks fits: -2 ln of the likelihood on the training runs, with the price of their own parameters (BIC)."""
    assert fit.candidate is not None
    training = [trial.name for trial in fit.polished.misfit.problem.trials]
    total = sum(fit.counts[item] for item in training)
    own = len(fit.candidate.parameters) + len(fit.candidate.shared)
    return fit.train * total + own * float(np.log(total))


def diagnose(
    trials: Sequence[Trial], effects: Sequence[Effect] | None = None, everything: bool = False, tell: Progress | None = None
) -> Diagnosis:
    """Find what a vehicle's model lacks.

    Parameters
    ----------
    trials
        Runs with recordings, of one vehicle. At least three are needed to name anything: one in three stays untouched by all fits.
    effects
        The library to try (default: all effects known).
    everything
        Try the whole library everywhere, whatever the place test says.
    tell
        Told of progress.

    Raises
    ------
    InputError
        For trials that do not belong together.
    """
    with threadpool_limits(1, user_api="blas"):
        return _diagnose(trials, effects, everything, tell)


def _diagnose(trials: Sequence[Trial], effects: Sequence[Effect] | None, everything: bool, tell: Progress | None) -> Diagnosis:
    say = tell or (lambda stage, done, total, best: None)
    trials = sorted(trials, key=_kind)  # whatever order they came in
    say("detect", 0, 1, "")
    detection = detect(trials)
    say("detect", 1, 1, f"chi {detection.chi:.3f}")
    ordered = (*detection.problem.trials, *detection.held_out)
    gap = Gap(detection.chi, detection.chi, 1.0, _runs(detection.base, detection.base, detection.held_out))

    def conclude(verdict: VerdictName, reason: str, next_experiment: str | None = None) -> Diagnosis:
        found = Verdict(verdict, reason, (), gap, next_experiment=next_experiment)
        return Diagnosis(ordered, detection, (), (), (), (), found)

    if max(detection.chi, float(np.sqrt(detection.base.train))) <= limit.NOISE_FLOOR:
        return conclude("no_missing_effect", f"the recalibrated model is at the noise floor: chi {detection.chi:.3f}")
    if not detection.held_out:
        return conclude(
            "insufficient_data",
            f"chi is {detection.chi:.2f}, but {len(trials)} run{'s' if len(trials) > 1 else ''} leave none untouched to check an effect on",
            next_experiment="record at least three runs, with two hump heights or speeds",
        )
    say("localise", 0, 1, "")
    places, passed = localise(detection)
    say("localise", 1, 1, passed[0].place.label if passed else "no single place")
    candidates = list_candidates(trials[0].run.vehicle, ordered, list(effects if effects is not None else library().values()))
    chosen = candidates if everything else shortlist(candidates, places, passed)
    if not chosen:
        raise InputError("no effect of the library can live on this vehicle")
    fits = name(detection, passed, chosen, tell)
    return _judge(detection, ordered, places, passed, fits, len(candidates), gap)


def _judge(
    detection: Detection,
    ordered: tuple[Trial, ...],
    places: list[PlaceResult],
    passed: list[PlaceResult],
    fits: list[Fit],
    tried: int,
    gap: Gap,
) -> Diagnosis:
    """Stages 4 and 5: whether the best effect is good enough on untouched runs, alone in that, and significant."""
    base, best = detection.base, fits[0]
    assert best.candidate is not None
    before = max(base.train - 1, 1e-9), max(base.held_out - 1, 1e-9)
    after = max(best.train - 1, 0.0), max(best.held_out - 1, 0.0)
    p = min(1.0, tried * p_value(base, best, len(best.candidate.parameters) + len(best.candidate.shared)))
    labels = tuple((item.place.label, item.chi) for item in (passed or places)[:5])
    fitted = replace(gap, after=_chi(best), runs=_runs(base, best, detection.held_out))
    good = (
        np.isfinite(best.held_out)
        and (after[0] <= limit.LAW_PASSES * before[0] or np.sqrt(best.train) <= limit.LAW_CHI)
        and (after[1] <= limit.LAW_PASSES * before[1] or np.sqrt(max(best.held_out, 0.0)) <= limit.LAW_CHI)
    )
    ties = [item for item in fits[1:] if _tied(item, best, before[0])]

    def finish(verdict: Verdict, chosen: tuple[Fit, ...] = ()) -> Diagnosis:
        return Diagnosis(ordered, detection, tuple(places), tuple(passed), tuple(fits), chosen, verdict)

    if p > limit.SIGNIFICANT or (detection.chi <= limit.WEAK and not good):
        return finish(
            Verdict(
                "too_weak",
                f"chi is {detection.chi:.3f}, but no effect is told from chance (p {p:.2g})",
                (),
                gap,
                labels,
                next_experiment="a higher hump or a higher speed makes the effect larger",
            )
        )
    if not good:
        where = sentence([label for label, _ in labels[:3]]) if passed else "no single place"
        left = f"chi {np.sqrt(best.train):.2f} ({np.sqrt(best.held_out):.2f} untouched)"
        reason = f"the best of {len(fits)} candidates, {best.label}, leaves {left}"
        return finish(Verdict("not_in_library", f"{reason}; the residual wants an unknown force at {where}", (), fitted, labels))
    effects = tuple(_named(item, base, fits, p) for item in (best, *ties[:2]))
    if ties:
        reason = f"{sentence([item.label for item in (best, *ties)])} explain the runs equally well"
        return finish(
            Verdict("ambiguous", reason, effects, fitted, labels, next_experiment=APART),
            (best,),
        )
    reason = f"{best.label} closes {100 * effects[0].held_out_gain:.1f} % of the excess on untouched runs"
    return finish(Verdict("named", reason, effects[:1], fitted, labels), (best,))


def _tied(item: Fit, best: Fit, before: float) -> bool:
    assert item.candidate is not None
    assert best.candidate is not None
    if item.candidate.effect.name == best.candidate.effect.name and ALL_TYRES in (item.candidate.place, best.candidate.place):
        return False  # all tyres hold the one axle that matters
    floor = limit.NOISE_FLOOR**2 - 1
    near = item.train - best.train <= max(0.02 * before, 0.5 * floor)
    return bool(near and item.train - 1 <= limit.TIE * max(best.train - 1, 0.25 * floor))


def _named(fit: Fit, base: Fit, fits: Sequence[Fit], p: float) -> NamedEffect:
    candidate = fit.candidate
    assert candidate is not None
    gain = 1 - max(fit.held_out - 1, 0.0) / max(base.held_out - 1, 1e-9)
    return NamedEffect(candidate.effect.name, candidate.place, estimate(fit), p, float(gain), gain_interval(base, fit))


def estimate(fit: Fit) -> dict[str, NamedParameter]:
    """Return the effect's own parameters with 90 % intervals from the Fisher information of the fit."""
    candidate = fit.candidate
    assert candidate is not None
    misfit, x = fit.polished.misfit, fit.polished.x
    jacobian = misfit.jacobian(x)
    information = jacobian.T @ jacobian
    n = misfit.n_parameters
    information[:n, :n] += np.diag(np.full(n, 1.0 / 36.0))
    covariance = np.linalg.pinv(information, hermitian=True) * max(fit.train, 1.0)
    slopes = misfit.problem.space.slopes(misfit.problem.space.values(misfit.split(x)[0]))
    found: dict[str, NamedParameter] = {}
    own = len(candidate.parameters)
    for i, parameter in enumerate(candidate.effect.parameters):
        if i < own:
            column = n - own + i
            value, scale = float(fit.polished.values[column]), float(slopes[column])
        elif candidate.shared:
            column = n
            value, scale = float(misfit.adjusted(x)[0]), candidate.shared[0].scale
        else:
            continue
        spread = 1.645 * abs(scale) * float(np.sqrt(max(covariance[column, column], 0.0)))
        found[parameter.name] = NamedParameter(value, (value - spread, value + spread), parameter.unit)
    return found


def gain_interval(base: Fit, fit: Fit, blocks: int = 200, seed: int = 7) -> tuple[float, float] | None:
    """Return the 90 % interval of the gain in mean square, by a bootstrap over runs and blocks of spectral lines."""
    pairs = []
    for one, two in zip(base.polished.misfit.white_lines(base.polished.x), fit.polished.misfit.white_lines(fit.polished.x), strict=True):
        gain = (np.abs(one) ** 2 - np.abs(two) ** 2).mean(axis=1)
        pairs += [part.mean() for part in np.array_split(gain, max(1, len(gain) // 10))]
    if len(pairs) < 4:
        return None
    random = np.random.Generator(np.random.PCG64(seed))
    means = [float(np.mean(random.choice(pairs, len(pairs)))) for _ in range(blocks)]
    low, high = np.percentile(means, [5, 95])
    return float(low), float(high)


def _chi(fit: Fit) -> float:
    return float(np.sqrt(sum(fit.runs[item] * fit.counts[item] for item in fit.counts) / sum(fit.counts.values())))


def _runs(base: Fit, fit: Fit, held_out: Sequence[Trial]) -> tuple[dict[str, object], ...]:
    later = {trial.name for trial in held_out}
    return tuple(
        {
            "run": item,
            "untouched": item in later,
            "before": float(np.sqrt(base.runs[item])),
            "after": float(np.sqrt(fit.runs.get(item, base.runs[item]))),
        }
        for item in base.runs
    )


__all__ = ["NUISANCES", "Detection", "Diagnosis", "detect", "diagnose", "localise", "name", "shortlist", "split_runs"]
