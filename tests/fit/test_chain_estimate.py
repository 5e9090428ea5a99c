"""The low-pass of a recording, found in worlds that scipy's integrator and filters made."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
import scipy.signal

from tests.fit.recordings import two_axle
from vehgen.fit.chain_estimate import estimate_chain, fine_response, trusted_band
from vehgen.fit.misfit import Misfit
from vehgen.fit.noise import EVEN, Noise
from vehgen.fit.nuisances import Nuisances
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials

FINE, RATE = 40, 100.0
SIGMA = np.array([0.02, 5e-4, 0.02, 5e-4])
TRUTH = {
    "mH": 1500.0, "Lf": 1.18, "mf": 90.0, "mr": 150.0, "IZ": 2640.0, "kf": 62505.0,
    "kr": 71655.0, "cf": 3270.0, "cr": 4455.0, "ktf": 673140.0, "ktr": 612975.0,
}  # fmt: skip
RUN = """vehicle: sedan2.yaml
speed: {speed} m/s
road: [{{profile: {{file: road.csv, distance: s, height: h}}}}]
duration: 8 s
sensors:
  F: {{body: body, behind: front, channels: {{acceleration: F_az, pitch_rate: F_q}}}}
  R: {{body: body, behind: rear, channels: {{acceleration: R_az, pitch_rate: R_q}}}}
recording: run.csv
"""


def fine_channels(road, speed):
    """Return the sedan's channels every 1/(FINE RATE) s, by scipy.signal.lsim's first-order hold."""
    mass, damping, stiffness, load = two_axle(TRUTH)
    inverse = np.linalg.inv(mass)
    a = np.block([[np.zeros((4, 4)), np.eye(4)], [-inverse @ stiffness, -inverse @ damping]])
    b = np.vstack([np.zeros((4, 2)), inverse @ load])
    heave, pitch = a[4], a[5]
    rows, direct = [], []
    for place in (TRUTH["Lf"], TRUTH["Lf"] - 2.8):
        rows += [heave - place * pitch, np.eye(8)[5]]
        direct += [b[4] - place * b[5], np.zeros(2)]
    time = np.arange(int(9 * RATE * FINE)) / (RATE * FINE)
    wheels = np.column_stack([np.interp(speed * time - late, *road) - road[1][0] for late in (0.0, 2.8)])
    return scipy.signal.lsim((a, b, np.array(rows), np.array(direct)), wheels, time)[1]


def rough_road(seed=0):
    """Return a road of about ISO 8608 class B: a random walk of heights every 5 cm."""
    s = np.arange(0.0, 160.0, 0.05)
    return s, np.cumsum(np.random.default_rng(seed).standard_normal(len(s))) * 1.5e-3 * np.sqrt(0.05)


def recorded(folder, sampled, speed, road):
    np.savetxt(folder / "road.csv", np.column_stack(road), delimiter=",", header="s,h", comments="")
    values = sampled[: int(8 * RATE) + 1]
    values = values + SIGMA * np.random.default_rng(1).standard_normal(values.shape)
    rows = np.column_stack([np.arange(len(values)) / RATE, values])
    np.savetxt(folder / "run.csv", rows, delimiter=",", header="t,F_az,F_q,R_az,R_q", comments="")
    (folder / "run.yaml").write_text(RUN.format(speed=speed), encoding="utf-8")
    problem = make_problem(load_trials([folder / "run.yaml"]), ["kf", "kr", "cf", "cr", "ktf", "ktr"])
    noise = Noise(EVEN, SIGMA)
    misfit = Misfit(problem, {"run": noise}, problem.space.start, Nuisances(0.05, 0.005), (0.5, 40.0))
    x = np.concatenate([problem.space.unit(problem.space.start), np.zeros(misfit.n_errors)])
    return misfit, x


def delayed(misfit, x, seconds):
    """Return x with the clock that a fit would have found."""
    moved = x.copy()
    moved[misfit.n_parameters + misfit.error_position(0, "delay")] = seconds / misfit.nuisances.delay
    return moved


def low_passed(channels, order, cut_off, design=scipy.signal.butter):
    extra = {"norm": "mag"} if design is scipy.signal.bessel else {}
    return scipy.signal.sosfilt(design(order, cut_off, fs=RATE * FINE, output="sos", **extra), channels, axis=0)[::FINE]


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


@pytest.mark.parametrize(("order", "cut_off"), [(2, 30.0), (4, 22.0), (8, 35.0)])
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
