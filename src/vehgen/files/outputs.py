"""Where results go: what may be written and what may be replaced.

A command writes a result under a name that is free, or over a file that vehgen wrote itself and that nobody has changed since (see
:mod:`vehgen.files.manifest`). It writes over other files only when told to (`--force`), and never over a file that it reads, a symbolic
link, a folder, a device, a pipe or a socket. A link is refused rather than followed: it may lead to anything, and replacing it would cut
it off.

The rules hold inside :func:`guarding_results`, which the command line puts around every command. In a Python session a caller names the
files itself: there only what is no regular file is refused, and nothing is marked.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from pathlib import Path

from vehgen.errors import InputError
from vehgen.files.atomic import TEMPORARY, replace_file
from vehgen.files.inputs_seen import was_read
from vehgen.files.manifest import MANIFEST, is_own, mark_own


@dataclass(frozen=True)
class _Guard:
    """What a command may do: write over foreign files or not, and the places it has written to already."""

    force: bool
    written: set[str] = field(default_factory=set)


_GUARD: ContextVar[_Guard | None] = ContextVar("rules for the results of this command", default=None)


@contextmanager
def guarding_results(force: bool = False) -> Iterator[None]:
    """Hold the rules for commands until the block ends.

    Parameters
    ----------
    force
        Replace files that vehgen did not write, or that were changed since.
    """
    token = _GUARD.set(_Guard(force))
    try:
        yield
    finally:
        _GUARD.reset(token)


def check_results(paths: Iterable[Path]) -> None:
    """Check all files that a command is about to write, before its work begins; see :func:`check_result`.

    Raises
    ------
    InputError
        For the first that cannot be written, and when two are the same.
    """
    places: set[str] = set()
    for path in paths:
        check_result(path)
        if _place(path) in places:
            raise InputError(f"two results would be written to {path}; name another file for one of them")
        places.add(_place(path))


def check_result(path: Path) -> None:
    """Check whether a result may be written.

    Raises
    ------
    InputError
        For a name whose parent is no folder or not writable, for what is no regular file; inside :func:`guarding_results` also for a file
        that this command read, and, without force, for one that vehgen did not write or that was changed since.
    """
    if path.name == MANIFEST or TEMPORARY.fullmatch(path.name):
        raise InputError(f"cannot write {path}: vehgen keeps this name for itself; name another file")
    found = _look(path)
    if found is not None and not stat.S_ISREG(found.st_mode):
        raise InputError(f"cannot write {path}: it is {_kind(found.st_mode)}; the name of a file was expected")
    _check_folder(path)
    guard = _GUARD.get()
    if found is None or guard is None:
        return
    if was_read(path):
        raise InputError(f"{path} is a file that this command reads, which is never written over; name another file")
    if not (guard.force or _place(path) in guard.written or is_own(path)):
        raise InputError(f"{path} exists and was not written by vehgen (or was changed since); name another file or add --force")


def write_text(path: Path, text: str) -> None:
    """Write a text as UTF-8; see :func:`write_bytes`."""
    try:
        data = text.encode()
    except UnicodeEncodeError as error:
        raise InputError(f"cannot write {path}: {text[error.start]!r} is no character; is a file name not in UTF-8?") from error
    write_bytes(path, data)


def write_bytes(path: Path, data: bytes) -> None:
    """Write a result whole or not at all, and mark it as vehgen's own; folders that lack are made.

    Raises
    ------
    InputError
        When :func:`check_result` or the operating system refuses.
    """
    check_result(path)
    replace_file(path, data)
    guard = _GUARD.get()
    if guard is not None:
        guard.written.add(_place(path))
        mark_own(path, data)


def _check_folder(path: Path) -> None:
    """Check that the nearest folder above that exists is one, and may be written to."""
    for folder in path.parents:
        if not os.path.lexists(folder):
            continue
        if not folder.is_dir():
            raise InputError(f"cannot write {path}: {folder} is not a folder")
        if not os.access(folder, os.W_OK | os.X_OK):
            raise InputError(f"cannot write {path}: {folder} is a folder without permission to write")
        return


def _look(path: Path) -> os.stat_result | None:
    """Return what stands under a name, a link itself and not what it leads to; None where nothing does."""
    try:
        return path.lstat()
    except (FileNotFoundError, NotADirectoryError):
        return None
    except (OSError, ValueError) as error:
        raise InputError(f"cannot write {path}: {getattr(error, 'strerror', None) or error}") from error


def _kind(mode: int) -> str:
    kinds = ((stat.S_ISLNK, "a symbolic link"), (stat.S_ISDIR, "a folder"), (stat.S_ISFIFO, "a pipe"), (stat.S_ISSOCK, "a socket"))
    return next((name for is_kind, name in kinds if is_kind(mode)), "a device")


def _place(path: Path) -> str:
    return str(Path(os.path.realpath(path.parent)) / path.name)
