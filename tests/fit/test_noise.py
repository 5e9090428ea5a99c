from dataclasses import replace

import numpy as np
import pytest
import scipy.optimize
from threadpoolctl import threadpool_info, threadpool_limits

from tests.fit.recordings import sedan_truth, write_run
from vehgen.fit.noise import EVEN, LOUDER_HZ, DrawnRoughness, Noise, estimate_noise
from vehgen.fit.road_answer import KNOT_WAVENUMBERS, RoadAnswer, road_answer
from vehgen.fit.trial import load_trials
from vehgen.fit.window import taper, transform
from vehgen.simulate.frequency_response import frequency_response


def make_answer(random, n=400, channels=4, axles=3):
    frequency = np.linspace(0.3, 40.0, n)
    shape = (n, channels, axles)
    return RoadAnswer(frequency, frequency / 2.0, random.standard_normal(shape) + 1j * random.standard_normal(shape), 0.01)


def draw(noise, answer, random):
    root = np.linalg.cholesky(noise.density(answer))
    unit = random.standard_normal((*root.shape[:2], 1)) + 1j * random.standard_normal((*root.shape[:2], 1))
    return (root @ unit / np.sqrt(2))[:, :, 0]


def test_the_whitener_makes_the_density_one():
    random = np.random.default_rng(0)
    answer = make_answer(random)
    noise = Noise(10.0 ** random.uniform(-6, -3, len(KNOT_WAVENUMBERS)), np.array([1e-4, 0.1, 1.0, 0.01]), 0.7)
    white = noise.whitener(answer)
    found = white @ noise.density(answer) @ white.conj().transpose(0, 2, 1)
    assert np.abs(found - np.eye(4)).max() < 1e-6


def test_drawn_roughness_of_a_linear_vehicle_is_as_likely_as_its_levels_and_rougher_with_them():
    random = np.random.default_rng(6)
    answer, sigma = make_answer(random, n=30), np.array([0.01, 0.1, 0.02, 0.2])
    plain = Noise(np.full(len(KNOT_WAVENUMBERS), 2e-4), sigma)
    gain = answer.gain @ answer.gain.conj().transpose(0, 2, 1)
    drawn = replace(plain, drawn=DrawnRoughness(answer.frequency, 2e-4 * gain, np.zeros((1, 4))))
    lines = random.standard_normal((30, 4)) + 1j * random.standard_normal((30, 4))
    own = 2 * answer.dt * np.eye(4) * sigma**2
    for factor in (1.0, 3.0):
        first, second = plain.rougher(factor), drawn.rougher(factor)
        np.testing.assert_allclose(first.density(answer) - own, factor * 2e-4 * gain, rtol=1e-9, atol=1e-15)
        np.testing.assert_allclose(second.density(answer), first.density(answer), rtol=1e-9, atol=1e-15)
        assert second.loss(lines, answer) == pytest.approx(first.loss(lines, answer), rel=1e-9)


def test_drawn_roughness_is_that_of_the_nearest_frequency():
    drawn = DrawnRoughness(np.array([1.0, 2.0, 4.0]), np.arange(3.0)[:, None, None].astype(complex), np.zeros((1, 1)))
    assert drawn.at(np.array([0.1, 1.4, 1.6, 2.9, 3.1, 50.0]))[:, 0, 0].real.tolist() == [0, 0, 1, 1, 2, 2]


def test_louder_bands_add_to_the_channel_alone():
    random = np.random.default_rng(4)
    answer = make_answer(random)
    plain = Noise(10.0 ** random.uniform(-6, -3, len(KNOT_WAVENUMBERS)), np.array([1e-4, 0.1, 1.0, 0.01]))
    factors = np.ones((len(LOUDER_HZ), 4))
    factors[2, 1] = 4.0
    louder = replace(plain, louder=factors)
    more = louder.density(answer) - plain.density(answer)
    inside = (answer.frequency >= LOUDER_HZ[2]) & (answer.frequency < LOUDER_HZ[3])
    assert more[inside, 1, 1].real == pytest.approx(3 * plain.density(answer)[inside, 1, 1].real, rel=1e-9)
    more[inside, 1, 1] = 0
    assert np.abs(more).max() < 1e-9
    white = louder.whitener(answer)
    assert np.abs(white @ louder.density(answer) @ white.conj().transpose(0, 2, 1) - np.eye(4)).max() < 1e-6


