"""MATLAB files of version 5 to 7: vectors of one length by their names, the time among them. MATLAB stores no units.

They are read here, not by scipy: its reader trusts the sizes in a file, and a damaged one ends the process.
"""

from __future__ import annotations

import math
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError, Position, did_you_mean, shortened, shown
from vehgen.files.reading import read_bytes, short_path
from vehgen.files.tables.columns import MAX_TABLE_BYTES, TableColumns
from vehgen.files.tables.sheet import Sheet

MATLAB_KIND = "a MATLAB file"
VERSION_5 = b"MATLAB 5.0 MAT-file"
_HEADER, _MATRIX, _COMPRESSED = 128, 14, 15
"""Length of the header of a MATLAB 5 file [bytes], and its marks of a variable and of a packed one."""
_NUMBERS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}
"""How numbers are stored, by the mark of their element."""
_NUMBER_CLASSES = range(6, 16)
"""Classes of MATLAB's arrays that hold numbers: double, single and the integers."""
_OBJECT_CLASS = 17
"""Class of tables, texts of MATLAB's newer kind and other objects: of these no dimensions are told."""
_COMPLEX = 0x0800
_NAME_BYTES = 4096
"""What a packed variable says of itself stands within so many bytes."""


@dataclass(frozen=True)
class _Variable:
    """A variable: its class and flags, its shape without dimensions of 1, and its bytes from the numbers on."""

    matrix_class: int
    flags: int
    shape: tuple[int, ...]
    values: bytes


def read(path: Path, names: tuple[str, ...]) -> TableColumns:
    """Read vectors of a MATLAB file; raises InputError for a damaged one, for vectors of different lengths, and as :meth:`Sheet.select`."""
    check_unpacked(path, MAX_TABLE_BYTES, 5 * MAX_TABLE_BYTES)
    data = read_bytes(path, MAX_TABLE_BYTES, MATLAB_KIND)
    order = ">" if data[126:128] == b"MI" else "<"
    try:
        places = {name: place for name, place in _places(data, order) if name}
        for name in names:
            if name not in places:
                raise InputError(f"no variable {shown(name)}; {did_you_mean(name, list(places))}", Position(path, 1, 1))
        found = {name: _variable(_unpacked(data, *places[name]), order)[1] for name in dict.fromkeys(names)}
    except (struct.error, zlib.error, ValueError) as error:
        raise InputError(f"{short_path(path)} cannot be read as {MATLAB_KIND}: it is damaged ({shortened(str(error))})") from error
    lengths = {name: variable.shape for name, variable in found.items()}
    if any(len(shape) != 1 for shape in lengths.values()) or len(set(lengths.values())) > 1:
        sizes = ", ".join(f"{shortened(name)} {shape}" for name, shape in lengths.items())
        raise InputError(f"vectors of one length were expected, found {sizes}", Position(path, 1, 1))
    vectors = [_vector(path, name, found[name], order) for name in names]
    return Sheet(path, names, (None,) * len(names), vectors.__getitem__, len(vectors[0])).select(names)


def _places(data: bytes, order: str) -> Iterator[tuple[str, tuple[int, int, int]]]:
    """Yield name, and mark, begin and length [bytes] of every variable of a file."""
    place = _HEADER
    while place + 8 <= len(data):
        mark, size = struct.unpack_from(f"{order}II", data, place)
        if mark not in (_MATRIX, _COMPRESSED):
            raise ValueError(f"the mark {mark} at byte {place}, where a variable was expected")
        if place + 8 + size > len(data):
            raise ValueError("it ends within a variable")
        whole = (mark, place + 8, size)
        yield _variable(_unpacked(data, *whole, most=_NAME_BYTES), order)[0], whole
        place += 8 + size


def _unpacked(data: bytes, mark: int, begin: int, size: int, most: int = 0) -> bytes:
    """Return the bytes of a variable, unpacked, at most so many of them (0: all)."""
    own = data[begin : begin + size]
    if mark == _MATRIX:
        return own[:most] if most else own
    found = zlib.decompressobj().decompress(own, most)
    return found[8:]  # its own mark and length


def _variable(own: bytes, order: str) -> tuple[str, _Variable]:
    """Return the name of a variable, and what it holds; raises ValueError or struct.error for damaged ones."""
    _, flags, place = _element(own, 0, order)
    (word,) = struct.unpack_from(f"{order}I", flags)
    sizes = b""
    if word & 0xFF != _OBJECT_CLASS:
        _, sizes, place = _element(own, place, order)
    _, name, place = _element(own, place, order)
    shape = tuple(size for size in np.frombuffer(sizes, f"{order}i4").tolist() if size != 1)
    return name.decode("latin-1"), _Variable(word & 0xFF, word, shape, own[place:])


def _element(own: bytes, place: int, order: str) -> tuple[int, bytes, int]:
    """Return mark and content of an element, and where the next begins; short ones hold their length beside their mark."""
    mark, size = struct.unpack_from(f"{order}II", own, place)
    if mark >> 16:
        size, mark = mark >> 16, mark & 0xFFFF
        if size > 4:
            raise ValueError(f"a short element of {size} bytes")
        return mark, own[place + 4 : place + 4 + size], place + 8
    if place + 8 + size > len(own):
        raise ValueError("an element is longer than its variable")
    return mark, own[place + 8 : place + 8 + size], place + 8 + -(-size // 8) * 8


def _vector(path: Path, name: str, variable: _Variable, order: str) -> NDArray[np.generic]:
    """Return the numbers of a variable; raises InputError where it holds others, or not as many as it says."""
    if variable.matrix_class not in _NUMBER_CLASSES or variable.flags & _COMPLEX:
        raise InputError(f"{shown(name)} holds no real numbers; a vector of them was expected", Position(path, 1, 1))
    try:
        mark, content, _ = _element(variable.values, 0, order)
        numbers = np.frombuffer(content, f"{order}{_NUMBERS[mark]}")
    except (struct.error, KeyError, ValueError) as error:
        raise InputError(f"{short_path(path)} is a damaged MATLAB file: {shown(name)} cannot be read; export again") from error
    if len(numbers) != math.prod(variable.shape):
        raise InputError(
            f"{shown(name)} holds {len(numbers)} numbers where {variable.shape} were told: the file is damaged", Position(path, 1, 1)
        )
    return numbers


def check_unpacked(path: Path, most: int, unpacked: int) -> None:
    """Refuse a MATLAB 5 file of more than `most` bytes, or that would unpack to more than `unpacked`, before anything unpacks it whole."""
    data = read_bytes(path, most, MATLAB_KIND)
    place, total = _HEADER, 0
    while data.startswith(VERSION_5) and place + 8 <= len(data):
        kind, size = struct.unpack_from(">II" if data[126:128] == b"MI" else "<II", data, place)
        place += 8
        if kind == _COMPRESSED:
            unpacker = zlib.decompressobj()
            rest = data[place : place + size]
            while rest and total <= unpacked:
                try:
                    total += len(unpacker.decompress(rest, 2**20))
                except zlib.error as error:
                    raise InputError(f"{short_path(path)} is a damaged MATLAB file ({shortened(str(error))}); export again") from error
                rest = unpacker.unconsumed_tail
        place += size
    if total > unpacked:
        raise InputError(f"{short_path(path)} would unpack to more than {unpacked >> 20} MB")
