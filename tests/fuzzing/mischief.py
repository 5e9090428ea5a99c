"""What vehgen must never do, done here on purpose, so that the tests know that the harness would see it."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from tests.fuzzing.hostile import MARK
from vehgen.errors import InputError, Position


class RawRefusalError(InputError):
    """A refusal that says its message as it came, which InputError itself does not."""

    def __init__(self, message: str, position: Position) -> None:
        super().__init__(message, position)
        self._raw = f"{position}: {message}"

    def __str__(self) -> str:
        return self._raw


def write_beside() -> None:
    Path("beside.txt").write_text("x", encoding="utf-8")


def overwrite() -> None:
    Path("mischief.yaml").write_text("x", encoding="utf-8")


def remove() -> None:
    Path("mischief.yaml").rename("other.yaml")


def start() -> None:
    subprocess.run([sys.executable, "-c", "pass"], check=True)


def shell() -> None:
    os.system("true")


def connect() -> None:
    with socket.socket() as found:
        found.connect_ex(("127.0.0.1", 9))


def execute() -> None:
    exec(f"{MARK} = 1", {})


def execute_anything() -> None:
    exec("x = 1", {})


def fill_memory() -> None:
    bytearray(400 * 2**20)


def spend_time() -> None:
    while True:
        sum(range(1000))


def wait() -> None:
    time.sleep(3600)


def crash() -> None:
    raise ZeroDivisionError


def die() -> None:
    os.abort()


def no_place() -> None:
    raise InputError("wrong")


def no_such_line() -> None:
    raise InputError("wrong", Position("mischief.yaml", 7, 1))


def no_such_file() -> None:
    raise InputError("wrong", Position("absent.yaml", 3, 1))


def reversed_text() -> None:
    raise RawRefusalError("\u202ewrong", Position("mischief.yaml", 1, 1))


def two_lines() -> None:
    raise RawRefusalError("wrong\nwrong", Position("mischief.yaml", 1, 1))


def long_text() -> None:
    raise InputError("wrong" * 1000, Position("mischief.yaml", 1, 1))


def refuse() -> None:
    raise InputError("wrong", Position("mischief.yaml", 1, 1))


def write_out() -> None:
    Path("out/result.txt").write_text("x", encoding="utf-8")


EXPECTED = {
    write_beside: "side effect: open for writing outside --out",
    overwrite: "side effect: a file was changed",
    remove: "side effect: os.rename outside --out",
    start: "side effect: subprocess.Popen",
    shell: "side effect: os.system",
    connect: "side effect: socket.connect",
    execute: "side effect: exec of code that holds a text of the file",
    execute_anything: "side effect: exec of <string>",
    fill_memory: "MemoryError",
    spend_time: "too slow",
    wait: "waits for ever",
    crash: "ZeroDivisionError",
    die: "killed by signal 6",
    no_place: "no place",
    no_such_line: "a place beyond the end",
    no_such_file: "a place in no file",
    reversed_text: "control or direction characters in the message: U+202E",
    two_lines: "control or direction characters in the message: U+000A",
    long_text: "a message that is too long",
    refuse: "",
    write_out: "",
}
"""How the judge's first words about each should read."""

MISCHIEF: dict[str, Callable[[], None]] = {action.__name__: action for action in EXPECTED}


def do(path: str) -> None:
    """Do what a file names."""
    MISCHIEF[Path(path).read_text(encoding="utf-8").strip()]()
