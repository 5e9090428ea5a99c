"""Humps found and refused, GPS speeds, clipping."""

import re

import numpy as np
import pytest

from vehgen.errors import InputError
from vehgen.phones.export import Stream
from vehgen.phones.gps import crossing_speed
from vehgen.phones.hump_event import expected_onset, find_hump
from vehgen.phones.importing import clipping_warnings

T = np.arange(0, 25, 0.01)


def crossing(noise=0.05, seed=0, axles=(8.0, 9.7, 10.4, 12.0)):
    values = np.random.default_rng(seed).normal(0, noise, len(T))
    for start in axles:
        late = np.maximum(T - start, 0)
        values += 2.0 * np.exp(-2 * late) * np.sin(2 * np.pi * 3 * late) * (start < T)
    return values


@pytest.mark.parametrize("seed", range(5))
def test_the_onset_is_the_first_axle(seed):
    event = find_hump(T, crossing(seed=seed), 4.5, "phone")
    assert event.onset == pytest.approx(8.0, abs=0.03)
    assert event.contrast > 10


@pytest.mark.parametrize(("noise", "found"), [(0.25, True), (0.6, False)])
def test_a_hump_stands_out_from_a_road_a_sixth_as_loud_but_not_from_one_a_third_as_loud(noise, found):
    if found:
        event = find_hump(T, crossing(noise), 4.5, "phone")
        assert event.contrast == pytest.approx(6.0, abs=0.6)
        assert event.onset == pytest.approx(8.0, abs=0.05)
        return
    with pytest.raises(InputError, match="shows no hump"):
        find_hump(T, crossing(noise), 4.5, "phone")


@pytest.mark.parametrize("noise", [0.003, 0.01, 0.03])
def test_the_energy_of_an_answer_is_expected_to_set_in_where_noise_lets_it_be_seen(noise):
    """It grows by e a second; without noise it would set in where it begins."""
    answer = np.where(T < 12, np.exp(T - 12), np.exp(-2 * (T - 12))) * np.sin(2 * np.pi * 3 * T)
    event = find_hump(T, answer + np.random.default_rng(0).normal(0, noise, len(T)), 9.0, "phone")
    assert expected_onset(answer, 0.01, event.contrast) == pytest.approx(event.onset, abs=0.4)


def test_handling_the_phone_long_before_is_passed_over():
    values = crossing()
    values[50:150] += np.random.default_rng(1).normal(0, 1.0, 100)
    assert find_hump(T, values, 4.5, "phone").onset == pytest.approx(8.0, abs=0.03)


@pytest.mark.parametrize(("share", "first", "other"), [(0.9, 8.0, 30.0), (1.1, 30.0, 8.0), (0.5, 8.0, None)])
def test_another_pass_as_loud_is_told(share, first, other):
    time = np.arange(0, 50, 0.01)
    values = np.r_[crossing(), np.zeros(len(T))] + share * np.r_[np.zeros(2200), crossing(seed=1), np.zeros(300)]
    event = find_hump(time, values, 4.5, "phone")
    assert event.onset == pytest.approx(first, abs=0.05)
    told = re.match(r"phone: \d+% as loud at ([\d.]+) s as in the pass from ([\d.]+) s, which is taken", " ".join(event.warnings))
    assert [float(text) for text in told.groups()] == pytest.approx([other + 2, event.onset], abs=2.5) if other else told is None
    assert find_hump(T, crossing(), 4.5, "phone").warnings == ()


@pytest.mark.parametrize("seed", range(5))
def test_a_rough_road_without_a_hump_is_refused(seed):
    with pytest.raises(InputError, match="shows no hump: its loudest moment"):
        find_hump(T, np.random.default_rng(seed).normal(0, 0.3, len(T)), 4.5, "phone")


def test_driving_off_without_a_hump_is_refused():
    values = np.random.default_rng(0).normal(0, 1, len(T)) * np.where(T > 6, 1.0, 0.01)
    with pytest.raises(InputError, match="shows no hump"):
        find_hump(T, values, 4.5, "phone")


def test_a_recording_that_begins_on_the_hump_is_refused():
    late = T > 7.8
    with pytest.raises(InputError, match=r"no 1 s of quiet before|shows no hump"):
        find_hump(T[late], crossing()[late], 4.5, "phone")


def gps(values):
    values = np.asarray(values, dtype=float)
    return Stream(np.arange(len(values)) + 0.5, values[:, None], ("speed",), "m/s")


def test_gps_speed_is_the_median_of_valid_readings_in_the_crossing():
    found = crossing_speed(gps([0, 0, -1, 2.0, 2.1, 1.9, np.nan, 9.0]), 2.0, 7.0, "phone")
    assert (found.median, found.low, found.high, found.count) == (2.0, 1.9, 2.1, 3)
    assert found.deviation == pytest.approx(0.1 / np.sqrt(3))
    assert crossing_speed(gps([0.4, 0.5, 0.5]), 0.0, 5.0, "phone").median == 0.5


def test_a_speed_that_changes_in_the_pass_is_known_less_well():
    """Even from the lowest reading to the highest it would scatter by their distance over the root of 12."""
    steady, changing = (crossing_speed(gps(values), 0.0, 5.0, "phone") for values in ([2.0, 2.3, 1.9], [2.6, 3.5]))
    assert not steady.changes
    assert changing.changes
    assert changing.deviation_in_pass == pytest.approx(np.sqrt(0.1**2 / 2 + 0.9**2 / 12))
    assert steady.deviation_in_pass == steady.deviation == pytest.approx(0.1 / np.sqrt(3))
    assert not crossing_speed(gps([20.0, 21.5]), 0.0, 5.0, "phone").changes


def test_a_reading_that_a_logger_repeats_counts_once():
    rows = np.repeat([2.0, 2.1, 2.1], 100)
    stream = Stream(np.arange(300) / 100, rows[:, None], ("speed",), "m/s")
    assert crossing_speed(stream, 0.0, 5.0, "phone").count == 2
    assert crossing_speed(gps([2.1, 2.1, 2.1]), 0.0, 5.0, "phone").count == 3


def test_of_a_moving_vehicle_the_readings_at_rest_do_not_count():
    values = [4.0, 4.1, 0.05, 0.02, 0.0, 0.1]
    assert crossing_speed(gps(values), 0.0, 9.0, "phone", moving=True).median == pytest.approx(4.05)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (None, "recorded no GPS speed"),
        ([-1, -1, -1], "no valid GPS speed"),
        ([0, 0, 0.1], "cannot be"),
        ([900, 900], "cannot be"),
        ([70, 70], "cannot be"),
    ],
)
def test_no_speed_asks_for_one(values, message):
    with pytest.raises(InputError, match=rf"{message}.*give `speed`"):
        crossing_speed(None if values is None else gps(values), 0.0, 5.0, "phone")


def test_clipping_is_found_at_the_extreme_only():
    values = np.column_stack([crossing(), crossing(seed=1)])
    values[:, 1] = np.clip(values[:, 1], -5.0, 1.5)
    (found,) = clipping_warnings("phone", Stream(T, values, ("x", "z"), "m/s^2"))
    assert "acceleration z is clipped at 1.5 m/s^2 from 8." in found
