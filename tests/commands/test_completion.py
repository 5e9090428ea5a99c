"""What a shell completes with the printed script."""

import shutil
import subprocess
from pathlib import Path

import pytest

from vehgen.commands import main, make_parser
from vehgen.commands.completion import subparsers
from vehgen.vehicle import bundled_models


@pytest.fixture
def script(work: Path, capsys: pytest.CaptureFixture[str]) -> Path:
    assert main(["completion", "bash"]) == 0
    path = work / "script.bash"
    path.write_text(capsys.readouterr().out)
    return path


def completed(script: Path, *words: str) -> set[str]:
    if shutil.which("bash") is None:
        pytest.skip("needs bash")
    listed = " ".join(f"'{word}'" for word in words)
    ask = f'. {script}; COMP_WORDS=({listed}); COMP_CWORD={len(words) - 1}; _vehgen; printf "%s\\n" "${{COMPREPLY[@]}}"'
    found = subprocess.run(["bash", "-c", ask], capture_output=True, text=True, check=True, cwd=script.parent)
    assert found.stderr == ""
    return set(found.stdout.split("\n")) - {""}


def test_bash_completes_commands_options_choices_models_and_files(script: Path):
    (script.parent / "sedan of mine.yaml").write_text("")
    assert completed(script, "vehgen", "") == set(subparsers(make_parser()))
    assert completed(script, "vehgen", "sens") == {"sensors", "sensitivity"}
    assert completed(script, "vehgen", "calibrate", "--se") == {"--sensors", "--search", "--seed"}
    assert completed(script, "vehgen", "calibrate", "--search", "m") == {"mpga"}
    assert completed(script, "vehgen", "completion", "") == {"bash", "zsh", "fish"}
    assert completed(script, "vehgen", "build", "sedan") == {"sedan2", "sedan of mine.yaml"}
    assert completed(script, "vehgen", "build", "tractor5") == {name for name in bundled_models() if name.startswith("tractor5")}


def test_fish_and_zsh_are_told_every_command(capsys: pytest.CaptureFixture[str]):
    for shell in ("fish", "zsh"):
        assert main(["completion", shell]) == 0
        text = capsys.readouterr().out
        assert all(name in text for name in subparsers(make_parser()))
        assert "road_train" in text
