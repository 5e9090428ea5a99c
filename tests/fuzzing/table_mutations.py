"""Mutations of tables (CSV) and of phone exports (zip archives of tables)."""

from __future__ import annotations

import io
import lzma
import struct
import zipfile
import zlib
from dataclasses import replace
from random import Random

from tests.fuzzing.cases import Case
from tests.fuzzing.hostile import MARK, TEXTS
from tests.fuzzing.text_mutations import TEXT_MUTATIONS

CELLS = (
    "",
    "nan",
    "NaN",
    "inf",
    "-inf",
    "1e300",
    "-1e300",
    "1e-300",
    "1e999",
    "-0",
    "0x10",
    "1_0",
    "1,5",
    "x",
    "'",
    '"',
    "1e308",
    "1e12",
    "9" * 400,
)
TRACKS = (".gpx", ".nmea")
"""Endings of tables that have no cells."""
LARGEST = 1_000_000
"""What an archive may hold to be changed once more [bytes]."""

NAMES = ("t", "", "s", "h", *TEXTS)


def cells_of(data: bytes) -> list[list[str]]:
    """Return the cells of a table."""
    return [line.split(",") for line in data.decode("utf-8", "replace").splitlines()]


def mutate_cells(random: Random, data: bytes) -> tuple[bytes, str]:
    """Change a table: a cell, a name, columns, rows, its clock; returns it with a word for what was done."""
    rows = cells_of(data)
    kind = random.choice(
        ("cell", "cell", "name", "name", "short", "column", "clock", "rows", "empty", "quote", "separator", "long", "stuck", "repeat")
    )
    i = random.randrange(len(rows)) if rows else 0
    if not rows or kind == "empty":
        return random.choice((b"", b"\n", b"t\n", b",,,\n", b"\xff\xfe", data[: len(data) // 2])), kind
    j = random.randrange(len(rows[i])) if rows[i] else 0
    if kind == "cell" and rows[i]:
        rows[i][j] = random.choice(CELLS)
    elif kind == "name":
        rows[0][random.randrange(len(rows[0]))] = random.choice(NAMES)
    elif kind == "repeat":
        rows[0] = [rows[0][0]] * len(rows[0])
    elif kind == "short":
        rows[i] = rows[i][:-1] if random.random() < 0.5 else [*rows[i], "1"]
    elif kind == "column":
        rows = [[*row[:j], random.choice(CELLS), *row[j + 1 :]] for row in rows]
    elif kind == "clock":
        factor = random.choice((-1, 0, 1e-9, 1e9, 1e300))
        rows[1:] = [[f"{factor * k:g}", *row[1:]] for k, row in enumerate(rows[1:])]
    elif kind == "rows":
        rows = [rows[0], *(rows[1:] * random.choice((0, 2, 300)))]
    elif kind == "quote":
        rows[i] = ['"' + ",".join(rows[i])]
    elif kind == "long":
        rows[i] = rows[i] * random.choice((100, 20000))
    elif kind == "stuck":
        rows[1:] = [row[:1] + rows[1][1:] for row in rows[1:]]
    separator = random.choice((";", "\t", " ", "|")) if kind == "separator" else ","
    return ("\n".join(separator.join(row) for row in rows) + random.choice(("\n", "\n", "", "\r\n"))).encode("utf-8", "surrogatepass"), kind


def mutate_table(random: Random, case: Case) -> Case:
    """Change one of the tables of a run."""
    names = [name for name in case.files if name.endswith((".csv", *TRACKS))]
    if not names:
        return case
    name = random.choice(names)
    if name.endswith(TRACKS) or random.random() < 0.3:
        data = random.choice(TEXT_MUTATIONS)(random, replace(case, main=name)).files[name]
        return replace(case, files={**case.files, name: data}, mutations=(*case.mutations, f"text of {name}"))
    data, kind = mutate_cells(random, case.files[name])
    return replace(case, files={**case.files, name: data}, mutations=(*case.mutations, f"{kind} of {name}"))


def archive_of(files: dict[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    """Return a zip archive."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", method) as archive:
        for name, content in files.items():
            archive.writestr(zipfile.ZipInfo(name), content, method)
    return data.getvalue()


def lying(data: bytes, size: int) -> bytes:
    """Return an archive whose directory tells another size of its files."""
    found = bytearray(data)
    at = found.find(b"PK\x01\x02")
    while at >= 0:
        found[at + 24 : at + 28] = struct.pack("<I", size)
        at = found.find(b"PK\x01\x02", at + 4)
    return bytes(found)


def mutate_export(random: Random, case: Case) -> Case:
    """Change a phone export: its archive, the names in it, or one of its tables; or make it a bomb."""
    if case.main not in case.files:
        return case
    try:
        with zipfile.ZipFile(io.BytesIO(case.files[case.main])) as archive:
            if sum(item.file_size for item in archive.infolist()) > LARGEST:
                return TEXT_MUTATIONS[0](random, case)
            files = {name: archive.read(name) for name in archive.namelist()}
    except (zipfile.BadZipFile, OSError, ValueError, NotImplementedError, RuntimeError, EOFError, lzma.LZMAError, zlib.error):
        return TEXT_MUTATIONS[0](random, case)
    kind = random.choice(("cells", "cells", "cells", "cells", "names", "drop", "bytes", "bomb", "many", "lie", "nested", "plain", "folder"))
    if not files:
        kind = "plain"
    name = random.choice(sorted(files)) if files else ""
    special, main, data = dict(case.special), case.main, b""
    if kind == "cells":
        files[name], word = mutate_cells(random, files[name])
        kind = f"{word} of {name}"
    elif kind == "names":
        letters = random.choice((*TEXTS, "../../" + MARK, "/" + MARK, "C:" + MARK, "meta/" + name, name.upper()))
        files[letters.replace("\ud800", "?")[:60000] or "x"] = files.pop(name)
    elif kind == "drop":
        del files[name]
    elif kind == "bomb":
        files[name] = files[name] + b"0,0,0,0\n" * (1 << 22)
    elif kind == "many":
        files |= {f"{i}.csv": b"x\n" for i in range(1000)}
    elif kind == "nested":
        files = {"inner.zip": archive_of(files)}
    elif kind == "plain":
        main, data = (
            "plain.csv",
            random.choice(
                (b"", b"t,az\n0,0\n", b"PK", b"\xd0\xcf\x11\xe0" + bytes(600), b"MATLAB 5.0" + bytes(600), b"MATLAB 7.3 MAT-file")
            ),
        )
    elif kind == "folder":
        return replace(
            case,
            files={f"phone/{key}": value for key, value in files.items() if ".." not in key and "\x00" not in key},
            main="phone",
            mutations=(*case.mutations, "folder"),
        )
    data = data or archive_of(
        files,
        zipfile.ZIP_DEFLATED
        if kind == "bomb"
        else random.choice((zipfile.ZIP_DEFLATED, zipfile.ZIP_STORED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA)),
    )
    if kind == "bytes":
        noisy = bytearray(data)
        for _ in range(random.choice((1, 5, 50))):
            noisy[random.randrange(len(noisy))] = random.randrange(256)
        data = bytes(noisy)
    elif kind == "lie":
        data = lying(data, random.choice((0, 1, 2**32 - 1)))
    return replace(case, files={main: data}, main=main, special=special, mutations=(*case.mutations, kind))
