"""Every place where a vehicle, run, cargo, frame or effects file gives a name or a text: a bad one is refused where it stands."""

import json

import pytest

from vehgen.cargo import load_cargo
from vehgen.cargo.frame_file import load_frame
from vehgen.effects.entry import load_effects
from vehgen.errors import InputError
from vehgen.files.names import MAX_TEXT
from vehgen.simulate import load_run
from vehgen.vehicle import load_vehicle, parse_vehicle

VEHICLE = """\
name: rig
title: a rig
parameters:
  mB: {value: 900 kg, meaning: mass}
bodies:
  frame: {mass: mB, motions: [heave], title: frame}
axles:
  front: {body: frame, tyre: {k: 100 kN/m}, title: tyre}
links:
  post: {ground: {}, frame: {}, k: 10 kN/m, title: post, laws: [{law: {force: k3*d^3, parameters: {k3: 1 N/m^3}}}]}
sets:
  soft: {mB: 800 kg}
"""
RUN = """\
vehicle: vehicle.yaml
title: a run
speed: 2 m/s
duration: 1 s
forces: {shaker: {body: frame, harmonic: {amplitude: 1 N, frequency: 1 Hz}}}
displacements: {post: {harmonic: {amplitude: 1 mm, frequency: 1 Hz}}}
sensors:
  L1: {body: frame, channels: {acceleration: az, velocity: {column: v}}}
outputs: {load: {axle: front, quantity: tyre_load}}
"""
CARGO = """\
name: box
title: a box
source: nowhere
on: frame
behind: frame
rigid: {mass: 1 t, length: 1 m, height: 1 m, front: 0 m}
"""
EFFECTS = """\
effects:
  stiffer:
    title: a stiffer spring
    meaning: a spring
    attaches: suspension
    force: k3*d^3
    parameters:
      k3: {meaning: cubic stiffness, unit: N/m^3, low: 1e4, high: 1e9, starts: [1e7]}
"""

FRAME = """\
name: module
title: a small box
source: nowhere
on: semitrailer
behind: fifth_wheel
front: 0.5 m
size: {length: 2.4 m, width: 1.2 m, height: 1.0 m}
materials:
  board: {E: 8 GPa, nu: 0.25, density: 700 kg/m^3}
sections:
  joist: {bar: {height: 50 mm, width: 10 mm}}
panels:
  floor: {layers: [{material: board, thickness: 20 mm}]}
mesh: {size: 0.2 m}
damping: [{frequency: 10 Hz, ratio: 0.02}, {frequency: 50 Hz, ratio: 0.02}]
"""

# file, line with the name in it, the name
PLACES = [
    (VEHICLE, "name: rig", "rig"),
    (VEHICLE, "  mB: {value: 900 kg", "mB"),
    (VEHICLE, "  frame: {mass", "frame"),
    (VEHICLE, "  front: {body", "front"),
    (VEHICLE, "  post: {ground", "post"),
    (VEHICLE, "  post: {ground: {}, frame: {}", "frame: {}"),
    (VEHICLE, "[{law: {force", "law: {force"),
    (VEHICLE, "parameters: {k3: 1", "k3: 1"),
    (VEHICLE, "  soft: {mB", "soft"),
    (VEHICLE, "  soft: {mB", "mB: 800"),
    (RUN, "forces: {shaker", "shaker"),
    (RUN, "displacements: {post", "post"),
    (RUN, "  L1: {body", "L1"),
    (RUN, "outputs: {load", "load"),
    (CARGO, "name: box", "box"),
    (FRAME, "name: module", "module"),
    (FRAME, "  board: {E", "board"),
    (FRAME, "  joist: {bar", "joist"),
    (EFFECTS, "  stiffer:", "stiffer"),
    (EFFECTS, "      k3: {", "k3"),
]
LOADERS = {VEHICLE: load_vehicle, RUN: load_run, CARGO: load_cargo, FRAME: load_frame, EFFECTS: load_effects}


