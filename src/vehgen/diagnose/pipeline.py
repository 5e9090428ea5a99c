"""The diagnosis in five stages: detect, localise, name, add, verify. Each can be used by itself; each leaves its evidence."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from vehgen.diagnose.collecting import collect
from vehgen.diagnose.decision import Decision
from vehgen.diagnose.detect.detection import Detection, detect
from vehgen.diagnose.detect.splitting import kind_of_run, split_runs
from vehgen.diagnose.left_out import leave_out
from vehgen.diagnose.localise.localisation import localise, shortlist
from vehgen.diagnose.result import Decided, Diagnosis
from vehgen.diagnose.select.search import DiagnosisProgress, search_round
from vehgen.effects import Effect, library
from vehgen.fit.parallel import HERE, Runner, one_blas_thread
from vehgen.fit.trial import Trial


def diagnose_trials(
    trials: Sequence[Trial],
    effects: Sequence[Effect] | None = None,
    everywhere: bool = False,
    progress: DiagnosisProgress | None = None,
    band: tuple[float, float] | None = None,
    runner: Runner = HERE,
) -> Diagnosis:
    """Find what a vehicle's model lacks.

    Parameters
    ----------
    trials
        Runs with recordings, of one vehicle. At least three are needed to name anything: one in three is kept for validation. Runs with
        a recording that is clipped, stuck or drifts are left out where three others remain.
    effects
        The library to try (default: all effects known).
    everywhere
        Try the whole library everywhere, whatever the place test says.
    progress
        Told of progress.
    band
        Frequencies compared [Hz] (default: what the run files ask for).
    runner
        Where places are tested and candidates are fitted (default: here, one after the other).

    Returns
    -------
    The diagnosis. After Ctrl-C what was found until then; only during the first stage Ctrl-C is passed on.

    Raises
    ------
    InputError
        For trials that do not belong together.
    """
    with one_blas_thread():
        say = progress or (lambda stage, done, total, best: None)
        say("detect", 0, 1, "")
        usable, left_out = leave_out(sorted(trials, key=kind_of_run))  # whatever order they came in
        detection = detect(usable, band)
        say("detect", 1, 1, f"chi {detection.chi:.3f}")
        found = Decision(detection, list(effects if effects is not None else library().values()), everywhere, say, runner).decide()
        return with_evidence(left_out.told_beside(found), say)


def with_evidence(found: Decided, progress: DiagnosisProgress) -> Diagnosis:
    """Return the diagnosis with its evidence, and a note where sensors had recorders of their own; Ctrl-C leaves out what takes long."""
    recorder, verdict = found.models.detection.recorder, found.verdict
    if recorder is not None and recorder.apart:
        verdict = replace(verdict, notes=(*verdict.notes, recorder.describe()))
    try:
        progress("evidence", 0, 1, "")
        evidence, stopped = collect(found.models), found.stopped
        progress("evidence", 1, 1, "")
    except KeyboardInterrupt:
        evidence, stopped = collect(found.models, quick=True), True
    return Diagnosis(verdict, stopped, evidence, found.models)


__all__ = ["Detection", "Diagnosis", "detect", "diagnose_trials", "localise", "search_round", "shortlist", "split_runs"]
