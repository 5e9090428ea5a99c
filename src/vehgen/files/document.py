"""YAML files read as data with the place of every value, refusing what a stranger's file could do to us."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.composer import Composer
from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode
from ruamel.yaml.reader import ReaderError

from vehgen.errors import InputError, Position, shortened, shown
from vehgen.files import reading
from vehgen.files.names import unprintable

MAX_DOCUMENT_BYTES = 1_000_000
MAX_VALUES = 20_000
MAX_NESTING = 20
MAX_PROBLEM = 200
"""So many characters of what the YAML reader says are told: it quotes the file."""
MAX_DIGITS = 400
"""A longer whole number stays text: Python refuses to write it again, and no float holds it."""
_PLAIN_KEYS = {"str", "int", "float", "bool", "null", "timestamp", "merge", "value"}


@dataclass(frozen=True)
class Located:
    """A value of a YAML file with its place: a scalar, a list, or a mapping of names to located values.

    `indent` is how many columns right of `position` a scalar's text begins (1 after a quote), None where it does not stand there as it is
    (a mapping or list, escapes, several lines).
    """

    value: Any
    position: Position
    key_position: Position | None = None
    indent: int | None = None

    def plain(self) -> Any:
        """Return the bare data."""
        if isinstance(self.value, dict):
            return {key: item.plain() for key, item in self.value.items()}
        if isinstance(self.value, list):
            return [item.plain() for item in self.value]
        return self.value

    def child(self, part: str | int) -> Located | None:
        """Return the value under a key or index, None where there is none."""
        if isinstance(self.value, dict):
            return self.value.get(str(part))
        if isinstance(self.value, list) and isinstance(part, int) and part < len(self.value):
            child: Located = self.value[part]
            return child
        return None

    @property
    def is_bare(self) -> bool:
        """Whether it is the nothing behind a key."""
        return self.value is None and self.position == self.key_position and not self.position.is_argument

    def at(self, path: tuple[str | int, ...]) -> Located:
        """Return the value at `path`; parts of the path that the file lacks are passed over."""
        node = self
        for part in path:
            node = node.child(part) or node
        return node

    def find(self, path: tuple[str | int, ...], *, key: bool = False, offset: int | None = None) -> Position:
        """Return the place of the value (or key, or character `offset` of a text) at `path`, as far as the file has it."""
        node = self.at(path)
        if key and node.key_position:
            return node.key_position
        if offset is None or node.indent is None:
            return node.position
        return replace(node.position, column=node.position.column + node.indent + offset)


def locate_arguments(data: Any, path: str, known: Located | None = None) -> Located:
    """Return plain data given in Python as located data.

    Parameters
    ----------
    data
        Mappings, sequences and anything else, which stays as it is.
    path
        What errors call the argument; keys and indices are added to it.
    known
        Located data read before: what has a place there keeps it.
    """
    position = Position(path) if known is None else known.position
    key_position = position if known is None else known.key_position

    def inside(part: str | int, item: Any) -> Located:
        return locate_arguments(item, f"{path}.{part}", None if known is None else known.child(part))

    if isinstance(data, Mapping):
        return Located({str(key): inside(str(key), item) for key, item in data.items()}, position, key_position)
    if isinstance(data, list | tuple):
        return Located([inside(index, item) for index, item in enumerate(data)], position, key_position)
    return Located(data, position, key_position, None if known is None else known.indent)


class _TooManyError(Exception):
    """A text holds more keys and values than are read; `line` and `column` count from 0."""

    def __init__(self, line: int, column: int) -> None:
        super().__init__(line, column)
        self.line, self.column = line, column


class _BoundedComposer(Composer):
    """Composes no more nodes than MAX_VALUES with their keys need: reading what would be refused later takes seconds."""

    def __init__(self, loader: Any = None) -> None:
        super().__init__(loader)
        self._count = 0

    def compose_node(self, parent: Any, index: Any) -> Any:
        self._count += 1
        if self._count > 2 * MAX_VALUES + 1:
            mark = self.parser.peek_event().start_mark
            raise _TooManyError(mark.line, mark.column)
        return super().compose_node(parent, index)


def read_document(path: Path) -> Located:
    """Read a YAML file into located data.

    Raises
    ------
    InputError
        For a missing, oversized, malformed or hostile file (a pipe, aliases that multiply, custom tags, deep nesting, duplicate keys).
    """
    return read_text(reading.read_text(path, MAX_DOCUMENT_BYTES, "a YAML file"), path)


def read_text(text: str, path: Path | str) -> Located:
    """Read YAML text into located data; `path` is what errors call it."""
    lines = text.splitlines()
    reader = YAML(typ="safe", pure=True)
    reader.Composer = _BoundedComposer
    try:
        root = reader.compose(text)
    except _TooManyError as error:
        raise InputError(f"more than {MAX_VALUES} values", _within(lines, path, error.line, error.column)) from error
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = _within(lines, path, mark.line, mark.column) if mark else Position(path, 1, 1)
        problem = shortened(str(error.problem or error.context), MAX_PROBLEM)
        hint = "; indent by spaces" if "'\\t'" in problem else ""
        raise InputError(f"not valid YAML: {problem}{hint}", place) from error
    except ReaderError as error:
        before = text[: error.position]
        place = _within(lines, path, before.count("\n"), len(before) - before.rfind("\n") - 1)
        raise InputError(f"not valid YAML: {shortened(str(error).splitlines()[0], MAX_PROBLEM)}", place) from error
    except (YAMLError, ValueError) as error:
        raise InputError(f"not valid YAML: {shortened(str(error).splitlines()[0], MAX_PROBLEM)}", Position(path, 1, 1)) from error
    except RecursionError as error:
        raise InputError("nested too deeply", Position(path, 1, 1)) from error
    if (found := re.search(r"^%YAML\s+(\S+)", text, re.MULTILINE)) and found.group(1) != "1.2":
        said = f"YAML 1.2 was expected, found {shown(found.group(1))}: older ones read words and numbers otherwise; leave `%YAML` out"
        raise InputError(said, Position(path, 1, 1))
    if root is None:
        raise InputError("the file is empty", Position(path, 1, 1))
    return _Converter(path, lines).convert(root, 0)


def _within(lines: list[str], path: Path | str, line: int, column: int) -> Position:
    """Return the place at a line and column that count from 0; ruamel's place beyond the last line becomes the file's last character."""
    if line >= len(lines):
        return Position(path, max(len(lines), 1), max(len(lines[-1]) if lines else 0, 1))
    return Position(path, line + 1, min(column, len(lines[line])) + 1)


class _Converter:
    """Turns composed YAML nodes into Located values, counting them so that aliases cannot multiply without end."""

    def __init__(self, path: Path | str, lines: list[str]) -> None:
        self.path = path
        self.lines = lines
        self.count = 0

    def convert(self, node: Node, depth: int) -> Located:
        position = _within(self.lines, self.path, node.start_mark.line, node.start_mark.column)
        self.count += 1
        if self.count > MAX_VALUES:
            raise InputError(f"more than {MAX_VALUES} values (do aliases multiply?)", position)
        if depth > MAX_NESTING:
            raise InputError(f"nested more than {MAX_NESTING} deep", position)
        kind = str(node.tag).rpartition(":")[2]
        if isinstance(node, MappingNode) and kind == "map":
            return Located(self._mapping(node, depth), position)
        if isinstance(node, SequenceNode) and kind == "seq":
            return Located([self.convert(item, depth + 1) for item in node.value], position)
        if isinstance(node, ScalarNode):
            return Located(_scalar(node, kind, position), position, indent=_indent(node))
        raise InputError(f"the tag {shortened(str(node.tag))} is not allowed", position)

    def _mapping(self, node: MappingNode, depth: int) -> dict[str, Located]:
        mapping: dict[str, Located] = {}
        for key, item in node.value:
            place = _within(self.lines, self.path, key.start_mark.line, key.start_mark.column)
            if not isinstance(key, ScalarNode):
                raise InputError("a key must be a name", place)
            if str(key.tag).rpartition(":")[2] not in _PLAIN_KEYS:
                raise InputError(f"the tag {shortened(str(key.tag))} is not allowed", place)
            _check_characters(key.value, place)
            if key.value in mapping:
                raise InputError(f"duplicate name {shown(key.value)}; each may stand once", place)
            found = replace(self.convert(item, depth + 1), key_position=place)
            is_nothing = isinstance(item, ScalarNode) and item.start_mark.index == item.end_mark.index
            mapping[key.value] = replace(found, position=place) if is_nothing else found  # ruamel puts nothing where the next thing begins
        return mapping


def _scalar(node: ScalarNode, kind: str, position: Position) -> Any:
    text = node.value
    _check_characters(text, position)
    try:
        match kind:
            case "null":
                return None
            case "bool":
                if text.lower() not in ("true", "false"):
                    raise InputError(f"true or false was expected, found {shown(text)}", position)
                return text.lower() == "true"
            case "int":
                return int(text.replace("_", ""), 0) if len(text) <= MAX_DIGITS else text
            case "float":
                return float(text.replace("_", "").replace(".inf", "inf").replace(".nan", "nan"))
            case "str" | "timestamp":
                return text
    except ValueError:
        return text
    raise InputError(f"the tag {shortened(str(node.tag))} is not allowed", position)


def _indent(node: ScalarNode) -> int | None:
    """Return how many columns right of its mark the text of a scalar begins, None where it is not written there as it is."""
    quotes = 1 if node.style in ("'", '"') else 0
    whole = node.end_mark.line == node.start_mark.line and node.end_mark.column - node.start_mark.column == len(node.value) + 2 * quotes
    return quotes if whole else None


def _check_characters(text: str, position: Position) -> None:
    """Refuse characters that could command a terminal, mislead a reader or cannot be written."""
    if (found := unprintable(text)) is not None:
        raise InputError(f"the character {found} is not allowed in a text", position)
