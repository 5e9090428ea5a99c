"""What a law would do, to first order, against simulations with the law switched on a little."""

import numpy as np
import pytest

from vehgen.diagnose.fits.candidate import build_problem, list_candidates
from vehgen.diagnose.fits.first_order import ProbeMotion
from vehgen.diagnose.fits.model_fit import NUISANCES, CurrentModel
from vehgen.effects import EffectLocator, library
from vehgen.fit.misfit import Misfit
from vehgen.fit.window import flatten
from vehgen.simulate import SimulatorPool


@pytest.fixture(scope="module")
def detection(detection_of):
    return detection_of()


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["cubic_stiffness", "quadratic_damping", "tyre_damping", "progressive_stiffness"])
def test_a_weak_law_moves_the_residuals_as_a_simulation_with_it_does(detection, name):
    problem, moved, simulated = _both(detection, name, 0.02)
    assert problem.trials[0].simulator.model.elements != detection.problem.trials[0].simulator.model.elements
    assert moved @ simulated > 0.99 * np.linalg.norm(moved) * np.linalg.norm(simulated)
    assert np.linalg.norm(moved) == pytest.approx(np.linalg.norm(simulated), rel=0.05)


@pytest.mark.parametrize("name", ["dry_friction", "hysteresis", "frame_bending"])
def test_what_is_no_force_of_travel_and_rate_is_left_to_a_simulation(detection, name):
    assert _both(detection, name, 1.0)[1] is None


def _both(detection, name, share):
    """Return the problem of an effect, and how it moves the residuals at a share of its first start: to first order, simulated."""
    base = detection.base.least_squares
    footing, trial = CurrentModel.of(detection.base), detection.problem.trials[0]
    candidates = list_candidates(trial.run.vehicle, detection.trials, [library()[name]])
    problem = build_problem(candidates[0], footing.problem, EffectLocator(trial.run.vehicle, dict(trial.values)), SimulatorPool())
    values = problem.space.start.copy()
    values[: len(footing.unit)] = base.values
    values[len(footing.unit)] *= share
    unit = np.clip(problem.space.unit(values), 0.0, 1.0)
    moved = ProbeMotion(base.misfit, base.x).moved(problem, problem.space.values(unit))
    posed = Misfit(problem, base.misfit.noises, problem.space.start, NUISANCES, base.misfit.band)
    after = posed.whitened_spectrum(np.concatenate([unit, footing.errors]))
    lines = zip(after, base.misfit.whitened_spectrum(base.x), strict=True)
    return problem, moved, np.concatenate([flatten(new - old) for new, old in lines])
