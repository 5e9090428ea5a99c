"""Excel exports come back as the CSV exports of the same recording do."""

import csv
import io
import zipfile

import numpy as np
import pytest

from vehgen.errors import InputError
from vehgen.phones import ColumnMap, read_export, workbook

from .exports import phyphox, still, write_zip

openpyxl = pytest.importorskip("openpyxl")
SHEETS = {"meta/time.csv": "Metadata Time", "meta/device.csv": "Metadata Device"}
DEVICE = '"property","value"\n"deviceModel","Phone"\n"accelerometer Name","bmi160"\n'
PACKAGE = "http://schemas.openxmlformats.org/package/2006"
OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
KIND = "application/vnd.openxmlformats-officedocument.spreadsheetml"
PARTS = {
    "_rels/.rels": f"<Relationships xmlns='{PACKAGE}/relationships'>"
    f"<Relationship Id='rId1' Type='{OFFICE}/officeDocument' Target='xl/workbook.xml'/></Relationships>",
    "[Content_Types].xml": f"<Types xmlns='{PACKAGE}/content-types'>"
    "<Default Extension='rels' ContentType='application/vnd.openxmlformats-package.relationships+xml'/>"
    f"<Override PartName='/xl/workbook.xml' ContentType='{KIND}.sheet.main+xml'/>"
    f"<Override PartName='/xl/worksheets/sheet1.xml' ContentType='{KIND}.worksheet+xml'/></Types>",
    "xl/workbook.xml": f"<workbook xmlns='{MAIN}' xmlns:r='{OFFICE}'>"
    "<sheets><sheet name='Raw Data' sheetId='1' r:id='rId1'/></sheets></workbook>",
    "xl/_rels/workbook.xml.rels": f"<Relationships xmlns='{PACKAGE}/relationships'>"
    f"<Relationship Id='rId1' Type='{OFFICE}/worksheet' Target='worksheets/sheet1.xml'/></Relationships>",
}
"""What stands around the one sheet of a workbook."""


def as_cell(text):
    """Return what the app writes: numbers as numbers, NaN and words as text."""
    try:
        number = float(text)
    except ValueError:
        return text
    return number if np.isfinite(number) else text


def write_workbook(path, files):
    """Write the CSV files of an export as the sheets of a workbook."""
    book = openpyxl.Workbook()
    book.remove(book.active)
    for name, text in files.items():
        sheet = book.create_sheet(SHEETS.get(name, name.removesuffix(".csv")))
        for row in csv.reader(io.StringIO(text)):
            sheet.append([as_cell(cell) for cell in row])
    book.save(path)
    return path


def test_phyphox_sheets_give_what_its_csv_files_do(tmp_path):
    t, force, rotation = still()
    files = {**phyphox(t, force, rotation, speed=2.5), "meta/device.csv": DEVICE}
    export = read_export(write_workbook(tmp_path / "a.xlsx", files))
    same = read_export(write_zip(tmp_path / "a.zip", files))
    assert export.app == "phyphox"
    assert set(export.streams) == set(same.streams) == {"acceleration", "rotation", "speed"}
    for name, stream in same.streams.items():
        np.testing.assert_array_equal(export.streams[name].values, stream.values)
        np.testing.assert_array_equal(export.streams[name].time, stream.time)
    assert export.epoch.at(1.5) == pytest.approx(1_700_000_001.5)
    assert export.accelerometer == same.accelerometer == "bmi160"
    assert export.acceleration_sign == 1


def test_a_sheet_as_phyphox_streams_it_without_places_of_cells(tmp_path):
    t, force, _ = still(40)
    heads = "".join(
        f"<c t='inlineStr' s='0'><is><t xml:space='preserve'>{name}</t></is></c>"
        for name in ("Time (s)", "Beschleunigung x (m/s^2)", "Beschleunigung y (m/s^2)", "Beschleunigung z (m/s^2)")
    )
    rows = ["".join(f"<c><v>{float(value)!r}</v></c>" for value in row) for row in np.column_stack([t, force])]
    rows += ["<c t='inlineStr'><is><t xml:space='preserve'>NaN</t></is></c>" * 4]
    body = "".join(f"<row>{row}</row>" for row in (heads, *rows))
    sheet = f"<worksheet xmlns='{MAIN}'><sheetData>{body}</sheetData></worksheet>"
    export = read_export(write_zip(tmp_path / "raw.xlsx", {**PARTS, "xl/worksheets/sheet1.xml": sheet}))
    assert list(export.streams) == ["acceleration"]
    np.testing.assert_array_equal(export.streams["acceleration"].values[:-1], force)
    assert np.isnan(export.streams["acceleration"].values[-1]).all()


def test_words_among_numbers_are_told_at_their_sheet_row_and_column(tmp_path):
    files = phyphox(*still(20), start=None)
    book = openpyxl.load_workbook(write_workbook(tmp_path / "a.xlsx", files))
    book["Gyroscope"]["C7"] = "broken"
    book.save(tmp_path / "a.xlsx")
    with pytest.raises(InputError, match=r"a\.xlsx: Gyroscope:7:3: expected a number in column 'Y \(rad/s\)', found 'broken'"):
        read_export(tmp_path / "a.xlsx")


def test_blank_rows_keep_the_numbers_of_those_below(tmp_path):
    book = openpyxl.Workbook()
    for row in (["t", "a"], [0.0, 1.0], [], [], [0.1, "four"]):
        book.active.append(row)
    book.save(tmp_path / "log.xlsx")
    with pytest.raises(InputError, match=r":5:2: expected a number in column 'a', found 'four'"):
        read_export(tmp_path / "log.xlsx", ColumnMap("t", "a"))


def test_workbooks_of_no_app_too_many_sheets_and_too_much_text_are_refused(tmp_path, monkeypatch):
    path = write_workbook(tmp_path / "a.xlsx", {"one.csv": "a,b\n1,2\n", "two.csv": "a,b\n1,2\n"})
    with pytest.raises(InputError, match="is of no app that vehgen knows"):
        read_export(path)
    with monkeypatch.context() as patch:
        patch.setattr(workbook, "MAX_SHEETS", 1)
        with pytest.raises(InputError, match="holds 2 sheets; at most 1 were expected"):
            read_export(path)
    with pytest.raises(InputError, match="sheet 'one' holds more than 0 MB of text"):
        workbook.read_sheets(path, 5)


def test_a_damaged_workbook_is_refused(tmp_path):
    data = write_workbook(tmp_path / "a.xlsx", phyphox(*still(20))).read_bytes()
    with zipfile.ZipFile(io.BytesIO(data)) as source, zipfile.ZipFile(tmp_path / "bad.xlsx", "w") as target:
        for part in source.namelist():
            target.writestr(part, source.read(part)[: 300 if part.endswith("sheet1.xml") else None])
    with pytest.raises(InputError, match="cannot be read as an Excel workbook"):
        read_export(tmp_path / "bad.xlsx")