def test_the_loss_is_minus_two_ln_of_the_likelihood_and_its_slopes_are_its_derivatives():
    random = np.random.default_rng(1)
    answer = make_answer(random, n=50)
    noise = Noise(10.0 ** random.uniform(-4, -1, len(KNOT_WAVENUMBERS)), random.uniform(0.5, 2, 4), 0.7)
    lines = random.standard_normal((50, 4)) + 1j * random.standard_normal((50, 4))
    loss, by_level, by_sigma = noise.loss_and_slopes(lines, answer)
    direct = sum(
        2 * (np.linalg.slogdet(S)[1] + (line.conj() @ np.linalg.solve(S, line)).real)
        for S, line in zip(noise.density(answer), lines, strict=True)
    )
    assert loss == pytest.approx(direct, rel=1e-12)
    for array, slopes in ((noise.levels, by_level), (noise.sigma, by_sigma)):
        for i in range(len(array)):
            sides = []
            for step in (1e-5, -1e-5):
                moved = array.copy()
                moved[i] *= np.exp(step)
                one = Noise(moved, noise.sigma, 0.7) if array is noise.levels else Noise(noise.levels, moved, 0.7)
                sides.append(one.loss(lines, answer))
            assert (sides[0] - sides[1]) / 2e-5 == pytest.approx(slopes[i], rel=1e-4, abs=1e-4)


def test_the_loss_of_one_axle_is_that_of_its_closed_form_however_loud_the_road():
    """By the matrix determinant lemma and by Sherman and Morrison: 30 channels, the road is up to 1e11 times as loud as their noise."""
    random = np.random.default_rng(5)
    answer = make_answer(random, n=20, channels=30, axles=1)
    level, sigma = 1e-3, random.uniform(1e-12, 1e-11, 30)
    lines = random.standard_normal((20, 30)) + 1j * random.standard_normal((20, 30))
    loss, _, _ = Noise(np.full(len(KNOT_WAVENUMBERS), level), sigma).loss_and_slopes(lines, answer)
    own, road = 2 * answer.dt * sigma**2, answer.gain[:, :, 0]
    loud = 1 + level * (np.abs(road) ** 2 / own).sum(axis=1)
    along = np.abs((road.conj() * lines / own).sum(axis=1)) ** 2 * level / loud
    direct = 2 * (np.log(own).sum() * 20 + np.log(loud).sum() + (np.abs(lines) ** 2 / own).sum() - along.sum())
    assert loss == pytest.approx(direct, rel=1e-9)


def test_level_and_sigma_come_out_of_noise_that_was_drawn_with_them():
    random = np.random.default_rng(2)
    answer = make_answer(random, n=800)
    truth = Noise(np.full(len(KNOT_WAVENUMBERS), 2e-3), np.array([0.05, 0.2, 0.1, 0.3]))
    found = estimate_noise(
        [(draw(truth, answer, random), answer) for _ in range(3)], Noise(np.full(len(KNOT_WAVENUMBERS), 1e-5), np.ones(4))
    )[0]
    assert found.sigma == pytest.approx(truth.sigma, rel=0.2)
    inside = (answer.wavenumber > 0.3) & (answer.wavenumber < 15)
    assert np.median(found.level(answer.wavenumber[inside])) == pytest.approx(2e-3, rel=0.15)


def test_a_rig_has_no_road_whose_roughness_could_be_told():
    """A shaker's runs were warned of a road rougher than class D."""
    random = np.random.default_rng(8)
    answer, sigma = make_answer(random), np.array([0.01, 0.1, 0.02, 0.2])
    answer = replace(answer, gain=np.zeros_like(answer.gain))
    lines = draw(Noise(EVEN, sigma), answer, random)
    (found,) = estimate_noise([(lines, answer)], Noise(EVEN, 3 * sigma))
    assert found.levels == pytest.approx(EVEN)
    np.testing.assert_allclose(found.sigma, sigma, rtol=0.1)


def test_each_trial_has_a_road_of_its_own_roughness_and_all_have_the_same_sensors():
    random = np.random.default_rng(4)
    answer, sigma = make_answer(random, n=800), np.array([0.05, 0.2, 0.1, 0.3])
    levels = (5e-4, 8e-3)
    residuals = [(draw(Noise(np.full(len(KNOT_WAVENUMBERS), level), sigma), answer, random), answer) for level in levels]
    found = estimate_noise(residuals, Noise(np.full(len(KNOT_WAVENUMBERS), 1e-5), np.ones(4)))
    inside = (answer.wavenumber > 0.3) & (answer.wavenumber < 15)
    for noise, level in zip(found, levels, strict=True):
        assert np.median(noise.level(answer.wavenumber[inside])) == pytest.approx(level, rel=0.2)
    assert found[0].sigma.tolist() == found[1].sigma.tolist()
    alike = estimate_noise(residuals, Noise(np.full(len(KNOT_WAVENUMBERS), 1e-5), np.ones(4)), same_road=True)
    assert alike[0].levels == pytest.approx(alike[1].levels)


