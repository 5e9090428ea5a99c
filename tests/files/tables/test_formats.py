"""The same table, written by the programs that write such files, reads as the same numbers with its units."""

from __future__ import annotations

import struct
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import scipy.io

from vehgen.errors import InputError
from vehgen.files.tables import read_columns

T = np.arange(0.0, 2.0, 0.01)
AZ = 0.3 * np.sin(9 * T) - 1234.5 * (T > 1)
FRAME = pd.DataFrame({"t": T, "az": AZ, "other": np.cos(T)})
WITH_UNITS = FRAME.rename(columns={"t": "t [s]", "az": "az [m/s²]"})


def mdf(path: Path, az: np.ndarray = AZ, unit: str = "m/s²", **more: object) -> None:
    asammdf = pytest.importorskip("asammdf")
    with asammdf.MDF(version="4.10") as file:
        signals = [asammdf.Signal(az, T, name="az", unit=unit, **more), asammdf.Signal(np.cos(T), T, name="other")]
        file.append(signals, common_timebase=True)
        file.save(path.with_suffix(".mf4"), overwrite=True)
    path.with_suffix(".mf4").rename(path)


def uff(path: Path) -> None:
    pyuff = pytest.importorskip("pyuff")
    file = pyuff.UFF(str(path.with_suffix(".uff")))
    for name, values in (("az", AZ), ("other", np.cos(T))):
        data = pyuff.prepare_58(
            func_type=1, rsp_node=12, rsp_dir=3, ref_node=1, ref_dir=0, id1=name, data=values, x=T, ordinate_axis_units_lab="m/s^2",
            ordinate_spec_data_type=12, abscissa_axis_units_lab="s", abscissa_spec_data_type=17, abscissa_spacing=1, binary=1,
            abscissa_min=float(T[0]), abscissa_inc=0.01, num_pts=len(T), ord_data_type=4, orddenom_spec_data_type=0, z_axis_value=0.0,
        )  # fmt: skip
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ResourceWarning)  # pyuff does not close what it writes
            file.write_sets(data, "add")
    path.with_suffix(".uff").rename(path)


def parquet(path: Path) -> None:
    arrow = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    schema = arrow.schema([arrow.field("t", "double", metadata={"unit": "s"}), arrow.field("az", "double", metadata={"unit": "m/s²"})])
    parquet.write_table(arrow.table([T, AZ], schema=schema), path)


def excel(path: Path) -> None:
    pytest.importorskip("openpyxl")
    WITH_UNITS.to_excel(path, index=False)


def matlab(path: Path, packed: bool) -> None:
    scipy.io.savemat(path.with_suffix(".mat"), {"t": T, "az": AZ, "other": "text"}, do_compression=packed)
    path.with_suffix(".mat").rename(path)


WRITERS: dict[str, Callable[[Path], object]] = {
    "comma": lambda path: WITH_UNITS.to_csv(path, float_format="%.17g", index=False),
    "semicolon and decimal comma": lambda path: WITH_UNITS.to_csv(path, float_format="%.17g", index=False, sep=";", decimal=","),
    "semicolon and decimal point": lambda path: WITH_UNITS.to_csv(path, float_format="%.17g", index=False, sep=";"),
    "tab and decimal comma, quoted": lambda path: WITH_UNITS.to_csv(
        path, float_format="%.17g", index=False, sep="\t", decimal=",", quoting=1
    ),
    "byte order mark": lambda path: WITH_UNITS.to_csv(path, float_format="%.17g", index=False, sep=";", decimal=",", encoding="utf-8-sig"),
    "row of units": lambda path: path.write_text(
        "t;az\ns;m/s^2\n" + FRAME[["t", "az"]].to_csv(None, float_format="%.17g", index=False, header=False, sep=";")
    ),
    "parquet": parquet,
    "parquet of pandas": lambda path: pytest.importorskip("pyarrow") and WITH_UNITS.to_parquet(path),
    "excel": excel,
    "mdf": mdf,
    "uff": uff,
    "matlab": lambda path: matlab(path, False),
    "packed matlab": lambda path: matlab(path, True),
}


