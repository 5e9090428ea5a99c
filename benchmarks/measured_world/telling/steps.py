"""At which step does the diagnosis lose an effect that the recordings tell? Its own steps, gone on with where it would have ended."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from threadpoolctl import threadpool_limits

from benchmarks.measured_world.solve import imported, vehicle_file, workplace
from benchmarks.measured_world.telling.true_law import true_candidate
from vehgen.diagnose import thresholds as limit
from vehgen.diagnose.detect.detection import Detection, detect
from vehgen.diagnose.detect.odd_run import disagreement
from vehgen.diagnose.detect.splitting import kind_of_run
from vehgen.diagnose.fits.candidate import Candidate, list_candidates
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.select.criteria import p_value_of, passes, tied
from vehgen.diagnose.select.placebo_laws import compare_with_placebo_laws
from vehgen.diagnose.select.ranking import SearchRound, merit
from vehgen.diagnose.select.search import search_round
from vehgen.diagnose.select.validation import gain_interval, seen_again
from vehgen.effects import library
from vehgen.fit.trial import load_trials
from vehgen.vehicle import as_vehicle

Data = dict[str, Any]


def steps_of_case(root: Path, name: str, hidden: Data) -> Data:
    """Return what every step of the diagnosis makes of a case with an effect, also beyond the step at which it ends."""
    with workplace(root / "cases" / name) as folder, threadpool_limits(1, user_api="blas"):
        trials = load_trials(imported(folder)[0], as_vehicle(vehicle_file(folder)))
        detection = detect(sorted(trials, key=kind_of_run))
        candidates = list_candidates(trials[0].run.vehicle, detection.trials, list(library().values()), detection.floor.noises)
        return steps(detection, candidates, hidden)


def steps(detection: Detection, candidates: Sequence[Candidate], hidden: Data) -> Data:
    """Return the outcome of each step, and of the first round's fits: the true law's and the best one's."""
    base, true = detection.base, true_candidate(hidden, candidates)
    odd = disagreement(detection)
    found = search_round(detection, base, candidates)
    own = next((fit for fit in found.fits if (fit.last.effect.name, fit.last.place) == (true.effect.name, true.place)), None)
    order = [fit.last.label for fit in found.fits]
    return {
        "quiet": detection.is_quiet,
        "chi": detection.chi,
        "nothing_missing": detection.nothing_missing,
        "odd_run": None if odd is None else type(odd).__name__,
        "passed_places": [item.place.label for item in found.passed[:5]],
        "fitted": len(found.fits),
        "rank": order.index(true.label) + 1 if own is not None else None,
        "true": None if own is None else judged_fit(detection, found, own, len(candidates)),
        "best": judged_fit(detection, found, found.fits[0], len(candidates)) if found.fits else None,
        "idle": [fit.last.place for fit in found.idle],
        "first": order[:5],
    }


def judged_fit(detection: Detection, found: SearchRound, fit: ModelFit, tried: int) -> Data:
    """Return what the diagnosis's criteria say of one fit."""
    base = detection.base
    good, p = passes(fit, base), p_value_of(found, fit, tried)
    runs = [trial.name for trial in detection.validation_runs]
    interval = gain_interval(base, fit, runs)
    rivals = compare_with_placebo_laws(found, fit)
    weak = [
        name
        for name, fails in (
            ("passes", not good),
            ("chance", p > limit.SIGNIFICANT),
            ("validation", not seen_again(base, fit, runs)),
            ("placebo laws", rivals is not None and rivals[1] >= rivals[0] - limit.DECOY),
        )
        if fails
    ]
    return {
        "law": fit.last.label,
        "gain": base.squares - merit(fit),
        "training": fit.training,
        "validation": fit.validation,
        "p": p,
        "gain_interval": interval,
        "rivals": rivals,
        "tied": [item.last.label for item in tied(found, fit)][:6],
        "fails": weak,
    }
