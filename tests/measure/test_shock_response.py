"""Shock response spectra against the known responses of oscillators."""

import numpy as np
import pytest
import scipy.optimize
import scipy.signal

from vehgen.measure.shock_response import shock_response, spectrum_frequencies


def half_sine_maximum(ratio):
    """Return the largest undamped response to a half sine of height 1; `ratio` is the oscillator's frequency over the pulse's, above 1."""
    t = np.linspace(0.0, np.pi, 200_001)  # phase of the pulse
    return float(np.abs((np.sin(t) - np.sin(ratio * t) / ratio) / (1 - 1 / ratio**2)).max())


@pytest.mark.parametrize("ratio", [1.5, 2.0, 3.0, 6.0])
def test_the_primary_response_to_a_half_sine(ratio):
    duration, dt = 0.05, 1e-4
    t = np.arange(0.0, duration + dt / 2, dt)
    pulse = 30.0 * np.sin(np.pi * t / duration)
    natural = np.array([ratio / (2 * duration)])
    found = shock_response(pulse, dt, natural, quality=1e6)[0]
    assert found == pytest.approx(30.0 * half_sine_maximum(ratio), rel=2e-3)


def test_the_classic_maximum_of_a_half_sine():
    """Undamped, 1.768 times the pulse at 1.62 times its frequency; slow oscillators swing afterwards: 2 r cos(pi r/2)/(1 - r^2)."""
    duration, dt = 0.05, 5e-5
    pulse = np.sin(np.pi * np.arange(0.0, duration + dt / 2, dt) / duration)
    ratios = np.linspace(1.4, 1.9, 101)
    found = shock_response(pulse, dt, ratios / (2 * duration), quality=1e6)
    assert found.max() == pytest.approx(1.768, abs=3e-3)
    assert ratios[found.argmax()] == pytest.approx(1.62, abs=0.02)
    slow = shock_response(pulse, dt, np.array([0.3 / (2 * duration)]), quality=1e6)[0]
    assert slow == pytest.approx(2 * 0.3 * np.cos(np.pi * 0.3 / 2) / (1 - 0.3**2), rel=3e-3)


def test_the_filter_is_exact_for_what_is_straight_between_samples():
    base = np.random.default_rng(2).normal(size=400)
    natural, quality, dt = 12.0, 10.0, 2e-3
    w = 2 * np.pi * natural
    system = scipy.signal.lti([w / quality, w**2], [1.0, w / quality, w**2])
    time = np.arange(len(base)) * dt
    _, motion, _ = scipy.signal.lsim(system, np.concatenate([[0.0], base]), np.concatenate([time, [time[-1] + dt]]))
    at_samples = np.abs(motion).max()
    assert shock_response(base, dt, np.array([natural]), quality)[0] >= at_samples * (1 - 1e-9)
    assert shock_response(np.append(base, 0.0), dt, np.array([natural]), quality)[0] == pytest.approx(at_samples, rel=0.1)


def test_a_stiff_oscillator_follows_its_base_and_resonance_amplifies_by_q():
    t = np.arange(0.0, 20.0, 1e-3)
    sine = 3.0 * np.sin(2 * np.pi * 4.0 * t)
    stiff, tuned = shock_response(sine, 1e-3, np.array([400.0, 4.0]))
    assert stiff == pytest.approx(3.0, rel=0.01)
    assert tuned == pytest.approx(3.0 * np.sqrt(1 + 10.0**2), rel=0.01)


def test_frequencies_end_where_samples_are_too_far_apart():
    assert spectrum_frequencies(1000.0)[-1] == pytest.approx(100.0, rel=0.13)
    assert spectrum_frequencies(1e5)[-1] <= 200.0
    assert spectrum_frequencies(100.0).max() <= 10.0
    np.testing.assert_allclose(spectrum_frequencies(1000.0)[::6][:4], [1.0, 2.0, 4.0, 8.0])
