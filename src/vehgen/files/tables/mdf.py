"""Measurement files of ASAM, MDF 4 (.mf4): channels by their names, with their units; `t` or `time` is the clock of their group.

A file may hold formulas for its channels, and asammdf would compute them: only plain numbers and linear conversions are read.
"""

from __future__ import annotations

import logging
import struct
import zlib
from contextlib import closing, suppress
from pathlib import Path
from typing import Any

import numpy as np

from vehgen.errors import InputError, Position, did_you_mean, shown
from vehgen.files.reading import read_bytes
from vehgen.files.tables.columns import MAX_TABLE_BYTES, TableColumns
from vehgen.files.tables.foreign import faults_of, library
from vehgen.files.tables.sheet import Sheet, check_size

MDF_KIND = "an MDF 4 file"
MDF_CLOCKS = ("t", "time")
"""What the clock of a group may be called in a run file, whatever its own name."""
_VERSION_BYTES = 16
MAX_UNPACKED_MDF_BYTES = 2 * MAX_TABLE_BYTES
"""Packed blocks of one file, together, unpack to at most this [bytes]."""
_PACKED = b"##DZ"
_PACKED_HEADER = struct.Struct("<4s4xQQ2sBBIQQ")
"""Mark, length and links of a packed block; what it held, how it is packed, and its sizes, unpacked and packed."""
_DEFLATE = (0, 1)
_NUMBER_CHANNELS, _VIRTUAL_CHANNELS = (0, 2), (3, 6)
"""Types of channel of MDF 4: those with a number in every record, the clock among them, and those that only count records."""
_NUMBER_DATA = range(6)
"""Types of data of MDF 4: integers and reals in both orders of bytes."""
_VALIDITY_FLAGS = 3
_PLAIN_OR_LINEAR = (0, 1)
"""Types of conversion of MDF 4: of the others one is a formula, and the rest are tables and texts."""


def read(path: Path, names: tuple[str, ...]) -> TableColumns:
    """Read channels of an MDF 4 file.

    Raises
    ------
    InputError
        For a damaged, unfinished or older file, for a missing channel, one of several groups or clocks, one with a conversion that is
        neither plain nor linear, and as :meth:`Sheet.select`.
    """
    head = read_bytes(path, MAX_TABLE_BYTES, MDF_KIND)[:_VERSION_BYTES]
    if head[:8] != b"MDF     " or head[8:10] != b"4.":
        version = head[8:12].decode("ascii", "replace")
        raise InputError(f"a finished MDF file of version 4 was expected, found {shown(version)}; convert it", Position(path, 1, 1))
    _check_packed(path)
    asammdf = library("asammdf", "mdf", path)
    library("asammdf.blocks.mdf_v4", "mdf", path).MDF4.__del__ = _close
    logging.getLogger("asammdf").setLevel(logging.CRITICAL)
    with faults_of(path, MDF_KIND):
        file = asammdf.MDF(str(path), process_bus_logging=False)
    with closing(file):
        return _select(path, file, names)


def _check_packed(path: Path) -> None:
    """Refuse packed blocks that unpack to more than they say, or all of them to more than any table; raises InputError."""
    data = read_bytes(path, MAX_TABLE_BYTES, MDF_KIND)
    place, total = data.find(_PACKED), 0
    while place >= 0:
        if place + _PACKED_HEADER.size <= len(data):
            *_, method, _, _, told, size = _PACKED_HEADER.unpack_from(data, place)
            begin = place + _PACKED_HEADER.size
            total += told
            if method not in _DEFLATE or told > MAX_UNPACKED_MDF_BYTES or total > MAX_UNPACKED_MDF_BYTES:
                what = f"packed blocks of at most {MAX_UNPACKED_MDF_BYTES} bytes, by deflate, were expected"
                raise InputError(f"{what}; save the file unpacked", Position(path, 1, 1))
            with faults_of(path, MDF_KIND):
                found = zlib.decompressobj().decompress(data[begin : begin + size], told + 1)
            if len(found) > told:
                raise InputError("a packed block is larger than it says: the file is damaged", Position(path, 1, 1))
        place = data.find(_PACKED, place + 1)


