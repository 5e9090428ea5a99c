"""Starter files can be used as they are, and what was edited is not written over."""

from pathlib import Path

import pytest

from tests.commands.calls import run_json
from vehgen.commands import main
from vehgen.mechanics import derive
from vehgen.simulate import lint, load_run, simulate
from vehgen.vehicle import load_vehicle


@pytest.mark.parametrize("kind", ["truck", "semitrailer"])
def test_a_starter_vehicle_can_be_used_in_all_its_sets(kind: str, work: Path):
    assert main(["new", kind, "--out", "my lorry.yaml"]) == 0
    vehicle = load_vehicle("my lorry.yaml")
    assert vehicle.name == "my_lorry"
    model = derive(vehicle)
    for chosen in (None, *vehicle.sets):
        assert lint(model, vehicle.values(chosen)) == []
    assert vehicle.ranges()


def test_what_stands_in_comments_can_be_used_too(work: Path):
    assert main(["new", "--out", "a.yaml"]) == 0
    text = Path("a.yaml").read_text()
    text = text.replace("# suspension: {k: kr", "suspension: {k: kr").replace("    suspension: {k: kr, c: 18 kN s/m}\n", "", 1)
    text = text.replace("# links:\n#   seat", "links:\n  seat").replace("# silence", "silence")
    text = text.replace("bodies:\n", "bodies:\n  driver: {mass: 90 kg, motions: [heave]}\n")
    Path("a.yaml").write_text(text)
    vehicle = load_vehicle("a.yaml")
    assert list(vehicle.links) == ["seat"]
    assert vehicle.axles["rear"].suspension.laws
    assert vehicle.silence


def test_a_starter_run_can_be_simulated(work: Path):
    assert main(["new", "run", "--out", "r.yaml"]) == 0
    response = simulate(load_run("r.yaml"))
    assert response.warnings == ()
    assert [item.name for item in response.channels] == ["front_az", "front_q", "rear_az"]


def test_an_edited_starter_is_kept(work: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["new", "--out", "a.yaml"]) == 0
    assert main(["new", "--out", "a.yaml"]) == 0
    with Path("a.yaml").open("a") as stream:
        stream.write("# mine\n")
    capsys.readouterr()
    assert main(["new", "--out", "a.yaml"]) == 2
    assert "was not written by vehgen (or was changed since)" in capsys.readouterr().err
    assert Path("a.yaml").read_text().endswith("# mine\n")
    assert run_json(capsys, "static", "a.yaml")["warnings"] == []
