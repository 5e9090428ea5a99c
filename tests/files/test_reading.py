"""Files are read as data of a bounded size, whatever a path leads to; faults have a place."""

import os
import sys
from pathlib import Path

import numpy as np
import pytest

from vehgen.errors import InputError
from vehgen.files.document import read_document
from vehgen.files.reading import LONGEST_LINE, open_regular, read_bytes, read_lines, read_text
from vehgen.files.tables import csv_table, read_columns
from vehgen.phones.archive import read_members

posix = pytest.mark.skipif(sys.platform == "win32", reason="needs pipes and devices")


@pytest.fixture
def pipe(tmp_path):
    path = tmp_path / "pipe"
    os.mkfifo(path)
    return path


@posix
@pytest.mark.parametrize("read", [read_document, read_members, lambda path: read_columns(path, ("t",)), lambda path: read_bytes(path, 10)])
def test_a_pipe_nobody_writes_to_is_refused_at_once(pipe, read):
    with pytest.raises(InputError, match=r"is a pipe, socket or device; .* was expected"):
        read(pipe)


@posix
@pytest.mark.parametrize("read", [read_document, read_members, lambda path: read_columns(path, ("t",))])
def test_a_device_without_an_end_is_refused(read):
    with pytest.raises(InputError, match="/dev/zero is a pipe, socket or device"):
        read(Path("/dev/zero"))


def test_a_file_swapped_for_a_pipe_between_two_looks_is_refused(pipe, tmp_path, monkeypatch):
    plain = tmp_path / "plain"
    plain.write_text("a")
    seen = os.stat(plain)
    monkeypatch.setattr(os, "stat", lambda path: seen)
    with pytest.raises(InputError, match="is a pipe"):
        open_regular(pipe, 10)


def test_size_is_checked_before_the_first_byte_is_read(tmp_path):
    path = tmp_path / "sparse"
    with path.open("wb") as stream:
        stream.truncate(2**40)
    for read in (read_document, read_members, lambda item: read_columns(item, ("t",))):
        with pytest.raises(InputError, match="1:1: 1099511627776 bytes"):
            read(path)


def test_paths_that_no_file_can_have(tmp_path):
    with pytest.raises(InputError, match="cannot be a path"):
        read_bytes(Path("a\0b"), 10)
    with pytest.raises(InputError, match="File name too long") as caught:
        read_bytes(tmp_path / ("a" * 5000), 10)
    assert len(str(caught.value)) < 400


def test_a_missing_file_is_told_with_its_nearest_neighbour(tmp_path):
    for name in ("hump_2ms.csv", "hump_2ms.yaml", "a.csv"):
        (tmp_path / name).touch()
    with pytest.raises(InputError, match=r"no file .*humps_2ms\.csv; did you mean 'hump_2ms\.csv'\?$"):
        read_bytes(tmp_path / "humps_2ms.csv", 10)
    with pytest.raises(InputError, match=r"no file .*HUMPS_2MS\.CSV; did you mean 'hump_2ms\.csv'\?$"):
        read_bytes(tmp_path / "HUMPS_2MS.CSV", 10)
    for name in ("b.csv", "hump_2ms.mf4", "absent/hump_2ms.csv"):
        with pytest.raises(InputError, match=rf"no file .*{name}$"):
            read_bytes(tmp_path / name, 10)


def test_an_unreadable_folder_is_no_traceback(tmp_path, monkeypatch):
    def refuse(path):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(os, "stat", refuse)
    with pytest.raises(InputError, match=r"cannot read .*: Permission denied"):
        read_bytes(tmp_path / "a", 10)


@pytest.mark.parametrize(
    ("content", "place"),
    [
        (b"\xff", "1:1"),
        ("ä\nbö".encode() + b"\xe9", "2:3"),
        (b"x" * 90_000 + b"\n" + b"y" * 70_000 + b"\xe2\x82", "2:70001"),
    ],
)
def test_what_is_not_utf8_has_line_and_column(tmp_path, content, place):
    path = tmp_path / "a.csv"
    path.write_bytes(content)
    for read in (lambda: read_text(path, 10**6), lambda: list(read_lines(path, 10**6))):
        with pytest.raises(InputError, match=f"a.csv:{place}: not UTF-8 text"):
            read()


