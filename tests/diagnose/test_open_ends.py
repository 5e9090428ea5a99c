"""Intervals where derivatives do not tell them: a stop that no run meets, a number at an end of its range."""

from dataclasses import replace

import numpy as np
import pytest
from benchmarks.hidden_effects.generator import Effect

from tests.diagnose.conftest import CUBIC, HUMPS
from vehgen.diagnose.fits.candidate import list_candidates
from vehgen.diagnose.naming import told_alone
from vehgen.diagnose.select.estimates import estimate
from vehgen.diagnose.select.fitter import Fitter
from vehgen.diagnose.select.open_ends import told_numbers
from vehgen.diagnose.verdict import NamedParameter
from vehgen.effects import EFFECTS
from vehgen.fit.misfit import Misfit

STOP = Effect("bump_stop", "rear", {"k": 3e5, "clearance": 0.008, "rebound": 0.5})


def fitted(detection, effect):
    fitter = Fitter(detection, detection.base, ())
    (candidate,) = [item for item in list_candidates(detection.trials[0].run.vehicle, detection.trials, [effect]) if item.place == "rear"]
    fit = fitter.fit_at_once(candidate)
    return fit, fit.last


def within_its_range(fit):
    """Return a fit of which the last number, at the upper end of its range, lies in the middle of a wider one."""
    old = fit.least_squares
    space = old.misfit.problem.space
    wider = replace(space, upper=np.append(space.upper[:-1], 2 * space.upper[-1] - space.lower[-1]))
    misfit = Misfit(replace(old.misfit.problem, space=wider), old.misfit.noises, old.values, old.misfit.nuisances, old.misfit.band)
    x = old.x.copy()
    x[: space.size] = wider.unit(old.values)
    return replace(fit, least_squares=replace(old, misfit=misfit, x=x, linearisation=None))


@pytest.mark.thorough
def test_a_stop_that_no_run_meets_may_lie_anywhere_beyond(detection_of):
    """A rebound stop that was not there was told within a hundredth, just beyond the largest travel."""
    fit, candidate = fitted(detection_of(STOP, runs=HUMPS), EFFECTS["bump_stop"])
    found, hidden = told_numbers(fit, candidate)
    assert hidden == ["rebound"]
    assert "bump_stop_rear_rebound" in fit.least_squares.on_bound
    assert found["rebound"].interval is None
    assert list(told_alone(found, hidden)) == ["k", "clearance"]
    assert [found[name] for name in ("k", "clearance")] == [estimate(fit)[name] for name in ("k", "clearance")]
    nearer = within_its_range(fit)
    space = nearer.least_squares.misfit.problem.space
    found, hidden = told_numbers(nearer, candidate)
    assert hidden == ["rebound"]
    assert found["rebound"].interval[1] == pytest.approx(space.upper[-1])
    assert found["clearance"] == estimate(nearer)["clearance"]


@pytest.mark.thorough
def test_a_number_at_an_end_of_its_range_may_lie_beyond_it(detection_of):
    (k3,) = EFFECTS["cubic_stiffness"].parameters
    detection = detection_of(CUBIC, runs=HUMPS)
    free, candidate = fitted(detection, EFFECTS["cubic_stiffness"])
    scale = k3.scale(Fitter(detection, detection.base, ()).locator.site("rear"))
    held, candidate = fitted(
        detection, replace(EFFECTS["cubic_stiffness"], parameters=(replace(k3, high=0.9e8 / scale, starts=(0.5e8 / scale,)),))
    )
    assert held.least_squares.values[-1] == pytest.approx(0.9e8, rel=1e-3)
    narrow, wide = estimate(held)["k3"].interval, told_numbers(held, candidate)[0]["k3"].interval
    assert narrow[1] < 1e8 < wide[1]
    assert wide[0] == narrow[0]
    assert told_numbers(free, free.last)[0] == estimate(free)


def test_what_runs_do_not_tell_is_left_out_of_the_sentence_but_never_all():
    item = NamedParameter(1.0, (0.5, 1.5), "m")
    assert told_alone({"a": item, "b": item}, ["b"]) == {"a": item}
    assert told_alone({"a": item}, ["a"]) == {"a": item}
