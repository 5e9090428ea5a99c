"""What a diagnosis says it was made from."""

import hashlib

from vehgen.diagnose.collecting import origin_of
from vehgen.fit.trial import load_trials

RUN = """\
vehicle: ../../plate.yaml
duration: 4 s
sample: 10 ms
speed: {file: tables/speed.csv}
forces: {shaker: {body: plate, file: tables/force.csv, unit: N}}
sensors: {s: {body: plate, channels: {acceleration: az}}}
recording: ../table.csv
"""
PLATE = """\
bodies: {plate: {mass: 100 kg, pitch_inertia: 10 kg m^2}}
axles:
  front: {body: plate, x: 1 m, tyre: {k: 100 kN/m, c: 300 N s/m}}
  rear: {body: plate, x: -1 m, tyre: {k: 100 kN/m, c: 300 N s/m}}
"""


def test_every_table_that_drove_a_run_is_among_the_inputs_by_a_name_of_its_own(tmp_path):
    (tmp_path / "plate.yaml").write_text(PLATE)
    (tmp_path / "table.csv").write_text("t,az\n" + "".join(f"{i / 100},{i % 7 - 3}\n" for i in range(400)))
    files = ["plate.yaml", "table.csv"]
    for name in ("one", "two"):
        folder = tmp_path / "runs" / name
        (folder / "tables").mkdir(parents=True)
        (folder / "run.yaml").write_text(RUN.replace("../table.csv", "../../table.csv"))
        (folder / "tables" / "speed.csv").write_text("t,speed\n0,5\n9,6\n")
        (folder / "tables" / "force.csv").write_text(f"t,force\n0,0\n1,{len(files)}\n9,0\n")
        files += [f"runs/{name}/{file}" for file in ("run.yaml", "tables/speed.csv", "tables/force.csv")]
    trials = load_trials([tmp_path / "runs" / name / "run.yaml" for name in ("one", "two")])
    (tmp_path / "own.yaml").write_text("effects: {}\n")
    files.append("own.yaml")
    found = origin_of(trials, [str(tmp_path / "own.yaml")]).inputs
    assert len(found) == len(files)
    for name, digest in found.items():
        file = (tmp_path / "runs" / "one" / name).resolve().relative_to(tmp_path).as_posix()
        files.remove(file)
        assert digest == hashlib.sha256((tmp_path / file).read_bytes()).hexdigest()
    assert files == []
