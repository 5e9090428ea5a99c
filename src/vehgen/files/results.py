"""Results as values: plain data and back, a table, a figure. One mixin gives these to every result class.

A result class is a frozen dataclass (``eq=False`` where it holds arrays: results are equal when their data are) in the room that computes
it. Its fields are its JSON keys, of the types of :mod:`vehgen.files.result_fields`. What is read is checked field by field; nothing of it
is ever run.
"""

from __future__ import annotations

import csv
import html
import io
import json
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Self, get_type_hints

from vehgen.errors import InputError, Position, did_you_mean, printable
from vehgen.files.reading import read_text
from vehgen.files.result_fields import IN_MEMORY

if TYPE_CHECKING:
    from pydantic import TypeAdapter

MAX_RESULT_BYTES = 50_000_000
"""A larger result file is refused."""
MAX_TABLE_ROWS = 30
"""So many rows a notebook shows at most."""
FORMULA_SIGNS = ("=", "+", "-", "@", "\t", "\r", "\n")
"""A spreadsheet may run a cell that begins so as a formula."""
Cell = str | float | int | bool | None
Table = tuple[tuple[str, ...], list[tuple[Cell, ...]]]
"""Names of columns, and rows."""


class Result:
    """What a computation returns: written with :meth:`to_dict`, read with :meth:`from_dict`, shown as table and figure.

    Attributes
    ----------
    KIND
        What the result is of: its mark in files.
    FORMAT_VERSION
        Raised when its data change their form.
    DRAWING
        The function that draws it, as `module:function`. The rooms that draw stand above those that compute, so that a result names its
        picture and imports it when it is first asked for.
    """

    KIND: ClassVar[str]
    FORMAT_VERSION: ClassVar[int] = 1
    DRAWING: ClassVar[str]

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and isinstance(other, Result) and self.to_dict() == other.to_dict()

    def to_dict(self) -> dict[str, Any]:
        """Return plain data for JSON (SI units), with the result's kind and the version of its form; undefined numbers are None."""
        data: dict[str, Any] = _adapter(type(self)).dump_python(self, mode="json", by_alias=True)
        for name in _unwritten(type(self)):
            del data[name]
        return {"format": f"vehgen {self.KIND}", "format_version": self.FORMAT_VERSION, **self._packed(data)}

    @classmethod
    def from_dict(cls, data: Any, source: str = "the data") -> Self:
        """Return the result that :meth:`to_dict` wrote.

        Parameters
        ----------
        data
            Plain data.
        source
            What errors call them: a file's name.

        Raises
        ------
        InputError
            For data of another kind or version, and for what is missing or wrong in them, with its place.
        """
        from pydantic import ValidationError

        found = kind_of(data, source)
        if found != cls.KIND:
            raise InputError(f"{source} holds the result of a {found}; that of a {cls.KIND} was expected")
        if (version := data.get("format_version")) != cls.FORMAT_VERSION:
            raise InputError(f"{source} has the form {version!r}; this vehgen reads form {cls.FORMAT_VERSION}: make the result again")
        try:
            text = json.dumps(cls._unpacked(data), allow_nan=False)
        except (ValueError, TypeError, RecursionError) as error:
            raise InputError(f"{source}: plain data were expected, all numbers finite: {error}") from error
        try:
            result: Self = _adapter(cls).validate_json(text, strict=True)
        except ValidationError as error:
            raise InputError(f"{source}: {_first_error(error)}") from error
        return result

    @classmethod
    def _unpacked(cls, data: dict[str, Any]) -> dict[str, Any]:
        """Return data as the class's fields have them, from data as they are written."""
        return data

    def _packed(self, data: dict[str, Any]) -> dict[str, Any]:
        """Return data as they are written, from data as the class's fields have them."""
        return data

    def table(self) -> Table:
        """Return the result as a table."""
        raise NotImplementedError

    def to_dataframe(self) -> Any:
        """Return the result's table as a pandas DataFrame.

        Raises
        ------
        InputError
            Where pandas is not installed.
        """
        try:
            pandas = import_module("pandas")
        except ModuleNotFoundError as error:
            raise InputError("a DataFrame needs pandas, which is not installed: pip install pandas") from error
        columns, rows = self.table()
        return pandas.DataFrame(rows, columns=list(columns))

    def plot(self) -> Any:
        """Return the result's picture, a matplotlib Figure."""
        module, _, name = self.DRAWING.partition(":")
        return getattr(import_module(module), name)(self)

    def _repr_html_(self) -> str:
        columns, rows = self.table()
        head = "".join(f"<th>{html.escape(name)}</th>" for name in columns)
        body = "".join(f"<tr>{''.join(f'<td>{html.escape(_shown(cell))}</td>' for cell in row)}</tr>" for row in rows[:MAX_TABLE_ROWS])
        more = f"<p>and {len(rows) - MAX_TABLE_ROWS} rows more</p>" if len(rows) > MAX_TABLE_ROWS else ""
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{more}"


