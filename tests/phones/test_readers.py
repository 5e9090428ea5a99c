"""Exports come back as the arrays they were written from, whatever the dialect and the file names."""

import zipfile
from pathlib import Path

import numpy as np
import pytest

from vehgen.commands.option_strings import read_column_map
from vehgen.errors import InputError
from vehgen.phones import ColumnMap, EpochMap, PhoneSensor, read_export
from vehgen.phones.importing import read_phones

from .exports import SEPARATORS, SHARED, phyphox, sensor_logger, still, table, write_folder, write_zip


@pytest.mark.parametrize("dialect", SEPARATORS)
def test_phyphox_dialects(tmp_path, dialect):
    t, force, rotation = still()
    export = read_export(write_zip(tmp_path / "a.zip", phyphox(t, force, rotation, dialect, speed=2.5)))
    assert export.app == "phyphox"
    assert export.streams["acceleration"].values == pytest.approx(force, abs=1e-8)
    assert export.streams["rotation"].values == pytest.approx(rotation, abs=1e-8)
    assert export.streams["acceleration"].time == pytest.approx(t)
    assert export.streams["speed"].values == pytest.approx(2.5)
    assert export.epoch.at(1.5) == pytest.approx(1_700_000_001.5)


@pytest.mark.parametrize("dialect", SEPARATORS)
@pytest.mark.parametrize(
    ("words", "level", "kind"), [("Linear Acceleration", 0.0, "linear_acceleration"), ("Beschleunigung", 9.8, "acceleration")]
)
def test_phyphox_single_experiment_padded_with_nan(tmp_path, dialect, words, level, kind):
    t, force, _ = still()
    force = force - [0, 0, 9.81 - level]
    t[-5:] = force[-5:] = np.nan
    header = ["Time (s)", *(f"{words} {axis} (m/s^2)" for axis in "xyz"), "Absolute acceleration (m/s^2)"]
    text = table(header, [t, force, np.linalg.norm(force, axis=1)], dialect)
    export = read_export(write_folder(tmp_path, {"Raw Data.csv": text}))
    assert list(export.streams) == [kind]
    assert export.streams[kind].values[:-5] == pytest.approx(force[:-5], abs=1e-8)
    assert np.isnan(export.streams[kind].values[-5:]).all()


def test_pauses_shift_the_epoch():
    clock = EpochMap(np.array([0.0, 10.0]), np.array([100.0, 150.0]))
    assert [clock.at(t) for t in (-1.0, 9.0, 10.0, 12.0)] == [99.0, 109.0, 150.0, 152.0]


def test_sensor_logger_columns_are_z_first(tmp_path):
    t, force, rotation = still()
    export = read_export(write_zip(tmp_path / "a.zip", sensor_logger(t, force, rotation)))
    assert export.app == "Sensor Logger"
    assert export.streams["acceleration"].values == pytest.approx(force, abs=1e-6)
    assert export.streams["rotation"].values == pytest.approx(rotation, abs=1e-6)
    assert export.epoch.at(0.25) == pytest.approx(1_700_000_000.25, abs=1e-6)
    assert export.acceleration_sign is None


@pytest.mark.parametrize(
    ("metadata", "sign"), [(("android", "false"), 1), (("ios", "true"), 1), (("ios", "false"), -1), (("web", ""), None)]
)
def test_sensor_logger_metadata_tells_the_sign(tmp_path, metadata, sign):
    export = read_export(write_zip(tmp_path / "a.zip", sensor_logger(*still(), metadata=metadata)))
    assert export.acceleration_sign == sign


def test_two_exports_in_one_folder_are_refused(tmp_path):
    t, force, rotation = still()
    files = sensor_logger(t, force, rotation)
    folder = write_folder(tmp_path / "day", {f"{run}/{name}": text for run in ("first", "second") for name, text in files.items()})
    with pytest.raises(InputError, match=r"holds 'first/.*' and 'second/.*': the export of one recording was expected"):
        read_export(folder)
    assert "acceleration" in read_export(folder / "first").streams
    beside = write_folder(tmp_path / "beside", {**files, "raw/notes.txt": "a,b\n1,2\n", "processed/notes.txt": "a,b\n1,2\n"})
    assert "acceleration" in read_export(beside).streams


@pytest.mark.parametrize("text", ["", "time,seconds_elapsed,z,y,x\n"])
def test_a_file_that_holds_nothing_is_told(tmp_path, text):
    files = sensor_logger(*still())
    export = read_export(write_zip(tmp_path / "a.zip", {**files, "Gyroscope.csv": text}))
    assert "rotation" not in export.streams
    assert [note for note in export.notes if ("Gyroscope.csv is empty" if not text else "no sample of rotation") in note]


