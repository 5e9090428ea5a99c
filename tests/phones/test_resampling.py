"""Uneven clocks against signals known in closed form."""

import numpy as np
import pytest
import scipy.signal

from vehgen.errors import InputError
from vehgen.phones.export import Stream
from vehgen.phones.resampling import check_rate, clean, gaps, resample

TONES = [(1.0, 1.3, 0.1), (0.7, 4.7, 1.0), (1.0, 11.9, 2.0), (0.5, 17.3, 0.4), (1.0, 20.0, 0.9)]


def signal(t):
    return sum(a * np.sin(2 * np.pi * f * t + p) for a, f, p in TONES)


def clock(rate, jitter, seconds=8.0, seed=1):
    n = int(seconds * rate)
    return (np.arange(n) + jitter * np.random.default_rng(seed).uniform(-0.5, 0.5, n)) / rate


@pytest.mark.parametrize("jitter", [0.0, 0.3, 0.8])
@pytest.mark.parametrize("rate", [59.4, 100.0, 100.7, 208.0, 400.0])
def test_pass_band_error_is_far_below_one_percent(rate, jitter):
    t = clock(rate, jitter)
    grid = np.arange(1.0, 7.0, 0.01)
    found = resample(t, signal(t)[:, None], grid)[:, 0]
    assert np.abs(found - signal(grid)).max() < 5e-4 * np.abs(signal(grid)).max()


def test_channels_are_independent():
    t, grid = clock(100.0, 0.3), np.arange(1.0, 3.0, 0.01)
    both = resample(t, np.column_stack([signal(t), 5 + 0 * t]), grid)
    assert both[:, 0] == pytest.approx(resample(t, signal(t)[:, None], grid)[:, 0], abs=1e-9)
    assert both[:, 1] == pytest.approx(5.0)


def test_what_the_grid_cannot_hold_does_not_fold_into_it():
    t = clock(400.0, 0.2)
    grid = np.arange(2.0, 6.0, 0.01)
    for tone in (53.0, 80.0, 130.0):
        found = resample(t, np.sin(2 * np.pi * tone * t)[:, None], grid)[:, 0]
        assert found.std() < 2e-3, tone


def test_white_noise_keeps_its_level_up_to_the_nyquist_frequency():
    t = clock(100.0, 0.15, 100.0)
    noise = np.random.default_rng(3).normal(0, 1, len(t))
    grid = np.arange(2.0, 98.0, 0.01)
    frequency, density = scipy.signal.welch(resample(t, noise[:, None], grid)[:, 0], 100.0, nperseg=200)
    for low, high in ((5, 20), (20, 40), (47, 49.5)):
        assert density[(frequency > low) & (frequency < high)].mean() == pytest.approx(0.02, rel=0.2)


def test_a_grid_beyond_the_samples_is_refused():
    t = clock(100.0, 0.0, 5.0)
    with pytest.raises(InputError, match="a longer recording is needed"):
        resample(t, t[:, None], np.arange(0.0, 6.0, 0.01))


def test_cleaning_drops_sorts_and_says_so():
    t = np.arange(400) * 0.01
    values = np.sin(t)[:, None].copy()
    values[[3, 4]] = np.nan
    t[[10, 11]] = t[[11, 10]]
    t[20] = t[19]
    padded = Stream(np.append(t, [np.nan] * 3), np.vstack([values, np.full((3, 1), np.nan)]), ("x",), "m/s^2")
    found, notes = clean(padded, "phone")
    assert notes == (
        "phone: 2 missing samples were dropped",
        "phone: 1 samples were out of order and 1 repeated; sorted, the first of each kept",
    )
    assert len(found.time) == 397
    assert (np.diff(found.time) > 0).all()


def test_a_clock_that_runs_backwards_is_refused():
    t = np.arange(200)[::-1] * 0.01
    with pytest.raises(InputError, match="is it the time column"):
        clean(Stream(t, t[:, None], ("x",), "m/s^2"), "phone")


@pytest.mark.parametrize(("swapped", "usable"), [(5, True), (20, False)])
def test_a_clock_may_run_backwards_once_in_a_hundred_samples(swapped, usable):
    t = np.arange(1000) * 0.01
    first = 10 + 45 * np.arange(swapped)
    t[first], t[first + 1] = t[first + 1], t[first]
    stream = Stream(t, t[:, None], ("x",), "m/s^2")
    if usable:
        assert len(clean(stream, "phone")[0].time) == 1000
        return
    with pytest.raises(InputError, match=f"{swapped} times run backwards and 0 are repeated, of 1000: is it the time column"):
        clean(stream, "phone")


@pytest.mark.parametrize("length", [500, 150])
def test_two_recordings_in_one_file_are_refused(length):
    first, second = np.arange(700) * 0.01, np.arange(length) * 0.01 + 0.0037
    t = np.concatenate([first, second])
    with pytest.raises(InputError, match="phone: at its sample 701 the clock goes back, and on from there: two recordings in one file"):
        clean(Stream(t, t[:, None], ("x",), "m/s^2"), "phone")


def test_one_wrong_time_or_batches_that_change_places_are_no_second_recording():
    t = np.arange(6000) * 0.01
    wrong = t.copy()
    wrong[2000] += 5.003
    swapped = np.concatenate([t[:1000], t[1200:1400], t[1000:1200], t[1400:]])
    for times in (wrong, swapped):
        found, _ = clean(Stream(times, times[:, None], ("x",), "m/s^2"), "phone")
        np.testing.assert_array_equal(found.time, np.sort(times))


def test_slow_logs_are_refused_with_the_rate_needed():
    with pytest.raises(InputError, match=r"logged at 2.5 Hz; at least 50 Hz is needed to see up to 25 Hz"):
        check_rate(np.arange(100) / 2.5, 25.0, "phone")
    with pytest.raises(InputError, match=r"logged at 0.1 Hz, if its times are in s; state `time_unit=ms`"):
        check_rate(np.arange(100) * 10.0, 25.0, "phone")
    assert check_rate(clock(59.4, 0.4), 25.0, "phone") == pytest.approx(59.4, rel=0.02)
    assert check_rate(np.arange(100) / 49.6, 25.0, "phone") == pytest.approx(49.6)  # a clock may be a little slow
    with pytest.raises(InputError, match="logged at 48 Hz; at least 50 Hz is needed"):
        check_rate(np.arange(100) / 48.0, 25.0, "phone")


def test_gaps_are_found():
    t = np.delete(np.arange(500) * 0.01, range(200, 230))
    assert gaps(t) == [pytest.approx((1.99, 0.31))]
    assert gaps(np.delete(np.arange(500) * 0.01, [200, 201, 300, 301, 302, 303])) == [pytest.approx((2.99, 0.05))]
