"""Equations of motion that an earlier process derived: plain data beside the compiled kernels, read only where they can be trusted."""

from __future__ import annotations

import hashlib
import json
import sys
import warnings
from functools import cache
from importlib import metadata
from pathlib import Path

from vehgen.codegen.cache import cache_folder
from vehgen.codegen.cache_pruning import prune
from vehgen.codegen.kernel_store import read_parts, writable_folder, write_parts
from vehgen.errors import CacheWarning
from vehgen.files.entry import file_form
from vehgen.mechanics.plain_equations import PlainEquations
from vehgen.vehicle import Vehicle

EQUATIONS_FILE = "equations.json"
DERIVING_ROOMS = ("files", "vehicle", "mechanics")
"""Rooms whose code makes equations of a vehicle's file."""


def equations_as_data(vehicle: Vehicle) -> PlainEquations | None:
    """Return a vehicle's equations without channels, derived now or by an earlier process of this user, version and vehicle.

    Returns
    -------
    None where they are no plain data, for functions that their expressions hold. A cache that cannot be written to costs time only.
    """
    folder, name = cache_folder(), equations_name(vehicle)
    known = read_parts(folder, name)
    if EQUATIONS_FILE in known:
        return PlainEquations.from_text(known[EQUATIONS_FILE].decode())
    from vehgen.mechanics.derivation import derive

    found = PlainEquations.of(derive(vehicle))
    if found is not None:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", CacheWarning)
            write_parts(folder, name, {EQUATIONS_FILE: found.to_text().encode()})
            prune(writable_folder(folder))
    return found


def equations_name(vehicle: Vehicle) -> str:
    """Return what a vehicle's equations are called in the cache: a hash of its file's form and of all that derives them."""
    parts = [json.dumps(file_form(vehicle), default=str), metadata.version("sympy"), sys.version, _code()]
    digest = hashlib.sha256("\n".join(parts).encode()).hexdigest()
    return f"model_{digest[:20]}"


@cache
def _code() -> str:
    """Return the version of the code that derives equations: a hash of its files, whatever their times say."""
    return code_hash(Path(__file__).parents[1])


def code_hash(root: Path) -> str:
    """Return a hash of the names and the content of the files of the deriving rooms under `root`."""
    found = hashlib.sha256()
    for path in (path for room in DERIVING_ROOMS for path in sorted((root / room).rglob("*.py"))):
        data = path.read_bytes()
        found.update(f"{path.relative_to(root).as_posix()} {len(data)}\n".encode())
        found.update(data)
    return found.hexdigest()
