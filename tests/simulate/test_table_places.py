"""What is wrong with a table that a run file names is said at the row of the table."""

from pathlib import Path

import pytest

from vehgen.errors import InputError
from vehgen.mechanics import derive
from vehgen.simulate import load_run, make_scenario

SPEED = "vehicle: sedan2\nspeed: {file: v.csv, time: t, speed: v}\nduration: 1 s\n"
POINTS = "vehicle: sedan2\nspeed: 2 m/s\nroad: [{hump: {shape: points, file: v.csv, distance: t, height_column: v, at: 1 m}}]\n"
PROFILE = "vehicle: sedan2\nspeed: 2 m/s\nduration: 1 s\nroad: [{profile: {file: v.csv, distance: t, height: v}}]\n"
FORCE = "vehicle: sedan2\nspeed: 2 m/s\nduration: 1 s\nforces: {f: {body: body, file: v.csv, time: t, force: v}}\n"

CASES = [
    (SPEED, "t,v\n0,1\n1,2\n1,3\n", "4:1: 't' must ascend; 1 comes after 1"),
    (SPEED, "t,v\n0,1\n", "2:1: 1 rows of numbers; at least 2 were expected"),
    (SPEED, "t,v\n0,1\n1,0\n", "3:2: every speed of a history must be above 0"),
    (SPEED, "t,v\n0,1\n1,1e-5\n", "3:2: a speed is 0.01 to 150 m/s in magnitude, found 1e-05 m/s"),
    (POINTS, "v,t\n0,0\n0.1,0.3\n0,0.2\n", "4:2: 't' must ascend; 0.2 comes after 0.3"),
    (POINTS, "t,v\n0,0\n", "2:1: 1 rows of numbers"),
    (POINTS, "t,v\n0,0\n0.2,7\n0.4,0\n", "3:2: the height of a hump is at most 2 m"),
    (POINTS, "t,v\n0,0\n1000,1e-5\n", "3:1: the length of a hump is 0.001 to 50 m in magnitude, found 1000 m"),
    (PROFILE, "t,v\n3,0\n2,1\n", "3:1: 't' must ascend; 2 comes after 3"),
    (FORCE, "t,v\n0,5\n1,6\n0.5,7\n", "4:1: 't' must ascend; 0.5 comes after 1"),
    (FORCE, "t,v\n0,5\n1,\xff\n", "3:2: 'ÿ' in column 'v' is not a finite number"),
    (FORCE, "t,w\n0,5\n", "1:1: no column 'v'"),
    (FORCE, "t,v,v\n0,5,6\n", "1:3: two columns are named 'v'"),
]


@pytest.mark.parametrize(("run", "table", "said"), CASES, ids=[case[2][:30] for case in CASES])
def test_it_is_refused_at_its_row(tmp_path: Path, run: str, table: str, said: str):
    (tmp_path / "v.csv").write_bytes(table.encode("latin-1"))
    (tmp_path / "run.yaml").write_text(run, encoding="utf-8")
    found = load_run(tmp_path / "run.yaml")
    model = derive(found.vehicle, found.outputs(), found.forces())
    with pytest.raises(InputError) as caught:
        make_scenario(found, model, model.values())
    assert f"v.csv:{said}" in str(caught.value)
    line, column = next((n, line.index("v.csv") + 1) for n, line in enumerate(run.splitlines(), 1) if "v.csv" in line)
    assert str(caught.value).endswith(f" (asked for by {tmp_path / 'run.yaml'}:{line}:{column})")
