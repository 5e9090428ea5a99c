"""The road's part of the noise against roads that were drawn and driven over by scipy's integrator."""

from dataclasses import fields, replace

import numpy as np
import pytest

from tests.fit.profile_world import FINE, RATE, fine_channels, read_run, rough_road
from vehgen.diagnose.inputs.adjustments import AxleShift
from vehgen.fit import road_answer as module
from vehgen.fit.adjustments import Gain, SensorDelay, SpeedScale
from vehgen.fit.misfit import Misfit
from vehgen.fit.noise import Noise
from vehgen.fit.nuisances import Nuisances
from vehgen.fit.problem import make_problem
from vehgen.fit.reading import Reading
from vehgen.fit.road_answer import KNOT_WAVENUMBERS, RoadAnswer, as_read, road_answer
from vehgen.fit.window import transform
from vehgen.road import ConstantSpeed

SPEED, SIGMA = 2.5, np.array([2e-3, 5e-5, 2e-3, 5e-5])
PER_METRE = 1.5e-3**2
"""Variance that the heights of rough_road gain in a metre [m^2/m]: a random walk, Gd(n) = 2 PER_METRE/(2 pi n)^2."""


@pytest.fixture(scope="module")
def driven(tmp_path_factory):
    """A trial of 8 s, and the spectral lines of 56 such records of the same vehicle over roads that were drawn."""
    drives = [fine_channels(rough_road(seed), SPEED, 62.0)[::FINE] for seed in range(8)]
    trial = read_run(tmp_path_factory.mktemp("rough"), drives[0], SPEED, rough_road(0))
    n = len(trial.recording.time)
    frequency = np.fft.rfftfreq(n, 1 / RATE)
    inside = (frequency >= 0.5) & (frequency <= 6.0)
    random = np.random.default_rng(1)
    starts = range(int(4 * RATE), len(drives[0]) - n, n)
    pieces = np.array([drive[start : start + n] for drive in drives for start in starts])
    lines = transform(pieces + SIGMA * random.standard_normal(pieces.shape), 1 / RATE, inside)
    return trial, frequency[inside], lines


NONE = Nuisances(**dict.fromkeys((item.name for item in fields(Nuisances) if item.name != "asked"), 0.0))
NOISE = Noise(np.full(len(KNOT_WAVENUMBERS), 2 * PER_METRE / (2 * np.pi * 0.1) ** 2), SIGMA)


def whitened_powers(driven, answer=None, lines=None):
    """Return the mean square of the channels' whitened lines by band: 0.5 to 1.5, 1.5 to 3 and 3 to 6 Hz, `shape (3, 4)`."""
    trial, frequency, on_time = driven
    lines = on_time if lines is None else lines
    white = np.einsum("nij,pnj->pni", NOISE.whitener(answer or road_answer(trial, frequency, trial.values)), lines)
    bands = [(0.5, 1.5), (1.5, 3.0), (3.0, 6.1)]
    return np.array([(np.abs(white[:, (frequency >= low) & (frequency < high)]) ** 2).mean(axis=(0, 1)) for low, high in bands])


@pytest.mark.slow
def test_records_of_a_rough_road_hold_what_the_window_shows_of_it(driven):
    np.testing.assert_allclose(whitened_powers(driven), 1.0, atol=0.25)


@pytest.mark.thorough
def test_a_road_is_met_at_the_speed_that_a_fit_of_all_speeds_begins_at(driven):
    """Axles follow one another 5 % sooner than the file says: by its speed noise seems up to several times as large as it is."""
    trial, frequency, _ = driven
    stated = replace(trial, scenario=replace(trial.scenario, speed=ConstantSpeed(SPEED / 1.05)))
    told, untold = (answer_at(stated, frequency, SpeedScale("runs", 0.01, 1.0), begun) for begun in (5.0, 0.0))
    powers = whitened_powers(driven, told)
    np.testing.assert_allclose(powers, whitened_powers(driven), rtol=0.02)
    assert whitened_powers(driven, untold).max() > 1.5 * powers.max()


