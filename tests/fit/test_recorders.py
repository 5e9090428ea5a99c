"""Recorders that no run file declares: which low-pass stands for them, in which channels, and where the compared band ends."""

from dataclasses import replace

import numpy as np
import pytest

from tests.fit.profile_world import FINE, SIGMA, fine_channels, low_passed, misfit_of, read_run, rough_road
from vehgen.fit.chain_estimate import ChainEstimate, estimate_chain
from vehgen.fit.chain_losses import ChainFit, group_delay
from vehgen.fit.misfit import Misfit
from vehgen.fit.nuisances import Nuisances
from vehgen.fit.recorders import FoundRecorder, clearest, find_recorder, has_unknown
from vehgen.measure.acquisition import POINT_SAMPLES, AcquisitionChain

BESSEL = AcquisitionChain("bessel", 2, 30.0)
SMALL = Nuisances(0.05, 0.005)


@pytest.fixture(scope="module")
def rough():
    road = rough_road()
    return road, fine_channels(road, 12.0)


def found_of(chain, cut=False, band=(0.5, 40.0), clear=True, channels=("F_az",)):
    return FoundRecorder(ChainEstimate(ChainFit(chain, 1.0), (), 1.0, clear), band, cut, channels)


def smooth_swell():
    s = np.arange(0.0, 60.0, 0.02)
    return s, 0.01 * np.exp(-(((s - 10.0) / 1.5) ** 2))


def test_only_what_no_run_file_states_is_unknown(tmp_path, rough):
    road, channels = rough
    sampled = channels[::FINE]
    assert has_unknown([read_run(tmp_path, sampled, 12.0, road)])
    assert not has_unknown([read_run(tmp_path, sampled, 12.0, road, extra="acquisition: none\n")])
    assert has_unknown([read_run(tmp_path, sampled, 12.0, road, extra="acquisition: {filter: unknown}\n")])


def late_fit(trial, seconds):
    """Return a fit that has found the delay of the low-pass for one of the clock."""
    misfit, x = misfit_of(trial, SMALL)
    x[misfit.n_parameters + misfit.error_position(0, "delay")] = seconds / misfit.nuisances.delay
    return misfit, x


def chi2(misfit, x):
    return np.mean(np.concatenate([np.abs(item.ravel()) ** 2 for item in misfit.whitened_spectrum(x)]))


def test_the_low_pass_that_a_recording_was_made_through_stands_in_the_channels_that_state_none(tmp_path, rough):
    road, channels = rough
    late = 0.4159 / 22.0
    own = AcquisitionChain("butterworth", 4, 22.0, -late)
    trial = read_run(tmp_path, low_passed(channels, 4, 22.0), 12.0, road)
    trial = replace(trial, scenario=replace(trial.scenario, chains={**trial.scenario.chains, "F_q": own}))
    recorder = find_recorder(*late_fit(trial, late))
    assert recorder.channels == ("F_az", "R_az", "R_q")
    assert (recorder.chain.filter, recorder.chain.order, recorder.cut) == ("butterworth", 4, False)
    assert recorder.chain.cut_off == pytest.approx(22.0, rel=0.03)
    assert recorder.band == (0.5, 40.0)
    assert "a butterworth low-pass of order 4 at 2" in recorder.describe()
    (applied,) = recorder.applied([trial])
    assert applied.scenario.chain("F_q") == own
    assert {applied.scenario.chain(name) for name in ("F_az", "R_az", "R_q")} == {recorder.chain}
    assert not has_unknown([applied])


@pytest.mark.thorough
def test_a_low_pass_beyond_the_band_of_a_fit_is_found_where_more_is_to_be_compared(tmp_path, rough):
    """A band that was cut for folding, before a better fit told the recorder, opens again."""
    late = 0.4159 / 38.0
    misfit, x = late_fit(read_run(tmp_path, low_passed(rough[1], 4, 38.0), 12.0, rough[0]), late)
    cut = Misfit(misfit.problem, misfit.noises, misfit.problem.space.start, misfit.nuisances, (0.5, 20.0))
    found = find_recorder(cut, x, band=(0.5, 40.0))
    assert not found.is_like(find_recorder(cut, x))
    assert found.is_like(find_recorder(misfit, x))
    assert (found.estimate.is_clear, found.band, found.chain.filter) == (True, (0.5, 40.0), "butterworth")
    assert found.chain.cut_off == pytest.approx(38.0, rel=0.03)


