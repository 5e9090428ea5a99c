"""The low-pass of a recording, found in worlds that scipy's integrator and filters made."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.signal

from tests.fit.profile_world import FINE, RATE, SIGMA, fine_channels, low_passed, misfit_of, read_run, rough_road
from vehgen.fit.chain_estimate import estimate_chain
from vehgen.fit.fine_response import fine_response, trusted_band
from vehgen.fit.nuisances import Nuisances
from vehgen.fit.recorders import MOST_LEFT

NUISANCES = Nuisances(0.05, 0.005)


def recorded(folder, sampled, speed, road):
    return misfit_of(read_run(folder, sampled, speed, road), NUISANCES)


def delayed(misfit, x, seconds):
    """Return x with the clock that a fit would have found."""
    moved = x.copy()
    moved[misfit.n_parameters + misfit.error_position(0, "delay")] = seconds / misfit.nuisances.delay
    return moved


@pytest.fixture(scope="module")
def rough():
    road = rough_road()
    return road, fine_channels(road, 12.0)


def test_point_samples_are_told_from_filtered_ones(tmp_path, rough):
    road, channels = rough
    found = estimate_chain(*recorded(tmp_path, channels[::FINE], 12.0, road))
    assert found.best.chain.filter == "none"
    assert found.is_clear
    assert found.scale < 1.2


@pytest.mark.parametrize(("order", "cut_off"), [(2, 30.0), (4, 22.0), (4, 8.0), (8, 35.0)])
def test_a_low_pass_is_found_with_its_cut_off(tmp_path, rough, order, cut_off):
    road, channels = rough
    misfit, x = recorded(tmp_path, low_passed(channels, order, cut_off), 12.0, road)
    late = {2: 0.2251, 4: 0.4159, 8: 0.8158}[order] / cut_off
    found = estimate_chain(misfit, delayed(misfit, x, late))
    assert found.best.chain.filter == "butterworth"
    assert found.best.chain.order == order
    assert found.best.chain.cut_off == pytest.approx(cut_off, rel=0.03)
    assert found.best.chain.delay == pytest.approx(-late, rel=0.02)
    assert found.is_clear
    assert found.scale < 1.2


@pytest.mark.parametrize("known", [True, False])
def test_an_engines_line_that_no_chain_explains_hides_no_chain(tmp_path, rough, known):
    """It wanders from 21 to 21.5 Hz, five times as loud as the noise."""
    road, channels = rough
    sampled = channels[::FINE].copy()
    t = np.arange(len(sampled)) / RATE
    sampled += 5 * SIGMA * np.sin(2 * np.pi * (21 * t + 0.25 * t**2 / t[-1]))[:, None]
    trial = replace(read_run(tmp_path, sampled, 12.0, road), lines=(21.0, 21.5) if known else ())
    found = estimate_chain(*misfit_of(trial, NUISANCES))
    assert (found.best.chain.filter == "none" and found.is_clear and found.scale < 1.2) == known
    assert (found.scale > MOST_LEFT) == (not known)


def test_resampling_in_software_is_an_ideal_low_pass(tmp_path, rough):
    road, channels = rough
    taps = scipy.signal.firwin(4001, 49.0, window=("kaiser", 6.0), fs=RATE * FINE)
    sampled = scipy.signal.oaconvolve(channels, taps[:, None], axes=0)[2000:][::FINE]
    found = estimate_chain(*recorded(tmp_path, sampled, 12.0, road))
    assert found.best.chain.filter == "ideal" or found.best.chain.cut_off > 45.0
    assert found.best.loss < next(item.loss for item in found.others if item.chain.filter == "none") - 100


def test_where_nothing_lies_above_the_band_no_chain_is_clear_and_the_whole_band_is_trusted(tmp_path):
    """A smooth swell excites nothing above some 10 Hz: point samples do as well as an ideal low-pass."""
    s = np.arange(0.0, 60.0, 0.02)
    road = s, 0.01 * np.exp(-(((s - 10.0) / 1.5) ** 2))
    misfit, x = recorded(tmp_path, fine_channels(road, 4.0)[::FINE], 4.0, road)
    assert not estimate_chain(misfit, x).is_clear
    assert trusted_band(misfit.problem.trials[0], fine_response(misfit, x, 0), misfit.noises["run"]) == 50.0


def test_the_trusted_band_ends_where_folded_energy_meets_the_noise(tmp_path, rough):
    road, channels = rough
    misfit, x = recorded(tmp_path, channels[::FINE], 12.0, road)
    trial, fine = misfit.problem.trials[0], fine_response(misfit, x, 0)
    ends = [trusted_band(trial, fine, replace(misfit.noises["run"], sigma=factor * SIGMA)) for factor in (0.1, 1.0, 10.0)]
    assert ends[0] <= ends[1] <= ends[2]
    taps = scipy.signal.firwin(8001, 50.0, window=("kaiser", 9.0), fs=RATE * FINE)
    folded = (channels - scipy.signal.oaconvolve(channels, taps[:, None], axes=0)[4000:][: len(channels)])[::FINE][:801]
    frequency, power = scipy.signal.welch(folded, RATE, nperseg=200, axis=0)
    share = (power / (2 / RATE * SIGMA**2)).max(axis=1)
    below = share[(frequency > 1) & (frequency < ends[1] - 3)]
    assert below.max(initial=0.0) < 0.3
    if ends[1] < 45:
        assert share[(frequency > ends[1] - 1) & (frequency < ends[1] + 3)].max() > 0.03
