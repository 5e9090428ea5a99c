"""Each fault of a run file at its place.

`@` marks where an error must point; it is taken out before the file is read.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.simulate.run_files import GOOD, RIG, SHORT, load, write
from vehgen.errors import InputError
from vehgen.simulate.run_file import load_run
from vehgen.simulate.run_file.checks import MAX_STEPS

CASES = [
    (
        "no vehicle",
        "vehicle: rig.yaml",
        "vehicle: @trcktor5",
        "no file {folder}/trcktor5, and no bundled model 'trcktor5'; did you mean 'tractor5'",
    ),
    ("vehicle of a folder", "vehicle: rig.yaml", "vehicle: @.", "{folder} is a folder; a YAML file was expected"),
    ("vehicle of a number", "vehicle: rig.yaml", "vehicle: @5", "input should be a valid string (found '5')"),
    ("vehicle of entries", "vehicle: rig.yaml", "vehicle: @{file: rig.yaml}", "expected a single text, found `key: value` entries"),
    ("vehicle of a list", "vehicle: rig.yaml", "vehicle: @[rig.yaml]", "expected a single text, found a list"),
    ("unknown key", "title: a test", "@titel: a test", "unknown key 'titel'; did you mean 'title'?"),
    ("unknown set", "set: soft", "set: @sft", "rig has no parameter set 'sft'; did you mean 'soft'?"),
    ("unknown parameter", "{kF: 1.2 MN/m}", "{@kFF: 1.2 MN/m}", "rig has no parameter with a value 'kFF'; did you mean 'kF'?"),
    ("parameter that follows", "{kF: 1.2 MN/m}", "{@b2: 1 m}", "rig has no parameter with a value 'b2'; known: b1, kF, mB"),
    ("wrong unit of a parameter", "{kF: 1.2 MN/m}", "{kF: @1.2 MN}", "kF must be in N/m, found N"),
    ("no unit of a parameter", "{kF: 1.2 MN/m}", "{kF: @1.2}", "missing unit: kF must be in N/m, found no unit"),
    ("symbol in a parameter", "{kF: 1.2 MN/m}", "{kF: @2*kF}", "expected a plain quantity in N/m, found a symbol in '2*kF'"),
    ("parameter by zero", "{kF: 1.2 MN/m}", "{kF: @1 N/m/0}", "'1 N/m/0' has no value: float division by zero"),
    ("unit of a parameter", "{kF: 1.2 MN/m}", "{kF: 1.2 @MNm}", "'MNm' after 1.2 is not a unit; did you mean 'MN m'"),
    (
        "negative parameter",
        "parameters: {kF: 1.2",
        "@parameters: {kF: -1.2",
        "negative k: axles.front.suspension.k is -1.2e+06 in this run; it must not be below 0 ({folder}/rig.yaml:9:60)",
    ),
    (
        "vanishing parameter",
        "parameters: {kF: 1.2 MN/m}",
        "@parameters: {mB: 0}",
        "a degree of freedom without inertia: body 'frame' heaves with no mass in this run ({folder}/rig.yaml:7:17)",
    ),
    ("no speed", "speed: 7.2 km/h\n", "", None),
    (
        "harmonic too fast for the step",
        "harmonic: {amplitude: 2 kN, frequency: 5 Hz",
        "harmonic: {amplitude: 2 kN, frequency: @1000 Hz",
        "a cycle takes 0.5 steps of 0.002 s; at least 2 were expected: a lower frequency",
    ),
    (
        "key of another hump",
        "{shape: half_sine, length: 50 cm",
        "@{shape: half_sine, ramp: 0.2, length: 50 cm",
        "the key ramp belongs to a hump of the shape trapezoid, not to half_sine",
    ),
    (
        "key of a hump of points",
        "{shape: points,",
        "@{shape: points, height: 2 cm,",
        "the key height belongs to a hump of the shape half_sine or",
    ),
    (
        "random road twice",
        "  - iso8608: {class: B, seed: 1}\n",
        "  - iso8608: {class: B, seed: 1}\n  - @iso8608: {class: A, seed: 1}\n",
        "two random roads of one seed go up and down together, as one that is higher; another `seed` was expected",
    ),
    ("seed of a word", "seed: 1}", "seed: @true}", "input should be a valid integer (found 'True')"),
    (
        "force of a suspension that there is not",
        "load1: {axle: rear, quantity: tyre_load}",
        "load1: {axle: rear, quantity: @suspension_force}",
        "rear has no suspension of its own: it is fixed to 'frame'",
    ),
    (
        "sensor some way behind nothing",
        "L3: {body: frame}",
        "L3: @{body: frame, distance: 2 m}",
        "`distance` counts from what `behind` names, and nothing is named: from the COG the place is `x: -2 m`",
    ),
    (
        "force some way behind nothing",
        "shaker: {body: frame, x: 0.5 m,",
        "shaker: @{body: frame, distance: -0.5 m,",
        "`distance` counts from what `behind` names, and nothing is named: from the COG the place is `x: 0.5 m`",
    ),
    ("speed without a unit", "speed: 7.2 km/h", "speed: @7.2", "expected m/s, found no unit in 7.2; write e.g. '7.2 m/s'"),
    ("speed in kilograms", "speed: 7.2 km/h", "speed: @7.2 kg", "expected m/s, found kg in '7.2 kg'"),
    ("speed of nothing", "speed: 7.2 km/h", "speed: @0 m/s", "expected a finite number above 0, found 0"),
    ("speed backwards", "speed: 7.2 km/h", "speed: @-2 m/s", "expected a finite number above 0, found -2"),
    ("speed of a symbol", "speed: 7.2 km/h", "speed: @v1", "expected a plain quantity in m/s, found a symbol in 'v1'"),
    ("speed by zero", "speed: 7.2 km/h", "speed: @1 m/s/0", "'1 m/s/0' has no value"),
    ("speed without end", "speed: 7.2 km/h", "speed: @1e999 m/s", "1e999 is too large a number"),
    ("speed of a call", "speed: 7.2 km/h", "speed: @open(1)", "only sqrt, abs, sign, min, max may be called"),
    ("speed of a list", "speed: 7.2 km/h", "speed: @[1]", "expected a number in m/s"),
    ("speed file's key", "speed: 7.2 km/h", "speed: {@fil: a.csv}", "unknown key 'fil'; did you mean 'file'?"),
    ("speed file's name", "speed: 7.2 km/h", "@speed: {time: t}", "speed lacks the key 'file'"),
    ("duration", "duration: 10 s", "duration: @10 m", "expected s, found m in '10 m'"),
    ("duration of nothing", "duration: 10 s", "duration: @0 s", "expected a finite number above 0"),
    (
        "duration of years",
        "duration: 10 s",
        "duration: @1e9 s",
        "a duration is 0.001 to 100000 s in magnitude, found 1e+09 s: a question of units?",
    ),
    (
        "duration of a day",
        "duration: 10 s",
        "duration: @24 h",
        f"a run has at most {MAX_STEPS} steps; 86400 s in steps of 0.002 s are more",
    ),
    ("step", "step: 2 ms", "step: @-1 ms", "expected a finite number above 0"),
    ("sample between steps", "sample: 10 ms", "sample: @9 ms", "`sample` must be a whole number of steps of 0.002 s, found 0.009 s"),
    ("sample below a step", "sample: 10 ms", "sample: @0.5 ms", "`sample` must be a whole number of steps of 0.002 s, found 0.0005 s"),
    ("footprint", "footprint: 0.24 m", "footprint: @0.24", "expected m, found no unit in 0.24; write e.g. '0.24 m'"),
    ("footprint of nothing", "footprint: 0.24 m", "footprint: @0 m", "expected a finite number above 0"),
    (
        "road of no list",
        GOOD[GOOD.index("  - hump") : GOOD.index("footprint")],
        "  @hump: {}\n",
        "expected a list: [first, second], or lines that begin with `- `",
    ),
    (
        "hump's shape",
        "shape: half_sine",
        "shape: @half_sin",
        "input should be 'half_sine', 'versine', 'trapezoid', 'rectangle' or 'points', found 'half_sin'",
    ),
    ("hump's key", "height: 30 mm", "@heigth: 30 mm", "unknown key 'heigth'; did you mean 'height'"),
    (
        "hump without a length",
        "hump: {shape: half_sine, length: 50 cm,",
        "hump: @{shape: half_sine,",
        "a half_sine hump lacks the key length",
    ),
    (
        "hump without a height",
        "hump: {shape: half_sine, length: 50 cm, height: 30 mm,",
        "hump: @{shape: half_sine, length: 50 cm,",
        "a half_sine hump lacks the key height",
    ),
    (
        "hump without a radius",
        "hump: {shape: rectangle, length: 1 m, height: 20 mm, at: 14 m, radius: 10 mm}",
        "hump: @{shape: rectangle, length: 1 m, height: 20 mm, at: 14 m}",
        "a rectangle hump lacks the key radius",
    ),
    ("hump without a file", "hump: {shape: points, file: hump.csv,", "hump: @{shape: points,", "a points hump lacks the key file"),
    (
        "hump without a place",
        "hump: {shape: half_sine, length: 50 cm, height: 30 mm, at: 6 m}",
        "@hump: {shape: half_sine, length: 50 cm, height: 30 mm}",
        "road.0.hump lacks the key 'at'",
    ),
    ("hump's length", "length: 50 cm", "length: @0 m", "expected a finite number above 0"),
    ("hump's height in kilograms", "height: 30 mm", "height: @30 kg", "expected m, found kg in '30 kg'"),
    ("hump's ramp", "ramp: 0.3", "ramp: @0.7", "input should be less than or equal to 0.5 (found '0.7')"),
    ("two in one entry", "  - iso8608", "    iso8608", None),
    ("none in an entry", "  - iso8608: {class: B, seed: 1}", "  - @{}", "a road entry is one of hump, iso8608, profile"),
    ("road class", "class: B", "class: @J", "input should be 'A', 'B', 'C', 'D', 'E', 'F', 'G' or 'H', found 'J'"),
    ("road class's key", "class: B", "@clas: B", "unknown key 'clas'; did you mean 'class'?"),
    ("no road class", "iso8608: {class: B, seed: 1}", "@iso8608: {seed: 1}", "road.4.iso8608 lacks the key 'class'"),
    ("seed", "seed: 1", "seed: @one", "input should be a valid integer"),
    ("sensor on no body", "L1: {body: frame", "L1: {body: @frmae", "rig has no body 'frmae'; did you mean 'frame'?"),
    (
        "sensor behind nothing",
        "behind: front, distance: -0.29",
        "behind: @fornt, distance: -0.29",
        "rig has no axle, hinge or body 'fornt'; did you mean 'front'",
    ),
    (
        "sensor in two places",
        "L1: {body: frame, behind",
        "L1: @{body: frame, x: 1 m, behind",
        "a place has `x`, or `behind` with `distance`, not both",
    ),
    (
        "sensor's quantity",
        "{acceleration: L1_az",
        "{@accelaration: L1_az",
        "unknown quantity 'accelaration' of a sensor; did you mean 'acceleration'",
    ),
    ("sensor's x", "x: b1 - 1 m", "x: b1 - @b3", "unknown symbol 'b3'; known: b1, b2, kF, mB"),
    ("sensor's x in kilograms", "x: b1 - 1 m", "x: @mB", "x must be in m, found kg"),
    ("sensor's x without a unit", "x: b1 - 1 m", "x: @2", "missing unit: x must be in m, found no unit"),
    ("sensor's x by zero", "x: b1 - 1 m", "x: @1 m/(b1/b1 - 1)", "'1 m/(b1/b1 - 1)' has no value"),
    ("channel's key", "{column: v2", "{@colum: v2", "unknown key 'colum'; did you mean 'column'?"),
    ("channel's sign", "sign: -1", "sign: @-2", "input should be 1 or -1, found -2"),
    ("channel of a number", "acceleration: L1_az", "acceleration: @5", "input should be a valid string (found '5')"),
    ("channels of one name", "pitch_rate: L1_q", "pitch_rate: v2", None),
    ("sensor and output of one name", "travel1: {", "L1_az: {", None),
    ("output of no axle", "{axle: front, quantity", "{axle: @frnt, quantity", "rig has no axle 'frnt'; did you mean 'front'?"),
    ("output of no link", "{link: post, quantity", "{link: @pots, quantity", "rig has no link 'pots'; did you mean 'post'?"),
    (
        "output of both",
        "travel1: {axle: front,",
        "travel1: @{axle: front, link: post,",
        "an output belongs to an `axle`, a `link` or a `hinge`",
    ),
    ("output of neither", "travel1: {axle: front,", "travel1: @{", "an output belongs to an `axle`, a `link` or a `hinge`"),
    (
        "output's quantity",
        "quantity: suspension_travel",
        "quantity: @suspension_travl",
        "unknown quantity 'suspension_travl' of an axle; did you mean 'suspension_travel'",
    ),
    (
        "axle's quantity of a link",
        "quantity: link_force",
        "quantity: @tyre_force",
        "unknown quantity 'tyre_force' of a link; did you mean 'link_force'?",
    ),
    ("displacement of no link", "  post: {harmonic", "  @pst: {harmonic", "rig has no link to the ground 'pst'; did you mean 'post'?"),
    ("displacement in newtons", "amplitude: 5 mm", "amplitude: @5 N", "expected m, found N in '5 N'"),
    (
        "displacement of nothing",
        "post: {harmonic: {amplitude: 5 mm, frequency: 3 Hz}}",
        "post: @{}",
        "either `harmonic` or `file` was expected",
    ),
    ("force in metres", "amplitude: 2 kN", "amplitude: @2 mm", "expected N, found m in '2 mm'"),
    ("force of no frequency", "frequency: 5 Hz", "frequency: @0 Hz", "expected a finite number above 0"),
    (
        "noise that is a word",
        "unit: mm/s, sign: -1",
        "unit: mm/s, noise: @banana",
        "expected a plain quantity in m/s, found a symbol in 'banana'",
    ),
    ("noise of a length", "unit: mm/s, sign: -1", "unit: mm/s, noise: @1 mm", "expected m/s, found m in '1 mm'"),
    ("no noise", "unit: mm/s, sign: -1", "unit: mm/s, noise: @0 mm/s", "a noise above 0 was expected, found '0 mm/s'"),
    ("phase in degrees, as it seems", "phase: 90 deg", "phase: @90", "a phase in rad is at most 6.3 in magnitude, found 90"),
    ("force's phase", "phase: 90 deg", "phase: @90 s", "expected no unit, found s in '90 s'"),
    (
        "force of two kinds",
        "ram: {body: frame,",
        "ram: @{harmonic: {amplitude: 1 N, frequency: 1 Hz}, body: frame,",
        "either `harmonic` or `file` was expected",
    ),
    ("force on no body", "ram: {body: frame", "ram: {body: @rear", "rig has no body 'rear'; known: frame"),
    ("duplicate", "duration: 10 s", "duration: 10 s\n@speed: 1 m/s", "duplicate name 'speed'"),
]

# messages whose place is not in the text that changes
ELSEWHERE = {
    "no speed": ("1:1", "the file lacks the key 'speed'"),
    "two in one entry": ("13:5", "a road entry is one of hump, iso8608, profile"),
    "channels of one name": ("24:56", "two channels are named 'v2'; each column needs a name of its own"),
    "sensor and output of one name": ("27:3", "two channels are named 'L1_az'"),
}


def test_the_good_run_is_good(tmp_path: Path):
    assert load(tmp_path, GOOD).vehicle.name == "rig"


@pytest.mark.parametrize(("old", "new", "message"), [case[1:] for case in CASES], ids=[case[0] for case in CASES])
def test_fault(old: str, new: str, message: str | None, tmp_path: Path, request: pytest.FixtureRequest):
    assert old in GOOD
    text = GOOD.replace(old, new, 1)
    if message is None:
        place, message = ELSEWHERE[request.node.callspec.id]
        text = text.replace("@", "")
    else:
        before, _, after = text.partition("@")
        place = f"{before.count(chr(10)) + 1}:{len(before) - before.rfind(chr(10))}"
        text = before + after
    path = write(tmp_path, text)
    with pytest.raises(InputError) as caught:
        load_run(path)
    assert str(caught.value).startswith(f"{path}:{place}: {message.replace('{folder}', str(tmp_path))}")
    assert "\n" not in str(caught.value)


def test_each_case_has_its_own_name():
    assert len({case[0] for case in CASES}) == len(CASES)
    assert {case[0] for case in CASES if case[3] is None} == set(ELSEWHERE)


def test_a_fault_of_the_vehicle_names_the_vehicles_file(tmp_path: Path):
    path = write(tmp_path, SHORT)
    (tmp_path / "rig.yaml").write_text(RIG.replace("value: 900 kg", "value: 900 kgs"))
    with pytest.raises(InputError, match=r"rig\.yaml:2:19: 'kgs' after 900 is not a unit; did you mean 'kg'\?"):
        load_run(path)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", r"run\.yaml:1:1: the file is empty$"),
        ("- a\n", r"run\.yaml:1:1: a file of `key: value` lines was expected$"),
        ("vehicle: run.yaml\nspeed: 1 m/s\n", r"run\.yaml:1:1: unknown key 'vehicle'"),
        ("vehicle: [\n", r"run\.yaml:1:10: not valid YAML"),
    ],
)
def test_what_is_no_run_file(text: str, message: str, tmp_path: Path):
    with pytest.raises(InputError, match=message):
        load(tmp_path, text)


def test_no_run_file_at_all(tmp_path: Path):
    with pytest.raises(InputError, match=r"^no file .*absent\.yaml$"):
        load_run(tmp_path / "absent.yaml")


@settings(max_examples=150, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.lists(
        st.tuples(
            st.sampled_from(["delete", "insert", "replace"]),
            st.floats(0, 0.999),
            st.integers(1, 10),
            st.sampled_from(
                [
                    "",
                    " ",
                    "\n",
                    ":",
                    "{",
                    "}",
                    "[",
                    "]",
                    "-",
                    "0",
                    "1/0",
                    "null",
                    "true",
                    "x",
                    " kg",
                    "front",
                    "1e999",
                    "'",
                    "&a",
                    "*a",
                    "!b ",
                ]
            ),
        ),
        min_size=1,
        max_size=3,
    )
)
def test_mutilated_runs_are_read_or_refused(tmp_path: Path, changes: list[tuple[str, float, int, str]]):
    text = GOOD
    for kind, where, size, piece in changes:
        place = int(where * len(text))
        end = place + (0 if kind == "insert" else size)
        text = text[:place] + ("" if kind == "delete" else piece) + text[end:]
    refusal: InputError | None = None
    path = write(tmp_path, text)
    try:
        load_run(path)
    except InputError as error:
        refusal = error
    if refusal is not None:
        assert refusal.position is not None
        assert refusal.position.file == path
        assert "\n" not in str(refusal)