def test_one_export_for_two_sensors_is_refused(tmp_path):
    sensors = [PhoneSensor("L1", "tractor", forward="y"), PhoneSensor("L2", "semitrailer", forward="y")]
    one, other = (write_zip(tmp_path / f"{i}.zip", sensor_logger(*still(2000, seed=i))) for i in range(2))
    with pytest.raises(InputError, match=r"L1 \(0.zip\) and L2 \(0.zip\) recorded the same numbers"):
        read_phones([one, one], sensors, None, 25.0)
    assert len(read_phones([one, other], sensors, None, 25.0)) == 2


def test_sensor_logger_without_gravity(tmp_path):
    t, force, rotation = still()
    files = sensor_logger(t, force - [0, 0, 9.81], rotation, names=("Accelerometer", "Gyroscope"))
    assert set(read_export(write_folder(tmp_path, files)).streams) == {"linear_acceleration", "rotation"}


def test_apps_are_told_by_header_not_by_name(tmp_path):
    t, force, rotation = still()
    files = phyphox(t, force, rotation)
    renamed = {"TotalAcceleration.csv": files["Accelerometer.csv"], "Metadata.csv": files["Gyroscope.csv"]}
    export = read_export(write_zip(tmp_path / "sensorlogger.zip", renamed))
    assert export.app == "phyphox"
    assert set(export.streams) == {"acceleration", "rotation"}


def test_plain_csv_with_a_column_map(tmp_path):
    t, force, rotation = still()
    path = tmp_path / "log.csv"
    path.write_text(table(["ms", "up", "pitch", "v"], [1000 * t, force[:, 2] / 9.80665, np.degrees(rotation[:, 1]), 7.2 + 0 * t], quote=""))
    columns = read_column_map(
        "time=ms,time_unit=ms,acceleration=up,acceleration_unit=g,pitch_rate=-pitch,pitch_rate_unit=deg/s,speed=v,speed_unit=km/h"
    )
    export = read_export(path, columns)
    assert export.streams["vertical_acceleration"].time == pytest.approx(t)
    assert export.streams["vertical_acceleration"].values[:, 0] == pytest.approx(force[:, 2])
    assert export.streams["pitch_rate"].values[:, 0] == pytest.approx(-rotation[:, 1])
    assert export.streams["speed"].values == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ("10,1,2,3", "log.csv:3:4: 4 cells below 3 headings"),
        ("0,01,1,0,2,0", "log.csv:3:4: 6 cells below 3 headings; where each number is in two of them for its decimal comma, separate"),
    ],
)
def test_a_row_of_more_cells_than_headings_is_refused(tmp_path, row, said):
    (tmp_path / "log.csv").write_text(f"t,az,q\n0,0,0\n{row}\n20,1,2,\n")
    with pytest.raises(InputError, match=said):
        read_export(tmp_path / "log.csv", ColumnMap("t", "az"))


@pytest.mark.parametrize("above", ["", "# a log\n\n# ", "# a log\n"])
@pytest.mark.parametrize("name", ["az", "az [g]", "-az"])
def test_a_plain_csv_is_in_the_units_of_its_headings(tmp_path, name, above):
    (tmp_path / "log.csv").write_text(above + "t [ms],az [g],v (km/h)\n0,0,36\n10,1,36\n20,2,36\n")
    found = read_export(tmp_path / "log.csv", ColumnMap("t", name, speed="v", speed_unit="km/h")).streams
    assert found["vertical_acceleration"].time == pytest.approx([0.0, 0.01, 0.02])
    assert abs(found["vertical_acceleration"].values[1, 0]) == pytest.approx(9.80665)
    assert found["speed"].values == pytest.approx(10.0)


@pytest.mark.parametrize(("row", "acceleration"), [("ms,g,km/h,mrad/s", 9.80665), ("ms,,km/h,mrad/s", 9.80665e-3)])
def test_a_plain_csv_may_have_a_row_of_units(tmp_path, row, acceleration):
    (tmp_path / "log.csv").write_text(f"t,az [mg],v,q\n{row}\n0,0,36,0\n10,1,36,90\n")
    found = read_export(tmp_path / "log.csv", ColumnMap("t", "az", pitch_rate="q", speed="v")).streams
    assert found["vertical_acceleration"].time == pytest.approx([0.0, 0.01])
    assert found["vertical_acceleration"].values[:, 0] == pytest.approx([0.0, acceleration])
    assert found["speed"].values == pytest.approx(10.0)
    assert found["pitch_rate"].values[:, 0] == pytest.approx([0.0, 0.09])
    with pytest.raises(InputError, match=r"the heading 't \[ms\]' of .*log.csv says ms, `columns` s; correct one of them"):
        read_export(tmp_path / "log.csv", ColumnMap("t", "az", time_unit="s"))


