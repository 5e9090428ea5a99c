"""Damaged, hostile and mistaken tables are refused with one line that says where; a lacking library is named with its extra."""

from __future__ import annotations

import io
import sys
import zipfile
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from random import Random

import numpy as np
import pandas as pd
import pytest
import scipy.io

from tests.files.tables.test_formats import WRITERS
from vehgen.errors import InputError
from vehgen.files.tables import read_columns, workbook_parts
from vehgen.files.tables.foreign import items_of

CASES = [
    ("t;az\n0;1,5\n1;2.5\n", "3:2: '2.5' in column 'az': a decimal comma and a decimal point in one table"),
    ("t;az\n0;1.234,5\n", "2:2: '1.234,5' in column 'az' is not a finite number"),
    ("t;az\n0;1,2,3\n", "2:2: '1,2,3' in column 'az' is not a finite number"),
    ("t,az\n0,1_000\n", "2:2: '1_000' in column 'az' is not a finite number"),
    ("t;az\n0;1_000,5\n", "2:2: '1_000,5' in column 'az' is not a finite number"),
    ("t,az\n0,1,5\n", "2:3: 3 cells below 2 headings"),
    ("t;az\n0;1;5\n", "2:3: 3 cells below 2 headings"),
    ("t,az\n0,00,1,5\n", "2:3: 4 cells below 2 headings; where each number is in two of them for its decimal comma, separate columns by"),
    ("t,az\ns,m/s^2\n", "1:1: a header line and at least one line of numbers were expected"),
    ("t,az\nfoo,banana\n0,1\n", "2:1: 'foo' in column 't' is not a finite number"),
    ("t,az\ns,5\n0,1\n", "2:1: 's' in column 't' is not a finite number"),
    ("t,az\ns,nan\n0,1\n", "2:1: 's' in column 't' is not a finite number"),
    ("t [s],t [ms],az\n0,0,1\n", "1:2: two columns are named 't'"),
    ("time;az\n0;1\n", "1:1: no column 't'; known: az, time"),
    ("", "1:1: a header line"),
]


@pytest.mark.parametrize(("text", "said"), CASES, ids=range(len(CASES)))
def test_a_table_of_text_is_refused_at_its_cell(tmp_path: Path, text: str, said: str):
    (tmp_path / "run.csv").write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        read_columns(tmp_path / "run.csv", ("t", "az"))
    assert f"run.csv:{said}" in str(caught.value)


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (bytes.fromhex("d0cf11e0a1b11ae1") + bytes(600), "an Excel file of the old form (.xls); save it as .xlsx or CSV"),
        (b"\x89HDF\r\n\x1a\n" + bytes(600), "an HDF5 file, as MATLAB writes with -v7.3"),
        (b"\x1f\x8b" + bytes(60), "packed (gzip)"),
        (b"UnFinMF 4.10    " + bytes(600), "a finished MDF file of version 4 was expected"),
        (b"MDF     3.30    " + bytes(600), "a finished MDF file of version 4 was expected, found '3.30'"),
        (b"MDF     4.10    " + bytes(600), "cannot be read as an MDF 4 file"),
        (b"PAR1" + bytes(600), "cannot be read as a Parquet file"),
        (b"PK\x03\x04" + bytes(600), "cannot be read as an Excel workbook"),
        (b"    -1\n    58\nnothing\n    -1\n", "cannot be read as a universal file"),
        (b"MATLAB 5.0 MAT-file" + bytes(600), "cannot be read as a MATLAB file"),
    ],
    ids=lambda item: repr(item[:8]),
)
def test_what_is_damaged_or_of_another_version_is_told(tmp_path: Path, data: bytes, said: str):
    for mark, module in ((b"PAR1", "pyarrow"), (b"PK", "openpyxl"), (b"MDF", "asammdf"), (b"    -1", "pyuff")):
        if data.startswith(mark):
            pytest.importorskip(module)
    (tmp_path / "run.dat").write_bytes(data)
    with pytest.raises(InputError) as caught:
        read_columns(tmp_path / "run.dat", ("t", "az"))
    assert said in str(caught.value)


@pytest.mark.parametrize("name", ["parquet", "excel", "mdf", "uff", "comma", "matlab", "packed matlab"])
def test_damaged_files_are_refused_or_read_but_never_crash(tmp_path: Path, name: str):
    path = tmp_path / "run.xlsx"
    WRITERS[name](path)
    whole, random = path.read_bytes(), Random(5)
    for _ in range(40):
        data = bytearray(whole[: random.randrange(len(whole))] if random.random() < 0.4 else whole)
        for _ in range(random.randrange(1, 6)):
            if data:
                data[random.randrange(len(data))] = random.randrange(256)
        path.write_bytes(bytes(data))
        with suppress(InputError):
            found = read_columns(path, ("t", "az"))
            assert np.isfinite(np.array(found.values)).all()


