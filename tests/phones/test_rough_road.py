"""Phones on one drive over a rough road, put on one clock by what they recorded alone."""

import numpy as np
import pytest

from tests.measure.rough_half_car import PLACES, SEDAN, drive
from vehgen.commands import main
from vehgen.errors import InputError
from vehgen.phones import PhoneSensor
from vehgen.phones.rough_road import read_drive

from .rough_phones import write_phone

SENSORS = (PhoneSensor("F", ""), PhoneSensor("R", ""))
EPOCH = 1.7e9


@pytest.fixture(scope="module")
def motion():
    return drive(SEDAN, 200.0, 15.0, 3)


@pytest.fixture(scope="module")
def front(motion, tmp_path_factory):
    time, values = motion
    return write_phone(tmp_path_factory.mktemp("front") / "front.zip", time, values[:, 0], values[:, 2], 15.0, 1, start=EPOCH)


def write_rear(folder, motion, **options):
    time, values = motion
    return write_phone(folder / "rear.zip", time, values[:, 1], values[:, 2], seed=2, **options)


@pytest.mark.thorough
@pytest.mark.parametrize(("shift", "drift"), [(0.0, 0.0), (7.3, 8e-5), (40.0, -1.2e-4), (12.0, 9e-4)])
def test_clocks_are_found_without_epochs(tmp_path, motion, front, shift, drift):
    """What is read is the motion itself: the rear place's, later by the way from axle to axle, which no recording can tell."""
    found = read_drive([front, write_rear(tmp_path, motion, shift=shift, drift=drift)], SENSORS, 20.0, 8.0)
    assert [channel.name for channel in found.channels] == ["F_az", "R_az"]
    travel = np.sum(np.abs([*PLACES.values()])) / 15.0
    note = next(text for text in found.notes if "its clock is" in text)
    told = float(note.split("its clock is ")[1].split(" s ")[0])
    assert -0.02 <= told - (shift + drift * float(found.time[-1]) / 2) <= travel + 0.05
    assert float(note.split("runs ")[1].split(" ")[0]) == pytest.approx(1e6 * drift, abs=4)
    assert found.warnings == ()
    assert found.gps is not None
    assert np.unique(found.gps[1]) == pytest.approx(15.0)


@pytest.mark.thorough
@pytest.mark.parametrize("drift", [4e-4, -9e-4])
def test_the_shift_is_that_in_the_middle_of_the_drive(tmp_path, motion, front, drift):
    """Both lay at one place, so that no way from axle to axle is in it; the piece that fits best without the drift is elsewhere."""
    time, values = motion
    beside = write_phone(tmp_path / "beside.zip", time, values[:, 0], values[:, 2], seed=2, shift=12.0, drift=drift)
    found = read_drive([front, beside], SENSORS, 20.0, 8.0)
    note = next(text for text in found.notes if "its clock is" in text)
    told = float(note.split("its clock is ")[1].split(" s ")[0])
    assert told == pytest.approx(12.0 + drift * float(time[-1]) / 2, abs=0.01)


@pytest.mark.thorough
def test_clocks_that_may_differ_by_more_than_is_looked_for_are_warned_of(tmp_path, motion, front):
    found = read_drive([front, write_rear(tmp_path, motion, drift=1.3e-3)], SENSORS, 20.0, 8.0)
    (warning,) = found.warnings
    assert "their clocks differ by 100" in warning
    assert "or more, the most that is looked for" in warning


@pytest.mark.thorough
def test_a_pitch_rate_is_read_where_forward_is_said(tmp_path, motion, front):
    time, values = motion
    found = read_drive([front], [PhoneSensor("F", "", forward="y")], 20.0, 8.0)
    assert [(channel.name, channel.unit) for channel in found.channels] == [("F_az", "m/s^2"), ("F_q", "rad/s")]
    true = np.column_stack([np.interp(found.time + 0.055, time, values[:, i]) for i in (0, 2)])
    assert np.corrcoef(found.values[:, 1], true[:, 1])[0, 1] > 0.98


@pytest.mark.thorough
def test_holes_are_told_not_refused(tmp_path, motion, front):
    found = read_drive([front, write_rear(tmp_path, motion, shift=2.0, hole=(80.0, 80.4))], SENSORS, 20.0, 8.0)
    assert len(found.holes) == 1
    assert found.holes[0][1] - found.holes[0][0] == pytest.approx(0.4, abs=0.03)
    assert found.holes[0][0] == pytest.approx(78.0, abs=0.3)


def test_recordings_of_two_drives_are_refused(tmp_path, front):
    time, values = drive(SEDAN, 200.0, 15.0, 4)
    other = write_phone(tmp_path / "other.zip", time, values[:, 1], values[:, 2], seed=2)
    with pytest.raises(InputError, match="nothing in common at any shift of their clocks"):
        read_drive([front, other], SENSORS, 20.0, 8.0)


def test_recordings_at_different_times_are_refused(tmp_path, motion, front):
    with pytest.raises(InputError, match=r"the later began (99|100)(\.\d+)? s after the other had ended"):
        read_drive([front, write_rear(tmp_path, motion, start=EPOCH + 300.0)], SENSORS, 20.0, 8.0)


@pytest.mark.thorough
def test_a_world_clock_that_is_off_is_told(tmp_path, motion, front):
    found = read_drive([front, write_rear(tmp_path, motion, shift=3.0, start=EPOCH + 9.0)], SENSORS, 20.0, 8.0)
    assert "are both of one drive?" in found.warnings[0]


def test_recordings_that_hardly_overlap_are_refused(tmp_path, motion, front):
    time, values = motion
    short = write_phone(tmp_path / "short.zip", time[:2000], values[:2000, 1], values[:2000, 2], seed=2)
    with pytest.raises(InputError, match="at least 32 s together are needed: record longer"):
        read_drive([front, short], SENSORS, 20.0, 8.0)


def test_a_phone_too_slow_for_the_band_is_refused(tmp_path, motion, front):
    slow = write_rear(tmp_path, motion, rate=25.0)
    with pytest.raises(InputError, match=r"rear\.zip: acceleration was logged at 25 Hz; at least 40 Hz is needed"):
        read_drive([front, slow], SENSORS, 20.0, 8.0)
    assert read_drive([front, slow], SENSORS, 12.0, 8.0).values.shape[1] == 2


def test_an_import_without_a_road_names_the_other_command(tmp_path, front, capsys):
    assert main(["import", str(front), "--vehicle", "sedan2", "--sensor", "F:body=body,x=0", "--out", str(tmp_path / "run.yaml")]) == 2
    error = capsys.readouterr().err
    assert "--hump or --profile was expected, neither was found" in error
    assert "`vehgen transmissibility`" in error
    assert "record one pass over a known hump" in error
    assert not (tmp_path / "run.yaml").exists()
