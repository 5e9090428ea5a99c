"""Units in headings and in a row below them: what counts as one, and where a wrong one is told."""

from __future__ import annotations

import pickle
from pathlib import Path

import pandas as pd
import pytest

from vehgen.errors import InputError
from vehgen.files.tables import TableColumns, read_columns
from vehgen.files.tables.headings import MissingColumnError

INCH, MINUTE, GRAVITY = 0.0254, 60.0, 9.80665


def read(folder: Path, text: str, names: tuple[str, ...] = ("t", "az")) -> TableColumns:
    (folder / "run.csv").write_text(text, encoding="utf-8")
    return read_columns(folder / "run.csv", names)


@pytest.mark.parametrize(
    ("heading", "usual", "factor"),
    [
        ("az (in)", "m", INCH),
        ("az [in]", "m", INCH),
        ("az (in)", "m/s^2", 1.0),
        ("az (in)", "N", 1.0),
        ("az (min)", "s", MINUTE),
        ("az (min)", "m", 1.0),
        ("az (g)", "m/s^2", GRAVITY),
        ("az (in/s)", "m/s", INCH),
        ("az (m/s²)", "m/s^2", 1.0),
    ],
)
def test_a_word_in_round_brackets_is_a_unit_where_it_fits(tmp_path: Path, heading: str, usual: str, factor: float):
    for name in ("az", heading):
        table = read(tmp_path, f"t,{heading}\n0,1\n1,2\n", ("t", name))
        assert table.in_si(1, usual, "what was measured").values[1] == pytest.approx([factor, 2 * factor])
    frame = pd.DataFrame({"t": [0.0, 1.0], heading: [1.0, 2.0]})
    pytest.importorskip("pyarrow")
    frame.to_parquet(tmp_path / "run.parquet")
    table = read_columns(tmp_path / "run.parquet", ("t", "az"))
    assert table.in_si(1, usual, "what was measured").values[1] == pytest.approx([factor, 2 * factor])


@pytest.mark.parametrize("heading", ["az [in]", "az (mm)", "az [min]"])
def test_other_units_that_do_not_fit_are_refused(tmp_path: Path, heading: str):
    with pytest.raises(InputError, match=r"run\.csv:1:2: acceleration is measured in m/s\^2, found"):
        read(tmp_path, f"t,{heading}\n0,1\n1,2\n").in_si(1, "m/s^2", "acceleration")


COMMENTED = "# made by a logger\n\n# 2026, 3 min\n"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
@pytest.mark.parametrize("heading", ["t,az [g]", "# t,az (g)", "t\taz [g]"])
def test_comments_stand_above_the_heading(tmp_path: Path, heading: str, encoding: str):
    text = f"{COMMENTED}{heading}\n0,1\n1,2\n" if "," in heading else f"{COMMENTED}{heading}\n0\t1,0\n1\t2,0\n"
    (tmp_path / "run.csv").write_text(text, encoding=encoding)
    table = read_columns(tmp_path / "run.csv", ("t", "az"))
    assert table.in_si(1, "m/s^2", "acceleration").values[1] == pytest.approx([GRAVITY, 2 * GRAVITY])
    assert [str(place).rpartition("run.csv")[2] for place in (table.place(0), table.heading(1))] == [":5:1", ":4:2"]
    with pytest.raises(InputError, match=r"run\.csv:4:2: height is measured in m, found 'g'"):
        table.in_si(1, "m", "height")
    with pytest.raises(InputError, match=r"run\.csv:4:1: no column 'ay'"):
        read_columns(tmp_path / "run.csv", ("t", "ay"))


def test_a_comment_below_the_heading_is_no_number(tmp_path: Path):
    with pytest.raises(InputError, match=r"run\.csv:4:1: '# stopped' in column 't' is not a finite number"):
        read(tmp_path, "# from here\nt,az\n0,1\n# stopped\n")


@pytest.mark.parametrize("name", ["# t", "t"])
def test_a_heading_may_be_named_with_its_sign(tmp_path: Path, name: str):
    assert read(tmp_path, "# t,az\n0,1\n", (name, "az")).values[0] == [0.0]


@pytest.mark.parametrize("damaged", ["t,az\n0,1\n".encode("utf-16")[:-1], b"\xff\xfe\x00\xd8t\x00"])
def test_damaged_utf16_is_one_line(tmp_path: Path, damaged: bytes):
    (tmp_path / "run.csv").write_bytes(damaged)
    with pytest.raises(InputError, match=r"run\.csv:1:1: not UTF-8 text: .*; save the file as UTF-8$"):
        read_columns(tmp_path / "run.csv", ("t", "az"))


def test_a_stated_unit_does_not_contradict_a_word(tmp_path: Path):
    assert read(tmp_path, "t,az (in)\n0,1\n").in_si(1, "m/s^2", "acceleration", "g").values[1] == pytest.approx([GRAVITY])
    with pytest.raises(InputError, match="correct one of them"):
        read(tmp_path, "t,az (in)\n0,1\n").in_si(1, "m", "height", "mm")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("t,az\ns,banana\n0,1\n", "2:2: unknown unit 'banana'"),
        ("t,az\ns,m/s\n0,1\n", "2:2: acceleration is measured in m/s^2, found 'm/s'"),
        ("t,x,az [m/s^2]\ns,,bananas\n0,1,1\n", "2:3: unknown unit 'bananas'"),
        ("t,x,az [banana]\ns,,\n0,1,1\n", "1:3: unknown unit 'banana'"),
        ("t;az\nsec;m/ss\n0;1\n", "2:2: unknown unit 'm/ss'"),
    ],
)
def test_a_wrong_unit_is_told_where_it_stands(tmp_path: Path, text: str, said: str):
    table = read(tmp_path, text)
    assert table.in_si(0, "s", "time").values[0] == pytest.approx([0.0])
    with pytest.raises(InputError) as caught:
        table.in_si(1, "m/s^2", "acceleration")
    assert f"run.csv:{said}" in str(caught.value)


def test_a_unit_of_a_row_of_units_is_no_word(tmp_path: Path):
    with pytest.raises(InputError, match=r"run\.csv:2:2: acceleration is measured in m/s\^2, found 'in'"):
        read(tmp_path, "t,az (in)\ns,in\n0,1\n").in_si(1, "m/s^2", "acceleration")


def test_a_missing_column_is_told_by_a_process_of_its_own_as_it_is_here(tmp_path: Path):
    (tmp_path / "run.csv").write_text("time,az\n0,1\n")
    with pytest.raises(MissingColumnError) as caught:
        read_columns(tmp_path / "run.csv", ("t",))
    sent = pickle.loads(pickle.dumps(caught.value))
    assert (str(sent), sent.message, sent.position, sent.column) == (str(caught.value), caught.value.message, caught.value.position, "t")
