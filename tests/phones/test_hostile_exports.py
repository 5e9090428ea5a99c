"""Whatever a file holds, the answer is an export or an InputError."""

import tempfile
from functools import partial
from pathlib import Path

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from vehgen.commands.option_strings import read_column_map, read_hump, read_sensor
from vehgen.errors import InputError
from vehgen.phones import ColumnMap, read_export
from vehgen.phones.csv_table import read_table
from vehgen.phones.locating import find_speed
from vehgen.phones.phone import make_phone
from vehgen.phones.plan import PhoneSensor, Plan, hump_road
from vehgen.vehicle import load_vehicle

from .exports import phyphox, sensor_logger, still, write_zip

QUICK = settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.too_slow])
SENSOR = PhoneSensor("L1", "body", forward="y")
VEHICLE = load_vehicle("tractor5.yaml")
PLAN = Plan(VEHICLE, hump_road(read_hump("half_sine,length=0.5,height=0.03")), (SENSOR,))
HEADS = st.sampled_from(
    [
        "time,seconds_elapsed,z,y,x", '"Time (s)","X (m/s^2)","Y (m/s^2)","Z (m/s^2)"', "Time (s);X (m/s^2);Y (m/s^2);Z (m/s^2)",
        "event,experiment time,system time", "version,platform,standardisation", "a,b,c", '"', "Time (s)\tX (rad/s)", "",
    ]
)  # fmt: skip
STARTS = [b"", b"PK\x03\x04", b"MATLAB 5.0 MAT-file", b"\xd0\xcf\x11\xe0", b"\xff\xfe", b"Time (s),"]
CELLS = st.sampled_from(["0", "1.5", "-3E2", "NaN", "", "inf", "1e999", "9.81", "1,5", "x", "START", "1700000000000000000", '"'])
ROWS = st.lists(st.lists(CELLS, max_size=6), max_size=12)


def refusal(read):
    """Return the InputError that a reader raises, or None; no other exception may come."""
    try:
        read()
    except InputError as error:
        return error
    return None


def check_read_or_refused(name, data, columns=None):
    """Check that a file is read and goes through what the import does first, or is refused in one line."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        path.write_bytes(data)

        def read():
            phone = make_phone(read_export(path, columns), SENSOR, name, 25.0)
            upward, pitch, _ = phone.turned(phone.begin, phone.end)
            time = np.arange(phone.begin, phone.begin + 1.0, 0.01)
            sampled = phone.sampled((upward, pitch), time)
            assert sampled.shape[0] == len(time)
            find_speed([phone], PLAN, 10.0)

        error = refusal(read)
    assert error is None or "\n" not in str(error)


@QUICK
@given(
    st.binary(max_size=300), st.sampled_from([b"", b"PK\x03\x04", b"MATLAB 5.0 MAT-file", b"\xd0\xcf\x11\xe0", b"\xff\xfe", b"Time (s),"])
)
def test_random_bytes(data, start):
    check_read_or_refused("a.csv", start + data)


@QUICK
@given(st.integers(0, 9000), st.integers(0, 9000), st.integers(0, 255), st.booleans())
def test_damaged_zips(cut, place, value, truncate):
    with tempfile.TemporaryDirectory() as folder:
        data = bytearray(write_zip(Path(folder) / "a.zip", phyphox(*still(260))).read_bytes())
    if truncate:
        del data[cut % len(data) :]
    else:
        data[place % len(data)] = value
    check_read_or_refused("a.zip", bytes(data))


@QUICK
@given(HEADS, ROWS, st.sampled_from([",", ";", "\t"]))
def test_wrong_tables(head, rows, separator):
    text = "\n".join([head, *(separator.join(row) for row in rows)])
    check_read_or_refused("TotalAcceleration.csv", text.encode())
    check_read_or_refused("a.csv", text.encode(), ColumnMap("a", "b", "c", "c"))


@QUICK
@given(st.data())
def test_shuffled_and_poisoned_samples(data):
    t, force, rotation = still(260)
    values = st.sampled_from([np.nan, np.inf, -1e300, 1e9, 0.0, -5.0])
    for _ in range(data.draw(st.integers(0, 30))):
        target = data.draw(st.sampled_from([t, force[:, 2], rotation[:, 0]]))
        target[data.draw(st.integers(0, len(target) - 1))] = data.draw(values)
    with np.errstate(all="ignore"):
        files = (
            sensor_logger(np.clip(np.nan_to_num(t), -1e9, 1e9), force, rotation)
            if data.draw(st.booleans())
            else phyphox(t, force, rotation)
        )
    with tempfile.TemporaryDirectory() as folder:
        packed = write_zip(Path(folder) / "a.zip", files).read_bytes()
    check_read_or_refused("a.zip", packed)


@QUICK
@given(st.text(alphabet="L1:body=tractor,hinde.x-0 \n\"'{", max_size=60))
def test_options(text):
    for read in (lambda text: hump_road(read_hump(text)), read_column_map, lambda text: read_sensor(text).check(VEHICLE)):
        for given_text in (text, "L1:" + text):
            error = refusal(partial(read, given_text))
            assert error is None or (str(error) and "\n" not in str(error))


def test_what_a_file_in_an_archive_is_called_does_not_command_the_terminal():
    name = "\x1b]0;pwned\x07\u202e" + "x" * 1000 + ".csv"
    table = read_table(b"a,b\n1,2\n", name, "export.zip")
    assert table.file == name
    assert table.name.isprintable()
    assert len(table.name) < 100
