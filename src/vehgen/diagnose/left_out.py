"""Runs whose recordings show a mistake by themselves: left out where enough others tell what the vehicle lacks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from vehgen.diagnose.inputs.checks import check_inputs
from vehgen.diagnose.inputs.fault import MeasurementFault
from vehgen.diagnose.phrases import join_names
from vehgen.diagnose.result import Decided
from vehgen.diagnose.verdict import VerdictName
from vehgen.diagnose.wording import mistaken
from vehgen.fit.trial import Trial

FEWEST_RUNS = 3
"""So many runs must be left: with fewer nothing could be named."""
BESIDE_A_MISTAKE: tuple[VerdictName, ...] = ("named", "several_effects", "ambiguous", "not_in_library")
"""Verdicts on the other runs that stand beside a mistake; by any other one the mistake is what is to be told, but where nothing was decided
as the diagnosis was stopped."""


@dataclass(frozen=True)
class LeftOut:
    """Runs that are left out, and the mistakes for which they are."""

    trials: tuple[Trial, ...] = ()
    faults: tuple[MeasurementFault, ...] = ()

    def told_beside(self, found: Decided) -> Decided:
        """Return a verdict on the other runs with the mistakes told."""
        if not self.trials:
            return found
        verdict, messages = found.verdict, [item.message for item in self.faults]
        runs = join_names([trial.name for trial in self.trials], "and")
        told = replace(verdict, faults=(*self.faults, *verdict.faults))
        if verdict.verdict in BESIDE_A_MISTAKE or found.stopped:
            told = replace(told, notes=(*verdict.notes, f"{runs} left out: {'; '.join(messages)}"))
        else:
            notes = (*verdict.notes, f"without {runs}: {verdict.reason}")
            reason = mistaken([item.message for item in told.faults])
            told = replace(told, verdict="measurement_fault", reason=reason, notes=notes, next_experiment=None)
        return replace(found, verdict=told, models=replace(found.models, left_out=self.trials))


def leave_out(trials: Sequence[Trial]) -> tuple[list[Trial], LeftOut]:
    """Return the runs to be diagnosed, and those whose recordings are clipped, stuck or drift; all of them where too few would be left."""
    faults = check_inputs(trials)
    spoilt = {run for item in faults for run in item.runs}
    rest = [trial for trial in trials if trial.name not in spoilt]
    if not spoilt or len(rest) < FEWEST_RUNS:
        return list(trials), LeftOut()
    return rest, LeftOut(tuple(trial for trial in trials if trial.name in spoilt), faults)
