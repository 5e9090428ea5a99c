"""`laden` and `module` from the command line."""

import json
from pathlib import Path

import pytest

from vehgen.commands import main
from vehgen.files.manifest import MANIFEST
from vehgen.vehicle import load_vehicle

EXAMPLES = Path(__file__).parents[2] / "docs" / "examples" / "cargo"


@pytest.fixture
def work(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run_json(capsys, *arguments):
    assert main([*map(str, arguments), "--json"]) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    return json.loads(captured.out)


def test_laden(work, capsys):
    found = run_json(capsys, "laden", "tractor5", EXAMPLES / "building_module.yaml", "--out", "out/laden.yaml")
    assert found["cargo_mass"] == pytest.approx(5771)
    assert [mode["laden_hz"] for mode in found["modes"]][:4] == pytest.approx([1.243297106, 2.627365595, 3.055570469, 6.787363978])
    assert sum(b - a for a, b in found["axles"].values()) == pytest.approx(5771 * 9.81)
    assert found["files"] == ["out/laden.yaml"]
    assert load_vehicle("out/laden.yaml").title == "Five-axle tractor-semitrailer, laden: building module"
    assert {path.name for path in (work / "out").iterdir()} == {"laden.yaml", MANIFEST}
    assert main(["laden", "tractor5", str(EXAMPLES / "pallets.yaml"), "--set", "SHCM-1"]) == 0
    table = capsys.readouterr().out
    assert "+98.100" in table
    assert "wrote tractor5_laden.yaml" in table


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["laden", "own.yaml", "cargo.yaml", "--out", "own.yaml"], "own.yaml is a file that this command reads"),
        (["laden", "own.yaml", "cargo.yaml", "--out", "cargo.yaml"], "cargo.yaml is a file that this command reads"),
        (["laden", "own.yaml", "absent.yaml"], "no file absent.yaml"),
        (["laden", "own.yaml", "cargo.yaml", "--out", "a-b.yaml", "--set", "x"], "own has no parameter set 'x'"),
        (
            ["laden", "own.yaml", "named.yaml", "--out", "new.yaml"],
            "the laden vehicle would not be valid: 'ground' has a meaning of its own",
        ),
        (["module", "frame.yaml", "--out", "frame.yaml"], "frame.yaml is a file that this command reads"),
        (["module", "absent.yaml"], "no file absent.yaml"),
    ],
)
def test_faults_leave_nothing_behind(work, capsys, arguments, message):
    (work / "own.yaml").write_text("extends: tractor5\nname: own\n")
    (work / "cargo.yaml").write_text((EXAMPLES / "pallets.yaml").read_text())
    (work / "named.yaml").write_text("name: ground\n" + (EXAMPLES / "pallets.yaml").read_text())
    (work / "frame.yaml").write_text((EXAMPLES / "steel_module.yaml").read_text())
    before = {path.name: path.read_text() for path in work.iterdir()}
    assert main(arguments) == 2
    captured = capsys.readouterr()
    assert captured.err.startswith("error: ")
    assert captured.err.count("\n") == 1
    assert message in captured.err
    assert {path.name: path.read_text() for path in work.iterdir()} == before


def test_module_then_laden(work, capsys):
    """From a frame to a laden vehicle, with a picture; coarse, for speed."""
    pytest.importorskip("pyfe3d")
    frame = (EXAMPLES / "steel_module.yaml").read_text().replace("mesh: {size: 0.2 m}", "mesh: {size: 0.6 m}")
    (work / "frame.yaml").write_text(frame)
    found = run_json(capsys, "module", "frame.yaml", "--out", "cargo.yaml", "--plot", "module.png")
    assert found["total_mass"] == pytest.approx(5771, abs=2)
    assert found["cog"]["above_floor"] == pytest.approx(0.98, abs=0.005)
    assert found["cog"]["behind_front"] == pytest.approx(4.35)
    assert found["frequency"] == pytest.approx(6.26, rel=0.05)
    assert found["damping_ratio"] == pytest.approx(0.02, rel=0.02)
    assert found["files"] == ["cargo.yaml", "module.png"]
    assert (work / "module.png").read_bytes()[:4] == b"\x89PNG"
    laden = run_json(capsys, "laden", "tractor5", "cargo.yaml", "--out", "laden.yaml")
    assert len(laden["modes"]) == 9
    assert laden["modes"][3]["unladen_hz"] is None
    assert main(["module", "frame.yaml", "--mass", "effective"]) == 0
    table = capsys.readouterr().out
    assert "fixed mass, moves with the carrier" in table
    assert "wrote frame_cargo.yaml" in table
