"""Mutations that know nothing of YAML's structure: bytes, tokens, words, lines."""

from __future__ import annotations

import re
from dataclasses import replace
from random import Random

from tests.fuzzing.cases import Case
from tests.fuzzing.hostile import NONSENSE_UNITS, NUMBERS, SIZES, TEXTS, TOKENS, UNITS

QUANTITY = re.compile(r"(?<![\w.])[-+]?\d+(\.\d+)?([eE][-+]?\d+)?")
WORD = re.compile(r"[\w.]+")


def text_of(case: Case) -> str:
    """Return the main file as text, whatever it holds."""
    return case.files[case.main].decode("utf-8", "surrogateescape")


def with_text(case: Case, text: str, word: str) -> Case:
    """Return the case with another text; bytes that were not UTF-8 stay what they were."""
    try:
        data = text.encode("utf-8", "surrogateescape")
    except UnicodeEncodeError:
        data = text.encode("utf-8", "surrogatepass")
    return replace(case, files={**case.files, case.main: data}, mutations=(*case.mutations, word))


def flip_bytes(random: Random, case: Case) -> Case:
    """Change a few bytes, or cut the file off."""
    data = bytearray(case.files[case.main])
    for _ in range(random.choice((1, 1, 2, 8))):
        if data:
            data[random.randrange(len(data))] = random.choice((random.randrange(256), 0, 0xFF, 0x0A, 0x22))
    if random.random() < 0.1:
        del data[random.randrange(len(data) + 1) :]
    if random.random() < 0.05:
        data = bytearray(random.choice((b"\xff\xfe", b"\xef\xbb\xbf", b"\xfe\xff", b"PK\x03\x04", b"\x1f\x8b"))) + data
    return replace(case, files={**case.files, case.main: bytes(data)}, mutations=(*case.mutations, "bytes"))


def insert_token(random: Random, case: Case) -> Case:
    """Put a token that means something to YAML, or a hostile text, anywhere."""
    text = text_of(case)
    place = random.randrange(len(text) + 1)
    piece = random.choice(TOKENS) if random.random() < 0.7 else random.choice(TEXTS)
    return with_text(case, text[:place] + piece + text[place + random.choice((0, 0, 1, 5)) :], "token")


def change_word(random: Random, case: Case) -> Case:
    """Replace a word by another of the file, by a hostile text or number; or drop a letter."""
    text = text_of(case)
    words = list(WORD.finditer(text))
    if not words:
        return insert_token(random, case)
    word = random.choice(words)
    kind = random.random()
    if kind < 0.4:
        new = random.choice(words).group()
    elif kind < 0.6:
        new = random.choice(TEXTS)
    elif kind < 0.8:
        new = str(random.choice(NUMBERS))
    else:
        new = word.group()[1:]
    return with_text(case, text[: word.start()] + new + text[word.end() :], "word")


def change_number(random: Random, case: Case) -> Case:
    """Replace a number by an extreme one, or its unit by another."""
    text = text_of(case)
    numbers = list(QUANTITY.finditer(text))
    if not numbers:
        return insert_token(random, case)
    number = random.choice(numbers)
    size = random.choice(SIZES)
    unit = random.choice(("", "", "", random.choice(UNITS), random.choice(NONSENSE_UNITS)))
    return with_text(case, text[: number.start()] + size + unit + text[number.end() :], f"number {size}{unit}")


def change_line(random: Random, case: Case) -> Case:
    """Drop, repeat, swap or indent lines."""
    lines = text_of(case).splitlines(keepends=True) or [""]
    i, j = random.randrange(len(lines)), random.randrange(len(lines))
    kind = random.choice(("drop", "repeat", "swap", "indent", "join"))
    if kind == "drop":
        del lines[i]
    elif kind == "repeat":
        lines.insert(j, lines[i])
    elif kind == "swap":
        lines[i], lines[j] = lines[j], lines[i]
    elif kind == "indent":
        lines[i] = random.choice((" ", "  ", "\t", "- ", "? ")) + lines[i]
    else:
        lines[i] = lines[i].rstrip("\n")
    return with_text(case, "".join(lines), f"{kind} line")


def nest_deeply(random: Random, case: Case) -> Case:
    """Put something nested thousands of levels deep in place of a word."""
    depth = random.choice((50, 200, 1000, 20000))
    word = random.choice(list(WORD.finditer(text_of(case))) or [re.match("", "")])
    assert word is not None
    deep = random.choice(
        (
            "[" * depth + "]" * depth,
            "[" * depth,
            "{a: " * depth + "1" + "}" * depth,
            "(" * depth + "1" + ")" * depth,
            "- " * depth + "1",
            "? " * depth + "1",
            "-" * depth + "1",
            "1" + "**2" * depth,
            "1" + "+1" * depth,
        )
    )
    text = text_of(case)
    return with_text(case, text[: word.start()] + deep + text[word.end() :], f"nested {depth}")


def alias_bomb(random: Random, case: Case) -> Case:
    """Begin the file with anchors that expand to billions of items, and use them."""
    width, levels = random.choice(((9, 9), (2, 30), (1000, 4), (9, 3)))
    lines = ["bomb0: &b0 [pwned]"]
    lines += [f"bomb{i}: &b{i} [{', '.join([f'*b{i - 1}'] * width)}]" for i in range(1, levels)]
    if random.random() < 0.3:
        lines = ["bomb0: &b0 {x: 1}"] + [f"bomb{i}: &b{i} {{<<: [{', '.join([f'*b{i - 1}'] * width)}]}}" for i in range(1, levels)]
    if random.random() < 0.3:
        lines = ["self: &self [*self]", "name: &n {a: *n}"]
    text = text_of(case)
    last = f"*b{levels - 1}" if lines[0].startswith("bomb") else "*self"
    word = random.choice(list(WORD.finditer(text)) or [re.match("", "")])
    assert word is not None
    if random.random() < 0.6:
        text = text[: word.start()] + last + " " + text[word.end() :]
    return with_text(case, "\n".join(lines) + "\n" + text, "aliases")


TEXT_MUTATIONS = (
    *(flip_bytes,) * 2,
    *(insert_token,) * 4,
    *(change_word,) * 5,
    *(change_number,) * 6,
    *(change_line,) * 4,
    nest_deeply,
    alias_bomb,
)
