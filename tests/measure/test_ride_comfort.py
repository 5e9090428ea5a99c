"""The weightings of ISO 2631-1 against its own tables, and what is told of a weighted sine against algebra."""

import numpy as np
import pytest

from vehgen.measure.ride_comfort import (
    WEIGHTINGS,
    WeightedVibration,
    evaluate_vibration,
    likely_reaction,
    reasons_to_doubt_rms,
    running_rms,
    weighted,
)

TABLE_3 = {
    "Wk": {0.5: 418, 0.8: 477, 1: 482, 1.25: 484, 1.6: 494, 2: 531, 2.5: 631, 3.15: 804, 4: 967, 5: 1039, 6.3: 1054, 8: 1036,
           10: 988, 12.5: 902, 16: 768, 20: 636, 25: 513, 31.5: 405, 40: 314, 50: 246, 63: 186, 80: 132},
    "Wd": {0.5: 853, 0.8: 992, 1: 1011, 1.25: 1008, 1.6: 968, 2: 890, 2.5: 776, 3.15: 642, 4: 512, 5: 409, 6.3: 323, 8: 253,
           10: 212, 12.5: 161, 16: 125, 20: 100, 25: 80, 31.5: 63.2, 40: 49.4, 50: 38.8, 63: 29.5, 80: 21.1},
}  # fmt: skip
"""Factors in thousandths at one-third-octave frequencies."""
MISPRINTED = {("Wd", 10)}
"""The table's 212 lies 5 % above the standard's own transfer function."""


@pytest.mark.parametrize("name", TABLE_3)
def test_weightings_are_those_of_the_standards_table(name):
    for nominal, thousandths in TABLE_3[name].items():
        if (name, nominal) not in MISPRINTED:
            found = abs(WEIGHTINGS[name].response(np.array([nominal])))[0]
            assert found == pytest.approx(thousandths / 1000, rel=0.01), nominal


def test_wb_follows_the_straight_lines_of_its_standard():
    """BS 6841:1987: 0.4 below 2 Hz, f/5 up to 5 Hz, 1 up to 16 Hz, 16/f above; the curve leaves them at their corners."""
    lines = {1.0: 0.4, 8.0: 1.0, 10.0: 1.0, 40.0: 0.4}
    found = abs(WEIGHTINGS["Wb"].response(np.array(list(lines))))
    np.testing.assert_allclose(found, list(lines.values()), rtol=0.08)


@pytest.mark.parametrize("rate", [100.0, 1000.0])
def test_a_weighted_sine_has_the_rms_vdv_and_crest_of_algebra(rate):
    t = np.arange(0.0, 200.0, 1 / rate)
    found = evaluate_vibration(2.0 * np.sin(2 * np.pi * 5.0 * t) + 9.81, 1 / rate, WEIGHTINGS["Wk"])
    amplitude = 2.0 * abs(WEIGHTINGS["Wk"].response(np.array([5.0])))[0]
    assert found.rms == pytest.approx(amplitude / np.sqrt(2), rel=2e-3)
    assert found.vdv == pytest.approx(amplitude * (200.0 * 3 / 8) ** 0.25, rel=2e-3)
    assert found.mtvv == pytest.approx(amplitude / np.sqrt(2), rel=0.02)
    assert found.crest == pytest.approx(np.sqrt(2), rel=0.05)


def test_the_largest_running_rms_is_that_of_the_loudest_second():
    values = np.zeros(1000)
    values[300:450] = 2.0
    running = running_rms(values, 0.01)
    assert running.max() == pytest.approx(2.0)
    assert running[350 - 1] == pytest.approx(2.0 * np.sqrt(0.5))
    assert running[-1] == 0.0


def test_a_rest_is_a_rest():
    found = evaluate_vibration(np.full(500, 9.81), 0.01, WEIGHTINGS["Wk"])
    assert (found.rms, found.mtvv, found.vdv) == (0.0, 0.0, 0.0)
    assert found.crest == 0.0


def test_nothing_wraps_around_from_the_end_to_the_beginning():
    values = np.zeros(2000)
    values[-50:] = 1.0
    assert abs(weighted(values, 0.01, WEIGHTINGS["Wk"])[:1500]).max() < 0.05 * values.max()


@pytest.mark.parametrize(
    ("rms", "reaction"),
    [
        (0.0, "not uncomfortable"),
        (0.31, "not uncomfortable"),
        (0.32, "a little uncomfortable"),
        (0.55, "a little uncomfortable or fairly uncomfortable"),
        (0.7, "fairly uncomfortable"),
        (0.9, "fairly uncomfortable or uncomfortable"),
        (1.1, "uncomfortable"),
        (1.4, "uncomfortable or very uncomfortable"),
        (1.8, "very uncomfortable"),
        (2.2, "very uncomfortable or extremely uncomfortable"),
        (2.6, "extremely uncomfortable"),
    ],
)
def test_reactions_overlap_as_in_the_standard(rms, reaction):
    """ISO 2631-1, C.2.3: less than 0.315, 0.315 to 0.63, 0.5 to 1, 0.8 to 1.6, 1.25 to 2.5, more than 2 m/s^2."""
    assert likely_reaction(rms) == reaction


@pytest.mark.parametrize(
    ("share", "measures"),
    [(0.5, 0), (0.4, 1), (0.2, 1), (0.14, 2), (0.03, 2), (0.02, 3)],
)
def test_an_rms_is_doubted_where_vibration_lasts_a_small_share_of_the_time(share, measures):
    """A sine of amplitude 1 for seconds of a rest: MTVV/RMS is p^(-1/2), VDV/(RMS T^(1/4)) (3/2p)^(1/4), the crest factor (2/p)^(1/2)."""
    rms, duration = np.sqrt(share / 2), 600.0
    found = WeightedVibration(rms, np.sqrt(0.5), (3 / 8 * share * duration) ** 0.25, 1 / rms)
    told = "".join(reasons_to_doubt_rms(found, duration))
    named = [name for name in ("MTVV over RMS", "VDV over RMS T^(1/4)", "weighted crest factor") if name in told]
    assert named == ["MTVV over RMS", "VDV over RMS T^(1/4)", "weighted crest factor"][:measures]
    if measures == 3:
        assert "MTVV over RMS 7.07 (above 1.5), VDV over RMS T^(1/4) 2.94 (above 1.75)" in told