def kind_of(data: Any, source: str, known: Sequence[str] = ()) -> str:
    """Return what written data are the result of.

    Raises
    ------
    InputError
        For data that vehgen did not write, or of a kind that is not among those `known` (default: any).
    """
    mark = data.get("format") if isinstance(data, dict) else None
    word, _, kind = mark.partition(" ") if isinstance(mark, str) else ("", "", "")
    if word != "vehgen" or not kind:
        raise InputError(f"{source} is no result of vehgen: a mapping with `format`, e.g. 'vehgen diagnosis', was expected")
    if known and kind not in known:
        raise InputError(f"{source} holds the result of a {kind[:40]!r}, which has no page; {did_you_mean(kind, known)}")
    return kind


def read_json(path: Path) -> Any:
    """Return the data of a JSON file.

    Raises
    ------
    InputError
        For a file that cannot be read or is too large, and at the place where it is no JSON.
    """
    try:
        return json.loads(read_text(path, MAX_RESULT_BYTES, "the JSON file of a result"))
    except json.JSONDecodeError as error:
        raise InputError(f"not valid JSON: {error.msg}", Position(path, error.lineno, error.colno)) from error
    except ValueError as error:
        raise InputError(f"{path} holds a number that is too long") from error
    except RecursionError as error:
        raise InputError(f"{path} is nested too deeply") from error


def json_text(result: Result) -> str:
    """Return a result as a JSON file holds it: a number a line would make long files longer, so lists of numbers stand on one line."""
    return _pretty(result.to_dict(), "")


def csv_text(table: Table, names: Sequence[str] = ()) -> str:
    """Return a table as the text of a CSV file, numbers with nine digits.

    What stands in the columns `names` is a stranger's text: an apostrophe goes before what a spreadsheet would run as a formula, and what
    could steer a terminal is escaped.
    """
    columns, rows = table
    harmless = [column in names for column in columns]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([_csv_cell(*pair) for pair in zip(row, harmless, strict=True)] for row in rows)
    return text.getvalue()


def _csv_cell(cell: Cell, harmless: bool) -> Cell:
    if isinstance(cell, float):
        return f"{cell + 0.0:.9g}"  # no -0
    if not (harmless and isinstance(cell, str)):
        return cell
    return f"'{printable(cell)}" if cell.startswith(FORMULA_SIGNS) else printable(cell)


def _pretty(data: Any, indent: str) -> str:
    if isinstance(data, dict) and data:
        inner = indent + " "
        lines = [f"{inner}{json.dumps(key)}: {_pretty(value, inner)}" for key, value in data.items()]
        return "{\n" + ",\n".join(lines) + f"\n{indent}}}"
    if isinstance(data, list) and any(isinstance(item, (dict, list)) and item for item in data):
        inner = indent + " "
        return "[\n" + ",\n".join(f"{inner}{_pretty(item, inner)}" for item in data) + f"\n{indent}]"
    return json.dumps(data, allow_nan=False)


_ADAPTERS: dict[str, TypeAdapter[Any]] = {}
"""By kind of result: they take long to make."""


def _adapter(cls: type[Result]) -> TypeAdapter[Any]:
    from pydantic import TypeAdapter

    if cls.KIND not in _ADAPTERS:
        _ADAPTERS[cls.KIND] = TypeAdapter(cls)
    return _ADAPTERS[cls.KIND]


def _unwritten(cls: type[Result]) -> list[str]:
    hints = get_type_hints(cls, include_extras=True)
    return [name for name, hint in hints.items() if IN_MEMORY in getattr(hint, "__metadata__", ())]


def _first_error(error: Any) -> str:
    first = error.errors(include_url=False)[0]
    place = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in first["loc"]).removeprefix(".")
    more = f" (and {error.error_count() - 1} more)" if error.error_count() > 1 else ""
    found = first.get("input")
    said = f", found {str(found)[:40]!r}" if isinstance(found, (str, int, float, bool)) else ""
    return f"`{place[:120]}`: {first['msg'][0].lower()}{first['msg'][1:]}{said}{more}"


def _shown(cell: Cell) -> str:
    return "" if cell is None else f"{cell:.5g}" if isinstance(cell, float) else str(cell)