@pytest.mark.thorough
def test_a_workbook_with_entities_or_of_a_bomb_is_refused(tmp_path: Path):
    pytest.importorskip("openpyxl")
    pd.DataFrame({"t": [0.0], "az": [1.0]}).to_excel(tmp_path / "good.xlsx", index=False)
    declared = b'<!DOCTYPE x [<!ENTITY a "7">]><worksheet'
    entities = {
        "first": lambda text: text.replace(b"<worksheet", declared, 1),
        "padded": lambda text: text.replace(b"<worksheet", b"<!--" + b"x" * 140_000 + b"-->" + declared, 1),
        "wide": lambda text: text.replace(b"<worksheet", declared, 1).decode().replace("UTF-8", "UTF-16").encode("utf-16"),
        "other": lambda text: b'<?xml version="1.0" encoding="cp037"?>' + text.decode().partition("?>")[2].encode("cp037"),
    }
    cases = [*((name, "the workbook declares entities") for name in entities), ("bomb", "would unpack to more than")]
    for name, said in cases:
        data = io.BytesIO()
        with zipfile.ZipFile(tmp_path / "good.xlsx") as source, zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
            for part in source.namelist():
                text = source.read(part)
                if part.endswith("sheet1.xml") and name in entities:
                    text = entities[name](text)
                archive.writestr(part, text)
            if name == "bomb":
                with archive.open("xl/more.xml", "w", force_zip64=True) as stream:
                    for _ in range(1001):
                        stream.write(bytes(1_000_000))
        (tmp_path / "bad.xlsx").write_bytes(data.getvalue())
        with pytest.raises(InputError, match=said):
            read_columns(tmp_path / "bad.xlsx", ("t", "az"))


def repacked(path: Path, source: Path, changes: dict[str, Callable[[bytes], bytes]]) -> Path:
    """Write a workbook again with some of its parts changed."""
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as new:
        for part in old.namelist():
            new.writestr(part, changes.get(part, bytes)(old.read(part)))
    return path


