"""MATLAB files of version 5 to 7: vectors of one length by their names, the time among them. MATLAB stores no units."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import numpy as np
import scipy.io

from vehgen.errors import InputError, Position, did_you_mean, shortened, shown
from vehgen.files.reading import read_bytes, short_path
from vehgen.files.tables.columns import MAX_TABLE_BYTES, TableColumns
from vehgen.files.tables.foreign import faults_of
from vehgen.files.tables.sheet import Sheet

MATLAB_KIND = "a MATLAB file"
VERSION_5 = b"MATLAB 5.0 MAT-file"
_HEADER, _COMPRESSED = 128, 15
"""Length of the header of a MATLAB 5 file [bytes], and its mark of a packed element."""


def read(path: Path, names: tuple[str, ...]) -> TableColumns:
    """Read vectors of a MATLAB file; raises InputError for a damaged one, for vectors of different lengths, and as :meth:`Sheet.select`."""
    check_unpacked(path, MAX_TABLE_BYTES, 5 * MAX_TABLE_BYTES)
    with faults_of(path, MATLAB_KIND):
        known = [name for name, _, _ in scipy.io.whosmat(str(path))]
    for name in names:
        if name not in known:
            raise InputError(f"no variable {shown(name)}; {did_you_mean(name, known)}", Position(path, 1, 1))
    with faults_of(path, MATLAB_KIND):
        found = scipy.io.loadmat(str(path), variable_names=list(names))
    vectors = [np.squeeze(np.asarray(found[name])) for name in names]
    lengths = {name: vector.shape for name, vector in zip(names, vectors, strict=True)}
    if any(len(shape) != 1 for shape in lengths.values()) or len(set(lengths.values())) > 1:
        sizes = ", ".join(f"{shortened(name)} {shape}" for name, shape in lengths.items())
        raise InputError(f"vectors of one length were expected, found {sizes}", Position(path, 1, 1))
    return Sheet(path, names, (None,) * len(names), vectors.__getitem__, len(vectors[0])).select(names)


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
