"""An entry of the corpus: a case, and where it must be refused."""

from __future__ import annotations

from dataclasses import dataclass

from tests.fuzzing.cases import Case
from tests.fuzzing.healthy import read

HERE = "§"
"""Stands in a text right before what is wrong; it is taken out, and its line must be named."""


@dataclass(frozen=True)
class Nasty:
    """A nasty case.

    `place` is the (file, line) at which it must be refused; with `refused` alone it must be refused anywhere, its file named; without, it
    may be accepted as well: then it must cost nothing and do nothing.
    """

    name: str
    case: Case
    place: tuple[str, int] | None = None
    refused: bool = True


def marked(format: str, name: str, text: str, refused: bool = True, command: tuple[str, ...] = (), **files: bytes) -> Nasty:
    """Return an entry whose main file is `text`, with HERE before what is wrong; the truck of the tutorial stands beside it."""
    main = f"{format}.yaml"
    place = (main, text[: text.index(HERE)].count("\n") + 1) if HERE in text else None
    beside = {"my_truck.yaml": read("docs/examples/my_truck.yaml"), **{key.replace("_csv", ".csv"): data for key, data in files.items()}}
    case = Case(format, {**beside, main: text.replace(HERE, "").encode("utf-8", "surrogatepass")}, main, command)
    return Nasty(f"{format}: {name[:60]}", case, place, refused)
