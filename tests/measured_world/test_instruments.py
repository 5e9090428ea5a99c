"""Filters, sampling, noise, phones and loggers of the measured world, against what is known of them."""

import numpy as np
import pytest
from benchmarks.hidden_effects.generator.setup import Reading
from benchmarks.measured_world import phone as phones
from benchmarks.measured_world.chain import RATE, Filter, Noise, quantised, sample
from benchmarks.measured_world.logger import Logger, Mount
from benchmarks.measured_world.motion import Motion, PlaceMotion
from scipy import signal

NONE = Filter("none", 1, 1.0)


def tone(frequency, seconds=4.0):
    return np.sin(2 * np.pi * frequency * np.arange(round(seconds * RATE)) / RATE)


def response(filtered, frequency):
    """Complex gain of a steady sine: its last whole seconds against a phasor."""
    n = round(2 * RATE)
    t = (len(filtered) - n + np.arange(n)) / RATE
    return 2j * np.mean(filtered[-n:] * np.exp(-2j * np.pi * frequency * t))


@pytest.mark.parametrize(("order", "frequency"), [(2, 10.0), (4, 20.0), (4, 45.0), (8, 60.0)])
def test_a_butterworth_has_the_gain_and_phase_of_its_polynomial(order, frequency):
    poles = 2 * np.pi * 45.0 * np.exp(1j * np.pi * (2 * np.arange(order) + order + 1) / (2 * order))
    expected = np.prod(-poles / (2j * np.pi * frequency - poles))
    assert abs(expected) == pytest.approx(1 / np.sqrt(1 + (frequency / 45.0) ** (2 * order)))
    found = response(Filter("butterworth", order, 45.0).apply(tone(frequency)), frequency)
    assert abs(found - expected) < 0.01


def test_a_bessel_delays_all_low_frequencies_alike_and_is_3_db_down_at_its_cutoff():
    filter = Filter("bessel", 4, 45.0)
    delays = [-np.angle(response(filter.apply(tone(f)), f)) / (2 * np.pi * f) for f in (3.0, 8.0, 14.0)]
    assert np.ptp(delays) < 2e-5
    assert abs(response(filter.apply(tone(45.0)), 45.0)) == pytest.approx(np.sqrt(0.5), abs=0.01)


def test_a_filter_starts_steady_and_an_unknown_one_is_refused():
    assert Filter("butterworth", 6, 45.0).apply(np.full((100, 2), 9.81)) == pytest.approx(np.full((100, 2), 9.81))
    with pytest.raises(ValueError, match="chebyshev"):
        Filter("chebyshev", 2, 45.0).apply(np.zeros(9))


@pytest.mark.parametrize(("filter", "amplitude"), [(NONE, 1.0), (Filter("butterworth", 8, 45.0), (45.0 / 70.0) ** 8)])
def test_a_tone_above_nyquist_folds_unless_it_is_filtered(filter, amplitude):
    seen = sample(filter.apply(tone(70.0)), 0.0, np.arange(200, 400) / 100.0)
    spectrum = np.abs(np.fft.rfft(seen)) / 100.0
    assert np.argmax(spectrum) == 60  # 30 Hz in 2 s: 100 - 70 Hz
    assert spectrum[60] == pytest.approx(amplitude, rel=0.05)


def test_samples_outside_of_what_is_known_are_refused():
    with pytest.raises(ValueError, match="known from"):
        sample(np.zeros(100), 0.0, np.array([0.1]))


def test_noise_has_its_density_and_rises_below_its_corner():
    values = Noise(2e-3, 10.0).draw((400_000,), np.random.default_rng(1))
    frequency, density = signal.welch(values, RATE, nperseg=8000)
    for low, high in ((2.0, 4.0), (8.0, 12.0), (500.0, 1500.0)):
        inside = (frequency >= low) & (frequency < high)
        assert np.mean(density[inside] / (4e-6 * (1 + 10.0 / frequency[inside]))) == pytest.approx(1.0, abs=0.15)


def test_values_are_rounded_and_cut():
    assert quantised(np.array([0.26, -7.0, 1.24]), 0.5, 2.0) == pytest.approx([0.5, -2.0, 1.0])


def still(n=8000):
    return PlaceMotion(*np.zeros((4, n)))


