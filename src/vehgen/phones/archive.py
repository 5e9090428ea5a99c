"""The files of an export, from a zip, a folder, a workbook or a single file, read into memory and never unpacked to disk."""

from __future__ import annotations

import lzma
import os
import struct
import zipfile
import zlib
from collections.abc import Iterator
from pathlib import Path, PurePosixPath
from typing import IO

from vehgen.errors import InputError, shortened, shown
from vehgen.files.reading import bounded, open_regular, read_bytes, short_path
from vehgen.phones.workbook import is_workbook, read_sheets

MAX_FILE = 64 * 2**20
"""Largest file of an export [bytes]: two hours of three axes at 200 Hz."""
MAX_TOTAL = 128 * 2**20
"""Largest export [bytes], unpacked."""
MAX_FILES = 500
MAX_RATIO = 200
"""Numbers as text shrink to a third; what shrinks to less than 1/200 of 1 MB or more is a bomb."""
MAX_DIRECTORY = 2**20
"""Largest list of files at the end of a zip [bytes]; of a zip64, which names its length elsewhere, the whole file counts."""
_END_SEARCHED = 2**16 + 22
OLE = bytes.fromhex("d0cf11e0a1b11ae1")
"""The first bytes of a legacy Excel file."""
EXPECTED = "a phone's export as zip, folder, CSV file or Excel workbook (.xlsx)"
TEXT_SUFFIXES = (".csv", ".txt", ".tsv")
CSV_AGAIN = "export again as CSV (in phyphox: Export data, then CSV with a decimal point; in Sensor Logger: Zipped CSV)"
OLD_EXCEL = f"is an Excel file of the old form (.xls); save it as .xlsx, or {CSV_AGAIN}"
EXCEL_INSIDE = f"is an Excel file among others; give a workbook (.xlsx) by itself, or {CSV_AGAIN}"


def read_members(path: Path) -> dict[str, bytes]:
    """Return the text files of an export by their names inside it; of a workbook its sheets as text.

    Raises
    ------
    InputError
        For a missing, damaged, encrypted, oversized or hostile archive, an old Excel file, and an export without a CSV file.
    """
    name = short_path(path)
    try:
        if not path.exists():
            raise InputError(f"no file or folder {name}")
        members = _folder(path) if path.is_dir() else _file(path)
    except (OSError, ValueError) as error:
        raise InputError(f"cannot read {name}: {getattr(error, 'strerror', None) or error}") from error
    if not members:
        raise InputError(f"{name} holds no CSV file; {EXPECTED} was expected")
    return members


def _file(path: Path) -> dict[str, bytes]:
    with open_regular(path, MAX_TOTAL, EXPECTED) as stream:
        start = stream.read(8)
        if start == OLE:
            raise InputError(f"{path} {OLD_EXCEL}")
        stream.seek(0)
        if start.startswith(b"PK"):
            return _zip(path, stream)
        return {path.name: bounded(stream, str(path), MAX_FILE, EXPECTED)}


def _folder(path: Path) -> dict[str, bytes]:
    found: dict[str, bytes] = {}
    total = 0
    for count, file in enumerate(_walk(path, 3)):
        if count >= MAX_FILES:
            raise InputError(f"{path} holds more than {MAX_FILES} files; the folder of one export was expected")
        if file.suffix.lower() in (".xls", ".xlsx"):
            raise InputError(f"{file} {EXCEL_INSIDE}")
        if file.suffix.lower() in TEXT_SUFFIXES:
            data = read_bytes(file, MAX_FILE, "the CSV file of a phone's export")
            total += len(data)
            if total > MAX_TOTAL:
                raise InputError(f"{path} holds more than {MAX_TOTAL >> 20} MB")
            found[file.relative_to(path).as_posix()] = data
    return found


def _walk(folder: Path, depth: int) -> Iterator[Path]:
    """Yield the plain files of a folder; links are passed over, since they may lead anywhere."""
    for item in sorted(folder.iterdir()):
        if item.name.startswith((".", "__MACOSX")) or item.is_symlink():
            continue
        if item.is_dir() and depth > 0:
            yield from _walk(item, depth - 1)
        elif item.is_file():
            yield item


def _zip(path: Path, stream: IO[bytes]) -> dict[str, bytes]:
    found: dict[str, bytes] = {}
    try:
        _check_directory(path, stream)
        with zipfile.ZipFile(stream) as archive:
            if is_workbook(archive):
                return read_sheets(path, MAX_TOTAL)
            entries = archive.infolist()
            _check_entries(path, entries)
            for entry in entries:
                if PurePosixPath(entry.filename).suffix.lower() in TEXT_SUFFIXES and not entry.filename.startswith("__MACOSX"):
                    if entry.filename in found:
                        raise InputError(f"{path} holds {shown(entry.filename)} twice")
                    with archive.open(entry) as member:
                        found[entry.filename] = bounded(member, f"{path}: {entry.filename}", entry.file_size)
    except (zipfile.BadZipFile, zlib.error, lzma.LZMAError, EOFError, struct.error, NotImplementedError, RuntimeError) as error:
        raise InputError(f"{path} is a damaged zip file ({shortened(str(error))}); export again") from error
    return found


def _check_directory(path: Path, stream: IO[bytes]) -> None:
    """Refuse a zip whose list of files is longer than MAX_FILES names need, before zipfile reads it into memory."""
    size = stream.seek(0, os.SEEK_END)
    stream.seek(max(size - _END_SEARCHED, 0))
    tail = stream.read(_END_SEARCHED)
    stream.seek(0)
    end = tail.rfind(b"PK\x05\x06")
    found = tail[end + 12 : end + 16] if end >= 0 else b""
    if len(found) < 4:
        raise zipfile.BadZipFile("its end is missing")
    listed = size if tail[max(end - 20, 0) : end].startswith(b"PK\x06\x07") else int.from_bytes(found, "little")
    if listed > MAX_DIRECTORY:
        raise InputError(f"{path} lists files in {listed} bytes; at most {MAX_FILES} files were expected")


def _check_entries(path: Path, entries: list[zipfile.ZipInfo]) -> None:
    if len(entries) > MAX_FILES:
        raise InputError(f"{path} holds {len(entries)} files; at most {MAX_FILES} were expected")
    if sum(entry.file_size for entry in entries) > MAX_TOTAL:
        raise InputError(f"{path} would unpack to more than {MAX_TOTAL >> 20} MB")
    for entry in entries:
        name = entry.filename
        if name.startswith(("/", "\\")) or ".." in PurePosixPath(name.replace("\\", "/")).parts or ":" in name.partition("/")[0]:
            raise InputError(f"{path} holds the name {shown(name)}, which leads out of the archive")
        if name.lower().endswith((".xls", ".xlsx")):
            raise InputError(f"{path} holds {shown(name)}, which {EXCEL_INSIDE}")
        if entry.flag_bits & 1:
            raise InputError(f"{path} is encrypted; export without a password")
        if entry.file_size > MAX_FILE or entry.file_size > 2**20 + MAX_RATIO * max(entry.compress_size, 1):
            raise InputError(f"{path}: {shown(name)} would unpack to {entry.file_size} bytes, far more than a recording")