def test_the_low_pass_found_leaves_noise_where_the_assumed_one_does_not(tmp_path, rough):
    road, channels = rough
    late = 0.2251 / 18.0
    trial = read_run(tmp_path, low_passed(channels, 2, 18.0), 12.0, road)
    recorder = find_recorder(*late_fit(trial, late))
    assert chi2(*late_fit(recorder.applied([trial])[0], late)) < 1.3
    assert chi2(*late_fit(trial, late)) > 3


def two_recorders(channels, front, rear):
    """Return samples of the sensors F and R through Butterworth low-passes of such orders and cut-offs [Hz]."""
    return np.column_stack([low_passed(channels[:, :2], *front), low_passed(channels[:, 2:], *rear)])


@pytest.mark.thorough
def test_sensors_have_low_passes_of_their_own_where_one_for_all_explains_far_less(tmp_path, rough):
    road, channels = rough
    late = {8: 0.8158 / 35.0, 2: 0.2251 / 20.0}
    trial = read_run(tmp_path, two_recorders(channels, (8, 35.0), (2, 20.0)), 12.0, road)
    misfit, x = late_fit(trial, late[8])
    rear_clock = [(item.name, item.place) for item in misfit.conditions(x)].index(("clock", "R"))
    x[misfit.n_parameters + rear_clock] = (late[2] - late[8]) / misfit.nuisances.clock
    recorder = find_recorder(misfit, x)
    (front, steep), (rear, soft) = recorder.apart
    assert (front, rear) == (("F_az", "F_q"), ("R_az", "R_q"))
    assert (steep.best.chain.filter, soft.best.chain.filter, soft.best.chain.order) == ("butterworth", "butterworth", 2)
    assert steep.best.chain.cut_off == pytest.approx(35.0, rel=0.05)
    assert soft.best.chain.cut_off == pytest.approx(20.0, rel=0.05)
    (applied,) = recorder.applied([trial])
    assert applied.scenario.chain("F_q") == steep.best.chain
    assert applied.scenario.chain("R_az") == soft.best.chain
    assert "differ" in recorder.describe()
    assert f"at {soft.best.chain.cut_off:.3g} Hz (R_az, R_q)" in recorder.describe()
    assert not recorder.is_like(replace(recorder, apart=()))
    for factor, alike in ((1.05, True), (1.2, False)):
        moved = replace(soft, best=replace(soft.best, chain=replace(soft.best.chain, cut_off=factor * soft.best.chain.cut_off)))
        assert recorder.is_like(replace(recorder, apart=((front, steep), (rear, moved)))) is alike
    assert not recorder.is_usual(100.0)
    assert [bool(item.apart) for item in recorder.with_usual(100.0)][:2] == [True, False]


@pytest.mark.parametrize("fault", ["none", "gain"])
def test_sensors_share_a_low_pass_where_their_own_would_explain_little_more(tmp_path, rough, fault):
    """With a sensor's gain wrong by a fifth a low-pass of its own would explain some of what is left, but no half of it."""
    road, channels = rough
    late = 0.4159 / 30.0
    sampled = low_passed(channels, 4, 30.0) * (1.0, 1.0, 1.0 if fault == "none" else 1.2, 1.0)
    recorder = find_recorder(*late_fit(read_run(tmp_path, sampled, 12.0, road), late))
    assert recorder.apart == ()


def test_where_every_chain_does_and_nothing_folds_the_band_stays(tmp_path):
    road = smooth_swell()
    trial = read_run(tmp_path, fine_channels(road, 4.0)[::FINE], 4.0, road)
    recorder = find_recorder(*misfit_of(trial, SMALL))
    assert not recorder.estimate.is_clear
    assert (recorder.band, recorder.cut) == ((0.5, 40.0), False)
    assert "others would do as well" in recorder.describe()


def test_where_folding_might_matter_unseen_the_band_ends_before_it(tmp_path, rough):
    road, channels = rough
    sigma = 2 * SIGMA
    trial = read_run(tmp_path, channels[::FINE][:201], 12.0, road, sigma=sigma)
    recorder = find_recorder(*misfit_of(trial, SMALL, sigma))
    assert not recorder.estimate.is_clear
    assert recorder.cut
    assert 20.0 <= recorder.band[1] < 40.0
    assert f"above {recorder.band[1]:.3g} Hz nothing is compared" in recorder.describe()
    assert find_recorder(*misfit_of(trial, SMALL, sigma), band=(0.5, 20.0)).band == (0.5, 20.0)
    shaken = replace(trial, lines=(36.0,))  # before the hump, too: no folding made it
    assert find_recorder(*misfit_of(shaken, SMALL, sigma)).band == (0.5, pytest.approx(1.03 * 36.0))