def test_phyphox_accelerations_that_are_in_g_are_not_taken_for_some_without_gravity(tmp_path):
    t, force, rotation = still()
    with pytest.raises(InputError, match=r"the acceleration has a mean of 1 m/s.2; .*: it seems to be in g;"):
        read_export(write_zip(tmp_path / "a.zip", phyphox(t, force / 9.80665, rotation)))


@pytest.mark.parametrize(
    "moments",
    [
        ("2026-11-03T10:59:59.990Z", "nan", "2026-11-03 12:00:00.010+01:00"),
        ("2026-11-03T23:59:59.990", "", "2026-11-04T00:00:00.010"),
        ("9:05:06.25", "", "09:05:06,27"),
        ("", "23:59:59.99", "00:00:00.01"),
    ],
)
def test_times_of_a_plain_csv_may_be_dates_and_times_of_day(tmp_path, moments):
    (tmp_path / "log.csv").write_text("t [UTC];az\n" + "".join(f"{text};{i}\n" for i, text in enumerate(moments)))
    time = read_export(tmp_path / "log.csv", ColumnMap("t", "az")).streams["vertical_acceleration"].time
    known = np.isfinite(time)
    assert known.tolist() == [text not in ("", "nan") for text in moments]
    assert time[known] == pytest.approx([0.0, 0.02], abs=1e-6)


@pytest.mark.parametrize(
    ("text", "columns", "message"),
    [
        (
            "t,b\n10:00:00,2\n10:00:71,2\n",
            ColumnMap("t", "b"),
            "log.csv:3:1: expected a time of day as above, such as 12:00:00.25 or 2024-",
        ),
        ("t,b\n10:00:00,2\n12.5,2\n", ColumnMap("t", "b"), "log.csv:3:1: expected a time of day as above"),
        (
            "t,b\n2026-11-03T10:00:00Z,2\n2026-11-03T10:00:01,2\n",
            ColumnMap("t", "b"),
            "log.csv:3:1: expected a date and time with its zone as",
        ),
        (
            "t,b\n05:12.34,2\n05:12.35,2\n",
            ColumnMap("t", "b"),
            "log.csv:2:1: expected seconds, or a time, such as 12:00:00.25 or 2024-05-01T",
        ),
        ("t,b\n3.11.2026 10:00:00,2\n", ColumnMap("t", "b"), "2024-05-01T12:00:00.25, in column 't', found '3.11.2026 10:00:00'"),
        ("t,b\n10:00:00,2\n", ColumnMap("t", "b", time_unit="s"), "log.csv holds times of day, which have no unit; leave `time_unit` out"),
        ("a,b\n1,2\n", None, "of no app that vehgen knows (its columns: 'a', 'b')"),
        ("a,b\n1,2\n", ColumnMap("a", "c"), "has no column 'c'"),
        ("# ;\na,b\n1,2\n3,four\n", ColumnMap("a", "b"), "log.csv:4:2: expected a number in column 'b', found 'four'"),
        ("a,b\n1,2\n", ColumnMap("a", "b", time_unit="kg"), "expected a unit of s, found 'kg'"),
        ("a,b [g]\n1,2\n", ColumnMap("a", "b", acceleration_unit="m/s^2"), "log.csv says g, `columns` m/s^2"),
        ("", None, "is empty"),
    ],
)
def test_plain_csv_errors(tmp_path, text, columns, message):
    (tmp_path / "log.csv").write_text(text)
    with pytest.raises(InputError) as caught:
        read_export(tmp_path / "log.csv", columns)
    assert message in str(caught.value)


def test_excel_of_the_old_form_or_among_other_files_is_refused_with_what_to_do(tmp_path):
    (tmp_path / "a.xls").write_bytes(bytes.fromhex("d0cf11e0a1b11ae1") + bytes(600))
    with pytest.raises(InputError, match=r"is an Excel file of the old form \(.xls\); save it as .xlsx, or export again as CSV"):
        read_export(tmp_path / "a.xls")
    write_zip(tmp_path / "a.zip", {**phyphox(*still()), "more/b.xlsx": "x"})
    with pytest.raises(InputError, match=r"holds 'more/b\.xlsx', which is an Excel file among others; give a workbook"):
        read_export(tmp_path / "a.zip")


@pytest.mark.parametrize("name", ["../evil.csv", "/etc/evil.csv", "a/../../evil.csv", "..\\evil.csv", "C:/evil.csv"])
def test_names_that_lead_out_are_refused(tmp_path, name):
    files = {**phyphox(*still()), name: "x"}
    with pytest.raises(InputError, match="leads out of the archive"):
        read_export(write_zip(tmp_path / "a.zip", files))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.zip"]


