"""Where an answer lies over recordings: oscillators on a random road, driven at a speed that wanders."""

from functools import partial

import numpy as np
import pytest
import scipy.signal

from vehgen.phones.clocks import TRUSTED, Match, match

STEP, SPEED = 0.01, 10.0
PACES, DAMPING = 2 * np.pi * np.array([3.0, 9.0]), 0.2


def road(seed):
    """Heights every centimetre of 400 m, a random walk that forgets after some metres."""
    return scipy.signal.lfilter([1.0], [1.0, -0.998], np.random.default_rng(seed).normal(0, 1e-3, 40_000))


def driven(heights, position):
    """The accelerations of two oscillators carried over a road, `shape (n, 2)`."""
    under = np.gradient(np.interp(position, 0.01 * np.arange(len(heights)), heights), STEP)
    found = []
    for pace in PACES:
        system = [2 * DAMPING * pace, pace**2, 0, 0], [1.0, 2 * DAMPING * pace, pace**2, 0]
        numerator, denominator, _ = scipy.signal.cont2discrete(system, STEP)
        found.append(scipy.signal.lfilter(numerator.ravel(), denominator, under))
    return np.column_stack(found)


def answer(duration, scale):
    return driven(road(1), SPEED * scale * np.arange(0, duration, STEP))


def laid(seed, wander, near=None, duration=25.0, before=6.0, after=4.0):
    """Lay the answer over a recording that begins before its road does [s], at a speed that wanders by a share of itself (rms)."""
    time = np.arange(-before, duration + after, STEP)
    ahead = np.sqrt(2) * wander * 12 / (2 * np.pi) * (1 - np.cos(2 * np.pi * time / 12))
    recording = time + before, driven(road(seed), np.clip(SPEED * (time + ahead), 0, None))
    return match([recording], partial(answer, duration), [slice(0, 2)], STEP, [near])[0]


@pytest.mark.parametrize(("wander", "tolerance"), [(0.0, 0.001), (0.012, 0.05)])
def test_a_long_road_is_found_though_the_speed_wanders(wander, tolerance):
    found = laid(1, wander)
    assert found.is_trusted
    assert (found.correlation < TRUSTED) == (wander > 0)
    assert found.shift == pytest.approx(6.0, abs=tolerance)
    assert found.scale == pytest.approx(1.0, abs=0.002)


@pytest.mark.parametrize("shift", [4.003, 3.997])
def test_a_shift_between_two_samples_is_found(shift):
    """A burst of 5 Hz, recorded so much later than it is expected."""

    def burst(t):
        return (np.exp(-(((t - 1.5) / 0.2) ** 2)) * np.sin(2 * np.pi * 5 * t))[:, None]

    time = np.arange(0, 10, STEP)
    (found,) = match([(time, burst(time - shift))], lambda scale: burst(np.arange(0, 3, STEP)), [slice(0, 1)], STEP, [(0.0, 8.0)])
    assert found.shift == pytest.approx(shift, abs=1e-3)
    assert found.correlation == pytest.approx(1.0, abs=0.02)


@pytest.mark.parametrize(
    ("correlation", "backwards", "trusted"),
    [(0.62, 0.5, True), (0.58, 0.25, False), (0.5, 0.15, True), (0.4, 0.15, False), (0.35, 0.05, True), (0.3, 0.05, False)],
)
def test_a_match_is_trusted_by_itself_or_beside_what_chance_does(correlation, backwards, trusted):
    """From 0.6 on; below, where it is three times as good as the same answer backwards, and a third."""
    assert Match(0.0, correlation, 1.0, backwards, ()).is_trusted is trusted


@pytest.mark.thorough
@pytest.mark.parametrize("seed", [2, 3, 4, 6])
@pytest.mark.parametrize(("duration", "before", "after"), [(25.0, 6.0, 4.0), (6.0, 1.0, 2.0), (6.0, 6.0, 6.0)])
def test_another_road_is_not_this_one(seed, duration, before, after):
    """Compared with shifts far from the best, of which a recording of 9 s has few, two of these were taken for passes over this road."""
    assert not laid(seed, 0.0, duration=duration, before=before, after=after).is_trusted


def test_of_a_hump_only_the_correlation_tells():
    """Near a hump no other shifts are tried, with which the match could be compared."""
    found, near = laid(1, 0.02), laid(1, 0.02, (0.0, 12.0))
    assert near.correlation == pytest.approx(found.correlation)
    assert near.correlation < TRUSTED
    assert (found.backwards < 0.3, near.backwards) == (True, 1.0)
    assert not near.is_trusted


def test_how_loud_a_channel_is_beside_its_prediction():
    """One recorded twice as loud, and one that is predicted to rest, of which nothing is said."""
    time = np.arange(-2.0, 22.0, STEP)
    recorded = 2 * np.interp(time, np.arange(0, 20.0, STEP), answer(20.0, 1.0)[:, 0], left=0.0, right=0.0)
    noise = np.random.default_rng(3).standard_normal(len(time))
    resting = partial(answer, 20.0)
    (found,) = match([(time, np.column_stack([recorded, noise]))], lambda scale: resting(scale) * [1.0, 0.0], [slice(0, 2)], STEP, [None])
    assert found.shift == pytest.approx(0.0, abs=STEP)
    assert found.loudness == pytest.approx((2.0, 1.0), rel=0.02)
