"""Tracks of GPS receivers (GPX): `t` since the first point [s] and `speed` [m/s], as recorded, else from the way between points."""

from __future__ import annotations

import math
from pathlib import Path
from xml.parsers import expat

import numpy as np

from vehgen.errors import InputError, Position, shown
from vehgen.files.reading import read_bytes
from vehgen.files.tables.columns import MAX_TABLE_BYTES, TableColumns, plain_float
from vehgen.files.tables.csv_table import MOST_ROWS
from vehgen.files.tables.moments import moment
from vehgen.files.tables.sheet import Sheet

GPX_KIND = "a GPX file"
EARTH_RADIUS_M = 6_371_008.8
"""Mean radius of the earth."""
DEEPEST_ELEMENT = 50


class _Points:
    """What a parser finds: of every track point its line, place, time and speed."""

    def __init__(self, path: Path, parser: expat.XMLParserType) -> None:
        self.path, self.parser = path, parser
        self.lines: list[int] = []
        self.places: list[tuple[float, float]] = []
        self.times: list[float] = []
        self.speeds: list[float] = []
        self.text: list[str] | None = None
        self.depth = 0
        self.inside = False

    def fault(self, message: str) -> InputError:
        """Return an error at the place that the parser has reached."""
        return InputError(message, Position(self.path, self.parser.CurrentLineNumber, self.parser.CurrentColumnNumber + 1))

    def doctype(self, *_: object) -> None:
        """Refuse a DOCTYPE; raises InputError."""
        raise self.fault("a GPX file has no DOCTYPE; one with entities is refused")

    def begin(self, tag: str, attributes: dict[str, str]) -> None:
        """Begin an element: a point is noted, the text of its time or speed kept; raises InputError for bad places and for too much."""
        self.depth += 1
        if self.depth > DEEPEST_ELEMENT or len(self.lines) > MOST_ROWS:
            raise self.fault(f"deeper than {DEEPEST_ELEMENT} elements, or more than {MOST_ROWS} points")
        name = tag.rpartition(":")[2]
        if name == "trkpt":
            self.inside = True
            self.lines.append(self.parser.CurrentLineNumber)
            self.places.append((self.number(attributes.get("lat", ""), 90.0), self.number(attributes.get("lon", ""), 180.0)))
            self.times.append(math.nan)
            self.speeds.append(math.nan)
        self.text = [] if self.inside and name in ("time", "speed") else None

    def number(self, text: str, most: float) -> float:
        """Return a number of at most `most` in size; raises InputError for anything else."""
        try:
            found = plain_float(text)
        except ValueError:
            found = math.nan
        if not abs(found) <= most:
            raise self.fault(f"a number of at most {most:g} was expected, found {shown(text)}")
        return found

    def read(self, text: str) -> None:
        """Keep a piece of the text of a time or speed."""
        if self.text is not None:
            self.text.append(text)

    def end(self, tag: str) -> None:
        """End an element: the time [s since 1970] or speed [m/s] of a point is read; raises InputError for a point without a time."""
        self.depth -= 1
        name = tag.rpartition(":")[2]
        if self.text is not None and name == "time":
            self.times[-1] = self.clock("".join(self.text).strip())
        elif self.text is not None and name == "speed":
            self.speeds[-1] = self.number("".join(self.text).strip(), 1e4)
        elif name == "trkpt":
            self.inside = False
            if math.isnan(self.times[-1]):
                raise self.fault("a point without a time; a track recorded while driving was expected")
        self.text = None

    def clock(self, text: str) -> float:
        """Return a moment [s since 1970], in UTC where it names no zone; raises InputError for what is none."""
        try:
            return moment(text)
        except ValueError as error:
            raise self.fault(f"a time such as 2024-05-01T12:00:00Z was expected, found {shown(text)}") from error


def read(path: Path, names: tuple[str, ...]) -> TableColumns:
    """Read `t` and `speed` of a track; raises InputError at the line of what is wrong, for a DOCTYPE, and for fewer than two points."""
    parser = expat.ParserCreate()
    points = _Points(path, parser)
    parser.StartDoctypeDeclHandler = points.doctype
    parser.StartElementHandler, parser.EndElementHandler, parser.CharacterDataHandler = points.begin, points.end, points.read
    try:
        parser.Parse(read_bytes(path, MAX_TABLE_BYTES, GPX_KIND), True)
    except expat.ExpatError as error:
        raise InputError(f"not XML: {expat.ErrorString(error.code)}", Position(path, error.lineno, error.offset + 1)) from error
    except (LookupError, ValueError) as error:
        raise InputError("not XML: an encoding that cannot be read; UTF-8 was expected", Position(path, 1, 1)) from error
    if len(points.lines) < 2:
        raise InputError("a GPX file with a track of at least two points was expected", Position(path, 1, 1))
    time, lines = np.array(points.times), np.array(points.lines, dtype=np.int64)
    for row in np.flatnonzero(~(np.diff(time) > 0)):
        raise InputError("the times of a track must ascend", Position(path, int(lines[row + 1]), 1))
    speed = np.array(points.speeds)
    if np.isnan(speed).any():
        speed = np.gradient(_way(np.radians(np.array(points.places))), time)
    columns = time - time[0], speed
    return Sheet(path, ("t", "speed"), ("s", "m/s"), columns.__getitem__, len(time), lines).select(names)


def _way(places: np.ndarray[tuple[int, int], np.dtype[np.float64]]) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Return the way from the first point to every other [m] along great circles through places `shape (n, 2)`, latitude first [rad]."""
    latitude, longitude = places.T
    half = np.sin(np.diff(latitude) / 2) ** 2 + np.cos(latitude[1:]) * np.cos(latitude[:-1]) * np.sin(np.diff(longitude) / 2) ** 2
    return np.concatenate([[0.0], np.cumsum(2 * EARTH_RADIUS_M * np.arcsin(np.sqrt(np.clip(half, 0.0, 1.0))))])