@pytest.mark.thorough
def test_a_road_is_met_at_the_speed_that_is_supposed_of_a_run(driven):
    """As at that of a fit of all speeds; how the driver strays about it is no other speed."""
    trial, frequency, _ = driven
    stated = replace(trial, scenario=replace(trial.scenario, speed=ConstantSpeed(SPEED / 1.05)))
    problem = make_problem([stated], ["kf"])
    own = replace(NONE, speed=0.01, wander=0.01)
    powers = []
    for speed in (5.0, 0.0):
        kinds = [item.name for item in Misfit(problem, {stated.name: NOISE}, problem.space.start, own).errors[0].items]
        supposed = np.array([speed if kind == "speed" else 5.0 * (-1) ** place for place, kind in enumerate(kinds)])
        misfit = Misfit(problem, {stated.name: NOISE}, problem.space.start, own, (0.5, 6.0), supposed=supposed)
        answer = misfit.residual_spectrum(np.concatenate([[0.5], supposed]))[0][1]
        assert misfit.frequency(0) == pytest.approx(frequency)
        powers.append(whitened_powers(driven, answer))
    exact = road_answer(trial, frequency, trial.values, own.speed_spread(trial))
    np.testing.assert_allclose(powers[0], whitened_powers(driven, exact), rtol=0.02)
    assert powers[1].max() > 1.2 * powers[0].max()


@pytest.mark.thorough
def test_a_road_is_met_by_axles_where_a_fit_of_their_places_begins(driven):
    """Where a file has the rear axle 0.3 m too far ahead, what it meets 0.12 s later than stated is no gap."""
    trial, frequency, _ = driven
    stated = replace(trial, scenario=trial.scenario.adjusted(farther=(0.0, -0.3)))
    told, untold = (answer_at(stated, frequency, AxleShift("", 0.02, moved=(0.0, 1.0)), begun) for begun in (15.0, 0.0))
    powers = whitened_powers(driven, told)
    np.testing.assert_allclose(powers, whitened_powers(driven), rtol=0.02)
    assert whitened_powers(driven, untold).max() > 1.5 * powers.max()


@pytest.mark.thorough
@pytest.mark.parametrize("is_late", [True, False], ids=["late", "gain"])
def test_a_sensor_that_reads_wrong_in_all_runs_reads_the_rough_road_so_too(driven, is_late):
    """Two sensors feel the same road; read 30 ms too late or by 0.7 too low, it is no noise by the way that it should come."""
    trial, frequency, lines = driven
    error, begun = (SensorDelay("R", 0.01), 3.0) if is_late else (Gain("R_az", 0.05, 1.0), -6.0)
    late = np.exp(-2j * np.pi * frequency[:, None] * [0.0, 0.0, 0.03, 0.03])  # under a window that is as late
    read = lines * (late if is_late else [1.0, 1.0, 0.7, 1.0])
    powers = whitened_powers(driven, answer_at(trial, frequency, error, begun), read)
    np.testing.assert_allclose(powers, whitened_powers(driven), rtol=0.1)
    assert whitened_powers(driven, lines=read).max() > 1.5 * powers.max()


def answer_at(trial, frequency, adjustment, begun):
    """Return the road's answer of a misfit that begins at an adjustment's number, in its unit."""
    problem = make_problem([trial], ["kf"])
    misfit = Misfit(problem, {trial.name: NOISE}, problem.space.start, NONE, (0.5, 6.0), (adjustment,), begun=(begun,))
    assert misfit.frequency(0) == pytest.approx(frequency)
    return misfit.residual_spectrum(np.array([0.5, begun]))[0][1]


@pytest.mark.thorough
def test_without_the_windows_spread_channels_would_have_to_agree_as_they_do_not(driven, monkeypatch):
    monkeypatch.setattr(module, "LINES_BESIDE", 0)
    assert whitened_powers(driven).max() > 5.0


def test_sensors_that_read_wrong_read_the_rough_road_wrong_too():
    random = np.random.default_rng(2)
    frequency = np.linspace(1.0, 20.0, 5)
    gain = random.standard_normal((5, 2, 2)) + 1j * random.standard_normal((5, 2, 2))
    channels = (("F_az", "F", "acceleration"), ("F_q", "F", "pitch_rate"))
    reading = Reading.of(frequency, RATE, channels, {("gain", "F_az"): 0.05, ("tilt", "F"): 0.02}, np.zeros(2))
    answer = RoadAnswer(frequency, frequency / SPEED, gain, 1 / RATE)
    unit = random.standard_normal((5, 2)) + 1j * random.standard_normal((5, 2))
    expected = reading.apply(np.einsum("nij,nj->ni", gain, unit))
    np.testing.assert_allclose(np.einsum("nij,nj->ni", as_read(answer, reading).gain, unit), expected)
    assert as_read(answer, None) is answer
