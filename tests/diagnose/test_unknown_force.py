"""The place test: no hypothesis needs errors of runs and sensors that no fit may have."""

from types import SimpleNamespace

import numpy as np
import pytest
from benchmarks.hidden_effects.generator import Effect

from vehgen.diagnose.localise.localisation import localise
from vehgen.diagnose.localise.unknown_force import list_places, score_locations
from vehgen.fit.alignment import MOST_SIGMAS
from vehgen.fit.linearisation import Lineariser

FRICTION = Effect("dry_friction", "rear", {"force": 450.0})


@pytest.fixture(scope="module")
def base(detection_of):
    return detection_of(FRICTION).base


@pytest.mark.slow
def test_errors_stay_within_their_bounds_at_every_place(base):
    misfit, x = base.least_squares.misfit, base.least_squares.x
    results = score_locations(misfit, x, list_places(misfit))
    assert results
    for result in results:
        unit, errors = misfit.split(result.x)
        assert np.abs(errors).max() <= MOST_SIGMAS
        assert unit.min() >= 0.0
        assert unit.max() <= 1.0


@pytest.mark.slow
def test_friction_is_placed_where_it_is(base):
    _, passed = localise(base)
    assert passed[0].place.label in ("suspension rear", "tyre rear")


@pytest.mark.parametrize("finite", [0, 1, 3])
def test_a_place_is_told_by_the_steps_before_the_model_diverges(base, finite):
    """A step led to where nothing can be simulated: a truck's diagnosis ended by errors of a run that were NaN."""
    misfit, x = base.least_squares.misfit, base.least_squares.x
    derive, calls = Lineariser(misfit), []

    def diverging(unknowns):
        calls.append(unknowns)
        found = derive(unknowns)
        return found if len(calls) <= finite else SimpleNamespace(spectra=[np.full_like(item, np.nan) for item in found.spectra])

    place = next(item for item in list_places(misfit) if item.label == "suspension front")
    (result,) = score_locations(misfit, x, [place], diverging)
    (whole,) = score_locations(misfit, x, [place], derive)
    assert np.isfinite(result.x).all()
    assert whole.chi - 1e-9 <= result.chi < np.inf
    assert len(calls) <= finite + 1
