"""Help, examples that can be typed, and what importing and asking for help load."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

import vehgen
from tests.commands.calls import python
from vehgen.commands import COMMANDS, main, make_parser

NAMES = [getattr(command, "NAME", command.__name__.rpartition(".")[2]) for command in COMMANDS]
HEAVY = {"sympy", "numba", "numpy", "scipy", "matplotlib", "rich", "pydantic", "ruamel"}


@pytest.mark.parametrize("name", NAMES)
def test_every_command_has_help_with_an_example_that_can_be_typed(name: str, capsys: pytest.CaptureFixture[str]):
    with pytest.raises(SystemExit) as left:
        main([name, "--help"])
    assert left.value.code == 0
    text = capsys.readouterr().out
    example = re.search(r"^example: (vehgen .*)$", text, re.MULTILINE)
    assert example is not None
    words = shlex.split(example.group(1).partition(">")[0])[1:]
    assert words[0] == name
    assert make_parser().parse_args(words).command == name


@pytest.mark.thorough
def test_examples_on_bundled_models_work(capsys: pytest.CaptureFixture[str]):
    for command in COMMANDS:
        words = shlex.split(command.EXAMPLE.partition(">")[0])[1:]
        if words[0] in (
            "modes",
            "static",
            "effects",
            "models",
            "schema",
            "completion",
            "bench",
        ):  # the others write files or read recordings
            assert main(words) == 0
            assert capsys.readouterr().out


def test_help_lists_every_command_and_no_command_prints_it(capsys: pytest.CaptureFixture[str]):
    with pytest.raises(SystemExit):
        main(["--help"])
    text = capsys.readouterr().out
    for command, name in zip(COMMANDS, NAMES, strict=True):
        assert re.search(rf"^ +{name}\s+{re.escape((command.__doc__ or '').split()[0])} ", text, re.MULTILINE)
    assert main([]) == 0
    assert capsys.readouterr().out == text
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"{vehgen.__version__}\n"


@pytest.mark.parametrize(
    "code",
    [
        "import vehgen; dir(vehgen)",
        "import vehgen.commands",
        "import runpy, sys; sys.argv = ['vehgen', '--help']; runpy.run_module('vehgen', run_name='__main__')",
        "import runpy, sys; sys.argv = ['vehgen', '--version']; runpy.run_module('vehgen', run_name='__main__')",
    ],
)
def test_help_and_import_stay_light(code: str):
    watch = f"import atexit, sys\natexit.register(lambda: print('loaded', sorted({HEAVY!r} & set(sys.modules)), file=sys.stderr))\n"
    found = python("-c", watch + code)
    assert found.stderr == "loaded []\n"


def test_no_commands_help_loads_a_heavy_package():
    """In one process: what any of them loaded would still be there at the end."""
    code = f"""
import contextlib, io, sys
from vehgen.commands import main
for name in {NAMES}:
    with contextlib.redirect_stdout(io.StringIO()) as printed, contextlib.suppress(SystemExit):
        main([name, "--help"])
    print(name, "usage:" in printed.getvalue(), sorted({HEAVY} & set(sys.modules)))
"""
    found = python("-c", code)
    assert found.stdout.splitlines() == [f"{name} True []" for name in NAMES]


def test_reading_a_bad_file_needs_no_heavy_package(work: Path):
    """A fault is found before sympy, numba or matplotlib are loaded."""
    (work / "bad.yaml").write_text("bodies:\n  body: {mas: 1 kg}\n")
    code = "import sys; from vehgen.commands import main; main(['build', 'bad.yaml'])\n"
    found = python("-c", code + f"print(sorted({HEAVY - {'pydantic', 'ruamel'}!r} & set(sys.modules)))", folder=work)
    assert found.stdout == "[]\n"


@pytest.mark.thorough
def test_the_packages_names_are_found_when_asked_for():
    code = "import vehgen; print([name for name in vehgen.__all__ if not callable(getattr(vehgen, name))])"
    assert python("-c", code).stdout == "[]\n"
    assert set(vehgen.__all__) < set(dir(vehgen))
    with pytest.raises(AttributeError, match="module 'vehgen' has no attribute 'Vehicl'"):
        _ = vehgen.Vehicl


@pytest.mark.thorough
def test_functions_stand_before_rooms_of_their_names():
    code = (
        "import vehgen.simulate.modes, vehgen.report, vehgen.diagnose\n"
        "from vehgen.simulate import load_run\n"
        "from vehgen import calibrate, diagnose, effects, report, simulate\n"
        "print([type(item).__name__ for item in (calibrate, diagnose, effects, report, simulate, vehgen.simulate, load_run)])"
    )
    assert python("-c", code).stdout == f"{['function'] * 7}\n"
