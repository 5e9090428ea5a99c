"""No command writes over a file that it read, or over one that vehgen did not write; refusals come before the work."""

from __future__ import annotations

import os
import shutil
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from tests.fit.recordings import sedan_truth, write_run
from vehgen.commands import main
from vehgen.files.manifest import MANIFEST

EXAMPLES = Path(__file__).parents[2] / "docs" / "examples"
FOREIGN = "exists and was not written by vehgen (or was changed since); name another file or add --force"
READ = "is a file that this command reads"
RUN = """\
vehicle: own.yaml
speed: 2 m/s
duration: 1 s
road:
  - hump: {shape: half_sine, length: 0.5 m, height: 0.03 m, at: 1 m}
sensors:
  L1: {body: body, channels: {acceleration: az}}
"""
HUMP = ("--hump", "half_sine,length=0.5,height=0.03")


@pytest.fixture
def own(work: Path) -> Path:
    """A folder with a vehicle and a run of it."""
    (work / "own.yaml").write_text("extends: base.yaml\nname: own\n")
    (work / "base.yaml").write_text("extends: quarter_car\nname: base\n")
    (work / "r.yaml").write_text(RUN)
    return work


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """Run a command that must be refused; returns its one line."""
    capsys.readouterr()
    assert main(list(arguments)) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("error: ")
    assert captured.err.count("\n") == 1
    return captured.err


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


def test_import_keeps_the_raw_export_and_an_edited_run_file(work: Path, capsys: pytest.CaptureFixture[str]):
    """`import raw.csv --out raw.yaml` writes its recording beside the raw file, not over it."""
    assert main(import_arguments(str(EXAMPLES / "phones" / "hump_2ms_phone1.zip"), "first.yaml", "--forward", "y")) == 0
    (work / "first_recording.csv").rename(work / "raw.csv")
    raw = (work / "raw.csv").read_bytes()
    plain = ("--columns", "time=t,acceleration=L1_az,pitch_rate=L1_q", "--speed", "2")
    for _ in range(2):
        assert main(import_arguments("raw.csv", "raw.yaml", *plain)) == 0
        assert (work / "raw.csv").read_bytes() == raw
    assert "recording: raw_recording.csv" in (work / "raw.yaml").read_text()
    with (work / "raw.yaml").open("a") as stream:
        stream.write("# checked by hand\n")
    (work / "raw_recording.csv").rename(work / "again_recording.csv")
    before = contents(work)
    assert FOREIGN in refused(capsys, *import_arguments("raw.csv", "raw.yaml", *plain))
    assert READ in refused(capsys, *import_arguments("again_recording.csv", "again.yaml", *plain, "--force"))
    assert contents(work) == before


def import_arguments(export: str, out: str, *options: str) -> list[str]:
    sensor = "L1:body=tractor,behind=axle1,distance=-0.29"
    return ["import", export, "--out", out, "--vehicle", "tractor5.yaml", "--sensor", sensor, *HUMP, *options]


@pytest.mark.parametrize("force", [(), ("--force",)])
def test_simulate_keeps_its_recording_run_and_vehicles(own: Path, capsys: pytest.CaptureFixture[str], force: tuple[str, ...]):
    (own / "r.yaml").write_text(RUN + "recording: r_response.csv\n")
    (own / "r_response.csv").write_text("t,az\n0,0\n")
    os.link(own / "base.yaml", own / "hard.yaml")
    before = contents(own)
    assert READ in refused(capsys, "simulate", "r.yaml", *force)
    for name in ("r.yaml", "own.yaml", "base.yaml", "./r.yaml", "hard.yaml"):
        assert READ in refused(capsys, "simulate", "r.yaml", "--out", name, *force)
    assert contents(own) == before


def test_simulate_keeps_the_road_that_it_drives_over(own: Path, capsys: pytest.CaptureFixture[str]):
    np.savetxt(own / "road.csv", [[0, 0], [1, 0.01], [50, 0]], delimiter=",", header="s,h", comments="")
    (own / "r.yaml").write_text(RUN.replace("hump: {shape", "profile: {file: road.csv, distance: s, height: h}\n  - hump: {shape"))
    before = contents(own)
    assert READ in refused(capsys, "simulate", "r.yaml", "--out", "road.csv", "--force")
    assert contents(own) == before


def test_simulate_keeps_what_it_did_not_write(own: Path, capsys: pytest.CaptureFixture[str]):
    (own / "r_response.csv").write_text("mine")
    (own / "a.png").write_text("mine")
    before = contents(own)
    assert FOREIGN in refused(capsys, "simulate", "r.yaml")
    assert FOREIGN in refused(capsys, "simulate", "r.yaml", "--out", "a.csv", "--plot")
    assert "two results" in refused(capsys, "simulate", "r.yaml", "--out", "b.png", "--plot")
    assert contents(own) == before
    assert main(["simulate", "r.yaml", "--force"]) == 0
    result = (own / "r_response.csv").read_bytes()
    assert result != b"mine"
    assert main(["simulate", "r.yaml"]) == 0
    assert (own / "r_response.csv").read_bytes() == result
    (own / "r_response.csv").write_text("edited")
    assert FOREIGN in refused(capsys, "simulate", "r.yaml")


def test_build_keeps_a_page_of_the_user(own: Path, capsys: pytest.CaptureFixture[str]):
    (own / "site").mkdir()
    (own / "site" / "index.html").write_text("mine")
    assert FOREIGN in refused(capsys, "build", "own.yaml", "--out", "site", "--no-plots")
    assert contents(own / "site") == {"index.html": b"mine"}
    assert main(["build", "own.yaml", "--out", "site", "--no-plots", "--force"]) == 0
    assert main(["build", "own.yaml", "--out", "site", "--no-plots"]) == 0


