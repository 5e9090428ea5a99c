"""The hostile options reach every command, and no name among them leads out of the folder; test_fuzzer.py tries some."""

from __future__ import annotations

import pytest

from tests.fuzzing.options import COMPILING, QUICK, REFUSED, stays_inside
from vehgen.commands import COMMANDS


def test_every_command_but_import_is_called():
    names = {command.__name__.rpartition(".")[2] for command in COMMANDS}
    assert {line.split()[0] for line in (*QUICK, *COMPILING, REFUSED)} == names - {"import_"}


@pytest.mark.parametrize(
    ("name", "inside"), [("a/../b", True), ("..", False), ("a/../../b", False), ("/a", False), ("", True), ("..a", True)]
)
def test_names_that_lead_out_of_the_folder_are_known(name: str, inside: bool):
    assert stays_inside(name) == inside
