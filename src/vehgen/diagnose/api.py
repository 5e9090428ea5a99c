"""A diagnosis in one call: vehicle and runs in, what the model lacks out."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence

from vehgen.diagnose.pipeline import diagnose_trials
from vehgen.diagnose.result import Diagnosis
from vehgen.diagnose.select.search import DiagnosisProgress
from vehgen.effects import Effect, effects_named
from vehgen.errors import ArgumentError
from vehgen.fit.parallel import can_be_sent, runner_at
from vehgen.fit.trial import TrialLike, load_trials
from vehgen.vehicle import VehicleLike, as_vehicle


def diagnose(
    vehicle: VehicleLike,
    runs: TrialLike | Sequence[TrialLike],
    *,
    effects: Sequence[str | Effect] | None = None,
    library: Iterable[str | os.PathLike[str]] | str | os.PathLike[str] = (),
    everywhere: bool = False,
    band: tuple[float, float] | None = None,
    workers: int = 1,
    scheduler: str | None = None,
    progress: DiagnosisProgress | None = None,
) -> Diagnosis:
    """Find what a vehicle's model lacks.

    Parameters
    ----------
    vehicle
        Whose `range`s say what may be refitted: itself, its file, or the name of a bundled model.
    runs
        Runs with recordings: their files, runs, or trials. At least three are needed to name anything: one in three is kept from
        all fits, for validation.
    effects
        Those to try, by name or themselves (default: the whole library).
    library
        Files of effects of your own.
    everywhere
        Try every effect at every place, whatever the place test says.
    band
        Frequencies compared [Hz] (default: what the run files ask for).
    workers
        So many processes of this machine test places and fit candidates, where that takes long. More than one needs
        `if __name__ == "__main__":` around a script's work. Effects of your own that are made of lambdas cannot be sent to other processes:
        all is done by this one then.
    scheduler
        Address of a Dask cluster that does so in their place.
    progress
        Called with the stage, what is done, how many of how many, and the best so far.

    Returns
    -------
    The diagnosis. After Ctrl-C what was found until then; only during the first stage Ctrl-C is passed on.

    Raises
    ------
    InputError
        For arguments and files that cannot be used, and runs that do not belong together.
    """
    if band is not None and (len(band) != 2 or not 0 <= band[0] < band[1]):
        raise ArgumentError(f"`band`: two frequencies in Hz were expected, the lower first; found {tuple(band)}", "band")
    chosen = effects_named(effects, library)
    trials = load_trials(runs, as_vehicle(vehicle))
    with runner_at(scheduler, workers if workers > 1 and can_be_sent(chosen) else 1) as runner:
        return diagnose_trials(trials, chosen, everywhere, progress, band, runner)