def test_levels_are_looked_for_on_one_thread_whatever_the_caller_allows(monkeypatch):
    """A dozen unknowns: on a busy machine, more threads of BLAS made it ten times slower."""
    random, threads, minimize = np.random.default_rng(2), set(), scipy.optimize.minimize

    def watch(*arguments, **options):
        threads.update(item["num_threads"] for item in threadpool_info() if item["user_api"] == "blas")
        return minimize(*arguments, **options)

    monkeypatch.setattr(scipy.optimize, "minimize", watch)
    answer = make_answer(random, n=50)
    truth = Noise(np.full(len(KNOT_WAVENUMBERS), 2e-3), np.array([0.05, 0.2, 0.1, 0.3]))
    with threadpool_limits(2, user_api="blas"):
        estimate_noise([(draw(truth, answer, random), answer)], truth)
    assert threads == {1}


def test_histories_drawn_have_the_density_they_should():
    random = np.random.default_rng(3)
    n, dt = 1000, 0.01
    frequency = np.fft.rfftfreq(n, dt)
    inside = (frequency >= 0.3) & (frequency <= 40)
    noise = Noise(EVEN, np.array([0.1, 0.4]))
    answer = RoadAnswer(frequency[inside], frequency[inside], np.zeros((inside.sum(), 2, 1), complex), dt)
    power = np.mean([np.abs(transform(noise.draw(answer, n, np.flatnonzero(inside), random), dt, inside)) ** 2 for _ in range(200)], axis=0)
    assert power[10:-10].mean(axis=0) == pytest.approx(2 * dt * noise.sigma**2, rel=0.03)


def test_the_taper_leaves_the_middle_alone():
    window = taper(1000, 0.01)
    assert window[0] == 0.0
    assert (window[80:-80] == 1.0).all()


def test_coloured_noise_has_the_density_of_white_noise_at_44_hz_and_more_below():
    answer = RoadAnswer(np.array([11.0, 44.0]), np.array([5.5, 22.0]), np.zeros((2, 1, 1), dtype=complex), 0.01)
    density = Noise(EVEN, np.array([0.3]), 0.5).density(answer)[:, 0, 0].real
    assert density == pytest.approx(2 * 0.01 * 0.3**2 * np.array([2.0, 1.0]))


def test_roughness_comes_as_from_one_road_under_all_axles(tmp_path):
    """G H R H* of an endless record is what one road of that density does, each axle later by its distance behind the first."""
    (trial,) = load_trials([write_run(tmp_path, "hump", sedan_truth(), 2.5)])
    frequency = np.linspace(1.0, 20.0, 40)
    gain = road_answer(trial, frequency, trial.values, windowed=False).gain
    found = gain @ gain.conj().transpose(0, 2, 1)
    per_metre = frequency_response(trial.simulator.model, frequency, values=trial.values, speed=2.5).values[:, :, 0]
    expected = per_metre[:, :, None] * per_metre[:, None, :].conj() * (0.1**2 * 2.5 / frequency**2)[:, None, None]
    size = np.sqrt(np.einsum("nii->ni", expected).real)
    np.testing.assert_allclose(found / (size[:, :, None] * size[:, None, :]), expected / (size[:, :, None] * size[:, None, :]), atol=2e-3)


def test_axles_agree_as_their_average_over_speeds_that_a_run_may_have_had(tmp_path):
    (trial,) = load_trials([write_run(tmp_path, "hump", sedan_truth(), 2.5)])
    frequency, spread = np.linspace(1.0, 20.0, 40), 0.014
    steps, weights = np.polynomial.hermite_e.hermegauss(31)
    shared = 0.0
    for step, weight in zip(steps, weights / weights.sum(), strict=True):
        other = replace(trial, scenario=trial.scenario.adjusted(speed=1 + spread * step))
        gain = road_answer(other, frequency, trial.values).gain
        shared = shared + weight * gain @ gain.conj().transpose(0, 2, 1)
    gain = road_answer(trial, frequency, trial.values, spread).gain
    found = gain @ gain.conj().transpose(0, 2, 1)
    size = np.sqrt(np.abs(found[:, 0, 0] * found[:, 2, 2]))
    assert np.abs(found[:, 0, 2] - shared[:, 0, 2]).max() < 0.02 * size.max()
    np.testing.assert_allclose(np.abs(found[:, 0, 2] - shared[:, 0, 2]) / size, 0.0, atol=0.03)
    exact = road_answer(trial, frequency, trial.values).gain
    certain = exact @ exact.conj().transpose(0, 2, 1)
    assert np.max(np.abs(certain[:, 0, 2] - shared[:, 0, 2]) / size) > 0.2
