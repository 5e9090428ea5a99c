"""What a diagnosis adds: a small vehicle file that extends the base, or what a run file must say."""

from __future__ import annotations

import io
from pathlib import Path

from ruamel.yaml import YAML

from vehgen.diagnose.fitting import Fit
from vehgen.diagnose.verdict import Verdict
from vehgen.effects import Surveyor
from vehgen.identify.problem import Problem
from vehgen.vehicle.writing import base_reference, quantity


def effect_file(fit: Fit, base: Problem, verdict: Verdict, folder: Path, name: str) -> str:
    """Return the text of a vehicle file that extends the base vehicle with its refitted parameters and the effect.

    The evidence stands in comments. An effect of runs or sensors changes no vehicle: its number is told in a comment.
    """
    candidate = fit.candidate
    assert candidate is not None
    trial = base.trials[0]
    vehicle = trial.run.vehicle
    values = fit.polished.misfit.problem.best_values(fit.polished.values)
    parameters = {key: {"value": quantity(vehicle, key, value)} for key, value in values.items() if key in vehicle.parameters}
    data: dict[str, object] = {
        "extends": base_reference(vehicle, folder),
        "name": name,
        "title": f"{vehicle.title or vehicle.name}, with {candidate.label}",
    }
    comments = [f"{verdict.verdict}: {verdict.reason}"]
    if candidate.effect.edit is not None:
        site = Surveyor(vehicle, dict(trial.values)).site(candidate.place)
        own = {parameter.name: values[symbol] for parameter, symbol in zip(candidate.effect.parameters, candidate.parameters, strict=True)}
        change = candidate.effect.change(site, own)
        data["parameters"] = {**parameters, **change.pop("parameters")}
        data |= change
    else:
        data["parameters"] = parameters
        numbers = [*fit.polished.misfit.adjusted(fit.polished.x), *(values[key] for key in candidate.parameters)]
        told = ", ".join(
            f"{item.name} = {value:.5g} {item.unit}".strip() for item, value in zip(candidate.effect.parameters, numbers, strict=False)
        )
        comments.append(f"{candidate.label} is an effect of the runs, to be corrected there: {told}")
    for effect in verdict.effects:
        for key, item in effect.parameters.items():
            interval = "" if item.interval is None else f", 90 % interval {item.interval[0]:.5g} to {item.interval[1]:.5g}"
            comments.append(f"{effect.name} at {effect.place}: {key} = {item.value:.5g} {item.unit}{interval}")
    stream = io.StringIO()
    writer = YAML()
    writer.default_flow_style = None
    writer.width = 120
    writer.dump(data, stream)
    return "".join(f"# {' '.join(line.split())}\n" for line in comments) + stream.getvalue()
