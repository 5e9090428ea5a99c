"""Files that appear whole or not at all: written under a temporary name in the same folder, then renamed.

The temporary name says which process wrote it (`.vehgen-PID-RANDOM.tmp`), so that what a killed process left behind is recognised and
removed by the next write into the same folder.
"""

from __future__ import annotations

import os
import re
import secrets
import stat
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from vehgen.errors import InputError

TEMPORARY = re.compile(r"\.vehgen-(\d{1,10})-[0-9a-f]{12}\.tmp")
"""The name of a file that is being written, with the number of the process that writes it."""
DEAD_AFTER = 60.0
"""A temporary file of a process that has ended is removed when it was untouched so long [s]; the process may run on another machine."""
STALE_AFTER = 3600.0
"""A temporary file untouched so long is removed whoever wrote it [s]: process numbers come again."""


def replace_file(path: Path, data: bytes) -> None:
    """Write a file under a temporary name and rename it; folders that lack are made, with the permissions that the umask leaves.

    Parameters
    ----------
    path
        The file; a file of this name is replaced.
    data
        What it shall hold.

    Raises
    ------
    InputError
        For whatever the operating system refuses: no permission, a full disk, a name too long. Nothing half-written stays behind.
    """
    try:
        with temporary_file(path.parent) as draft:
            draft.write_bytes(data)
            draft.replace(path)
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror or error}") from error


@contextmanager
def temporary_file(folder: Path) -> Iterator[Path]:
    """Make an empty file in a folder under a temporary name; it is removed at the end unless it was renamed.

    Parameters
    ----------
    folder
        Where; it is made if it lacks, and freed of what killed processes left in it.

    Raises
    ------
    OSError
        When the operating system refuses.
    """
    folder.mkdir(parents=True, exist_ok=True)
    remove_leftovers(folder)
    path = folder / f".vehgen-{os.getpid()}-{secrets.token_hex(6)}.tmp"
    os.close(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))
    try:
        yield path
    finally:
        with suppress(OSError):
            path.unlink(missing_ok=True)


def remove_leftovers(folder: Path) -> None:
    """Remove the user's own temporary files of processes that were killed while they wrote into a folder; never raises OSError."""
    with suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            match = TEMPORARY.fullmatch(entry.name)
            if match and _is_leftover(entry, int(match[1])):
                with suppress(OSError):
                    Path(entry.path).unlink()


def _is_leftover(entry: os.DirEntry[str], process: int) -> bool:
    try:
        found = entry.stat(follow_symlinks=False)
    except OSError:
        return False
    if not stat.S_ISREG(found.st_mode) or (hasattr(os, "getuid") and found.st_uid != os.getuid()):
        return False
    age = time.time() - found.st_mtime
    return age > STALE_AFTER or (age > DEAD_AFTER and not _runs(process))


def _runs(process: int) -> bool:
    """Whether a process of this number runs on this machine; True where that cannot be asked."""
    if os.name != "posix":
        return True
    try:
        os.kill(process, 0)  # signal 0 only asks
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):
        return True
    return True
