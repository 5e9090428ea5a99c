"""Noise floors and flat tops of channels."""

import numpy as np
import pytest
import scipy.stats

from vehgen.measure.quality import Clipping, find_clipping, has_cut, in_foreign_unit, noise_floor


def test_noise_floor_of_white_noise_and_of_an_engine():
    noise = np.random.default_rng(2).normal(0, 0.02, 1500)
    t = np.arange(1500) * 0.01
    quiet, engine = noise_floor(noise, 0.01, 100.0), noise_floor(noise + 0.1 * np.sin(2 * np.pi * 27 * t), 0.01, 100.0)
    assert quiet.sigma == pytest.approx(0.02, rel=0.06)
    assert quiet.band_sigma == pytest.approx(0.02, rel=0.2)
    assert quiet.band == (47.0, 50.0)
    assert engine.sigma > 3 * engine.band_sigma
    assert engine.band_sigma == pytest.approx(0.02, rel=0.2)
    assert noise_floor(noise, 0.01, 60.0).band == (27.0, 30.0)
    assert noise_floor(noise, 0.002, 500.0).band == (47.0, 50.0)


def ringing(n=2000):
    t = np.arange(n) * 0.01
    return np.sin(2 * np.pi * 1.3 * t) * np.exp(-((t - 10) ** 2)) + np.random.default_rng(4).normal(0, 1e-3, n)


def test_a_clipped_channel_has_a_flat_top_on_the_side_that_was_clipped():
    values = ringing()
    assert find_clipping(values, 3) == ()
    clipped = np.minimum(values, 0.5)
    (found,) = find_clipping(clipped, 3)
    assert found == Clipping(0.5, int((values >= 0.5).sum()), int(np.argmax((values >= 0.5)[:-2] & (values >= 0.5)[1:-1])))
    assert [item.level for item in find_clipping(np.clip(values, -0.4, 0.5), 3)] == [0.5, -0.4]


def test_rest_and_a_constant_are_no_clipping():
    assert find_clipping(np.full(50, 3.0), 3) == ()
    still = np.where(np.arange(200) < 100, 0.0, -np.abs(np.random.default_rng(1).normal(1, 0.2, 200)))
    assert find_clipping(still, 3) == ()
    assert [item.level for item in find_clipping(still, 3, rest=None)] == [0.0]


def test_what_rules_out_a_coarse_and_a_quantised_channel():
    square = np.tile([1.0, 1.0, 1.0, -1.0, -1.0, -1.0], 20)
    assert len(find_clipping(square, 3)) == 2
    assert find_clipping(square, 3, min_deviation=4.0) == ()
    coarse = np.round(ringing() / 0.25) * 0.25
    assert find_clipping(coarse, 2)
    assert find_clipping(coarse, 2, min_pile_up=4) == ()
    piled = np.array([0.0, 1.0, 2.0, 2.0, 2.0, 2.0, 1.0, 0.0, -1.0])
    assert [item.level for item in find_clipping(piled, 2, min_pile_up=2)] == [2.0]
    assert find_clipping(piled, 2, min_pile_up=2.1) == ()


def swept(seed, noise, step):
    """A slow sweep whose peaks are about equally high, with noise, rounded to a resolution."""
    t = np.arange(2000) * 0.004
    values = np.sin(2 * np.pi * (1 + 0.3 * t) * t) * (1 + 0.02 * t) + np.random.default_rng(seed).normal(0, noise, len(t))
    return np.round(values / step) * step


@pytest.mark.parametrize(("noise", "step"), [(0.015, 0.003), (0.003, 0.003), (0.001, 0.01), (0.0, 0.01)])
def test_equal_samples_on_a_round_top_have_cut_nothing(noise, step):
    every = [values for seed in range(100) for values in [swept(seed, noise, step)]]
    tops = [(values, item) for values in every for item in find_clipping(values, 2)]
    assert len(tops) >= 4
    assert not any(has_cut(*item) for item in tops)


@pytest.mark.parametrize("depth", [0.1, 0.3])
def test_what_was_cut_off_is_seen_through_noise(depth):
    for seed in range(20):
        values = swept(seed, 0.005, 1e-6)
        (top,) = find_clipping(np.minimum(values, values.max() - depth), 2)
        assert has_cut(np.minimum(values, values.max() - depth), top)


@pytest.mark.parametrize(("noises", "cut"), [(12, True), (6, False)])
def test_what_lies_some_noises_above_a_flat_top_was_cut_off(noises, cut):
    """The flanks are those of a parabola, whose top lies 0.16 above where it is flat."""
    place = np.arange(-10, 11)
    values = np.random.default_rng(5).normal(0, 0.16 / noises, 4000)
    values[1000:1021] = np.minimum(1 - (place / 10) ** 2, 0.84)
    assert has_cut(values, Clipping(0.84, 9, 1006)) is cut
    assert has_cut(-values, Clipping(-0.84, 9, 1006)) is cut


@pytest.mark.parametrize(("share", "cut"), [(0.45, False), (0.55, False), (0.75, True)])
def test_a_top_is_flat_by_more_than_chance_where_it_holds_more_than_a_round_one(share, cut):
    """A parabola is 5 steps lower at root 5 times the distance at which it is one step lower, so 45 % are expected in the first step."""
    count = round(100 * share)
    beside = (np.arange(100 - count) % 4 + 1.0)[np.argsort(np.arange(100 - count) % 4, kind="stable")]
    values = np.r_[-np.arange(40.0, 4.0, -1.0), -beside[::-1], np.zeros(count), -np.arange(5.0, 41.0)]
    by_chance = scipy.stats.binom.sf(count - 1, 100, 1 / np.sqrt(5))
    assert (by_chance < 1e-6) is np.bool_(cut)
    assert has_cut(values, Clipping(0.0, count, 36)) is cut


@pytest.mark.parametrize(("loudness", "foreign"), [(9.81, True), (57.3, True), (5.0, True), (3.0, False), (2.0, False), (1.0, False)])
def test_a_channel_is_in_another_unit_where_no_gain_is_so_large(loudness, foreign):
    """Gravities for m/s^2, degrees for radians; a gain of 2 or 3 is still a gain."""
    assert in_foreign_unit(loudness) is foreign
    assert in_foreign_unit(1 / loudness) is foreign