@pytest.fixture
def workbook(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a good workbook with a row of text, where little is already large."""
    pytest.importorskip("openpyxl")
    pd.DataFrame({"t": np.arange(900.0), "az": np.arange(900.0), "note": "text"}).to_excel(tmp_path / "good.xlsx", index=False)
    monkeypatch.setattr(workbook_parts, "MAX_WHOLE_PART_BYTES", 20_000)
    monkeypatch.setattr(workbook_parts, "MAX_SHEET_ROW_BYTES", 20_000)
    assert len(read_columns(tmp_path / "good.xlsx", ("t", "az")).lines) == 900
    return tmp_path / "good.xlsx"


SHEET, STRINGS, TYPES, RELATIONS = "xl/worksheets/sheet1.xml", "xl/sharedStrings.xml", "[Content_Types].xml", "xl/_rels/workbook.xml.rels"
PADDING = b"<a/>" * 10_000
BOMBS = {
    "texts": ({STRINGS: lambda xml: xml.replace(b"</sst>", b"<si><t>x</t></si>" * 4000 + b"</sst>")}, "xl/sharedStrings.xml"),
    "styles": ({"xl/styles.xml": lambda xml: xml.replace(b"<fonts", PADDING + b"<fonts")}, "xl/styles.xml"),
    "one row": ({SHEET: lambda xml: xml.replace(b"</row>", b"<c/>" * 10_000 + b"</row>", 1)}, "without the end of a row"),
    "no row": ({SHEET: lambda xml: xml.replace(b"<sheetData>", PADDING + b"<sheetData>")}, "without the end of a row"),
    "a sheet as texts": ({TYPES: lambda xml: xml.replace(b"/xl/sharedStrings.xml", b"/xl/worksheets/sheet1.xml")}, "would unpack to"),
    "a sheet as a chart": (
        {RELATIONS: lambda xml: xml.replace(b"relationships/worksheet", b"relationships/chartsheet")},
        "would unpack to",
    ),
}


@pytest.mark.parametrize("name", BOMBS)
def test_parts_that_would_fill_the_memory_are_refused(workbook: Path, name: str):
    changes, said = BOMBS[name]
    with pytest.raises(InputError, match=said):
        read_columns(repacked(workbook.with_name("bomb.xlsx"), workbook, changes), ("t", "az"))


@pytest.mark.parametrize(
    ("name", "place"), [("excel", "excel.read_rows"), ("parquet", "sheet.Sheet.select"), ("mdf", "mdf._select"), ("uff", "uff._headings")]
)
def test_our_own_mistakes_are_not_told_as_faults_of_the_file(tmp_path: Path, name: str, place: str, monkeypatch: pytest.MonkeyPatch):
    def mistaken(*_: object, **__: object) -> None:
        raise ZeroDivisionError

    WRITERS[name](tmp_path / "run.xlsx")
    monkeypatch.setattr(f"vehgen.files.tables.{place}", mistaken)
    with pytest.raises(ZeroDivisionError):
        read_columns(tmp_path / "run.xlsx", ("t", "az"))


def test_a_fault_of_a_library_amid_the_rows_is_told_as_the_files(tmp_path: Path):
    def rows() -> Iterator[int]:
        yield 1
        raise KeyError("r")

    found = items_of(rows(), tmp_path / "run.xlsx", "a workbook")
    assert next(found) == 1
    with pytest.raises(InputError, match="cannot be read as a workbook: 'r'"):
        next(found)


LIBRARIES = [("parquet", "pyarrow.parquet", "tables"), ("excel", "openpyxl", "tables"), ("mdf", "asammdf", "mdf"), ("uff", "pyuff", "uff")]


@pytest.mark.parametrize(("name", "module", "extra"), LIBRARIES, ids=[name for name, _, _ in LIBRARIES])
def test_a_lacking_library_is_named_with_its_extra(tmp_path: Path, name: str, module: str, extra: str, monkeypatch: pytest.MonkeyPatch):
    path = tmp_path / "run.xlsx"
    WRITERS[name](path)
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(InputError, match=rf"needs {module.partition('.')[0]}: pip install 'vehgen\[{extra}\]'"):
        read_columns(path, ("t", "az"))


def test_numbers_that_are_none_are_told_at_their_row(tmp_path: Path):
    scipy.io.savemat(tmp_path / "run.mat", {"t": np.array([0.0, 1.0, np.nan]), "az": np.array([1.0, 1e13, 2.0]), "z": np.array([1j, 2, 3])})
    with pytest.raises(InputError, match=r"run\.mat:3:1: nan in column 't' is not a finite number"):
        read_columns(tmp_path / "run.mat", ("t", "az"))
    with pytest.raises(InputError, match=r"run\.mat:2:1: 1e\+13 in column 'az' is beyond 1e\+12"):
        read_columns(tmp_path / "run.mat", ("az",))
    with pytest.raises(InputError, match="'z' holds no real numbers"):
        read_columns(tmp_path / "run.mat", ("z",))


@pytest.mark.parametrize(("own", "stated"), [("kN", "g"), ("mm", "m/s^2"), ("m/s^2", "g")])
def test_two_units_of_a_column_that_contradict_each_other_are_refused(tmp_path: Path, own: str, stated: str):
    (tmp_path / "run.csv").write_text(f"t,az [{own}]\n0,1\n1,2\n")
    table = read_columns(tmp_path / "run.csv", ("t", "az"))
    with pytest.raises(InputError, match="correct one of them"):
        table.in_si(1, "m/s^2", "acceleration", stated, None)


def test_a_heading_that_names_no_unit_leaves_the_word_to_who_states_one(tmp_path: Path):
    (tmp_path / "run.csv").write_text("t,az [banana]\n0,1\n1,2\n")
    table = read_columns(tmp_path / "run.csv", ("t", "az"))
    assert table.in_si(1, "m/s^2", "acceleration", "g", None).values[1] == pytest.approx([9.80665, 2 * 9.80665])


@pytest.mark.parametrize("text", ["s,h\n0,0\n5,0.01\n20,0\n\n", "s,h\n\n0,0\n , \n5,0.01\n20,0\n,\n"])
def test_a_line_without_any_number_says_nothing(tmp_path, text):
    (tmp_path / "profile.csv").write_text(text)
    table = read_columns(tmp_path / "profile.csv", ("s", "h"))
    assert [item.tolist() for item in table.values] == [[0.0, 5.0, 20.0], [0.0, 0.01, 0.0]]
    assert table.lines.tolist() == [number for number, line in enumerate(text.split("\n"), 1) if line[:1].isdigit()]
