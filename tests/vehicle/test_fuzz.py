"""Mutilated files: each is read, or refused with an InputError that has a place; never another exception."""

from __future__ import annotations

import json
import re
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.vehicle.rig import GOOD
from vehgen.errors import InputError
from vehgen.files.document import read_text
from vehgen.vehicle import bundled_models, parse_vehicle

MODELS = {name: path.read_text(encoding="utf-8") for name, path in bundled_models().items()} | {"rig": GOOD}
DATA = {name: read_text(text, name).plain() for name, text in MODELS.items()}

pieces = st.one_of(
    st.sampled_from(list("{}[]:,-*&!|>'\"#%@?~ \n\t0a.m/+()=<\\\x00\x07\x85\u2028\ufeff\u00e9\U0001f69a")),
    st.sampled_from(
        [
            "<<: *a",
            "&a ",
            "*a",
            "!!str ",
            "!!python/name:x ",
            "null",
            "~",
            "true",
            ".nan",
            ".inf",
            "1e999",
            "0",
            "-1",
            "1/0",
            "(",
            "sqrt(",
            "__x",
        ]
    ),
    st.sampled_from(
        ["mass", "equals", "value", "range: ", "points", "extends: quarter_car\n", "body: ", "- ", "---\n", "...\n", " kg", "^2", "**"]
    ),
    st.text(max_size=3),
)
edits = st.lists(
    st.tuples(
        st.sampled_from(
            ["delete", "insert", "replace", "drop line", "repeat line", "swap lines"] + 2 * ["other word", "drop letter", "new word"]
        ),
        st.floats(0, 1),
        st.integers(1, 12),
        pieces,
    ),
    min_size=1,
    max_size=4,
)


def mutate(text: str, changes: list[tuple[str, float, int, str]]) -> str:
    for kind, where, size, piece in changes:
        place = int(where * max(len(text) - 1, 0))
        if kind == "delete":
            text = text[:place] + text[place + size :]
        elif kind == "insert":
            text = text[:place] + piece + text[place:]
        elif kind == "replace":
            text = text[:place] + piece + text[place + size :]
        elif kind.endswith(("word", "letter")):
            text = change_word(text, kind, where, size, piece)
        else:
            lines = text.splitlines(keepends=True) or [""]
            line = int(where * (len(lines) - 1))
            if kind == "drop line":
                del lines[line]
            elif kind == "repeat line":
                lines.insert(line, lines[line])
            else:
                other = (line + size) % len(lines)
                lines[line], lines[other] = lines[other], lines[line]
            text = "".join(lines)
    return text


def change_word(text: str, kind: str, where: float, size: int, piece: str) -> str:
    words = list(re.finditer(r"[\w.]+", text))
    if not words:
        return text
    word = words[int(where * (len(words) - 1))]
    if kind == "drop letter":
        return text[: word.start()] + text[word.start() + 1 :]
    new = words[size * len(words) // 13].group() if kind == "other word" else piece.strip()
    return text[: word.start()] + new + text[word.end() :]


def read_or_refuse(text: str) -> bool:
    """Return whether the text was read; an InputError must be one line at a place of a file."""
    refusal: InputError | None = None
    try:
        parse_vehicle(text, "fuzz.yaml")
    except InputError as error:
        refusal = error
    if refusal is not None:
        assert refusal.position is not None
        assert refusal.position.line >= 1
        assert refusal.position.column >= 1
        assert "\n" not in str(refusal)
    return refusal is None


@pytest.mark.thorough
@settings(max_examples=100, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
@given(st.sampled_from(sorted(MODELS)), edits)
def test_mutilated_text(name: str, changes: list[tuple[str, float, int, str]]):
    read_or_refuse(mutate(MODELS[name], changes))


KEYS = [
    "name",
    "parameters",
    "value",
    "equals",
    "range",
    "bodies",
    "mass",
    "pitch_inertia",
    "motions",
    "carried_by",
    "size",
    "length",
    "at",
]
KEYS += ["hinges", "axles", "tyre", "links", "k", "c", "sets", "x", "body", "points", "ground"]
words = st.text(st.characters(codec="utf-8", exclude_categories=("Cc",)), max_size=6)
scalars = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(10**20), 10**20),
    st.floats(allow_nan=False, allow_infinity=False),
    words,
    st.sampled_from(
        ["1 kg", "-1 kg", "1 m", "0", "1/0", "1 m/0", "mT", "b1", "b2", "1e300 kg", "sqrt(-1)", "body", "tractor", "ground", "heave"]
    ),
)
values = st.recursive(scalars, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(words, inner, max_size=3), max_leaves=4)
keys = st.one_of(
    words,
    st.sampled_from(KEYS),
)
operations = st.lists(
    st.tuples(st.sampled_from(["remove", "replace", "add", "copy"]), st.lists(st.floats(0, 0.999), min_size=1, max_size=5), keys, values),
    min_size=1,
    max_size=3,
)


def edit(data: dict[str, Any], changes: list[tuple[str, list[float], str, Any]]) -> dict[str, Any]:
    """Change entries of a vehicle's data, each found by following fractions down the tree."""
    data = json.loads(json.dumps(data))
    for kind, path, key, value in changes:
        holder: Any = data
        *steps, last = path
        for step in steps:
            below = [item for item in (holder.values() if isinstance(holder, dict) else holder) if isinstance(item, (dict, list)) and item]
            if not below:
                break
            holder = below[int(step * len(below))]
        places = list(holder) if isinstance(holder, dict) else list(range(len(holder)))
        place = places[int(last * len(places))]
        if kind == "remove":
            del holder[place]
        elif kind == "replace":
            holder[place] = value
        elif isinstance(holder, dict):
            holder[key] = value if kind == "add" else json.loads(json.dumps(holder[place]))
        if not data:
            break
    return data


@pytest.mark.thorough
@settings(max_examples=80, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
@given(st.sampled_from(sorted(set(DATA) - {"road_train"})), operations)
def test_mutilated_data(name: str, changes: list[tuple[str, list[float], str, Any]]):
    """YAML holds JSON, so that well-formed files with wrong contents reach the deeper checks."""
    read_or_refuse(json.dumps(edit(DATA[name], changes), ensure_ascii=False))


@pytest.mark.parametrize("name", sorted(MODELS))
def test_unhurt_models_are_read_either_way(name: str):
    assert read_or_refuse(MODELS[name])
    assert read_or_refuse(json.dumps(DATA[name]))


@settings(max_examples=100, deadline=None, derandomize=True)
@given(st.text(max_size=60))
def test_any_text(text: str):
    read_or_refuse(text)
