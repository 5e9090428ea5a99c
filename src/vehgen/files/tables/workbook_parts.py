"""The parts of an Excel workbook, checked before anything parses them: no entities, and nothing that fills the memory."""

from __future__ import annotations

import posixpath
import re
import zipfile
from collections import defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import IO
from xml.parsers import expat

from vehgen.errors import InputError, Position, shown
from vehgen.files.tables.columns import MAX_TABLE_BYTES
from vehgen.files.tables.foreign import faults_of

EXCEL_KIND = "an Excel workbook (.xlsx)"
MAX_WORKBOOK_BYTES = 5 * MAX_TABLE_BYTES
"""All parts together, unpacked: sheets are XML, packed to a tenth [bytes]."""
MAX_WHOLE_PART_BYTES = MAX_TABLE_BYTES // 8
"""Texts, styles and all else but sheets are parsed whole: no such part unpacks to more [bytes]."""
MAX_SHEET_ROW_BYTES = 4 * 2**20
"""A sheet is parsed row by row: nowhere in it so many bytes without a row's end. Its 16384 columns need a quarter of it."""
MOST_WORKBOOK_PARTS = 1000
HEAD_BYTES = 65536
"""The first element of every part of a workbook begins within so many bytes: nothing can be declared after it."""
WORKBOOK_PART = "xl/workbook.xml"
"""The part by which an archive is a workbook."""
_CONTENT_TYPES, _RELATIONS = "[Content_Types].xml", ".rels"
_SHEET_PART = re.compile(r"xl/worksheets/[^/]+\.xml")
_SHEET_ROLES = {
    "application/vnd.openxmlformats-officedocument.spreadsheetml.worksheet+xml",
    "http://schemas.openxmlformats.org/officeDocument/2006/relationships/worksheet",
    "http://purl.oclc.org/ooxml/officeDocument/relationships/worksheet",
}
_ENTITIES = (b"<!DOCTYPE", b"<!ENTITY")
_COMMENT, _ELEMENT = re.compile(rb"<!--.*?-->", re.DOTALL), re.compile(rb"<[A-Za-z_]")
_ENCODING = re.compile(rb"""<\?xml[^>]*?encoding\s*=\s*["']([^"']*)""")
_OTHER_ENCODINGS = (b"\xff\xfe", b"\xfe\xff", b"<\x00", b"\x00<")


def check_parts(path: Path) -> None:
    """Refuse an archive that is no workbook, unpacks to too much, or whose XML declares entities; raises InputError."""
    with faults_of(path, EXCEL_KIND):
        archive = zipfile.ZipFile(path)
    with archive:
        parts = archive.infolist()
        if WORKBOOK_PART not in archive.namelist():
            raise InputError("a zip archive that is no Excel workbook; unpack the table first", Position(path, 1, 1))
        if len(parts) > MOST_WORKBOOK_PARTS or sum(part.file_size for part in parts) > MAX_WORKBOOK_BYTES:
            raise InputError(f"the workbook would unpack to more than {MAX_WORKBOOK_BYTES} bytes", Position(path, 1, 1))
        for part in parts:
            with faults_of(path, EXCEL_KIND), archive.open(part) as stream:
                head = stream.read(HEAD_BYTES)
            if not _is_plain(head):
                raise InputError("the workbook declares entities, which no program writes", Position(path, 1, 1))
        _check_sizes(path, archive, parts)


def _check_sizes(path: Path, archive: zipfile.ZipFile, parts: Sequence[zipfile.ZipInfo]) -> None:
    """Refuse large parts that are parsed whole, and sheets with rows longer than any."""
    large = [part for part in parts if part.file_size > min(MAX_WHOLE_PART_BYTES, MAX_SHEET_ROW_BYTES)]
    sheets = [part for part in large if _SHEET_PART.fullmatch(part.filename)]
    _refuse_whole(path, [part for part in large if part not in sheets])
    if sheets:
        with faults_of(path, EXCEL_KIND):
            roles = _roles(archive, [part for part in parts if part.filename == _CONTENT_TYPES or part.filename.endswith(_RELATIONS)])
        _refuse_whole(path, [part for part in sheets if not roles[posixpath.basename(part.filename)] <= _SHEET_ROLES])
    for part in sheets:
        with faults_of(path, EXCEL_KIND), archive.open(part) as stream:
            has_rows = _has_rows_throughout(stream)
        if not has_rows:
            raise InputError(
                f"{shown(part.filename)} of the workbook has more than {MAX_SHEET_ROW_BYTES} bytes without the end of a row; "
                "a sheet of numbers was expected",
                Position(path, 1, 1),
            )


def _refuse_whole(path: Path, parts: Sequence[zipfile.ZipInfo]) -> None:
    for part in parts:
        if part.file_size > MAX_WHOLE_PART_BYTES:
            raise InputError(
                f"{shown(part.filename)} of the workbook would unpack to {part.file_size} bytes; at most {MAX_WHOLE_PART_BYTES} were "
                "expected: save the columns of numbers alone",
                Position(path, 1, 1),
            )


def _roles(archive: zipfile.ZipFile, parts: Sequence[zipfile.ZipInfo]) -> Mapping[str, set[str]]:
    """Return by the last name of every part what the lists of contents and of relations call it."""
    found: dict[str, set[str]] = defaultdict(set)

    def begin(tag: str, attributes: dict[str, str]) -> None:
        own = {name.rpartition(":")[2]: text for name, text in attributes.items()}
        for name in (own.get("PartName"), own.get("Target")):
            if name is not None:
                found[posixpath.basename(posixpath.normpath(name))] |= {own[key] for key in ("ContentType", "Type") if key in own}

    for part in parts:
        parser = expat.ParserCreate()
        parser.StartElementHandler = begin
        with archive.open(part) as stream:
            parser.ParseFile(stream)
    return found


def _has_rows_throughout(stream: IO[bytes]) -> bool:
    """Return whether a row ends again and again in a sheet."""
    parser, fed, last, widest = expat.ParserCreate(), 0, 0, 0

    def end(tag: str) -> None:
        nonlocal last, widest
        if tag.rpartition(":")[2] == "row":
            widest = max(widest, parser.CurrentByteIndex - last)
            last = parser.CurrentByteIndex

    parser.EndElementHandler = end
    while block := stream.read(2**20):
        parser.Parse(block)
        fed += len(block)
        if max(widest, fed - last) > MAX_SHEET_ROW_BYTES:
            return False
    return True


def _is_plain(head: bytes) -> bool:
    """Return whether a part is no XML, or XML in UTF-8 whose first element begins within its head with no declaration before it."""
    start = head.removeprefix(b"\xef\xbb\xbf").lstrip()
    if start[:2] in _OTHER_ENCODINGS:
        return False
    if not start.startswith(b"<"):
        return True
    encoding = _ENCODING.match(start)
    if encoding is not None and encoding[1].lower() not in (b"utf-8", b"us-ascii"):
        return False
    before = _COMMENT.sub(b"", start)
    element = _ELEMENT.search(before)
    return element is not None and not any(mark in before[: element.start()] for mark in _ENTITIES)
