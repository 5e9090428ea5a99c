"""Results as values: written, read, refused, tabulated."""

import importlib
import json
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, ClassVar

import numpy as np
import pytest
from matplotlib.figure import Figure

from vehgen.errors import InputError
from vehgen.files.result_fields import IN_MEMORY, Array1D, Array2D, Flags, Number, rounded
from vehgen.files.results import Result, csv_text, json_text, kind_of, read_json


@dataclass(frozen=True, eq=False)
class Part:
    x: Array1D

    def __post_init__(self):
        if len(self.x) < 2:
            raise ValueError("two numbers or more were expected")


@dataclass(frozen=True, eq=False)
class Sample(Result):
    KIND: ClassVar[str] = "sample"
    DRAWING: ClassVar[str] = "tests.files.test_results:draw"

    name: str
    ratio: Number
    rows: Array2D
    pair: tuple[float, float] | None
    parts: dict[str, Part]
    loud: Flags
    engine: Annotated[object | None, IN_MEMORY] = field(default=None, repr=False)

    def table(self):
        return ("part", "first"), [(name, float(part.x[0])) for name, part in self.parts.items()]


def draw(result):
    figure = Figure()
    figure.suptitle(result.name)
    return figure


@pytest.fixture
def sample():
    rows = np.array([[1.0, np.nan], [1 / 3, -0.0]])
    return Sample("<b>", float("nan"), rows, (1.0, 2.0), {"a<": Part(np.array([1.5, 2.0]))}, np.array([True, False]), engine=object())


def test_a_result_survives_a_file(sample, tmp_path):
    path = tmp_path / "sample.json"
    path.write_text(json_text(sample), encoding="utf-8")
    again = Sample.from_dict(read_json(path), str(path))
    assert again == sample
    assert again.engine is None
    assert math.isnan(again.ratio)
    np.testing.assert_array_equal(again.rows, sample.rows)
    assert again.parts["a<"].x.dtype == np.float64
    assert json.loads(path.read_text(encoding="utf-8"))["format"] == "vehgen sample"


def test_results_with_other_numbers_differ(sample):
    data = sample.to_dict()
    data["rows"][1][0] = 0.3333
    assert Sample.from_dict(data) != sample


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"ratio": "3"}, "`ratio`: input should be a valid number, found '3'"),
        ({"rows": [[1], [2, 3]]}, "`rows`"),
        ({"pair": [1]}, "`pair[1]`: field required"),
        ({"parts": {"a": {"x": [1]}}}, "`parts.a`: value error, two numbers or more were expected"),
        ({"loud": [1, 0]}, "`loud[0]`: input should be a valid boolean"),
        ({"name": float("nan")}, "all numbers finite"),
        ({"format": "vehgen other"}, "holds the result of a other; that of a sample was expected"),
        ({"format": "other"}, "no result of vehgen"),
        ({"format_version": 2}, "this vehgen reads form 1"),
    ],
)
def test_what_is_wrong_is_said_with_its_place(sample, change, said):
    with pytest.raises(InputError) as caught:
        Sample.from_dict({**sample.to_dict(), **change}, "s.json")
    assert str(caught.value).startswith("s.json")
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


def test_what_is_missing_is_named(sample):
    data = sample.to_dict()
    del data["parts"]
    with pytest.raises(InputError, match="`parts`: field required"):
        Sample.from_dict(data)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b'{"a": 1,\n "b" 2}', ":2:6: not valid JSON"),
        (b"\xff\xfe", "not UTF-8"),
        (b"[" * 100_000, "nested too deeply"),
        (b"9" * 5000, "too long"),
        (b"", ":1:1: not valid JSON"),
    ],
)
def test_a_file_that_is_no_json_is_refused_in_one_line(tmp_path, content, said):
    path = tmp_path / "x.json"
    path.write_bytes(content)
    with pytest.raises(InputError) as caught:
        read_json(path)
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_file_without_an_end_is_refused(monkeypatch, tmp_path):
    monkeypatch.setattr("vehgen.files.results.MAX_RESULT_BYTES", 10)
    path = tmp_path / "x.json"
    path.write_text("[1, 2, 3, 4, 5]", encoding="utf-8")
    with pytest.raises(InputError, match="at most 10 bytes"):
        read_json(path)
    with pytest.raises(InputError, match="no file"):
        read_json(tmp_path / "none.json")
    with pytest.raises(InputError, match="is a folder"):
        read_json(tmp_path)


def test_the_nearest_kind_is_named():
    with pytest.raises(InputError, match="did you mean 'diagnosis'"):
        kind_of({"format": "vehgen diagnoses"}, "d.json", ("diagnosis", "validation"))


def test_a_notebook_shows_a_table_with_everything_escaped(sample):
    shown = sample._repr_html_()
    assert "<td>a&lt;</td><td>1.5</td>" in shown


def test_a_table_becomes_a_dataframe_where_pandas_is(sample):
    pandas = pytest.importorskip("pandas")
    frame = sample.to_dataframe()
    assert isinstance(frame, pandas.DataFrame)
    assert frame["first"].tolist() == [1.5]


def test_without_pandas_the_error_says_what_to_install(sample, monkeypatch):
    def refuse(name):
        raise ModuleNotFoundError(name)

    monkeypatch.setattr("vehgen.files.results.import_module", refuse)
    with pytest.raises(InputError, match="pip install pandas"):
        sample.to_dataframe()


def test_the_picture_is_drawn_by_the_function_that_the_class_names(sample):
    assert isinstance(sample.plot(), Figure)


def test_every_named_drawing_exists():
    for cls in _results():
        module, _, name = cls.DRAWING.partition(":")
        assert callable(getattr(importlib.import_module(module), name)), cls


def _results():
    source = Path(__file__).parents[2] / "src" / "vehgen"
    found = []
    for path in source.rglob("*.py"):
        if "(Result" in path.read_text(encoding="utf-8"):
            name = ".".join(("vehgen", *path.relative_to(source).with_suffix("").parts))
            module = importlib.import_module(name)
            found += [
                item for item in vars(module).values() if isinstance(item, type) and issubclass(item, Result) and item.__module__ == name
            ]
    kinds = [item.KIND for item in found if item is not Result]
    assert len(kinds) == len(set(kinds)) >= 4
    return [item for item in found if item is not Result]


def test_rounding_keeps_shape_and_what_counts():
    values = rounded(np.array([[123456.0, 1.23456e-9], [0.0, -2.0]]))
    assert values.tolist() == [[123460.0, 1.2346e-9], [0.0, -2.0]]


def test_a_strangers_name_in_a_table_steers_neither_terminal_nor_spreadsheet():
    text = csv_text((("vehicle", "chi"), [("a\x1b[2Jb", 1.0), ("=1+1", 2.0), ("plain", 3.0)]), ("vehicle",))
    assert text == "vehicle,chi\na\\x1b[2Jb,1\n'=1+1,2\nplain,3\n"


def test_zeros_of_a_table_have_no_sign():
    assert csv_text((("t", "a"), [(0.0, -0.0), (1.0, -1e-12)])) == "t,a\n0,0\n1,-1e-12\n"