def test_a_place_at_rest_feels_gravity_along_its_own_axes():
    fore, up = still(1).specific_force(0.1)
    assert (fore[0], up[0]) == pytest.approx((-9.81 * np.sin(0.1), 9.81 * np.cos(0.1)))
    pitched = PlaceMotion(np.array([1.0]), np.array([2.0]), np.array([0.3]), np.zeros(1))
    fore, up = pitched.specific_force()
    assert np.hypot(fore[0], up[0]) == pytest.approx(np.hypot(10.81, 2.0))


def lying(forward, angles=(0.0, 0.0, 0.0), device=None):
    ideal = phones.Device("ideal", "phyphox", "android", 100.0, NONE, NONE, Noise(0.0), Noise(0.0), 1e-9, 1e-9, 0.0, 0.0)
    none = (0.0, 0.0, 0.0)
    return phones.Phone("F", device or ideal, 0.0, forward, angles, 0.0, (0.5,), (0.0,), none, none, {"az": 0.0, "q": 0.0})


@pytest.mark.parametrize(("forward", "axis", "sign"), [("y", 1, 1.0), ("x", 0, 1.0), ("-y", 1, -1.0)])
def test_the_named_axis_of_a_phone_points_forward_and_its_axes_are_right_handed(forward, axis, sign):
    rotation = lying(forward).axes()
    assert rotation[:, 0] == pytest.approx(sign * np.eye(3)[axis])
    assert rotation[:, 2] == pytest.approx([0.0, 0.0, 1.0])
    assert np.linalg.det(rotation) == pytest.approx(1.0)


def test_a_tilted_phone_reads_gravity_and_turning_in_its_own_axes():
    n = 8000
    motion = PlaceMotion(np.zeros(n), np.zeros(n), np.zeros(n), np.full(n, 0.2))
    phone = lying("y", (0.05, -0.03, 0.02))
    force, turn = phones.record(phone, motion, 0.0, 0.2, 1.5, Reading(), np.random.default_rng(0))
    assert np.linalg.norm(force.xyz, axis=1) == pytest.approx(np.full(len(force.t), 9.81))
    assert np.degrees(np.arccos(force.xyz[0, 2] / 9.81)) == pytest.approx(np.degrees(np.hypot(0.05, 0.03)), abs=0.05)
    assert np.linalg.norm(turn.xyz, axis=1) == pytest.approx(np.full(len(turn.t), 0.2))
    assert turn.xyz[0, 0] == pytest.approx(-0.2, abs=0.001)  # about the axis to the left, which is -x of a phone with its top edge ahead


def test_a_phones_samples_are_late_by_its_delay_and_its_clock_drifts():
    n = 40_000
    ramp = np.arange(n) / RATE
    device = phones.DEVICES[0]
    device = phones.Device(**{**vars(device), "q_filter": NONE, "q_noise": Noise(0.0), "q_step": 1e-9, "jitter": 0.0, "delay": 0.004})
    phone = phones.Phone(**{**vars(lying("x", device=device)), "clock_error": 1e-4})
    motion = PlaceMotion(np.zeros(n), np.zeros(n), np.zeros(n), ramp)
    _, turn = phones.record(phone, motion, 0.0, 1.0, 9.5, Reading(), np.random.default_rng(0))
    assert turn.xyz[:, 1] == pytest.approx(1.0 + turn.t / 1.0001 - 0.004, abs=1e-6)


def test_a_logger_reads_gain_tilt_and_fast_time():
    n = 24_000
    t = np.arange(n) / RATE
    motion = Motion(0.0, {"F": PlaceMotion(np.sin(4 * t), np.zeros(n), np.zeros(n), np.cos(4 * t))}, 1.0)
    mount = Mount(0.0, 0.02, {"az": 0.01, "q": 0.0})
    logger = Logger(100.0, NONE, NONE, NONE, Noise(0.0), Noise(0.0), 39.24, 4.0, 0.1, {"F": mount})
    times, channels, clean, sigma = logger.record(motion, 0.5, 4.0, {}, np.random.default_rng(0))
    true = 0.5 + times / 1.1
    assert channels["F_az"] == pytest.approx(1.01 * np.sin(4 * true) * np.cos(0.02), abs=0.001)
    assert clean["F_q"] == pytest.approx(np.cos(4 * true), abs=1e-6)
    assert set(np.diff(np.unique(np.round(channels["F_q"] * 2**15 / 4.0, 6))) % 1.0) == {0.0}
    assert sigma == {"F_az": 0.0, "F_q": 0.0}
