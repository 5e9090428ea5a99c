"""The files that a run is made from: exactly those that are opened for it, each by a name that no other has."""

from pathlib import Path

import pytest

from tests.simulate.run_files import GOOD, write
from vehgen.files import collecting_reads
from vehgen.files.provenance import file_hash, file_hashes
from vehgen.fit.recording import read_recording
from vehgen.mechanics import derive
from vehgen.simulate import load_run, make_scenario
from vehgen.simulate.run_file.files_read import files_read
from vehgen.vehicle import load_vehicle
from vehgen.vehicle.loading import models_folder, vehicle_files

TABLES = {
    "hump.csv": "distance,h\n0,0\n0.5,0.02\n1,0\n",
    "roads/h.csv": "s,h\n0,0\n50,0.01\n",
    "forces/h.csv": "t,F\n0,1\n20,2\n",
    "speed.csv": "t,speed\n0,2\n20,2\n",
    "post.csv": "t,displacement\n0,0\n20,0.01\n",
    "measured.csv": "t,L1_az,L1_q,v2,L3_acceleration,L3_pitch_rate\n" + "".join(f"{i / 100}{f',{i % 7}' * 5}\n" for i in range(1000)),
}
RUN = (
    GOOD.replace("speed: 7.2 km/h", "speed: {file: speed.csv}")
    .replace("road.csv", "roads/h.csv")
    .replace("force.csv", "forces/h.csv")
    .replace("post: {harmonic: {amplitude: 5 mm, frequency: 3 Hz}}", "post: {file: ./post.csv, unit: m}")
)


@pytest.fixture
def run_path(tmp_path):
    for name, text in TABLES.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    return write(tmp_path, RUN)


def test_what_is_listed_is_what_is_opened(run_path):
    with collecting_reads() as opened:
        run = load_run(run_path)
        make_scenario(run, derive(run.vehicle), run.vehicle.values(run.file.set))
        read_recording(run)
    found = files_read([run])
    assert {path.resolve() for path in found.values()} == {Path(path) for path in opened}
    assert set(found) == {"run.yaml", "rig.yaml", *TABLES}
    assert set(found) - set(files_read([run], recordings=False)) == {"measured.csv"}
    assert set(files_read([run], inputs=False)) == {"run.yaml", "rig.yaml", "measured.csv"}


def test_files_of_one_name_in_different_folders_stay_apart(run_path):
    other = run_path.parent / "other"
    other.mkdir()
    for name in ("run.yaml", "measured.csv"):
        (other / name).write_text((run_path.parent / name).read_text().replace("7.2 km/h", "8 km/h") + "\n")
    second = other / "run.yaml"
    second.write_text(second.read_text().replace("vehicle: rig.yaml", "vehicle: ../rig.yaml"))
    runs = [load_run(run_path), load_run(second)]
    found = file_hashes(files_read(runs, inputs=False))
    assert set(found) == {"run.yaml", "rig.yaml", "measured.csv", "other/run.yaml", "other/measured.csv"}
    assert found["run.yaml"] == file_hash(run_path) != found["other/run.yaml"] == file_hash(second)
    assert set(files_read(runs[::-1], inputs=False)) == {"run.yaml", "../rig.yaml", "measured.csv", "../run.yaml", "../measured.csv"}


def test_a_bundled_model_is_known_by_its_name_and_stays_apart_from_a_file_named_so(tmp_path):
    (tmp_path / "run.yaml").write_text("vehicle: sedan2\nspeed: 2 m/s\nduration: 1 s\n")
    assert set(files_read([load_run(tmp_path / "run.yaml")])) == {"run.yaml", "sedan2.yaml"}
    own = tmp_path / "sedan2.yaml"
    own.write_text("extends: sedan2\n")
    found = vehicle_files(load_vehicle(own))
    assert found == {"sedan2.yaml": own, "sedan2.yaml (bundled)": models_folder() / "sedan2.yaml"}
