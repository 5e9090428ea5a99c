"""What tapered recordings tell of a fit, held against noise from a vehicle and a road that share no code with the fits."""

import numpy as np
import pytest

from tests.fit.recordings import sedan_truth, two_axle, write_run
from vehgen.fit.least_squares import LeastSquaresFit
from vehgen.fit.linearisation import linearise
from vehgen.fit.misfit import Misfit
from vehgen.fit.noise import Noise
from vehgen.fit.nuisances import Nuisances
from vehgen.fit.problem import make_problem
from vehgen.fit.road_answer import KNOT_WAVENUMBERS
from vehgen.fit.stationary import draw, recorded_information, score_covariance
from vehgen.fit.trial import load_trials
from vehgen.fit.window import Window, pulled_back, seen_share, transform

SPEED, LEVEL, SIGMA = 2.5, 16e-6, np.array([2e-3, 1e-4, 2e-3, 1e-4])
BAND = (0.5, 40.0)
RECORDS = 900


@pytest.fixture(scope="module")
def fit(tmp_path_factory):
    """A sedan over a hump on a rough road, at the truth; its speed is known, so that both axles follow the same road exactly."""
    truth = sedan_truth()
    trials = load_trials(write_run(tmp_path_factory.mktemp("hump"), "hump", truth, SPEED))
    problem = make_problem(trials)
    values = np.array([truth[name] for name in problem.space.names])
    noise = Noise(np.full(len(KNOT_WAVENUMBERS), LEVEL), SIGMA)
    known = Nuisances(speed=0.0, wander=0.0, asked=("speed", "wander"))
    misfit = Misfit(problem, {trials[0].name: noise}, values, known, BAND)
    return LeastSquaresFit(misfit, np.concatenate([problem.space.unit(values), np.zeros(misfit.n_errors)]), 1.0, 0.0)


def records_of_noise(n, dt):
    """Return what roughness and sensors put into RECORDS records, `shape (RECORDS, n, 4)`, cut out of long drives (force balance)."""
    random, truth = np.random.default_rng(5), sedan_truth()
    M, C, K, P = two_axle(truth)
    count = RECORDS * n
    frequency = np.fft.rfftfreq(count, dt)[1:]
    s = 2j * np.pi * frequency[:, None, None]
    late = np.array([0.0, 2.8 / SPEED])
    motion = np.linalg.solve(s**2 * M + s * C + K, P @ np.exp(-s * late[:, None]))
    places = {"F": truth["Lf"], "R": -(2.8 - truth["Lf"])}
    rows = [row for x in places.values() for row in ((s[:, 0, 0] ** 2, x), (None, x))]
    heave, pitch = motion[:, 0, 0], motion[:, 1, 0]
    way = np.stack([square * (heave - x * pitch) if square is not None else s[:, 0, 0] * pitch for square, x in rows], axis=1)
    density = LEVEL * 0.1**2 * SPEED / frequency**2
    unit = (random.standard_normal(len(frequency)) + 1j * random.standard_normal(len(frequency))) / np.sqrt(2)
    lines = np.zeros((count // 2 + 1, 4), dtype=complex)
    lines[1:] = way * (np.sqrt(density * count / (2 * dt)) * unit)[:, None]
    lines[-1] = 0
    drive = np.fft.irfft(lines, count, axis=0)
    return (drive + SIGMA * random.standard_normal(drive.shape)).reshape(RECORDS, n, 4)


def test_pulling_lines_back_is_the_transform_read_the_other_way():
    random = np.random.default_rng(1)
    n, dt = 301, 0.01
    inside = np.arange(n // 2 + 1) % 3 > 0
    for seen in (Window(), Window(fade_in=0.1, zeroed=True)):
        values = random.standard_normal((n, 2))
        lines = random.standard_normal((inside.sum(), 2)) + 1j * random.standard_normal((inside.sum(), 2))
        expected = float((lines.conj() * transform(values, dt, inside, seen=seen)).real.sum())
        assert float((pulled_back(lines, n, dt, np.flatnonzero(inside), seen) * values).sum()) == pytest.approx(expected, rel=1e-9)


def test_the_score_scatters_as_drives_over_other_roads_make_it(fit):
    """As much as computed; lines taken for independent say five times as much and more where slow motions count."""
    misfit, x = fit.misfit, fit.x
    block = linearise(misfit, x).blocks[0]
    trial = misfit.problem.trials[0]
    records = records_of_noise(len(trial.recording.time), trial.recording.dt)
    scores = np.array([2 * np.tensordot(block.conj(), misfit.whitened_signal(0, record), axes=((1, 2), (0, 1))).real for record in records])
    found = np.cov(scores.T)
    expected = score_covariance(misfit, x, 0, block)
    taken = np.diagonal(expected) > 1e-6 * np.diagonal(expected).max()
    size = 1 / np.sqrt(np.diagonal(expected)[taken])
    found, expected = (size[:, None] * item[np.ix_(taken, taken)] * size for item in (found, expected))
    assert np.diagonal(found) == pytest.approx(1.0, abs=0.2)
    assert np.sqrt(np.mean((found - expected) ** 2)) < 0.05
    independent = 2 * (np.abs(block[taken]) ** 2).sum(axis=(1, 2)) * size**2
    assert independent.max() > 5


def test_replicates_of_a_bootstrap_scatter_alike(fit):
    misfit, x = fit.misfit, fit.x
    block = linearise(misfit, x).blocks[0][: misfit.n_parameters]
    random, clean = np.random.default_rng(2), misfit.simulate(x)[0]
    drawn = [misfit.whitened_signal(0, draw(misfit, x, random)[0] - clean) for _ in range(300)]
    scores = np.array([2 * np.tensordot(block.conj(), lines, axes=((1, 2), (0, 1))).real for lines in drawn])
    expected = np.sqrt(np.diagonal(score_covariance(misfit, x, 0, block)))
    assert scores.std(axis=0) / expected == pytest.approx(1.0, abs=0.15)


def test_of_white_noise_a_record_tells_the_share_that_its_window_lets_through(fit):
    white = {name: Noise(np.full(len(KNOT_WAVENUMBERS), 1e-30), SIGMA) for name in fit.misfit.noises}
    misfit = Misfit(fit.misfit.problem, white, fit.values, fit.misfit.nuisances, BAND)
    found = recorded_information(LeastSquaresFit(misfit, fit.x, 1.0, 0.0))
    rows = linearise(misfit, fit.x).jacobian
    share = np.diagonal(found) / np.diagonal(rows.T @ rows)
    recording = fit.misfit.problem.trials[0].recording
    assert share == pytest.approx(seen_share(len(recording.time), recording.dt), abs=0.02)