def test_a_table_as_an_old_spreadsheet_writes_it_is_read(tmp_path):
    """In Windows-1252, but for bytes that this has no signs for."""
    path = tmp_path / "a.csv"
    for encoding in ("utf-8", "cp1252", "utf-16"):
        path.write_bytes("Zeit;Länge [m/s²];Güte\n0;1,5;schön\n1;2,5;€\n".encode(encoding))
        found = read_columns(path, ("Zeit", "Länge"))
        assert found.in_si(1, "m/s^2", "acceleration", None).values[1].tolist() == [1.5, 2.5]
    path.write_bytes(b"t,az\n0,1\n1,\x81\n")
    with pytest.raises(InputError, match=r"a\.csv:3:3: not UTF-8 text: the byte 0x81"):
        read_columns(path, ("t", "az"))


@pytest.mark.parametrize("first", ["sep=;", "\ufeffSEP=;", '"sep=;"', "# of a logger\nsep=;"])
def test_a_line_that_tells_excel_what_separates_columns_is_no_heading(tmp_path, first):
    (tmp_path / "a.csv").write_text(f"{first}\nt [s];a\n0;1,5\n1;2\n", encoding="utf-8")
    assert [column.tolist() for column in read_columns(tmp_path / "a.csv", ("t", "a")).values] == [[0.0, 1.0], [1.5, 2.0]]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("t,a\n0," + "1" * LONGEST_LINE + "\n", r":2:1: a line of more than 1000000 characters"),
        ("t,a\n" + '"' + "1\n" * 300_000, r":\d+:1: not a CSV table: field larger than"),
        ("t,a\n" + '"0","1\n2",' * 150_000, r"a row of more than 1000000 characters"),
        ("t,a\n0,1\n1,1e13\n", r":3:2: '1e13' in column 'a' is beyond 1e\+12"),
        ("t,a\n0,1\n1,-1e300\n", r":3:2: '-1e300' in column 'a' is beyond"),
        ("t,a\n0,1\n1,nan\n", r":3:2: 'nan' in column 'a' is not a finite number; `vehgen import` bridges gaps of a recording"),
        (
            "t,a\n10:00:00.01,1\n",
            r":2:1: '10:00:00.01' in column 't' is not a finite number; `vehgen import` reads the times of day of a recording",
        ),
        ("t,a\n0,1\n7\n", r":3:1: '' in column 'a' is not a finite number"),
        ("t,a,t\n0,1,2\n", r":1:3: two columns are named 't'"),
        ("t,a\n", r":1:1: a header line and at least one line of numbers"),
    ],
)
def test_tables_that_are_none(tmp_path, text, message):
    path = tmp_path / "a.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=message):
        read_columns(path, ("t", "a"))


def test_too_many_rows_are_refused(tmp_path, monkeypatch):
    """So many as docs/run-file.md says; shown with fewer, as two million take long to read."""
    assert csv_table.MOST_ROWS == 2_000_000
    path = tmp_path / "a.csv"
    monkeypatch.setattr(csv_table, "MOST_ROWS", 2000)
    path.write_text("t\n" + "0\n" * 2000)
    assert len(read_columns(path, ("t",)).values[0]) == 2000
    path.write_text("t\n" + "0\n" * 2001)
    with pytest.raises(InputError, match="more than 2000 rows"):
        read_columns(path, ("t",))


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_all_line_ends_and_quotes_are_read(tmp_path, end):
    path = tmp_path / "a.csv"
    path.write_bytes(("\ufefft,a" + end + "0, 1.5 " + end + '"1","-2e3"' + end).encode())
    t, a = read_columns(path, ("t", "a")).values
    np.testing.assert_array_equal(t, [0, 1])
    np.testing.assert_array_equal(a, [1.5, -2000])