def test_laden_and_module_keep_what_they_did_not_write(own: Path, capsys: pytest.CaptureFixture[str]):
    shutil.copy(EXAMPLES / "cargo" / "pallets.yaml", own / "cargo.yaml")
    shutil.copy(EXAMPLES / "cargo" / "steel_module.yaml", own / "frame.yaml")
    (own / "tractor5_laden.yaml").write_text("mine")
    (own / "frame_cargo.yaml").write_text("mine")
    before = contents(own)
    assert FOREIGN in refused(capsys, "laden", "tractor5", "cargo.yaml")
    assert FOREIGN in refused(capsys, "module", "frame.yaml")
    assert FOREIGN in refused(capsys, "module", "frame.yaml", "--out", "new.yaml", "--plot", "cargo.yaml")
    assert READ in refused(capsys, "module", "frame.yaml", "--out", "new.yaml", "--plot", "frame.yaml", "--force")
    assert "its name must end in" in refused(capsys, "module", "frame.yaml", "--out", "new.yaml", "--plot", "new.bmp")
    assert contents(own) == before
    assert main(["laden", "tractor5", "cargo.yaml", "--force"]) == 0
    assert main(["laden", "tractor5", "cargo.yaml"]) == 0


@pytest.mark.parametrize(
    ("arguments", "work_of", "name"),
    [
        (("calibrate", "sedan2.yaml", "hump.yaml"), "vehgen.calibrate.api:calibrate", "sedan2_calibrated.yaml"),
        (("calibrate", "sedan2.yaml", "hump.yaml"), "vehgen.calibrate.api:calibrate", "search.json"),
        (("calibrate", "sedan2.yaml", "hump.yaml"), "vehgen.calibrate.api:calibrate", "intervals.png"),
        (("diagnose", "sedan2.yaml", "hump.yaml"), "vehgen.diagnose:diagnose", "report.html"),
        (("diagnose", "sedan2.yaml", "hump.yaml"), "vehgen.diagnose:diagnose", "sedan2_with_dry_friction.yaml"),
        (("validate", "sedan2.yaml", "hump.yaml"), "vehgen.calibrate:validate", "validation_bands.png"),
        (("sensitivity", "sedan2.yaml", "hump.yaml"), "vehgen.calibrate:sensitivity", "sensitivity_R_q.png"),
        (("build", "sedan2.yaml"), "vehgen.report.building:derive", "kernel.py"),
    ],
)
def test_long_work_does_not_begin(
    work: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, arguments: tuple[str, ...], work_of: str, name: str
):
    write_run(work, "hump", sedan_truth())
    out = work / "out"
    out.mkdir()
    (out / name).write_text("mine")
    module, _, function = work_of.partition(":")
    monkeypatch.setattr(import_module(module), function, lambda *_, **__: pytest.fail("the work began"))
    assert FOREIGN in refused(capsys, *arguments, "--out", "out")
    assert contents(out) == {name: b"mine"}
    with pytest.raises(pytest.fail.Exception, match="the work began"):
        main([*arguments, "--out", "out", "--force"])
    if "hump.yaml" in arguments:
        (out / name).unlink()
        os.link(work / "hump.yaml", out / name)
        assert READ in refused(capsys, *arguments, "--out", "out", "--force")


@pytest.mark.parametrize(
    ("out", "message"),
    [
        ("", "--out wants a name; found ''"),
        ("a\nb.csv", "--out wants a name; found 'a\\nb.csv'"),
        ("a\0.csv", "--out wants a name; found 'a\\x00.csv'"),
        ("-", "results are not written to standard output"),
        ("results/", "--out names a file to write; found 'results/', a folder"),
        ("folder", "cannot write folder: it is a folder; the name of a file was expected"),
        (".", "cannot write .: it is a folder"),
        ("own.yaml/x.csv", "cannot write own.yaml/x.csv: own.yaml is not a folder"),
        ("own.yaml/x/y.csv", "cannot write own.yaml/x/y.csv: own.yaml is not a folder"),
        ("/dev/null", "cannot write /dev/null: it is a device"),
        ("pipe", "cannot write pipe: it is a pipe"),
        ("link.csv", "cannot write link.csv: it is a symbolic link"),
        ("n" * 300, "File name too long"),
        (MANIFEST, "vehgen keeps this name for itself"),
    ],
)
@pytest.mark.skipif(os.name != "posix", reason="needs POSIX links, pipes and devices")
def test_names_that_cannot_hold_a_file(own: Path, capsys: pytest.CaptureFixture[str], out: str, message: str):
    (own / "folder").mkdir()
    os.mkfifo(own / "pipe")
    (own / "link.csv").symlink_to("elsewhere.csv")
    before = sorted(own.iterdir())
    for force in ((), ("--force",)):
        assert message in refused(capsys, "simulate", "r.yaml", "--out", out, *force)
    assert sorted(own.iterdir()) == before


@pytest.mark.parametrize(
    ("out", "message"),
    [
        ("", "--out wants a name; found ''"),
        ("own.yaml", "cannot write own.yaml/kernel.py: own.yaml is not a folder"),
        ("own.yaml/deeper", "own.yaml is not a folder"),
        ("/dev/null", "/dev/null is not a folder"),
        ("n" * 300, "File name too long"),
    ],
)
def test_names_that_cannot_be_a_folder(own: Path, capsys: pytest.CaptureFixture[str], out: str, message: str):
    before = contents(own)
    assert message in refused(capsys, "build", "own.yaml", "--out", out, "--no-plots", "--force")
    assert contents(own) == before