@pytest.mark.parametrize(
    ("one", "other", "alike"),
    [
        (found_of(BESSEL), found_of(replace(BESSEL, cut_off=32.0)), True),
        (found_of(BESSEL), found_of(replace(BESSEL, cut_off=40.0)), False),
        (found_of(BESSEL), found_of(replace(BESSEL, order=4)), False),
        (found_of(BESSEL), found_of(BESSEL, cut=True), False),
        (found_of(POINT_SAMPLES), found_of(POINT_SAMPLES), True),
        (found_of(POINT_SAMPLES), found_of(BESSEL), False),
    ],
)
def test_recorders_are_alike_by_kind_and_cut_off(one, other, alike):
    assert one.is_like(other) is alike


def test_point_samples_are_told_in_words():
    assert "made through no low-pass at all" in found_of(POINT_SAMPLES).describe()


IDEAL = AcquisitionChain("ideal", 1, 48.0)


@pytest.mark.parametrize(
    ("chain", "cut_offs"),
    [
        (AcquisitionChain("bessel", 8, 21.6), [("bessel", 21.6), ("bessel", 43.0), ("ideal", 48.0)]),
        (AcquisitionChain("bessel", 8, 41.0), [("bessel", 41.0), ("ideal", 48.0)]),
        (IDEAL, [("ideal", 48.0)]),
        (POINT_SAMPLES, [("none", None), ("ideal", 48.0)]),
    ],
    ids=["unusually low", "usual", "ideal", "none"],
)
def test_an_unusually_low_cut_off_is_compared_with_a_usual_one(chain, cut_offs):
    recorder = FoundRecorder(ChainEstimate(ChainFit(chain, 1.0), (ChainFit(IDEAL, 2.0),), 1.0, True), (0.5, 40.0), False, ("F_az",))
    tried = recorder.with_usual(100.0)
    assert [(item.chain.filter, item.chain.cut_off) for item in tried] == [(kind, own and pytest.approx(own)) for kind, own in cut_offs]
    assert tried[0] is recorder
    usual = AcquisitionChain("bessel", 8, 43.0)
    if len(tried) == 3:
        assert abs(group_delay(usual) + tried[1].chain.delay) < 1e-9


@pytest.mark.parametrize(("squares", "stands"), [((900.0, 931.0, 950.0), 0), ((900.0, 925.0, 960.0), 1), ((900.0, 925.0, 950.0), 2)])
def test_low_passes_of_their_own_stand_where_refits_leave_far_less(squares, stands):
    """Where they do not, one for all stands, and an ideal one in its place where that does as well."""
    known = ChainEstimate(ChainFit(BESSEL, 1.0), (ChainFit(IDEAL, 2.0),), 1.0, True)
    shared = FoundRecorder(known, (0.5, 40.0), False, ("F_az", "R_az"))
    own = replace(shared, apart=((("F_az",), known), (("R_az",), replace(known, best=ChainFit(replace(BESSEL, cut_off=45.0), 1.0)))))
    tried = own.with_usual(85.0)
    assert [item.chain.filter for item in tried] == ["bessel", "bessel", "ideal"]
    assert clearest(tried, squares) == stands


def test_rivals_are_chains_that_do_nearly_as_well():
    low, other = ChainFit(AcquisitionChain("butterworth", 4, 8.5), 107.0), ChainFit(AcquisitionChain("bessel", 2, 7.2), 129.0)
    known = ChainEstimate(ChainFit(IDEAL, 100.0), (low, other, ChainFit(POINT_SAMPLES, 131.0)), 1.0, True)
    recorder = FoundRecorder(known, (0.5, 40.0), False, ("F_az",))
    assert [item.chain for item in recorder.nearly_as_good()] == [low.chain, other.chain]
    assert not any(item.estimate.is_clear for item in recorder.nearly_as_good())


def test_errors_are_held_about_none_when_a_low_pass_is_sought(tmp_path, rough):
    """Where a fit has sensors tilted by 3 standard deviations that stand level, no low-pass is the worse for setting them level again."""
    road, channels = rough
    trial = read_run(tmp_path, low_passed(channels, 4, 22.0), 12.0, road)
    misfit, x = late_fit(trial, 0.4159 / 22.0)
    plain = estimate_chain(misfit, x).best
    strayed = x.copy()
    tilts = [i for i, item in enumerate(misfit.conditions(x)) if item.name == "tilt"]
    strayed[misfit.n_parameters + np.array(tilts)] = 3.0
    found = estimate_chain(misfit, strayed).best
    assert found.chain.cut_off == pytest.approx(plain.chain.cut_off, rel=0.02)
    assert found.loss == pytest.approx(plain.loss, abs=2.0)
