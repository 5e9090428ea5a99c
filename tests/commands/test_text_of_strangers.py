"""Text of a stranger's file stays text: not code, not markup of a terminal, not a formula of a spreadsheet, not a path."""

from __future__ import annotations

import csv
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from tests.commands.calls import python
from vehgen.commands import main
from vehgen.commands.diagnose import _show
from vehgen.commands.progress import Bars
from vehgen.commands.terminal import print_table, warn
from vehgen.effects import registry
from vehgen.effects.library.memory import DRY_FRICTION_EFFECT
from vehgen.errors import InputError

CODE = r"""vehicle: quarter_car
speed: 2 m/s
duration: 1 s
sensors:
  A: {body: body, channels: {acceleration: "pwn\"\"\"\nopen('PWNED','w').write('x')\n\"\"\""}}
"""
MARKUP = "F[/x] [red]R[/red] [link=file:///etc]l[/link]"


@pytest.mark.parametrize("options", [(), ("--json",)])
def test_a_channel_that_is_code_is_refused_at_its_place(options: tuple[str, ...], work: Path, capsys: pytest.CaptureFixture[str]):
    (work / "run.yaml").write_text(CODE)
    assert main(["simulate", "run.yaml", *options]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("error: run.yaml:5:44: ")
    assert captured.err.count("\n") == 1
    assert [path.name for path in work.iterdir()] == ["run.yaml"]


@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        ("  A: {", "  'a\"\"\"\\n': {", "5:3"),
        ("speed:", 'outputs: {"a\\nb": {axle: wheel, quantity: tyre_load}}\nspeed:', "2:11"),
        ("speed:", "title: \"\\u202e\"\nspeed:", "2:8"),
    ],
)  # fmt: skip
def test_other_names_of_a_run_are_refused_too(old: str, new: str, place: str, work: Path, capsys: pytest.CaptureFixture[str]):
    (work / "run.yaml").write_text(CODE.replace(old, new, 1))
    assert main(["simulate", "run.yaml"]) == 2
    assert f"run.yaml:{place}: " in capsys.readouterr().err


def test_a_heading_that_is_a_formula_does_not_head_a_result(work: Path, capsys: pytest.CaptureFixture[str]):
    headings = ["=cmd|' /C calc'!A0", "+1", "-1", "@SUM(1)"]
    quantities = ["acceleration", "velocity", "displacement", "pitch_rate"]
    channels = ", ".join(f'{quantity}: "{heading}"' for quantity, heading in zip(quantities, headings, strict=True))
    (work / "run.yaml").write_text(
        CODE[: CODE.index("  A:")].replace("quarter_car", "sedan2") + f"  A: {{body: body, channels: {{{channels}}}}}\n"
    )
    assert main(["simulate", "run.yaml", "--json"]) == 0
    capsys.readouterr()
    (path,) = work.glob("*.csv")
    with path.open(newline="", encoding="utf-8") as stream:
        assert next(csv.reader(stream)) == ["t", *(f"A_{quantity}" for quantity in quantities)]


def test_markup_is_printed_as_it_stands(capsys: pytest.CaptureFixture[str]):
    print_table(MARKUP, (MARKUP, "x"), [(MARKUP, "1")])
    warn([MARKUP])
    captured = capsys.readouterr()
    assert captured.out.count(MARKUP) == 3
    assert captured.err == f"warning: {MARKUP}\n"
    with Bars(quiet=True) as bars:
        bars.tell(MARKUP, 0, 1, MARKUP)
        bars.say(MARKUP)
    assert MARKUP in capsys.readouterr().err


def test_a_folder_is_named_without_what_nobody_sees(work: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["build", "quarter_car", "--no-plots", "--out", "a\ufeff\u202eb"]) == 0
    assert "open a\\ufeff\\u202eb/index.html" in capsys.readouterr().out.splitlines()[-1]


def test_a_progress_bar_shows_markup_as_it_stands(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "200")
    with Bars(quiet=False) as bars:
        bars.tell("F[/x]", 0, 1, "R[/y]")
    captured = capsys.readouterr().err
    assert "F[/x]" in captured
    assert "R[/y]" in captured


def test_a_verdict_on_a_sensor_with_brackets_is_printed(capsys: pytest.CaptureFixture[str]):
    verdict = SimpleNamespace(
        verdict="sensor_fault", reason=MARKUP, effects=(), faults=(), notes=[MARKUP], next_experiment=MARKUP, gap=SimpleNamespace(runs=[])
    )
    found: Any = SimpleNamespace(verdict=verdict)
    _show(found)
    assert capsys.readouterr().out.count(MARKUP) == 3


@pytest.mark.parametrize("name", ["../../up", "=cmd()", "a b", "", "x" * 65, "é"])
def test_an_effect_of_another_package_has_a_name_too(name: str, monkeypatch: pytest.MonkeyPatch):
    from dataclasses import replace

    point = SimpleNamespace(name=f"{name}\u202e", load=lambda: replace(DRY_FRICTION_EFFECT, name=name))
    monkeypatch.setattr(registry, "entry_points", lambda group: [point])
    with pytest.raises(InputError, match="which is no name") as caught:
        registry.library()
    assert "\u202e" not in str(caught.value)


def test_warnings_in_a_pipe_are_a_line_each_on_stderr(work: Path):
    found = python("-m", "vehgen", "static", "vbi2d_2A3", folder=work, COLUMNS="40")
    lines = found.stderr.splitlines()
    assert lines
    assert all(line.startswith("warning: ") for line in lines)
    assert any(len(line) > 100 for line in lines)
    assert "warning" not in found.stdout
