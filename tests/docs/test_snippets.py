"""What can be copied from the pages runs: every snippet of Python, and every command line as far as its options."""

import re
import shlex
import shutil

import pytest

from tests.commands.calls import python
from tests.docs.pages import PAGES, ROOT
from vehgen.commands import COMMANDS, make_parser

BLOCK = re.compile(r"^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)
NAMES = [getattr(command, "NAME", command.__name__.rpartition(".")[2]) for command in COMMANDS]
OWN_TEST = "api.md"
"""Its snippets run, and are looked at, in a test of their own."""
COMMAND = re.compile(r"`(vehgen [^`]*)`")


def blocks(page, language):
    return [text for kind, text in BLOCK.findall(page.read_text(encoding="utf-8")) if kind == language]


def command_lines(page):
    """Return what follows `vehgen` in shell blocks, and in the text where a whole command is named."""
    lines = [line for text in blocks(page, "sh") for line in text.replace("\\\n", " ").splitlines() if line.startswith("vehgen ")]
    return [shlex.split(line.partition(" > ")[0], comments=True)[1:] for line in lines]


@pytest.mark.thorough
@pytest.mark.parametrize("page", [page for page in PAGES if blocks(page, "python") and page.name != OWN_TEST], ids=lambda path: path.name)
def test_python_runs(page, tmp_path):
    folder = tmp_path / "examples"
    shutil.copytree(ROOT / "docs" / "examples", folder)
    (folder / "snippet.py").write_text("\n".join(blocks(page, "python")), encoding="utf-8")
    found = python("-W", "error", "snippet.py", folder=folder)
    assert (found.returncode, found.stderr) == (0, "")


@pytest.mark.parametrize("page", [page for page in PAGES if command_lines(page)], ids=lambda path: path.name)
def test_commands_take_their_options(page):
    for words in command_lines(page):
        assert make_parser().parse_args(words).command == words[0]


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.name)
def test_commands_named_in_the_text_exist(page):
    for text in COMMAND.findall(page.read_text(encoding="utf-8")):
        word = text.split()[1]
        assert word in NAMES or word == "..." or word.startswith("--"), text


def test_every_page_with_python_is_found():
    assert {"README.md", "tutorial.md", "force-laws.md", "effects.md"} <= {page.name for page in PAGES if blocks(page, "python")}
