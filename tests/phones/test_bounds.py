"""Exports that would fill memory or time are refused before they are unpacked or laid out."""

import struct
import zipfile
import zlib

import numpy as np
import pytest

from vehgen.errors import InputError
from vehgen.phones import ColumnMap, read_export
from vehgen.phones import archive as archive_module
from vehgen.phones.csv_table import read_table
from vehgen.phones.export import Stream
from vehgen.phones.matlab import read_matlab
from vehgen.phones.resampling import clean

COLUMNS = ColumnMap("t", "a")


def test_a_long_list_of_files_is_refused_before_it_is_read(tmp_path, monkeypatch):
    path = tmp_path / "a.zip"
    with zipfile.ZipFile(path, "w") as archive:
        for i in range(6000):
            archive.writestr(f"{'x' * 200}{i}.csv", "")
    monkeypatch.setattr(archive_module.zipfile, "ZipFile", None)
    with pytest.raises(InputError, match=r"a\.zip lists files in \d{7} bytes; at most 500 files were expected"):
        read_export(path)


def test_a_zip64_of_many_bytes_is_refused_before_it_is_read(tmp_path, monkeypatch):
    path = tmp_path / "a.zip"
    end = b"PK\x05\x06" + struct.pack("<HHHHLLH", 0, 0, 0xFFFF, 0xFFFF, 0, 0xFFFFFFFF, 0)
    path.write_bytes(b"PK\x03\x04" + bytes(2**20) + b"PK\x06\x07" + bytes(16) + end)
    monkeypatch.setattr(archive_module.zipfile, "ZipFile", None)
    with pytest.raises(InputError, match="lists files in"):
        read_export(path)


def test_a_packed_matlab_file_is_measured_before_it_is_unpacked(tmp_path, monkeypatch):
    monkeypatch.setattr("vehgen.phones.matlab.MAX_TOTAL", 2**20)
    packed = zlib.compress(bytes(2**22))
    header = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<H", 0x0100) + b"IM"
    path = tmp_path / "a.mat"
    path.write_bytes(header + struct.pack("<II", 15, len(packed)) + packed)
    with pytest.raises(InputError, match="would unpack to more than 1 MB"):
        read_matlab(path)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("t,a\n0,1\n1,1e300\n", r"a\.csv:3:2: '1e300' in column 'a' is beyond 1e\+20"),
        ("t,a\n0,1\n1,1_000\n", r"a\.csv:3:2: expected a number in column 'a', found '1_000'"),
        ("\n\nt,a\n0,1\n\n1,x\n", r"a\.csv:6:2: expected a number in column 'a', found 'x'"),
        ("t,a,A\n0,1,2\n", "two columns 'a'"),
        ("t,a\n0," + "1" * 1_000_001, r"a\.csv:2:1: a line of more than 1000000 characters"),
        ("t,a\n0," + '"' + "1\n" * 200_000, "field larger than field limit"),
    ],
)
def test_plain_tables(tmp_path, text, message):
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(InputError, match=message):
        read_export(tmp_path / "a.csv", COLUMNS)


def test_a_table_is_not_held_as_cells(tmp_path):
    data = b"t,a\n" + b"0,1\n" * 500_000
    found = read_table(data, "a.csv")
    assert found.data is data
    assert found.column(1).nbytes == 8 * 500_000


@pytest.mark.parametrize(
    "time", [np.r_[np.arange(99) * 0.01, 1e9], np.arange(100) * 1e-9, np.arange(100) * 1e4], ids=["gap", "nanoseconds", "slow"]
)
def test_a_clock_that_no_phone_has_is_refused(time):
    with pytest.raises(InputError, match=r"spans .* s at .* Hz; at most 20000 s at 20000 Hz were expected: is time in s"):
        clean(Stream(time, np.zeros((100, 1)), ("a",), "m/s^2"), "phone")
