"""What a diagnosis adds: a small vehicle file that extends the base, or what a run file must say."""

from __future__ import annotations

from glob import escape
from pathlib import Path
from typing import Any

from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.fits.occurring import occurring
from vehgen.diagnose.select.estimates import estimate
from vehgen.diagnose.verdict import Verdict
from vehgen.effects import EffectLocator
from vehgen.effects.base import merge
from vehgen.effects.kinds import ShakingEffect
from vehgen.files.names import MAX_TEXT, joined_name
from vehgen.files.yaml_writer import yaml_document
from vehgen.fit.problem import Problem
from vehgen.vehicle.writing import base_reference, quantity


def effect_file(fit: ModelFit, base: Problem, verdict: Verdict, folder: Path, name: str, extends: str | None = None) -> str:
    """Return the text of a vehicle file that extends the base vehicle with its refitted parameters and the effects of a fit.

    The evidence stands in comments. An effect of runs or sensors changes no vehicle: its numbers are told in a comment. `extends` is what
    the file calls the base vehicle (default: as it is found from the folder on this machine).
    """
    trial = base.trials[0]
    vehicle = extended = trial.run.vehicle
    values = fit.least_squares.misfit.problem.best_values(fit.least_squares.values)
    data: dict[str, Any] = {
        "extends": extends or base_reference(vehicle, folder),
        "name": name,
        "title": f"{vehicle.title or vehicle.name}, with {fit.label}"[:MAX_TEXT],
        "parameters": {key: {"value": quantity(vehicle, key, value)} for key, value in values.items() if key in vehicle.parameters},
    }
    comments = [verdict.reason]
    for candidate in fit.effects:
        if not candidate.effect.changes_vehicle:
            told = ", ".join(f"{key} = {item.value:.5g} {item.unit}".strip() for key, item in estimate(fit, candidate).items())
            shakes = "shakes the vehicle, which no vehicle file says: put it right there"
            kind = shakes if isinstance(candidate.effect, ShakingEffect) else "is an effect of the runs, to be corrected there"
            comments.append(f"{candidate.label} {kind}: {told}")
            continue
        site = EffectLocator(extended, dict(trial.values), occurring(fit)).site(candidate.place)
        own = {parameter.name: values[symbol] for parameter, symbol in zip(candidate.effect.parameters, candidate.parameters, strict=True)}
        change = candidate.effect.change(site, own)
        merge(data, change)
        extended = extended.with_changes(change)
    for effect in verdict.effects:
        for key, item in effect.parameters.items():
            interval = "" if item.interval is None else f", 90 % interval {item.interval[0]:.5g} to {item.interval[1]:.5g}"
            comments.append(f"{effect.name} at {effect.place}: {key} = {item.value:.5g} {item.unit}{interval}")
    return yaml_document(data, comments)


def file_name(vehicle: str, fit: ModelFit) -> str:
    """Return what a vehicle with the effects of a fit is called, cut to the length of a name."""
    return joined_name(vehicle, "with", "_and_".join(dict.fromkeys(item.effect.name for item in fit.effects)))


def files_named_so(vehicle: str, folder: Path) -> list[Path]:
    """Return the files in a folder that a diagnosis may have to replace: those named as :func:`file_name` does, whatever the effects."""
    return sorted(folder.glob(f"{escape(vehicle)}_with_*.yaml")) if folder.is_dir() else []