def refusal(tmp_path, text, changed):
    (tmp_path / "vehicle.yaml").write_text(VEHICLE, encoding="utf-8")
    path = tmp_path / ("vehicle.yaml" if text is VEHICLE else "file.yaml")
    LOADERS[text](_written(path, text))
    with pytest.raises(InputError) as caught:
        LOADERS[text](_written(path, changed))
    return caught.value


def _written(path, text):
    path.write_text(text, encoding="utf-8")
    return path


def place_of(text, line, found):
    """Return line and column, from 1, of `found` within the line that holds `line`."""
    row, whole = next((i, whole) for i, whole in enumerate(text.splitlines(), 1) if line in whole)
    return row, whole.index(found, whole.index(line)) + 1


@pytest.mark.parametrize("bad", ["=cmd()", 'pwn"""\nopen("x")\n"""', "a" * 1000, "-x", "a/../b"])
@pytest.mark.parametrize(("text", "line", "old"), PLACES)
def test_a_bad_name_is_refused_where_it_stands(tmp_path, text, line, old, bad):
    name = old.partition(":")[0]
    row, column = place_of(text, line, old)
    lines = text.splitlines()
    lines[row - 1] = lines[row - 1][: column - 1] + json.dumps(bad) + lines[row - 1][column - 1 + len(name) :]
    error = refusal(tmp_path, text, "\n".join(lines))
    assert (error.position.line, error.position.column) == (row, column)
    assert "cannot be a name" in error.message
    assert len(error.message) < 300
    assert "\n" not in str(error)


def test_every_text_of_a_file_is_checked(tmp_path):
    for text in LOADERS:
        for word in ("title: ", "meaning: ", "source: "):
            if word not in text:
                continue
            start = text.index(word) + len(word)
            end = min(text.find(sign, start) for sign in ",}\n" if text.find(sign, start) > 0)
            row, column = text.count("\n", 0, start) + 1, start - text.rfind("\n", 0, start)
            for bad, why in (("a\u202eb", "U+202E"), ("x" * (MAX_TEXT + 1), "too long"), ("a\x07", "U+0007"), ("a\u2028b", "U+2028")):
                error = refusal(tmp_path, text, text[:start] + json.dumps(bad) + text[end:])
                assert why in error.message
                assert (error.position.line, error.position.column) == (row, column)


def test_a_heading_may_be_anything_on_one_line_and_names_its_channel_if_it_can(tmp_path):
    _written(tmp_path / "vehicle.yaml", VEHICLE)
    for heading, name in (
        ("a_z", "a_z"),
        ("Acceleration z (m/s^2)", "L1_acceleration"),
        ("=1+2", "L1_acceleration"),
        ("", "L1_acceleration"),
    ):
        run = load_run(_written(tmp_path / "file.yaml", RUN.replace("acceleration: az", f"acceleration: {json.dumps(heading)}")))
        assert run.outputs()[0].name == name
        assert run.file.sensors["L1"].column("L1", "acceleration") == (heading or "L1_acceleration")
    for old in ("acceleration: az", "column: v"):
        row, column = place_of(RUN, old, old.partition(": ")[2])
        for bad in ("a\nb", "x" * 201, "a\tb"):
            error = refusal(tmp_path, RUN, RUN.replace(old, f"{old.partition(':')[0]}: {json.dumps(bad)}"))
            assert "cannot head a column" in error.message
            assert error.position.line == row
            assert error.position.column in (column, column - len("{column: "))


def test_no_channel_takes_the_name_of_the_time(tmp_path):
    error = refusal(tmp_path, RUN, RUN.replace("outputs: {load", "outputs: {t"))
    assert "cannot be named 't'" in error.message
    assert (error.position.line, error.position.column) == place_of(RUN, "outputs: {load", "load")


def test_a_vehicle_without_a_name_takes_that_of_its_file(tmp_path):
    path = _written(tmp_path / "my rig (2).yaml", VEHICLE.removeprefix("name: rig\n"))
    assert load_vehicle(path).name == "my_rig__2_"


def test_an_error_about_a_long_name_is_short():
    with pytest.raises(InputError) as caught:
        parse_vehicle(VEHICLE.replace("body: frame", f"body: {'z' * 10_000}"))
    assert len(str(caught.value)) < 300
