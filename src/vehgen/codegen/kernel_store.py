"""Compiled kernels on disk: one file a kernel, read only where nobody else could have written it and its digest holds.

numba keeps compiled code as pickles and machine code, both of which run when they are read. So vehgen packs what numba wrote into one file
`kernel_HASH.bundle`: a mark, a digest, and an archive. A file that is damaged, foreign or of another version is not opened any further: it
counts as absent, the kernel is compiled anew, and the file replaced.
"""

from __future__ import annotations

import atexit
import errno
import hashlib
import io
import os
import shutil
import stat
import tempfile
import time
import warnings
import zipfile
from contextlib import suppress
from pathlib import Path

from vehgen.errors import CacheWarning

MARK = b"vehgen kernel 1\n"
MAX_BUNDLE_BYTES = 100_000_000
SECONDS_PER_DAY = 86_400.0
PARTS = (".nbi", ".nbc", ".pyc")
"""What numba and Python write beside a source file: an index, machine code, byte code."""

_private: dict[int, Path] = {}
_writable: dict[Path, Path] = {}


def distrust(folder: Path) -> str | None:
    """Say why what stands in a folder could be another user's, None where only this user can write to it.

    Parents count only where everybody may write to them without the sticky bit, and so exchange the folder.
    """
    if not hasattr(os, "geteuid"):
        return None
    folder = folder.resolve()
    found = folder.stat()
    if not stat.S_ISDIR(found.st_mode):
        return "it is not a folder"
    if found.st_uid != os.geteuid():
        return "it belongs to another user"
    if found.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
        return f"others can write to it (mode {stat.S_IMODE(found.st_mode):04o}; 0700 was expected)"
    for parent in folder.parents:
        mode = parent.stat().st_mode
        if mode & stat.S_IWOTH and not mode & stat.S_ISVTX:
            return f"everybody can exchange it: {parent} has mode {stat.S_IMODE(mode):04o}"
    return None


def refuse_open_folder(path: Path) -> None:
    """Raise an OSError where a temporary folder stands in a place that lets other users exchange it."""
    if reason := distrust(path):
        raise OSError(errno.EPERM, f"this temporary folder is not safe: {reason}; TMPDIR chooses another", str(path))


def writable_folder(folder: Path) -> Path:
    """Return `folder` where it can be trusted and written to, else a private temporary folder that lasts as long as this process.

    The folder is made with mode 0700 where it is absent. A :class:`CacheWarning` says once why it is not used.
    """
    if folder not in _writable:
        try:
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            reason = distrust(folder)
            if reason is None:
                with tempfile.TemporaryFile(dir=folder) as probe:
                    probe.write(bytes(4096))
        except OSError as error:
            reason = error.strerror or str(error)
        if reason is not None:
            warnings.warn(
                CacheWarning(
                    f"the kernel cache {folder} is not used: {reason}; kernels are compiled anew in every process. "
                    "VEHGEN_CACHE chooses another folder"
                ),
                stacklevel=2,
            )
        _writable[folder] = folder if reason is None else private_folder()
    return _writable[folder]


def private_folder() -> Path:
    """Return this process's own temporary folder, which is removed when the process ends."""
    owner = os.getpid()
    if owner not in _private:
        path = Path(tempfile.mkdtemp(prefix="vehgen_kernels_"))
        atexit.register(_remove, path, owner)
        refuse_open_folder(path)
        _private[owner] = path
    return _private[owner]


def _remove(path: Path, owner: int) -> None:
    if os.getpid() == owner:
        shutil.rmtree(path, ignore_errors=True)


def read_parts(folder: Path, name: str) -> dict[str, bytes]:
    """Return the compiled files of a kernel by file name; empty where there are none that can be trusted.

    Parameters
    ----------
    folder
        A cache folder; it need not exist.
    name
        A kernel's name.
    """
    places = [folder] if os.getpid() not in _private else [folder, private_folder()]
    for place in places:
        with suppress(OSError):
            if distrust(place) is None and (parts := _unpack(_read_own(_bundle(place, name)), name)):
                return parts
    return {}


def _bundle(folder: Path, name: str) -> Path:
    return folder / f"{name}.bundle"


def _read_own(path: Path) -> bytes:
    """Read a regular file of this user that nobody else can write to; note that it was used."""
    handle = os.open(path, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with os.fdopen(handle, "rb") as stream:
        found = os.fstat(handle)
        own = not hasattr(os, "geteuid") or (found.st_uid == os.geteuid() and not found.st_mode & (stat.S_IWGRP | stat.S_IWOTH))
        if not own or not stat.S_ISREG(found.st_mode) or found.st_size > MAX_BUNDLE_BYTES:
            return b""
        data = stream.read(MAX_BUNDLE_BYTES)
    if time.time() - found.st_mtime > SECONDS_PER_DAY:
        with suppress(OSError):
            os.utime(path)
    return data


def _digest(name: str, archive: bytes) -> bytes:
    return hashlib.sha256(name.encode() + b"\n" + archive).digest()


def _unpack(data: bytes, name: str) -> dict[str, bytes]:
    head, archive = data[: len(MARK) + 32], data[len(MARK) + 32 :]
    if head != MARK + _digest(name, archive):
        return {}
    with zipfile.ZipFile(io.BytesIO(archive)) as packed:
        return {item: packed.read(item) for item in packed.namelist() if item == Path(item).name}


def write_parts(folder: Path, name: str, parts: dict[str, bytes]) -> None:
    """Keep the compiled files of a kernel, whole or not at all; a folder that cannot take them costs a warning, not the work."""
    folder = writable_folder(folder)
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as packed:
        for item, content in sorted(parts.items()):
            packed.writestr(zipfile.ZipInfo(item), content)
    archive = buffer.getvalue()
    try:
        handle, temporary = tempfile.mkstemp(dir=folder, prefix=f".{name}.")
        try:
            with os.fdopen(handle, "wb") as stream:
                stream.write(MARK + _digest(name, archive) + archive)
            Path(temporary).replace(_bundle(folder, name))
        except BaseException:
            Path(temporary).unlink(missing_ok=True)
            raise
    except OSError as error:
        message = f"compiled code could not be kept in {folder} ({error.strerror or error}): it is compiled anew next time"
        warnings.warn(CacheWarning(message), stacklevel=2)
