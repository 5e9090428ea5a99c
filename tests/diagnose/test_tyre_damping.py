"""Tyres that lose energy, each in its own measure."""

import numpy as np
import pytest
from benchmarks.hidden_effects.generator import Effect

from vehgen.diagnose.pipeline import diagnose_trials
from vehgen.effects import EFFECTS

RATIOS = {"front": 0.03, "rear": 0.14}
DAMPING, OTHERS = EFFECTS["tyre_damping"], [EFFECTS[name] for name in ("tyre_footprint", "speed_error")]


@pytest.mark.slow
def test_ratios_that_differ_by_axle_are_told_each(trials_of):
    found = diagnose_trials(
        trials_of(*(Effect("tyre_damping", name, {"ratio": ratio}) for name, ratio in RATIOS.items())), [DAMPING, *OTHERS]
    )
    (effect,) = found.verdict.effects
    assert (found.verdict.verdict, effect.name, effect.place) == ("named", "tyre_damping", "each tyre")
    for name, ratio in RATIOS.items():
        assert effect.parameters[f"ratio_{name}"].value == pytest.approx(ratio, rel=0.15, abs=0.01)
    assert np.sqrt(found.chosen[-1].training) < 1.05


@pytest.mark.slow
def test_one_ratio_of_all_tyres_stays_one_number(trials_of):
    found = diagnose_trials(trials_of(Effect("tyre_damping", "all", {"ratio": 0.1})), [DAMPING, *OTHERS])
    (effect,) = found.verdict.effects
    assert (effect.name, effect.place) == ("tyre_damping", "all tyres")
