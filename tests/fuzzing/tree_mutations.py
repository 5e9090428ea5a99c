"""Mutations that know YAML: keys and values of a file dropped, renamed, swapped, copied, or replaced by hostile ones."""

from __future__ import annotations

import copy
import json
import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from random import Random
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from tests.fuzzing.cases import Case
from tests.fuzzing.hostile import NONSENSE_UNITS, NUMBERS, PATHS, SIZES, TEXTS, UNITS
from tests.fuzzing.text_mutations import change_number, text_of

FILE_KEYS = {"file", "extends", "vehicle", "recording"}
ANCHOR = re.compile(r"&\w")
LARGEST = 20_000
Node = Any


def read_tree(case: Case) -> Node:
    """Return the main file's data, or None where it is no YAML mapping any more, or one too large or circular to change again."""
    text = text_of(case)
    if len(text) > LARGEST or ANCHOR.search(text):
        return None
    try:
        found = YAML(typ="safe").load(text)
    except (YAMLError, ValueError, UnicodeError, RecursionError, TypeError, AttributeError):
        return None
    return found if isinstance(found, dict) and found else None


def write_tree(case: Case, data: Node, word: str, random: Random) -> Case:
    """Return the case with other data: YAML holds JSON, an entry a line."""
    text = json.dumps(_with_text_keys(data), indent=1, ensure_ascii=random.random() < 0.3, default=str)
    return case.with_text(text, (word,))


def _with_text_keys(node: Node) -> Node:
    """Return data whose keys JSON can write: YAML may make dates, pairs or bytes of them."""
    if isinstance(node, dict):
        return {key if isinstance(key, str | int | float | None) else str(key): _with_text_keys(item) for key, item in node.items()}
    return [_with_text_keys(item) for item in node] if isinstance(node, list) else node


def places(node: Node, depth: int = 0) -> Iterator[tuple[Node, Any]]:
    """Yield every (mapping or list, key or index) below a node."""
    if depth > 60:
        return
    for key in list(node) if isinstance(node, dict) else range(len(node)):
        yield node, key
        if isinstance(node[key], (dict, list)):
            yield from places(node[key], depth + 1)


def drop(random: Random, data: Node, holder: Node, key: Any) -> None:
    """Remove an entry."""
    del holder[key]


def another_type(random: Random, data: Node, holder: Node, key: Any) -> None:
    """Replace a value by one of another type."""
    holder[key] = random.choice(
        (
            None,
            True,
            0,
            -1.5,
            "x",
            [],
            {},
            [[]],
            {"": None},
            [holder[key]],
            {key if isinstance(key, str) else "k": holder[key]},
            list(range(2000)),
            {str(i): i for i in range(2000)},
            "2024-01-01",
            {"body": {"body": {"body": 1}}},
        )
    )


def hostile_value(random: Random, data: Node, holder: Node, key: Any) -> None:
    """Replace a value by a hostile text."""
    holder[key] = random.choice(TEXTS)


def number(random: Random, data: Node, holder: Node, key: Any) -> None:
    """Replace a value by an extreme number, with or without a unit."""
    if random.random() < 0.4:
        holder[key] = random.choice(NUMBERS)
        return
    old = holder[key] if isinstance(holder[key], str) else ""
    unit = random.choice((" " + old.partition(" ")[2], random.choice(UNITS), random.choice(NONSENSE_UNITS)))
    holder[key] = random.choice(SIZES) + unit


def path(random: Random, data: Node, holder: Node, key: Any) -> None:
    """Name another file: at a key that names one, or as `extends`."""
    named = [(node, name) for node, name in places(data) if name in FILE_KEYS]
    node, name = random.choice(named) if named else (data, random.choice(("extends", "recording")))
    node[name] = random.choice(PATHS)


def rename(random: Random, data: Node, holder: Node, key: Any) -> None:
    """Rename a key: to a hostile text, to another key of the file, or by a letter."""
    if not isinstance(holder, dict):
        return
    keys = [name for node, name in places(data) if isinstance(name, str)]
    new = random.choice((random.choice(TEXTS), random.choice(keys or [""]), str(key)[:-1], str(key).upper(), f" {key}"))
    items = [(new if name == key else name, value) for name, value in holder.items()]
    holder.clear()
    holder.update(items)


def rename_everywhere(random: Random, data: Node, holder: Node, key: Any) -> None:
    """Rename an entity and what refers to it: the file stays whole, its names become hostile."""
    if not isinstance(holder, dict) or not isinstance(key, str):
        return
    new = random.choice(TEXTS)

    def renamed(node: Node) -> Node:
        if isinstance(node, dict):
            return {new if name == key else name: renamed(value) for name, value in node.items()}
        if isinstance(node, list):
            return [renamed(value) for value in node]
        return new if node == key else node

    changed = renamed(data)
    data.clear()
    data.update(changed)


def other_value(random: Random, data: Node, holder: Node, key: Any) -> None:
    """Replace a value by another value of the file, or swap two."""
    node, name = random.choice(list(places(data)))
    old = copy.deepcopy(holder[key])
    holder[key] = copy.deepcopy(node[name])
    if random.random() < 0.5 and (node is not holder or name in (holder if isinstance(holder, dict) else range(len(holder)))):
        node[name] = old


def self_reference(random: Random, data: Node, holder: Node, key: Any) -> None:
    """Let something refer to itself, or to a name of the file."""
    names = [name for node, name in places(data) if isinstance(name, str)]
    holder[key] = random.choice((str(key), f"{key} + 1 m", f"2*{key}", random.choice(names or [""])))


def add_key(random: Random, data: Node, holder: Node, key: Any) -> None:
    """Add an entry: a known key at a strange place, or an unknown one."""
    if isinstance(holder, dict):
        nodes = list(places(data))
        node, name = random.choice(nodes)
        holder[str(name) if random.random() < 0.6 else random.choice(TEXTS)] = copy.deepcopy(node[name])
    else:
        holder.append(copy.deepcopy(holder[key]))


def copy_often(random: Random, data: Node, holder: Node, key: Any) -> None:
    """Copy an entry many times."""
    count = random.choice((3, 30, 300))
    if isinstance(holder, dict):
        holder.update({f"{key}_{i}": holder[key] for i in range(count)})
    else:
        holder.extend([holder[key]] * count)


CHANGES: tuple[Callable[[Random, Node, Node, Any], None], ...] = (
    *(drop, another_type, hostile_value, rename, rename_everywhere, other_value, self_reference, add_key, path) * 2,
    *(number,) * 6,
    copy_often,
)


def mutate_tree(random: Random, case: Case) -> Case:
    """Change one entry of the main file's data."""
    data = read_tree(case)
    if data is None:
        return change_number(random, case)
    found = list(places(data))
    holder, key = random.choice(found)
    if isinstance(holder[key], dict) and random.random() < 0.7:  # values rather than sections, mostly
        holder, key = random.choice(found)
    change = random.choice(CHANGES)
    change(random, data, holder, key)
    return write_tree(case, data, change.__name__, random)


def special_file(random: Random, case: Case) -> Case:
    """Put a pipe, a folder or a link in the place of a file, or such things beside it."""
    beside = {"pipe": "pipe", "folder": "folder", "zero": "link:/dev/zero"}
    if random.random() < 0.5:
        name = random.choice(sorted(case.files))
        beside[name] = random.choice(
            ("pipe", "folder", "link:/dev/zero", "link:/dev/null", "link:/proc/self/mem", f"link:{name}", "link:absent")
        )
    return replace(case, special={**case.special, **beside}, mutations=(*case.mutations, "special files"))
