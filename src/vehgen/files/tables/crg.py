"""Roads of OpenCRG (.crg): `distance` along the reference line and `height` on it, or under wheels: `height at 0.9 and -0.9`.

Places across are metres to the left of the reference line; of several, the mean counts: a vehicle in the pitch plane has one wheel an axle.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError, Position, shown
from vehgen.files.reading import read_bytes
from vehgen.files.tables.columns import MAX_TABLE_BYTES, TableColumns
from vehgen.files.tables.foreign import faults_of, library
from vehgen.files.tables.sheet import Sheet, check_size

CRG_KIND = "an OpenCRG file"
_PLACE = r"-?\d{1,3}(?:\.\d{1,6})?"
_HEIGHT = re.compile(rf"height(?: at ({_PLACE}(?: and {_PLACE})*))?", re.ASCII)
_OTHER_FILE = re.compile(rb"^\$ROAD_CRG_FILE", re.MULTILINE | re.IGNORECASE)

_END = re.compile(rb"^\s*reference_line_end_u\s*=\s*([-+0-9.eE]{1,40})\s*$", re.MULTILINE | re.IGNORECASE)


def read(path: Path, names: tuple[str, ...]) -> TableColumns:
    """Read distance and heights of a road; raises InputError for a damaged file, one that names another, and a place beside the road."""
    data = read_bytes(path, MAX_TABLE_BYTES, CRG_KIND).replace(b"\r", b"\n")
    if _OTHER_FILE.search(data):
        raise InputError("the road's data stand in another file ($ROAD_CRG_FILE); save it as one file", Position(path, 1, 1))
    across = [_across(path, name) for name in names]
    pyopencrg = library("pyopencrg", "crg", path)
    with faults_of(path, CRG_KIND):
        road = pyopencrg.read(str(path))
        last, step, low, high = float(road.u_end), float(road.u_inc), float(road.v_min), float(road.v_max)
        n_sections = int(road.nu)
    _check_end(path, data, last, step)
    check_size(path, n_sections, len(names))
    for places in across:
        for place in places or ():
            if not low <= place <= high:
                raise InputError(f"{place:g} m lies beside the road, which reaches from {low:g} to {high:g} m", Position(path, 1, 1))
            _check_gaps(path, road, place)
    with faults_of(path, CRG_KIND):
        road = road.apply_mods()
        columns = [_column(road, places) for places in across]
    return Sheet(path, names, ("m",) * len(names), columns.__getitem__, len(columns[0])).select(names)


def _check_end(path: Path, data: bytes, last: float, step: float) -> None:
    """Refuse a road that does not end where its header says [m]; raises InputError."""
    found = _END.search(data)
    if found is None:
        return
    try:
        told = float(found.group(1))
    except ValueError as error:
        raise InputError(f"the end of the reference line is no number: {shown(found.group(1).decode())}", Position(path, 1, 1)) from error
    if abs(told - last) > step:
        raise InputError(f"the header tells of a road to {told:g} m, its data end at {last:g} m: the file was cut", Position(path, 1, 1))


def _across(path: Path, name: str) -> tuple[float, ...] | None:
    """Return the places across the road whose mean height a column is; None for the distance."""
    if name == "distance":
        return None
    found = _HEIGHT.fullmatch(name)
    if found is None:
        known = "`distance`, `height`, or e.g. `height at 0.9 and -0.9`"
        raise InputError(f"no column {shown(name)}; an OpenCRG file has {known}", Position(path, 1, 1))
    return tuple(float(place) for place in (found.group(1) or "0").split(" and "))


def _check_gaps(path: Path, road: Any, place: float) -> None:
    """Refuse a road without heights at a place across it; raises InputError at the first cross section. Modifiers would fill such gaps."""
    v = np.asarray(road.v, dtype=np.float64)
    beside = slice(max(int(np.searchsorted(v, place, side="right")) - 1, 0), int(np.searchsorted(v, place)) + 1)
    for row in np.flatnonzero(np.isnan(np.asarray(road.z)[:, beside]).any(axis=1)):
        told = f"the road has no height {float(road.u[row]):g} m along it, {place:g} m across"
        raise InputError(told, Position(path, int(row) + 1, 1))


def _column(road: Any, across: tuple[float, ...] | None) -> NDArray[np.float64]:
    """Return the distance along the road, or the mean height at places across it [m]."""
    if across is None:
        along = np.asarray(road.u, dtype=np.float64)
        return np.asarray(along - along[0])
    return np.asarray(np.mean([road.long_section(place)[1] for place in across], axis=0), dtype=np.float64)
