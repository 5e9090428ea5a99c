"""Collect the evidence of a diagnosis from its fitted models: estimates, residuals, the force where the model errs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from vehgen import __version__
from vehgen.diagnose.curves import residual_curves, response_curves
from vehgen.diagnose.detect.detection import Detection, band_gaps, run_gaps
from vehgen.diagnose.detect.harmonics import distortions
from vehgen.diagnose.evidence import (
    BandChi,
    BaseParameter,
    ChannelNoise,
    Evidence,
    FittedCandidate,
    ForceEvidence,
    LawCurve,
    Origin,
    PlaceEvidence,
    RoundEvidence,
    RunAsks,
    RunConditions,
    RunSize,
    StepChi,
)
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.localise.free_form import Curve, FreeForm, fit_free_form, recover, strongest
from vehgen.diagnose.localise.recovered_force import RecoveredForce
from vehgen.diagnose.localise.unknown_force import PlaceResult
from vehgen.diagnose.result import DiagnosisModels
from vehgen.diagnose.select.estimates import estimate, estimates_by_run
from vehgen.diagnose.select.ranking import SearchRound
from vehgen.diagnose.verdict import RunChi
from vehgen.files.provenance import file_hashes, versions
from vehgen.files.result_fields import Array1D, rounded
from vehgen.files.units import NONE
from vehgen.fit.trial import Trial
from vehgen.simulate.run_file.files_read import files_read
from vehgen.vehicle.writing import plain_data

MAX_KEPT_CANDIDATES = 12
"""So many candidates of a look are kept at most."""
MAX_ROUND_PLACES = 4
"""So many places that suffice are kept of a look."""


def collect(models: DiagnosisModels, quick: bool = False) -> Evidence:
    """Return the evidence behind a verdict.

    Parameters
    ----------
    models
        The fitted models.
    quick
        Leave out what takes long: estimates of the candidates, single runs, and the recovered force.
    """
    detection = models.detection
    vehicle = detection.trials[0].run.vehicle
    first = models.rounds[0] if models.rounds else None
    psds, histories = residual_curves(models)
    return Evidence(
        vehicle=vehicle.title or vehicle.name,
        made_by=__version__,
        band=detection.band,
        noise=tuple(_noise(detection)),
        noise_slope=max(float(noise.slope) for noise in detection.floor.noises.values()),
        corrected=tuple(detection.floor.corrected),
        runs=tuple(RunSize(gap.run, float(gap.height), float(gap.speed), gap.share) for gap in run_gaps(detection)),
        bands=tuple(_bands(models)),
        distortions=tuple(distortions(detection)),
        places=tuple(_place(item, first.passed) for item in first.places) if first else (),
        rounds=tuple(_round(item, quick) for item in models.rounds),
        alone=() if quick else tuple(_alone(models)),
        meanings={fit.last.effect.name: fit.last.effect.meaning for item in models.rounds for fit in item.fits},
        steps=tuple(_steps(models)),
        psds=psds,
        histories=histories,
        parameters=tuple(_parameters(models)),
        conditions=tuple(_conditions(models.last)),
        force=None if quick else _force(models),
        responses=response_curves(models),
        origin=origin_of((*detection.trials, *models.left_out), models.libraries),
    )


def origin_of(trials: Sequence[Trial], libraries: Sequence[str] = ()) -> Origin:
    """Return the origin of a diagnosis of these runs, with files of own effects, without the command that asked for it."""
    vehicle = trials[0].run.vehicle
    return Origin(
        command="",
        made_on=datetime.now(UTC).isoformat(sep=" ", timespec="seconds"),
        inputs=file_hashes(files_read([trial.run for trial in trials], also=[Path(name) for name in libraries])),
        versions=versions(),
        vehicle=plain_data(vehicle),
        values=vehicle.values(),
    )


def run_chis(base: ModelFit, fit: ModelFit, validation_runs: Sequence[str]) -> tuple[RunChi, ...]:
    """Return every run's chi before, with the base model, and after, with a fit that adds effects to it."""
    return tuple(
        RunChi(
            run,
            run in validation_runs,
            float(np.sqrt(square)),
            float(np.sqrt(fit.mean_squares.get(run, square))),
        )
        for run, square in base.mean_squares.items()
    )


def _noise(detection: Detection) -> Iterator[ChannelNoise]:
    found: dict[str, tuple[str, list[float]]] = {}
    for trial in detection.trials:
        for channel, sigma in zip(trial.recording.channels, detection.floor.noises[trial.name].sigma, strict=True):
            found.setdefault(channel.name, (channel.quantity, []))[1].append(float(sigma))
    for name, (quantity, values) in found.items():
        yield ChannelNoise(name, quantity, min(values), max(values))


