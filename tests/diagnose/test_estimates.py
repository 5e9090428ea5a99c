"""What counts as gain and as chance, on numbers that can be reckoned by hand."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import scipy.stats

from tests.diagnose.conftest import CUBIC, HUMPS
from vehgen.diagnose import wording
from vehgen.diagnose.fits.candidate import list_candidates
from vehgen.diagnose.select import estimates
from vehgen.diagnose.select.estimates import RunEstimate, _median_error, estimate, excluded, p_value, untold
from vehgen.diagnose.select.fitter import Fitter
from vehgen.diagnose.select.validation import gain_interval, seen_again, validation_gain
from vehgen.diagnose.verdict import NamedParameter
from vehgen.effects import EFFECTS


def fit(power, train=1.0, count=1000):
    """Return a fit with one training run and one untouched run of 200 lines and 2 channels."""
    mean = float(np.mean(power))
    misfit = SimpleNamespace(problem=SimpleNamespace(trials=[SimpleNamespace(name="taught")]))
    return SimpleNamespace(
        validation=mean,
        training=train,
        mean_squares={"taught": train, "new": mean},
        counts={"taught": count, "new": 2 * np.size(power)},
        spectra={"new": np.asarray(power)},
        least_squares=SimpleNamespace(misfit=misfit),
    )


def noise(seed, level=1.0):
    return level * np.random.default_rng(seed).exponential(size=(200, 2))


def test_the_gain_is_the_share_of_the_excess_and_its_interval_holds_it():
    base, better = fit(noise(1, 5.0)), fit(noise(2, 2.0))
    gain = validation_gain(base, better)
    assert gain == pytest.approx(1 - (better.validation - 1) / (base.validation - 1))
    low, high = gain_interval(base, better, ["new"])
    assert low < gain < high
    assert 0.05 < high - low < 0.4


def test_a_gain_that_sits_in_few_lines_is_uncertain_but_no_more_than_everything():
    power = noise(3)
    power[90:100] += 40.0
    base, better = fit(power), fit(noise(3))
    low, high = gain_interval(base, better, ["new"])
    assert 0 <= low <= high <= 1


def test_runs_without_a_gap_show_no_gain():
    assert validation_gain(fit(noise(4)), fit(noise(5, 0.9))) is None
    assert gain_interval(fit(noise(4)), fit(noise(5, 0.9)), ["new"]) is None


def test_numbers_whose_intervals_reach_below_zero_are_not_told():
    """A stop in rebound that no run met was 0.043 m, from -2.1 to 2.2 m."""
    told = {"k": NamedParameter(391e3, (375e3, 408e3), "N/m"), "rebound": NamedParameter(0.043, (-2.1, 2.2), "m")}
    assert untold(told | {"fixed": NamedParameter(2.0, None, "")}) == ["rebound"]
    assert wording.not_told(["rebound"]).startswith("these runs do not tell how large rebound is")


def test_chance_is_the_likelihood_ratio_in_units_of_what_is_left():
    base, better = fit(noise(6), train=1.02), fit(noise(6), train=1.0)
    assert p_value(base, better, 2) == pytest.approx(scipy.stats.chi2.sf(20.0, 2))
    base, better = fit(noise(6), train=100.0), fit(noise(6), train=99.0)
    assert p_value(base, better, 1) == pytest.approx(scipy.stats.chi2.sf(1000 / 99.0, 1))


@pytest.mark.parametrize(
    ("half_width", "told"),
    [(1e3, ["k from -2e+06 to 9e+04 N/m"]), (3e6, [])],
    ids=["each run is sure", "one run hardly tells"],
)
def test_numbers_exclude_one_another_where_each_run_is_sure_of_its_own(monkeypatch, half_width, told):
    alone = [RunEstimate("one", "k", 8e4, 1e3), RunEstimate("two", "k", 9e4, 1e3), RunEstimate("three", "k", -2e6, half_width)]
    monkeypatch.setattr(estimates, "estimates_by_run", lambda fit, candidate=None: alone)
    monkeypatch.setattr(estimates, "estimate", lambda fit, candidate=None: {"k": NamedParameter(8.5e4, None, "N/m")})
    assert excluded(_of("cubic_stiffness")) == told


def _of(effect):
    """Return a fit of which only the last effect is known."""
    return SimpleNamespace(last=SimpleNamespace(effect=EFFECTS[effect]))


@pytest.mark.parametrize(("interval", "told"), [((-29.0, 171.0), ["amplitude from -29 to 171 N"]), ((4.0, 138.0), []), (None, [])])
def test_a_line_of_which_runs_tell_no_strength_is_none_of_an_engine(monkeypatch, interval, told):
    """Another mechanism's line is as loud as each run makes it: a resonator's grows with the hump."""
    numbers = {"frequency": NamedParameter(7.16, (7.1, 7.2), "Hz"), "amplitude": NamedParameter(71.0, interval, "N")}
    monkeypatch.setattr(estimates, "estimates_by_run", lambda fit, candidate=None: [])
    monkeypatch.setattr(estimates, "estimate", lambda fit, candidate=None: numbers)
    assert excluded(_of("engine_harmonic")) == told


def test_numbers_that_differ_by_less_than_themselves_are_of_one_law(monkeypatch):
    alone = [RunEstimate(str(value), "k", value, 1e2) for value in (8e4, 9e4, 4e4)]
    monkeypatch.setattr(estimates, "estimates_by_run", lambda fit, candidate=None: alone)
    monkeypatch.setattr(estimates, "estimate", lambda fit, candidate=None: {"k": NamedParameter(8e4, None, "N/m")})
    assert excluded(_of("cubic_stiffness")) == []


def test_runs_without_a_gap_speak_by_their_squares():
    """A law takes squares off a few lines, which chi over all of them hardly shows."""
    power = noise(7)
    seen, faint, chance = (power.copy() for _ in range(3))
    seen[50:90] += 2.0
    faint[50:90] += 0.5
    chance[55, 0] += 150.0  # in one line alone
    clean = SimpleNamespace(**{**vars(fit(power)), "validation": 1.0})
    for loud, told in ((seen, True), (faint, False), (chance, False)):
        base = SimpleNamespace(**{**vars(fit(loud)), "validation": 1.05})  # counts as no gap
        assert validation_gain(base, clean) is None
        assert seen_again(base, clean, ["new"]) == told
    assert not seen_again(clean, clean, [])


def test_runs_with_a_gap_speak_by_the_share_of_it_that_is_closed():
    assert seen_again(fit(noise(1, 5.0)), fit(noise(2, 2.0)), ["new"])
    assert not seen_again(fit(noise(1, 5.0)), fit(noise(2, 5.2)), ["new"])


@pytest.mark.parametrize("runs", [2, 3, 4, 6])
def test_a_median_of_few_runs_is_as_sure_as_it_says(runs):
    drawn = np.random.default_rng(runs).standard_normal((runs, 4000))
    held = np.mean(np.abs(np.median(drawn, axis=0)) <= 1.645 * _median_error(drawn))
    assert held == pytest.approx(0.9, abs=0.04)


def test_what_a_laws_form_leaves_open_is_in_its_interval(detection_of):
    detection = detection_of(CUBIC, runs=HUMPS)
    listed = list_candidates(detection.trials[0].run.vehicle, detection.trials, [EFFECTS["cubic_stiffness"]])
    found = Fitter(detection, detection.base, ()).fit_at_once(next(item for item in listed if item.place == "rear"))
    vague = replace(found.last.effect, parameters=(replace(found.last.effect.parameters[0], form=0.2),))
    known, unsure = (estimate(found, replace(found.last, effect=effect))["k3"] for effect in (found.last.effect, vague))
    half, wider = (0.5 * (item.interval[1] - item.interval[0]) for item in (known, unsure))
    assert wider == pytest.approx(np.hypot(half, 1.645 * 0.2 * known.value))
