"""Where an answer lies over recordings: an oscillator on a random road, driven at a speed that wanders."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.signal

from vehgen.phones.clocks import TRUSTED, match

STEP, SPEED, DURATION = 0.01, 10.0, 25.0
PACE, DAMPING = 2 * np.pi * 4.0, 0.2


def road(seed):
    """Heights every centimetre of 400 m, a random walk that forgets after some metres."""
    return scipy.signal.lfilter([1.0], [1.0, -0.998], np.random.default_rng(seed).normal(0, 1e-3, 40_000))


def driven(heights, position):
    """The acceleration of an oscillator carried over a road, `shape (n, 1)`."""
    system = scipy.signal.TransferFunction([2 * DAMPING * PACE, PACE**2, 0, 0], [1.0, 2 * DAMPING * PACE, PACE**2, 0])
    numerator, denominator, _ = scipy.signal.cont2discrete((system.num, system.den), STEP)
    under = np.interp(position, 0.01 * np.arange(len(heights)), heights)
    return scipy.signal.lfilter(numerator.ravel(), denominator, np.gradient(under, STEP))[:, None]


def answer(scale):
    return driven(road(1), SPEED * scale * np.arange(0, DURATION, STEP))


def laid(seed, wander, near=None):
    """Lay the answer over a recording that begins 6 s before its road does, at a speed that wanders by a share of itself (rms)."""
    time = np.arange(-6.0, DURATION + 4.0, STEP)
    ahead = np.sqrt(2) * wander * 12 / (2 * np.pi) * (1 - np.cos(2 * np.pi * time / 12))
    recording = time + 6.0, driven(road(seed), np.clip(SPEED * (time + ahead), 0, None))
    return match([recording], answer, [slice(0, 1)], STEP, [near])[0]


@pytest.mark.parametrize(("wander", "tolerance"), [(0.0, 0.001), (0.015, 0.05)])
def test_a_long_road_is_found_though_the_speed_wanders(wander, tolerance):
    found = laid(1, wander)
    assert found.is_trusted
    assert (found.correlation < TRUSTED) == (wander > 0)
    assert found.shift == pytest.approx(6.0, abs=tolerance)
    assert found.scale == pytest.approx(1.0, abs=0.002)


def test_a_match_that_stands_out_need_not_be_good():
    assert replace(laid(1, 0.015), correlation=0.5, elsewhere=0.15).is_trusted
    assert not replace(laid(1, 0.015), correlation=0.5, elsewhere=0.25).is_trusted
    assert not replace(laid(1, 0.015), correlation=0.25, elsewhere=0.05).is_trusted


@pytest.mark.parametrize("seed", [2, 3, 4, 5])
def test_another_road_is_not_this_one(seed):
    assert not laid(seed, 0.0).is_trusted


def test_of_a_hump_only_the_correlation_tells():
    """Near a hump no other shifts are tried, with which the match could be compared."""
    found, near = laid(1, 0.02), laid(1, 0.02, (0.0, 12.0))
    assert near.correlation == pytest.approx(found.correlation)
    assert near.correlation < TRUSTED
    assert (found.elsewhere < 0.3, near.elsewhere) == (True, 1.0)
    assert not near.is_trusted
