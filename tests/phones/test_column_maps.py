"""Plain CSVs of several loggers, each with headings of its own."""

import numpy as np
import pytest

from vehgen.commands import main
from vehgen.errors import ArgumentError
from vehgen.phones import ColumnMap, PhoneSensor, import_phones
from vehgen.phones.importing import read_phones

T = np.arange(0.0, 12.0, 0.01)
UP = {"one": np.sin(2 * np.pi * 2 * T) * (T > 5), "two": 0.5 * np.sin(2 * np.pi * 3 * T) * (T > 5)}
MAPS = [ColumnMap("t", "az"), ColumnMap("ms", "up", time_unit="ms", acceleration_unit="g")]
SENSORS = [PhoneSensor("A", "body", x="1 m"), PhoneSensor("B", "body", x="-1 m")]


@pytest.fixture
def exports(tmp_path):
    np.savetxt(tmp_path / "one.csv", np.column_stack([T, UP["one"]]), delimiter=",", header="t,az", comments="")
    np.savetxt(tmp_path / "two.csv", np.column_stack([1e3 * T, UP["two"] / 9.80665]), delimiter=",", header="ms,up", comments="")
    return [tmp_path / "one.csv", tmp_path / "two.csv"]


def test_each_export_is_read_by_its_own_map(exports):
    phones = read_phones(exports, SENSORS, MAPS, 25.0)
    for phone, upward in zip(phones, UP.values(), strict=True):
        np.testing.assert_allclose(phone.acceleration.time, T, atol=1e-9)
        np.testing.assert_allclose(phone.acceleration.values[:, 0], upward, atol=1e-9)


@pytest.mark.parametrize("one_map", [MAPS[0], MAPS[:1]])
def test_one_map_serves_all_exports(exports, one_map):
    np.savetxt(exports[1], np.column_stack([T, UP["two"]]), delimiter=",", header="t,az", comments="")
    second = read_phones(exports, SENSORS, one_map, 25.0)[1]
    np.testing.assert_allclose(second.acceleration.values[:, 0], UP["two"], atol=1e-9)


def test_maps_must_be_as_many_as_exports(exports, capsys):
    with pytest.raises(ArgumentError, match="3 maps of columns and 2 exports: give one for all, or one for each in the same order"):
        read_phones(exports, SENSORS, [*MAPS, MAPS[0]], 25.0)
    with pytest.raises(ArgumentError, match="`columns` lacks the key acceleration"):
        import_phones(
            exports, vehicle="sedan2", sensors=SENSORS, hump={"shape": "half_sine", "length": 0.5, "height": 0.03},
            columns=[{"time": "t", "acceleration": "az"}, {"time": "ms"}],
        )  # fmt: skip
    arguments = ["--vehicle", "sedan2", "--sensor", "A:body=body,x=1", "--hump", "half_sine,length=0.5,height=0.03", "--out", "run.yaml"]
    maps = ["--columns", "time=t,acceleration=az", "--columns", "time=ms,acceleration=up"]
    assert main(["import", str(exports[0]), *arguments, *maps]) == 2
    assert "2 maps of columns and 1 exports" in capsys.readouterr().err