def _parameters(models: DiagnosisModels) -> Iterator[BaseParameter]:
    base, last = models.detection.base.least_squares, models.last.least_squares
    dimensions = models.detection.trials[0].run.vehicle.dimensions
    space = base.misfit.problem.space
    final = last.misfit.problem.best_values(last.values)
    for name, filed, value in zip(space.names, space.start, base.values, strict=True):
        unit = "" if dimensions[name] == NONE else str(dimensions[name])
        yield BaseParameter(name, unit, float(filed), float(value), name in base.on_bound, float(final[name]), name in last.on_bound)


def _conditions(fit: ModelFit) -> Iterator[RunConditions]:
    for part in fit.parts:
        for trial in part.misfit.problem.trials:
            known = {item.name: item.value for item in part.conditions() if item.run == trial.name and item.name != "wander"}
            yield RunConditions(trial.name, *(known.get(name, 0.0) for name in ("delay", "speed", "height")))


def _bands(models: DiagnosisModels) -> Iterator[BandChi]:
    detection = models.detection
    wanted = {trial.name for trial in (detection.validation_runs or detection.trials)}
    after = {(item.run, item.channel, item.band): item.chi for item in band_gaps(detection, models.last)}
    pooled: dict[tuple[str, tuple[float, float]], list[tuple[float, float]]] = {}
    for item in band_gaps(detection):
        if item.run in wanted:
            pair = item.chi, after.get((item.run, item.channel, item.band), item.chi)
            pooled.setdefault((item.channel, item.band), []).append(pair)
    for (channel, band), pairs in pooled.items():
        before, later = np.sqrt(np.mean(np.square(pairs), axis=0))
        yield BandChi(channel, (float(band[0]), float(band[1])), float(before), float(later))


def _place(item: PlaceResult, passed: tuple[PlaceResult, ...]) -> PlaceEvidence:
    passes = item.place.label in {other.place.label for other in passed}
    return PlaceEvidence(item.place.label, item.chi, item.unknowns, bool(item.place.rows), passes)


def _round(item: SearchRound, quick: bool) -> RoundEvidence:
    candidates = [
        FittedCandidate(fit.last.label, float(np.sqrt(fit.training)), float(np.sqrt(fit.validation)), {} if quick else estimate(fit))
        for fit in item.fits[:MAX_KEPT_CANDIDATES]
    ]
    places = tuple(_place(place, item.passed) for place in item.passed[:MAX_ROUND_PLACES])
    return RoundEvidence(item.current.label, item.current.chi, places, len(item.fits), tuple(candidates))


def _alone(models: DiagnosisModels) -> Iterator[RunAsks]:
    for candidate in models.last.effects:
        for item in estimates_by_run(models.last, candidate):
            yield RunAsks(candidate.label, item.parameter, item.run, item.value, item.half_width)


def _steps(models: DiagnosisModels) -> Iterator[StepChi]:
    detection, base = models.detection, models.detection.base
    steps = [("as filed", *detection.as_filed), ("recalibrated", base.training, base.validation)]
    steps += [(f"+ {fit.last.effect.name}\nat {fit.last.place}", fit.training, fit.validation) for fit in models.chosen]
    for label, training, validation in steps:
        yield StepChi(label, float(np.sqrt(training)), float(np.sqrt(validation)))


def _force(models: DiagnosisModels) -> ForceEvidence | None:
    law = models.law
    if law is None and models.rounds:
        shown = strongest(models.rounds[0].passed)
        law = None if shown is None else fit_free_form(recover(models.detection, shown))
    return None if law is None else force_evidence(law)


def force_evidence(law: FreeForm, run: str | None = None) -> ForceEvidence:
    """Return a recovered force and the free-form law fitted to it, as a figure shows them.

    Parameters
    ----------
    law
        The fitted law.
    run
        Which run to show (default: the training run with the largest force).

    Raises
    ------
    KeyError
        For a run that is not the law's.
    """
    shown = _shown_run(law.runs, run)
    f, g, both = law.histories[shown.run]
    rest = shown.force - both
    return ForceEvidence(
        place=shown.place.label,
        kind=shown.place.kind,
        run=shown.run,
        angular=shown.angular,
        units=shown.units,
        description=law.describe(),
        travel=_law_curve(law.travel, shown.travel, f + rest),
        rate=_law_curve(law.rate, shown.rate, g + rest),
        time=rounded(shown.time, 7),
        force=rounded(shown.force),
        deviation=rounded(shown.deviation),
        law=rounded(both),
    )


def _law_curve(curve: Curve, motion: Array1D, dots: Array1D) -> LawCurve:
    return LawCurve(*(rounded(values) for values in (curve.x, curve.force, curve.low, curve.high, motion, dots)))


def _shown_run(runs: tuple[RecoveredForce, ...], name: str | None) -> RecoveredForce:
    if name is not None:
        return {item.run: item for item in runs}[name]
    return max((item for item in runs if not item.validation), key=lambda item: float(np.abs(item.force).max()))
