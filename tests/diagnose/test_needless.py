"""An effect that stood in for a later one is left out; one that is needed stays."""

import pytest
from benchmarks.hidden_effects.generator import Effect

from tests.diagnose.conftest import CUBIC, HUMPS
from vehgen.diagnose.fits.candidate import list_candidates
from vehgen.diagnose.select.fitter import Fitter
from vehgen.diagnose.select.needless import without_needless
from vehgen.diagnose.select.ranking import SearchRound
from vehgen.effects import EFFECTS

DAMPER = Effect("quadratic_damping", "rear", {"c2": 8e3})


@pytest.fixture(scope="module")
def chain_of(detection_of):
    """Return a function that gives what was detected, and a damper at the rear with a spring beside it, fitted one after the other."""

    def fit(*hidden):
        detection = detection_of(*hidden, runs=HUMPS)
        vehicle = detection.trials[0].run.vehicle
        library = [EFFECTS[name] for name in ("quadratic_damping", "cubic_stiffness")]
        damper, spring = (
            next(item for item in list_candidates(vehicle, detection.trials, library) if item.label == f"{effect.name} at rear")
            for effect in library
        )
        first = Fitter(detection, detection.base, ()).fit(damper)
        return detection, [first, Fitter(detection, first, ()).fit(spring)]

    return fit


@pytest.mark.thorough
def test_a_damper_that_stood_in_for_a_spring_is_left_out(chain_of):
    detection, chain = chain_of(CUBIC)
    rounds = [SearchRound(detection.base, (), (), (chain[0],)), SearchRound(chain[0], (), (), (chain[1],))]
    (left,) = without_needless(chain, detection, rounds)
    assert left.last.label == "cubic_stiffness at rear"
    assert left.training < 1.1 < chain[0].training
    assert rounds[0].fits == (left, chain[0])


@pytest.mark.slow
def test_both_stay_where_both_are_hidden(chain_of):
    detection, chain = chain_of(CUBIC, DAMPER)
    rounds = [SearchRound(detection.base, (), (), (chain[0],)), SearchRound(chain[0], (), (), (chain[1],))]
    assert without_needless(chain, detection, rounds) == chain
    assert [item.fits for item in rounds] == [(chain[0],), (chain[1],)]