def _close(file: Any) -> None:
    """Close a file as asammdf does when it lets go of one, without the complaint that Python prints of one that was read in part."""
    with suppress(AttributeError):
        file.close()


def _select(path: Path, file: Any, names: tuple[str, ...]) -> TableColumns:
    masters: dict[int, int] = dict(file.masters_db)
    places = [_place(path, file, masters, name) for name in names]
    home = next((place for place in places if place is not None), None)
    if home is None:
        raise InputError("a clock alone is no table; a channel was expected", Position(path, 1, 1))
    if home[0] not in masters:
        raise InputError(f"the group of {shown(names[places.index(home)])} has no clock", Position(path, 1, 1))
    wanted = [(home[0], masters[home[0]]) if place is None else place for place in places]
    signals = []
    for name, (group, index) in zip(names, wanted, strict=True):
        with faults_of(path, MDF_KIND):
            channels = [file.groups[group].channels[place] for place in (index, masters.get(group, index))]
            kinds = [channel.conversion.conversion_type for channel in channels if channel.conversion is not None]
            fits = all(_fits(channel, file.groups[group].channel_group) for channel in channels)
            n_samples = int(file.groups[group].channel_group.cycles_nr)
        check_size(path, n_samples, len(names))
        if not fits:
            raise InputError(f"the channel {shown(name)} is no plain number inside its records; export it as numbers", Position(path, 1, 1))
        if not set(kinds) <= set(_PLAIN_OR_LINEAR):
            raise InputError(
                f"the channel {shown(name)} is converted by a formula, table or text; export it as plain numbers", Position(path, 1, 1)
            )
        with faults_of(path, MDF_KIND):
            signals.append(file.get(group=group, index=index, ignore_invalidation_bits=False))
    clock = np.asarray(signals[0].timestamps)
    for name, signal in zip(names, signals, strict=True):
        own = np.asarray(signal.timestamps)
        if own.shape != clock.shape or not np.array_equal(own, clock):
            raise InputError(
                f"{shown(names[0])} and {shown(name)} have clocks of their own; export them on one raster (asammdf: resample)",
                Position(path, 1, 1),
            )
    clocks = set(masters.items())
    units = tuple("s" if place in clocks else signal.unit for place, signal in zip(wanted, signals, strict=True))
    return Sheet(path, names, units, lambda index: signals[index].samples, len(clock)).select(names)


def _fits(channel: Any, group: Any) -> bool:
    """Return whether a channel is a number that lies inside its group's records: asammdf reads wherever a damaged file says."""
    if channel.channel_type in _VIRTUAL_CHANNELS:
        return True
    n_bits = channel.bit_offset + channel.bit_count
    is_inside = channel.byte_offset + (n_bits + 7) // 8 <= group.samples_byte_nr
    has_validity = not channel.flags & _VALIDITY_FLAGS or channel.pos_invalidation_bit < 8 * group.invalidation_bytes_nr
    is_number = channel.channel_type in _NUMBER_CHANNELS and channel.data_type in _NUMBER_DATA and 0 < n_bits <= 64
    return bool(is_number and is_inside and has_validity)


def _place(path: Path, file: Any, masters: dict[int, int], name: str) -> tuple[int, int] | None:
    """Return group and index of a channel; None for the clock of whatever group the others are in."""
    found = [(group, index) for group, index in file.channels_db.get(name, ())]
    if found and all(masters.get(group) == index for group, index in found):
        return None
    if not found and name in MDF_CLOCKS:
        return None
    if not found:
        raise InputError(f"no channel {shown(name)}; {did_you_mean(name, list(file.channels_db))}", Position(path, 1, 1))
    if len(found) > 1:
        raise InputError(f"{len(found)} channels are named {shown(name)}; each needs a name of its own", Position(path, 1, 1))
    return found[0]
