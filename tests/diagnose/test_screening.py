"""Which candidates the first order says are worth fitting."""

import numpy as np
import pytest
from benchmarks.hidden_effects.generator import Effect

from vehgen.diagnose.fits import screening
from vehgen.diagnose.fits.candidate import list_candidates
from vehgen.diagnose.fits.model_fit import CurrentModel
from vehgen.effects import EFFECTS, EffectLocator
from vehgen.simulate import SimulatorPool

LAWS = [EFFECTS[name] for name in ("dry_friction", "hysteresis", "bump_stop", "quadratic_damping", "cubic_stiffness", "asymmetric_damping")]


@pytest.mark.parametrize("force", [15.0, 150.0])
def test_friction_far_below_where_its_search_begins_is_worth_a_fit(detection_of, monkeypatch, force):
    """Friction that holds what truly slips is of no use to first order; where it is small, so is its first order."""
    monkeypatch.setattr(screening, "MAX_CANDIDATES", 3)
    detection = detection_of(Effect("dry_friction", "front", {"force": force}))
    trial = detection.trials[0]
    candidates = list_candidates(trial.run.vehicle, detection.trials, LAWS)
    locator = EffectLocator(trial.run.vehicle, dict(trial.values))
    found = screening.screen(candidates, detection.base, CurrentModel.of(detection.base), locator, SimulatorPool())
    assert any(item.effect.name == "dry_friction" and item.place in ("front", "all suspensions") for item in found)
    assert len(found) < len(candidates)


def test_the_start_beside_the_others_is_smaller_than_all_of_them():
    starts = [np.array([40.0, 1.0]), np.array([20.0, 3.0])]
    np.testing.assert_allclose(screening._smaller(starts, np.array([0.2, 0.0])), [2.0, 3.0])
    np.testing.assert_allclose(screening._smaller(starts, np.array([-1.0, 0.0])), [20.0, 3.0])
    assert screening._smaller([np.zeros(0)], np.zeros(0)).size == 0
