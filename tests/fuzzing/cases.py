"""A case: the files of one folder, which of them is read, and how; written to a folder, and kept as a reproducer."""

from __future__ import annotations

import json
import os
import random
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path

FORMATS = ("vehicle", "run", "cargo", "frame", "facts", "effects", "table", "export", "options")
"""The six formats of YAML, the tables (CSV) that runs name, phone exports, and the options of commands."""


LONGEST_NAME = 255
"""Bytes of a file's name that file systems hold."""


@dataclass(frozen=True)
class Case:
    """Files of one folder, and what is done with them.

    Parameters
    ----------
    format
        One of :data:`FORMATS`.
    files
        Contents by name.
    main
        The file that vehgen is given.
    command
        Arguments of the command line; none: load, derive and generate by the API. `--out` lies below the folder `out`.
    special
        What is no regular file, by name: `pipe`, `folder`, or `link:TARGET`.
    mutations
        What was done to a healthy case, in words.
    """

    format: str
    files: dict[str, bytes]
    main: str
    command: tuple[str, ...] = ()
    special: dict[str, str] = field(default_factory=dict)
    mutations: tuple[str, ...] = ()

    @property
    def start(self) -> str:
        """The folder below the case's own that it is read from."""
        return "out" if self.format == "options" else "."

    @property
    def needs_place(self) -> bool:
        """Whether a refusal must name a line: there is one in the main file, unless that is an archive, no file, or not at fault."""
        return self.format not in {"export", "options"} and self.main in self.files and self.main not in self.special

    @property
    def written(self) -> dict[str, bytes]:
        """The files without those whose names no file system holds: nobody has such files."""
        names = (name for name in self.files if max(len(os.fsencode(part)) for part in name.split("/")) <= LONGEST_NAME)
        return {name: self.files[name] for name in names}

    def write(self, folder: Path) -> None:
        """Write the case's files into an empty folder, and an empty folder `out` beside them."""
        (folder / "out").mkdir(parents=True)
        for name, data in self.written.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_bytes(data)
        for name, kind in self.special.items():
            (folder / name).unlink(missing_ok=True)
            if kind == "pipe":
                os.mkfifo(folder / name)
            elif kind == "folder":
                (folder / name).mkdir()
            else:
                (folder / name).symlink_to(kind.removeprefix("link:"))

    def with_text(self, text: str, mutations: Iterable[str], name: str | None = None) -> Case:
        """Return the case with another main file (or file `name`); half surrogates are written as they are."""
        data = text.encode("utf-8", "surrogatepass")
        return replace(self, files={**self.files, name or self.main: data}, mutations=(*self.mutations, *mutations))

    def describe(self) -> str:
        """Return what is needed beside the files to do it again, as JSON."""
        return json.dumps(
            {"format": self.format, "main": self.main, "command": self.command, "special": self.special, "mutations": self.mutations},
            indent=1,
        )


def read_case(folder: Path) -> Case:
    """Return a case that was kept as a reproducer: `case.json` and the files beside it."""
    data = json.loads((folder / "case.json").read_text(encoding="utf-8"))
    special = data["special"]
    names = [path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file() and not path.is_symlink()]
    files = {name: (folder / name).read_bytes() for name in names if name not in {"case.json", "verdict.txt"}}
    return Case(data["format"], files, data["main"], tuple(data["command"]), special, tuple(data["mutations"]))


def generator(seed: int, format: str, number: int) -> random.Random:
    """Return the random numbers of one case: the same on every machine, whatever came before."""
    return random.Random(f"{seed} {format} {number}")