def test_bombs_are_refused(tmp_path):
    with pytest.raises(InputError, match="far more than a recording"):
        read_export(write_zip(tmp_path / "a.zip", {"Accelerometer.csv": "0" * 30_000_000}))
    with pytest.raises(InputError, match="holds 501 files"):
        read_export(write_zip(tmp_path / "b.zip", {f"{i}.csv": "a" for i in range(501)}))


def test_a_size_that_lies_is_refused(tmp_path):
    path = write_zip(tmp_path / "a.zip", {"Accelerometer.csv": "1,2,3\n" * 1000}, zipfile.ZIP_STORED)
    data = path.read_bytes().replace((6000).to_bytes(4, "little") * 2, (6000).to_bytes(4, "little") + (10).to_bytes(4, "little"))
    path.write_bytes(data)
    with pytest.raises(InputError):
        read_export(path)


def test_encrypted_zip_is_refused(tmp_path):
    path = write_zip(tmp_path / "a.zip", {"Accelerometer.csv": "abc"})
    data = bytearray(path.read_bytes())
    for mark, flag in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        data[data.index(mark) + flag] |= 1
    path.write_bytes(data)
    with pytest.raises(InputError, match="encrypted"):
        read_export(path)


def test_links_in_folders_are_passed_over(tmp_path):
    outside = tmp_path / "outside.csv"
    outside.write_text("a,b\n1,2\n")
    folder = tmp_path / "export"
    folder.mkdir()
    (folder / "link.csv").symlink_to(outside)
    with pytest.raises(InputError, match="holds no CSV file"):
        read_export(folder)


def test_units_that_cannot_be_are_refused(tmp_path):
    t, force, rotation = still()
    with pytest.raises(InputError, match="is its unit m/s"):
        read_export(write_zip(tmp_path / "a.zip", phyphox(t, force * 5, rotation)))


def test_missing_export(tmp_path):
    with pytest.raises(InputError, match="no file or folder"):
        read_export(tmp_path / "none.zip")


@pytest.mark.filterwarnings("ignore")
def test_matlab_mobile(tmp_path):
    matio = pytest.importorskip("matio")
    pandas = pytest.importorskip("pandas")
    t, force, rotation = still()
    index = pandas.DatetimeIndex(pandas.Timestamp("2026-01-01") + pandas.to_timedelta(t, unit="s"), name="Timestamp")
    tables = {"Acceleration": force, "AngularVelocity": rotation}
    frames = {name: pandas.DataFrame(values, columns=["X", "Y", "Z"], index=index) for name, values in tables.items()}
    frames["Position"] = pandas.DataFrame({"latitude": 48.0 + 0 * t, "speed": 2.0 + 0 * t}, index=index)
    path = tmp_path / "sensorlog_20260101.mat"
    matio.save_to_mat(str(path), frames)
    export = read_export(path)
    assert export.app == "MATLAB Mobile"
    assert export.streams["acceleration"].values == pytest.approx(force)
    assert export.streams["rotation"].time == pytest.approx(t, abs=1e-6)
    assert export.streams["speed"].values == pytest.approx(2.0)


@pytest.mark.filterwarnings("ignore")
def test_damaged_matlab_file(tmp_path):
    pytest.importorskip("matio")
    path = tmp_path / "a.mat"
    path.write_bytes(b"MATLAB 5.0 MAT-file, broken".ljust(124) + b"\x00\x01IM" + b"\x0e\x00\x00\x00\xff\xff\x00\x00garbage")
    with pytest.raises(InputError):
        read_export(path)


def test_the_real_sample():
    folder = next((parent / SHARED for parent in Path(__file__).parents if (parent / SHARED).is_dir()), None)
    if folder is None:
        pytest.skip("no real sample here")
    export = read_export(folder)
    assert export.app == "phyphox"
    assert set(export.streams) == {"acceleration", "rotation", "speed"}
    acceleration = export.streams["acceleration"]
    assert acceleration.values[0] == pytest.approx([-0.4806504822, 1.707798615, 9.449848938])
    assert len(acceleration.time) == 2000
    assert 1 / np.median(np.diff(acceleration.time)) == pytest.approx(100.7, abs=0.1)
    assert export.streams["speed"].values[0, 0] == -1.0


def test_phyphox_tells_what_the_accelerometer_is(tmp_path):
    device = '"property","value"\n"deviceModel","TA-1004"\n"accelerometer Name","BMI160 Accelerometer"\n"accelerometer Range","78.4532"\n'
    path = write_zip(tmp_path / "a.zip", {**phyphox(*still()), "meta/device.csv": device})
    assert read_export(path).accelerometer == "BMI160 Accelerometer"
    assert read_export(write_zip(tmp_path / "b.zip", phyphox(*still()))).accelerometer is None
