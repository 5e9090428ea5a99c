"""Read a file that a stranger wrote: regular files only, of a bounded size, as UTF-8 whose faults have a place."""

from __future__ import annotations

import codecs
import io
import os
import stat
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import IO, BinaryIO, TextIO

from vehgen.errors import InputError, Position, escaped, nearest_names, shown
from vehgen.files.inputs_seen import note_read

LONGEST_LINE = 1_000_000
"""No line of a text is longer [characters]."""
OLD_WINDOWS = "vehgen-windows-1252"
"""How Python's decoders call that bytes which are not UTF-8 are Windows-1252."""
LIKE_A_FILE = 0.75
"""A file whose name is so like a missing one's, 1 for the same, may have been meant."""
_SHOWN = 200
_BLOCK = 1 << 16
_FLAGS = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOCTTY", 0) | getattr(os, "O_BINARY", 0)


def short_path(path: Path | str) -> str:
    """Return a path as errors show it: a very long one without its middle."""
    text = escaped(str(path))
    return text if len(text) <= _SHOWN else f"{text[: _SHOWN // 2]}...{text[-_SHOWN // 2 :]}"


def open_regular(path: Path, most: int, kind: str = "a file", *, state: bool = False) -> BinaryIO:
    """Open a file for reading, if it is a regular one of at most `most` bytes; a pipe or device is refused without waiting for it.

    Parameters
    ----------
    path
        The file.
    most
        Its largest size [bytes]. A file that grows meanwhile is for the reader to notice.
    kind
        What was expected, as errors say it: `a YAML file`.
    state
        Vehgen's own state, such as a checkpoint, which the command that reads it may write again.

    Raises
    ------
    InputError
        For a file that is missing, a folder, a pipe or device, unreadable or too large, and a path that cannot be one.
    """
    name = short_path(path)
    if not state:
        note_read(path)
    try:
        _check(os.stat(path), path, most, kind)
        handle = os.open(path, _FLAGS)
        try:
            _check(os.fstat(handle), path, most, kind)
        except InputError:
            os.close(handle)
            raise
    except FileNotFoundError as error:
        raise InputError(f"no file {name}{near_file(path)}") from error
    except OSError as error:
        raise InputError(f"cannot read {name}: {error.strerror}; {kind} was expected") from error
    except ValueError as error:
        raise InputError(f"'{name}' cannot be a path: {error}; {kind} was expected") from error
    return os.fdopen(handle, "rb")


def near_file(path: Path) -> str:
    """Return a hint at the file whose name is nearest to that of a missing one, empty where none is near."""
    with suppress(OSError):
        beside = {item.stem: item.name for item in path.parent.iterdir() if item.suffix.casefold() == path.suffix.casefold()}
        for stem in nearest_names(path.stem, beside, 1, LIKE_A_FILE):
            return f"; did you mean {shown(beside[stem])}?"
    return ""


def _check(status: os.stat_result, path: Path, most: int, kind: str) -> None:
    name = short_path(path)
    if stat.S_ISDIR(status.st_mode):
        raise InputError(f"{name} is a folder; {kind} was expected")
    if not stat.S_ISREG(status.st_mode):
        raise InputError(f"{name} is a pipe, socket or device; {kind} was expected")
    if status.st_size > most:
        raise InputError(f"{status.st_size} bytes; {kind} of at most {most} bytes was expected", Position(path, 1, 1))


def read_bytes(path: Path, most: int, kind: str = "a file", *, state: bool = False) -> bytes:
    """Return the bytes of a regular file of at most `most`; raises InputError as :func:`open_regular`."""
    with open_regular(path, most, kind, state=state) as stream:
        return bounded(stream, short_path(path), most, kind)


def bounded(stream: IO[bytes], name: str, most: int, kind: str = "a file") -> bytes:
    """Return the rest of a stream; raises InputError where it is longer than `most` bytes or cannot be read."""
    try:
        data = stream.read(most + 1)
    except OSError as error:
        raise InputError(f"cannot read {name}: {error.strerror}") from error
    if len(data) > most:
        raise InputError(f"{name} is larger than {most} bytes; {kind} of at most that was expected")
    return data


def read_text(path: Path, most: int, kind: str = "a text file", *, state: bool = False) -> str:
    r"""Return the UTF-8 text of a regular file, its lines ended by `\n`.

    Raises
    ------
    InputError
        As :func:`open_regular`, and at the line and column of bytes that are not UTF-8.
    """
    data = read_bytes(path, most, kind, state=state)
    try:
        return data.decode("utf-8").replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError as error:
        raise not_utf8(io.BytesIO(data), path) from error


def _as_windows_1252(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeDecodeError) or error.encoding != "utf-8":
        raise error
    try:
        return error.object[error.start : error.end].decode("cp1252"), error.end
    except UnicodeDecodeError:
        raise error from None


codecs.register_error(OLD_WINDOWS, _as_windows_1252)


def read_lines(path: Path, most: int, kind: str = "a text file", *, undecodable: str = "strict") -> Iterator[str]:
    r"""Yield the lines of a UTF-8 or marked UTF-16 file with the ends they have: `\n`, `\r\n` or `\r`; a byte order mark is left out.

    Parameters
    ----------
    path
        The file.
    most
        Its largest size [bytes].
    kind
        What was expected, as errors say it.
    undecodable
        What becomes of bytes that are not UTF-8: they are refused, or with OLD_WINDOWS taken for Windows-1252, as spreadsheets write it.

    Raises
    ------
    InputError
        As :func:`open_regular`, for a line beyond LONGEST_LINE, and at the line and column of bytes that are not UTF-8.
    """
    with open_regular(path, most, kind) as stream:
        total = 0
        try:
            encoding = "utf-16" if stream.read(2) in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig"
            stream.seek(0)
            text = io.TextIOWrapper(stream, encoding=encoding, errors=undecodable, newline="")
            for line in split_lines(text, path):
                total += len(line)
                if total > most:
                    raise InputError(f"{short_path(path)} is larger than {most} bytes; {kind} of at most that was expected")
                yield line
        except UnicodeDecodeError as error:
            stream.seek(0)
            raise not_utf8(stream, path) from error
        except OSError as error:
            raise InputError(f"cannot read {short_path(path)}: {error.strerror}") from error


def split_lines(text: TextIO, where: Path | str) -> Iterator[str]:
    """Yield the lines of a text; raises InputError at a line beyond LONGEST_LINE characters."""
    count = 0
    while line := text.readline(LONGEST_LINE + 1):
        count += 1
        if len(line) > LONGEST_LINE:
            raise InputError(f"a line of more than {LONGEST_LINE} characters; a text of lines was expected", Position(where, count, 1))
        yield line


def not_utf8(stream: BinaryIO, where: Path | str) -> InputError:
    """Return the error at the first bytes of a stream that are not UTF-8."""
    decoder = codecs.getincrementaldecoder("utf-8")()
    line, column, wrong = 1, 1, b""
    while not wrong:
        block = stream.read(_BLOCK)
        try:
            text = decoder.decode(block, final=not block)
        except UnicodeDecodeError as error:
            text, wrong = error.object[: error.start].decode("utf-8"), error.object[error.start : error.start + 1]
        line += text.count("\n")
        column = len(text) - text.rfind("\n") if "\n" in text else column + len(text)
        if not block:
            break
    return InputError(
        f"not UTF-8 text: the byte 0x{wrong.hex() or '00'} cannot stand here; save the file as UTF-8", Position(where, line, column)
    )