@pytest.mark.parametrize("name", WRITERS)
def test_a_table_reads_as_it_was_written(tmp_path: Path, name: str):
    path = tmp_path / "table.dat"  # what it is stands in its first bytes, not in its name
    if name == "excel":
        path = tmp_path / "table.xlsx"
    WRITERS[name](path)
    found = read_columns(path, ("t", "az"))
    assert found.units == ((None, None) if "matlab" in name else ("s", "m/s^2"))
    np.testing.assert_allclose(found.values[0], T, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(found.values[1], AZ, rtol=1e-12, atol=1e-12)
    with pytest.raises(InputError, match=r"no (column|channel|variable) 'azz'; did you mean 'az'"):
        read_columns(path, ("t", "azz"))


def test_vectors_of_matlab(tmp_path: Path):
    path = tmp_path / "run.mat"
    scipy.io.savemat(path, {"t": T, "az": AZ[:, None], "short": T[:5], "text": "no numbers"}, do_compression=True)
    found = read_columns(path, ("t", "az"))
    assert found.units == (None, None)
    np.testing.assert_array_equal(found.values[1], AZ)
    numbers = {kind: np.array([1, 2, 100], kind) for kind in ("i1", "u1", "i2", "u2", "i4", "u4", "f4", "f8", "i8", "u8")}
    for packed in (False, True):
        scipy.io.savemat(tmp_path / "kinds.mat", {f"v{kind}": values for kind, values in numbers.items()}, do_compression=packed)
        assert np.array(read_columns(tmp_path / "kinds.mat", tuple(f"v{kind}" for kind in numbers)).values).tolist() == 10 * [[1, 2, 100]]
    with pytest.raises(InputError, match=r"vectors of one length were expected, found t \(200,\), short \(5,\)"):
        read_columns(path, ("t", "short"))
    with pytest.raises(InputError, match="no variable 'azz'; did you mean 'az'"):
        read_columns(path, ("t", "azz"))
    with pytest.raises(InputError, match="vectors of one length"):
        read_columns(path, ("t", "text"))


def test_vectors_beside_an_object_of_matlab(tmp_path: Path):
    """Tables and strings are stored without dimensions: flags, name, and what else MATLAB knows of them."""
    scipy.io.savemat(tmp_path / "run.mat", {"t": T, "az": AZ})
    parts = [(6, struct.pack("<II", 17, 0)), (1, b"log_data"), (1, b"MCOS\0\0\0\0"), (1, b"table\0\0\0")]
    body = b"".join(struct.pack("<II", mark, len(content)) + content for mark, content in parts)
    with (tmp_path / "run.mat").open("ab") as file:
        file.write(struct.pack("<II", 14, len(body)) + body)
    np.testing.assert_array_equal(read_columns(tmp_path / "run.mat", ("t", "az")).values, [T, AZ])
    with pytest.raises(InputError, match=r"no variable 'log_dat'; did you mean 'log_data'"):
        read_columns(tmp_path / "run.mat", ("log_dat",))


def test_a_formula_of_an_mdf_channel_is_never_computed(tmp_path: Path):
    """asammdf would hand a stranger's text to numexpr, and then to sympy."""
    mdf(tmp_path / "run.mf4", conversion={"formula": "X1*2"})
    with pytest.raises(InputError, match="the channel 'az' is converted by a formula, table or text; export it as plain numbers"):
        read_columns(tmp_path / "run.mf4", ("t", "az"))
    assert len(read_columns(tmp_path / "run.mf4", ("t", "other")).lines) == len(T)


def test_linear_conversions_of_mdf_count(tmp_path: Path):
    mdf(tmp_path / "run.mf4", np.arange(200, dtype=np.int16), "kN", conversion={"a": 0.5, "b": -3.0})
    found = read_columns(tmp_path / "run.mf4", ("time", "az")).in_si(1, "N", "force")
    np.testing.assert_allclose(found.values[1], 1e3 * (0.5 * np.arange(200) - 3.0), rtol=1e-12)


def test_channels_outside_of_their_records_are_refused(tmp_path: Path):
    """asammdf would read what lies behind them in memory."""
    mdf(tmp_path / "run.mf4")
    data = bytearray((tmp_path / "run.mf4").read_bytes())
    at = data.find(b"##CN")
    while at >= 0:
        links = int.from_bytes(data[at + 16 : at + 24], "little")
        offset = slice(at + 24 + 8 * links + 4, at + 24 + 8 * links + 8)
        data[offset] = (int.from_bytes(data[offset], "little") + 9).to_bytes(4, "little")
        at = data.find(b"##CN", at + 4)
    (tmp_path / "run.mf4").write_bytes(data)
    with pytest.raises(InputError, match="'az' is no plain number inside its records"):
        read_columns(tmp_path / "run.mf4", ("az",))


def test_packed_mdf_blocks_are_read_and_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    asammdf = pytest.importorskip("asammdf")
    path = tmp_path / "run.mf4"
    with asammdf.MDF(version="4.10") as file:
        file.append([asammdf.Signal(AZ, T, name="az", unit="g")])
        file.save(path, compression=2)
    data = path.read_bytes()
    at = data.index(b"##DZ")
    np.testing.assert_allclose(read_columns(path, ("t", "az")).in_si(1, "m/s^2", "acceleration").values[1], 9.80665 * AZ)
    monkeypatch.setattr("vehgen.files.tables.mdf.MAX_UNPACKED_MDF_BYTES", 1000)
    with pytest.raises(InputError, match="packed blocks of at most 1000 bytes, by deflate, were expected"):
        read_columns(path, ("t", "az"))
    monkeypatch.undo()
    path.write_bytes(data[: at + 32] + (100).to_bytes(8, "little") + data[at + 40 :])
    with pytest.raises(InputError, match="a packed block is larger than it says"):
        read_columns(path, ("t", "az"))


def test_channels_of_two_mdf_clocks_are_refused(tmp_path: Path):
    asammdf = pytest.importorskip("asammdf")
    with asammdf.MDF(version="4.10") as file:
        file.append([asammdf.Signal(AZ, T, name="az")])
        file.append([asammdf.Signal(AZ, T + 0.005, name="late")])
        file.save(tmp_path / "run.mf4")
    with pytest.raises(InputError, match="'t' and 'late' have clocks of their own"):
        read_columns(tmp_path / "run.mf4", ("t", "az", "late"))
    np.testing.assert_allclose(read_columns(tmp_path / "run.mf4", ("t", "late")).values[0], T + 0.005)


def test_units_are_those_of_the_file_and_may_not_be_contradicted(tmp_path: Path):
    path = tmp_path / "table.csv"
    path.write_text("t [ms],v (km/h),h (left),f [V]\n0,36,1,1\n500,72,2,2\n")
    found = read_columns(path, ("t", "v", "h (left)", "f"))
    assert found.units == ("ms", "km/h", None, "V")
    si = found.in_si(0, "s", "time").in_si(1, "m/s", "speed").in_si(1 + 1, "m", "height", "mm")
    np.testing.assert_allclose(np.array(si.values[:3]), [[0, 0.5], [10, 20], [1e-3, 2e-3]])
    with pytest.raises(InputError, match=r"the column 'v' is in 'km/h' as its file says \(.*table\.csv:1:2\), and in 'mph' as stated here"):
        found.in_si(1, "m/s", "speed", "mph")
    with pytest.raises(InputError, match=r"table\.csv:1:4: unknown unit 'V'"):
        found.in_si(3, "N", "force")
    assert found.in_si(3, "N", "force", "kN").values[3][1] == 2000


def test_a_spreadsheet_says_where_a_number_is_none(tmp_path: Path):
    pytest.importorskip("openpyxl")
    pd.DataFrame({"t": [0, 1], "az": [1.0, "broken"]}).to_excel(tmp_path / "run.xlsx", index=False)
    with pytest.raises(InputError, match=r"run\.xlsx:3:2: 'broken' in column 'az' is not a finite number"):
        read_columns(tmp_path / "run.xlsx", ("t", "az"))
