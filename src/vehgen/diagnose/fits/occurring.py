"""Which forces and travels occur at the springs of a rig: they set the scale of what may be missing there."""

from __future__ import annotations

import numpy as np

from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.effects.locator import Occurring
from vehgen.mechanics import ElementOutput
from vehgen.simulate import Simulator


def occurring(fit: ModelFit) -> dict[str, Occurring]:
    """Return the largest force and travel of every suspension and link in a fit's runs without a road, by name.

    A force that is measured beside them counts, too: what passes through a link that only damps is known by what pushes. Where axles carry
    weight, this is the scale of forces, and those that occur count nothing.
    """
    misfit, x = fit.least_squares.misfit, fit.least_squares.x
    vehicle = misfit.problem.trials[0].run.vehicle
    weighs = bool(vehicle.gravity and vehicle.axles)
    outputs = [ElementOutput(f"{name} force", name, "link_force") for name in vehicle.links]
    outputs += [ElementOutput(f"{name} travel", name, "link_travel") for name in vehicle.links]
    outputs += [ElementOutput(f"{name} force", name, "suspension_force") for name, axle in vehicle.axles.items() if axle.suspension]
    outputs += [ElementOutput(f"{name} travel", name, "suspension_travel") for name, axle in vehicle.axles.items() if axle.suspension]
    found: dict[str, Occurring] = {}
    for t, trial in enumerate(misfit.problem.trials):
        if weighs and trial.scenario.track.parts:
            continue
        simulator = Simulator(trial.run.vehicle, outputs, trial.run.forces())
        every = misfit.problem.values_of(fit.least_squares.values, trial)
        values = {name: every[name] for name in simulator.model.parameters if name in every}
        scenario = misfit.scenario(x, t)
        peaks = np.abs(simulator.run(simulator.parameters(values), scenario).responses[0]).max(axis=0)
        largest = dict(zip((output.name for output in outputs), peaks.tolist(), strict=True))
        pushed = max((float(np.abs(item.at(scenario.time)).max()) for item in scenario.forces), default=0.0)
        for name in dict.fromkeys(output.owner for output in outputs):
            before = found.get(name, Occurring(0.0, 0.0))
            force = 0.0 if weighs else max(before.force, largest[f"{name} force"], pushed)
            found[name] = Occurring(force, max(before.travel, largest[f"{name} travel"]))
    return found
