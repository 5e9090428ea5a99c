"""What it takes to make a result again: versions, and hashes of the files that it was made from."""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Iterable, Mapping
from importlib import metadata
from pathlib import Path

from vehgen.files.reading import read_bytes
from vehgen.files.tables import MAX_TABLE_BYTES

PACKAGES = ("numpy", "scipy", "numba")
"""What numbers depend on."""


def versions(packages: Iterable[str] = PACKAGES) -> dict[str, str]:
    """Return the versions of vehgen, of Python and of packages (default: those that compute)."""
    from vehgen import __version__

    return {"vehgen": __version__, "python": platform.python_version(), **{name: metadata.version(name) for name in packages}}


def file_hashes(files: Mapping[str, Path]) -> dict[str, str]:
    """Return the SHA-256 of files by name; what is no file is left out."""
    return {name: file_hash(path) for name, path in files.items() if path.is_file()}


def file_hash(path: Path) -> str:
    """Return the SHA-256 of a file; raises InputError where it cannot be read."""
    return hashlib.sha256(read_bytes(path, MAX_TABLE_BYTES)).hexdigest()
