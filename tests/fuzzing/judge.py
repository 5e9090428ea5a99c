"""Whether vehgen's answer to a file is acceptable: one clear line with a place that exists, within bounds of time and memory."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass
from pathlib import Path

ACCEPTED, REFUSED, FAULT = "accepted", "refused", "FAULT"
LONGEST = 600
TOO_SLOW = "too slow"
DIRECTIONS = {*map(chr, range(0x202A, 0x202F)), *map(chr, range(0x2066, 0x206A)), "\u200e", "\u200f", "\u061c", "\ufeff"}
PLACE = re.compile(r"^error: (?P<file>[^\n]*?):(?P<line>\d+):(?P<column>\d+): ")


@dataclass(frozen=True)
class Limits:
    """What a file may cost: CPU [s], on a machine as fast as the harness assumes, and memory beyond the imports [MB]."""

    seconds: float = 4.0
    megabytes: float = 300.0


@dataclass(frozen=True)
class Answer:
    """What the worker saw.

    `message` is the refusal without `error: `, None where the file was accepted; `place` its (file, line, column); `output` what a
    command printed besides, with warnings; `crash` the traceback of anything else than a refusal; `effects` what the audit found.
    """

    message: str | None = None
    place: tuple[str, int, int] | None = None
    output: str = ""
    crash: str = ""
    crash_type: str = ""
    effects: tuple[str, ...] = ()
    seconds: float = 0.0
    megabytes: float = 0.0


@dataclass(frozen=True)
class Verdict:
    """`outcome`: accepted, refused or FAULT; `reasons`: what is wrong; `answer`: what it is about; `compiles`: whether a kernel was."""

    outcome: str
    reasons: tuple[str, ...]
    answer: Answer
    compiles: bool = False

    @property
    def signature(self) -> str:
        """What two occurrences of one fault have in common."""
        return " | ".join(sorted({re.sub(r"'[^']*'|\"[^\"]*\"|\d+(\.\d+)?(e[-+]?\d+)?", "*", reason)[:160] for reason in self.reasons}))


def strange(text: str, allowed: str = "") -> set[str]:
    """Return the characters that may move a terminal's cursor, reverse its text or break a line."""
    return {
        letter
        for letter in text
        if letter not in allowed and (unicodedata.category(letter) in {"Cc", "Cs", "Zl", "Zp"} or letter in DIRECTIONS)
    }


def last_place(path: Path) -> tuple[int, int]:
    """Return the number of lines of a file, and the length of its longest line plus one."""
    text = path.read_bytes().decode("utf-8", "replace")
    lines = max(text.count("\n") + (not text.endswith("\n")), len(text.splitlines()), 1)
    return lines, max(len(line) for line in text.split("\n")) + 2


def check_message(message: str) -> list[str]:
    """Return what is wrong with a refusal as a line of text."""
    wrong = []
    if not message.strip():
        wrong.append("an empty message")
    if len(message) > LONGEST:
        wrong.append("a message that is too long")
    if letters := strange(message):
        wrong.append("control or direction characters in the message: " + " ".join(sorted(f"U+{ord(letter):04X}" for letter in letters)))
    return wrong


def check_place(place: tuple[str, int, int] | None, folder: Path, message: str) -> list[str]:
    """Return what is wrong with a refusal's place."""
    if place is None:
        return [f"no place: {message[:150]}"]
    name, line, column = place
    if not (folder / name).is_file():
        return [] if (line, column) == (1, 1) else [f"a place in no file: {name[:80]!r}"]
    lines, columns = last_place(folder / name)
    if not (1 <= line <= lines and 1 <= column <= columns):
        return [f"a place beyond the end: line {line} of {lines}, column {column} of {columns}; {message[:80]}"]
    return []


def judge(answer: Answer, folder: Path, limits: Limits, needs_place: bool = True) -> Verdict:
    """Judge an answer about the files of a folder."""
    reasons = [f"side effect: {item}" for item in answer.effects]
    if answer.crash:
        reasons.append(f"{answer.crash_type}: {crash_site(answer.crash)}")
    if answer.seconds > limits.seconds:
        reasons.append(f"{TOO_SLOW}: over {limits.seconds:g} s")
    if answer.megabytes > limits.megabytes:
        reasons.append(f"too much memory: over {limits.megabytes:g} MB")
    if answer.message is not None:
        reasons += check_message(answer.message)
        if needs_place:
            reasons += check_place(answer.place, folder, answer.message)
    if letters := strange(answer.output, "\n\t"):
        reasons.append("control or direction characters in the output: " + " ".join(sorted(f"U+{ord(letter):04X}" for letter in letters)))
    outcome = FAULT if reasons else ACCEPTED if answer.message is None else REFUSED
    return Verdict(outcome, tuple(reasons), answer)


def crash_site(crash: str) -> str:
    """Return the innermost file and function of vehgen in a traceback."""
    found = re.findall(r'vehgen/([\w/]+\.py)", line \d+, in (\S+)', crash)
    return " ".join(found[-1]) if found else crash.strip().rpartition("\n")[2][:120]
