"""Universal files (UFF, UNV): time responses, dataset 58, by id, or by node and direction; `t` or `time` is their abscissa."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from vehgen.errors import InputError, Position, shown
from vehgen.files.tables.columns import TableColumns
from vehgen.files.tables.foreign import faults_of, library
from vehgen.files.tables.sheet import Sheet

UFF_KIND = "a universal file (UFF 58)"
UFF_CLOCKS = ("t", "time")
TIME_RESPONSE = 1
"""Function type of a time response."""
MOST_DATASETS = 2000
_DIRECTIONS = {
    0: "",
    1: "+X",
    2: "+Y",
    3: "+Z",
    4: "+RX",
    5: "+RY",
    6: "+RZ",
    -1: "-X",
    -2: "-Y",
    -3: "-Z",
    -4: "-RX",
    -5: "-RY",
    -6: "-RZ",
}
_NO_NAME = ("", "NONE")
_NEEDED = {"func_type", "rsp_node", "rsp_dir", "x", "data"}


def read(path: Path, names: tuple[str, ...]) -> TableColumns:
    """Read time responses of a universal file; raises InputError for a damaged one, other functions, several clocks, and missing names."""
    pyuff = library("pyuff", "uff", path)
    with faults_of(path, UFF_KIND):
        file = pyuff.UFF(str(path))
        kinds = list(file.get_set_types())
    numbers = [i for i, kind in enumerate(kinds) if kind == 58]
    if not 0 < len(numbers) <= MOST_DATASETS:
        raise InputError(f"1 to {MOST_DATASETS} datasets 58 were expected, found {len(numbers)}", Position(path, 1, 1))
    with faults_of(path, UFF_KIND):
        sets: list[dict[str, Any]] = [file.read_sets(i) for i in numbers]
    if not all(item.keys() >= _NEEDED for item in sets):
        raise InputError("a dataset 58 lacks its abscissa or its data: the file is damaged", Position(path, 1, 1))
    sets = [item for item in sets if item["func_type"] == TIME_RESPONSE]
    if not sets:
        raise InputError("no dataset 58 is a time response", Position(path, 1, 1))
    headings = _headings(sets)
    clock = np.asarray(sets[0]["x"])
    clock_name = next((name for name in names if name in UFF_CLOCKS and name not in headings), UFF_CLOCKS[0])
    for name in names:
        own = np.asarray(sets[headings.index(name)]["x"]) if name in headings else clock
        if own.shape != clock.shape or not np.allclose(own, clock, rtol=1e-9, atol=1e-9):
            raise InputError(f"{shown(name)} and {shown(headings[0])} have clocks of their own; export them together", Position(path, 1, 1))
    units = (_unit(sets[0], "abscissa") or "s", *(_unit(item, "ordinate") for item in sets))

    def column(index: int) -> Any:
        return clock if index == 0 else np.real_if_close(np.asarray(sets[index - 1]["data"]))

    return Sheet(path, (clock_name, *headings), units, column, len(clock)).select(names)


def _headings(sets: list[dict[str, Any]]) -> list[str]:
    """Return what functions are called: their ids where each has one of its own, else node and direction."""
    ids = [str(item.get("id1") or "").strip() for item in sets]
    if len(set(ids)) == len(ids) and not any(name in _NO_NAME for name in ids):
        return ids
    return [f"{item['rsp_node']}{_DIRECTIONS.get(int(item['rsp_dir']), '')}" for item in sets]


def _unit(item: dict[str, Any], axis: str) -> str | None:
    label = str(item.get(f"{axis}_axis_units_lab") or "").strip()
    return None if label.upper() in _NO_NAME else label
