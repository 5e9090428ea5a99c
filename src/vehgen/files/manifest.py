"""How vehgen knows its own files: a hidden list in their folder, of names and of the hashes of what it wrote under them.

    {"vehgen files": {"response.csv": "9f86d081884c7d65..."}}

A hash and not a mark inside the file, because it serves every format alike (a CSV file has no place for a mark) and because a result that
somebody has edited since is thereby no longer vehgen's own. A result that was moved to another folder is not in the list there: it counts
as the user's. The list is a stranger's text like any other: what cannot be read as such a list is as good as none, it speaks of plain names
in its own folder only, and of them only with the hash of what they hold.
"""

from __future__ import annotations

import hashlib
import json
import os
import stat
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from vehgen.errors import InputError
from vehgen.files.atomic import replace_file

MANIFEST = ".vehgen-files.json"
"""The name of the list."""
KEY = "vehgen files"
MAX_MANIFEST_BYTES = 4 * 2**20
"""A longer list is not read [bytes]: about forty thousand names."""
PATIENCE = 2.0
"""How long to wait for another process that holds the list [s]."""


def is_own(path: Path) -> bool:
    """Whether a regular file holds exactly what vehgen last wrote under its name; False when that cannot be found out."""
    recorded = read_manifest(path.parent).get(path.name)
    if recorded is None:
        return False
    try:
        with path.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest() == recorded
    except OSError:
        return False


def mark_own(path: Path, data: bytes) -> None:
    """Enter a file that was just written; when the list cannot be written the file is merely taken for the user's next time."""
    try:
        with _alone(path.parent):
            files = {name: recorded for name, recorded in read_manifest(path.parent).items() if os.path.lexists(path.parent / name)}
            files[path.name] = hashlib.sha256(data).hexdigest()
            replace_file(path.parent / MANIFEST, json.dumps({KEY: dict(sorted(files.items()))}, indent=1).encode())
    except (InputError, OSError):
        return


def read_manifest(folder: Path) -> dict[str, str]:
    """Return the names and SHA-256 hashes (hexadecimal) that a folder's list holds; empty without a list that can be used."""
    try:
        found = (folder / MANIFEST).lstat()
        if not stat.S_ISREG(found.st_mode) or found.st_size > MAX_MANIFEST_BYTES:
            return {}
        data = json.loads((folder / MANIFEST).read_bytes())
    except (OSError, ValueError, RecursionError):
        return {}
    files = data.get(KEY) if isinstance(data, dict) else None
    if not isinstance(files, dict):
        return {}
    return {name: recorded for name, recorded in files.items() if isinstance(recorded, str) and Path(name).name == name}


@contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """Hold the folder's lock; where there are no locks, or another holds it too long, go on: a mark may be lost then, never a file."""
    try:
        import fcntl
    except ImportError:
        yield
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
                break
            except BlockingIOError:
                time.sleep(0.01)
            except OSError:
                break
        yield
    finally:
        os.close(handle)
