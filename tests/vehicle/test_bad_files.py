"""Every bad file: one error at the right place that says what would be right."""

import contextlib
import pathlib
import random

import pytest

from vehgen.errors import InputError
from vehgen.vehicle import bundled_models, load_vehicle, parse_vehicle

GOOD = """\
name: small
parameters:
  mB: {value: 8000 kg, meaning: body mass}
  b1: {value: 1.32 m, range: [0.8 m, 2.2 m]}
  b2: {equals: 3.46 m - b1}
bodies:
  frame: {mass: mB, pitch_inertia: 9000 kg m^2}
  trailer: {mass: 5 t, pitch_inertia: 9000 kg m^2}
  cab: {mass: 800 kg, pitch_inertia: 500 kg m^2, carried_by: {body: frame, x: 1 m, z: 1 m}}
hinges:
  pin: {frame: {x: -2 m, z: 0}, trailer: {x: 3 m, z: 0}}
axles:
  front: {body: frame, x: b1, mass: 600 kg, suspension: {k: 200 kN/m, c: 5 kN s/m}, tyre: {k: 1 MN/m}}
  rear: {body: frame, x: -b2, tyre: {k: 1 MN/m}}
  last: {body: trailer, x: -2 m, tyre: {k: 1 MN/m}}
links:
  mount: {frame: {x: 1 m}, cab: {x: 0 m}, k: 100 kN/m, c: 1 kN s/m}
sets:
  soft: {b1: 1 m}
"""


def test_the_good_file_is_good():
    vehicle = parse_vehicle(GOOD)
    assert vehicle.values("soft")["b1"] == 1.0
    assert vehicle.all_values(vehicle.values())["b2"] == pytest.approx(2.14)


CASES = {
    "unknown key": ("frame: {mass: mB,", "frame: {mas: mB,", "7:11", "unknown key 'mas'; did you mean 'mass'"),
    "unknown top key": ("hinges:", "hinge:", "10:1", "unknown key 'hinge'; did you mean 'hinges'"),
    "misspelt symbol": ("mass: mB", "mass: mb1", "7:17", "unknown symbol 'mb1'"),
    "symbol in equals": ("3.46 m - b1}", "3.46 m - b9}", "5:25", "unknown symbol 'b9'"),
    "missing unit": ("value: 8000 kg", "value: 8000", "7:17", "missing unit"),
    "missing unit in a place": ("mass: 5 t", "mass: 5", "8:19", "write e.g. '5 kg'"),
    "wrong unit": ("mass: mB", "mass: b1", "7:17", "must be in kg, found m"),
    "sum of units": ("3.46 m - b1}", "3.46 kg - b1}", "5:16", "cannot subtract kg and m"),
    "unknown unit": ("value: 8000 kg", "value: 8000 kgs", "3:20", "'kgs' after 8000 is not a unit; did you mean 'kg'"),
    "axle on no body": ("front: {body: frame", "front: {body: frmae", "13:17", "no body 'frmae'; did you mean 'frame'"),
    "hinge to no body": ("trailer: {x: 3 m, z: 0}}", "trialer: {x: 3 m, z: 0}}", "11:33", "no body 'trialer'; did you mean 'trailer'"),
    "three ends": ("trailer: {x: 3 m, z: 0}}", "trailer: {x: 3 m}, cab: {x: 0}}", "11:8", "joins two bodies"),
    "no inertia": ("frame: {mass: mB, pitch_inertia: 9000 kg m^2}", "frame: {mass: mB}", "7:3", "degree of freedom without inertia"),
    "no hop mass": ("mass: 600 kg", "mass: 0 kg", "13:37", "degree of freedom without inertia"),
    "negative mass": ("mass: 5 t", "mass: -5 t", "8:19", "negative mass"),
    "negative stiffness": ("k: 200 kN/m", "k: -200 kN/m", "13:61", "negative k"),
    "duplicate name": ("  trailer: {mass", "  frame: {mass", "8:3", "duplicate name 'frame'"),
    "name used twice": ("  mount:", "  front:", "17:3", "duplicate name 'front'"),
    "circular equals": ("3.46 m - b1}", "3.46 m - b2}", "5:16", "circular `equals`: b2 -> b2"),
    "range": ("[0.8 m, 2.2 m]", "[1.8 m, 2.2 m]", "4:30", "outside its range"),
    "empty range": ("[0.8 m, 2.2 m]", "[2.2 m, 0.8 m]", "4:30", "is empty"),
    "call": ("3.46 m - b1}", "open(b1)}", "5:16", "may be called"),
    "attribute": ("3.46 m - b1}", "b1.real}", "5:18", "may stand in an expression"),
    "unit as a name": ("  mB:", "  kg:", "3:3", "is a unit"),
    "mass without suspension": ("suspension: {k: 200 kN/m, c: 5 kN s/m}, ", "", "13:10", "suspension is missing"),
    "missing tyre": ("rear: {body: frame, x: -b2, tyre: {k: 1 MN/m}}", "rear: {body: frame, x: -b2}", "14:3", "lacks the key 'tyre'"),
    "nobody carries": ("mass: 5 t,", "motions: [], mass: 5 t,", "8:3", "nothing carries it"),
    "motion": ("mass: 5 t,", "motions: [hop], mass: 5 t,", "8:23", "'heave' or 'pitch'"),
    "set of unknown": ("soft: {b1", "soft: {b2", "19:10", "'b2' is none"),
    "carried in a circle": ("body: frame, x: 1 m", "body: cab, x: 1 m", "9:62", "in a circle"),
    "value with symbols": ("value: 1.32 m", "value: mB * 1 m/kg", "4:15", "write `equals"),
    "both value and equals": ("equals: 3.46 m - b1", "equals: 3.46 m - b1, value: 2 m", "5:7", "either `value` or `equals`"),
    "bad name": ("  pin:", "  pin-1:", "11:3", "cannot be a name"),
    "yaml": ("name: small", "name: 'small", "", "not valid YAML"),
    "tag": ("name: small", "name: !!python/name:os.system small", "1:7", "tag"),
}


@pytest.mark.parametrize("case", CASES)
def test_bad_file(case):
    old, new, place, message = CASES[case]
    assert old in GOOD
    with pytest.raises(InputError) as caught:
        parse_vehicle(GOOD.replace(old, new, 1), "bad.yaml")
    text = str(caught.value)
    assert text.startswith(f"bad.yaml:{place}")
    assert message in text
    assert "\n" not in text


def test_loop_of_hinges():
    text = GOOD.replace("hinges:\n", "hinges:\n  second: {trailer: {x: 1 m}, frame: {x: 1 m}}\n")
    with pytest.raises(InputError, match=r"bad.yaml:12:3: a loop of hinges"):
        parse_vehicle(text, "bad.yaml")


def test_unconnected_body_needs_a_place():
    from vehgen.mechanics import derive

    text = GOOD.replace("hinges:\n  pin: {frame: {x: -2 m, z: 0}, trailer: {x: 3 m, z: 0}}\n", "")
    with pytest.raises(InputError, match=r":8:3: nothing connects body 'trailer'"):
        derive(parse_vehicle(text))
    derive(parse_vehicle(text.replace("trailer: {mass", "trailer: {at: -6 m, mass")))


def test_a_bomb_of_aliases():
    lines = ["a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]"] + [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]" for i in range(1, 10)]
    with pytest.raises(InputError, match="do aliases multiply"):
        parse_vehicle("\n".join(lines))


def test_an_alias_of_itself_and_deep_nesting():
    for text in ("name: &a [*a]", "[" * 5000, "a: " + "{b: " * 60 + "1" + "}" * 60):
        with pytest.raises(InputError, match=r"nested|deep|YAML"):
            parse_vehicle(text)


def test_large_and_strange_files(tmp_path):
    path = tmp_path / "large.yaml"
    path.write_bytes(b"#" * 10_000_000)
    with pytest.raises(InputError, match="10000000 bytes"):
        load_vehicle(path)
    path.write_bytes(b"name: \xff\xfe")
    with pytest.raises(InputError, match="UTF-8"):
        load_vehicle(path)
    path.write_text("")
    with pytest.raises(InputError, match="empty"):
        load_vehicle(path)
    with pytest.raises(InputError, match="folder"):
        load_vehicle(tmp_path)
    with pytest.raises(InputError, match="did you mean 'tractor5'"):
        load_vehicle("tracktor5.yaml")


def test_extends(tmp_path):
    (tmp_path / "base.yaml").write_text(GOOD)
    (tmp_path / "child.yaml").write_text(
        "extends: base.yaml\nname: child\nparameters:\n  b1: {equals: 0.4 * b3}\n  b3: {value: 3 m}\n  b2: {value: 2 m}\n"
        "sets: null\nlinks:\n  mount: {k: 7 N/m}\n"
    )
    child = load_vehicle(tmp_path / "child.yaml")
    assert child.name == "child"
    assert child.all_values(child.values())["b1"] == pytest.approx(1.2)
    assert child.parameters["b1"].range is None
    assert not child.sets
    assert child.links["mount"].k.evaluate({}) == 7
    assert child.links["mount"].c.evaluate({}) == 1000
    assert [path.name for path in child.files] == ["child.yaml", "base.yaml"]


def test_errors_in_a_base_name_the_base(tmp_path):
    (tmp_path / "base.yaml").write_text(GOOD.replace("mass: 5 t", "mass: 5"))
    (tmp_path / "child.yaml").write_text("extends: base.yaml\n")
    with pytest.raises(InputError, match=r"base.yaml:8:19: missing unit"):
        load_vehicle(tmp_path / "child.yaml")


def test_circular_extends(tmp_path):
    (tmp_path / "a.yaml").write_text("extends: b.yaml\n")
    (tmp_path / "b.yaml").write_text("extends: a.yaml\n")
    with pytest.raises(InputError, match=r"b.yaml:1:10: circular `extends`: a.yaml -> b.yaml -> a.yaml"):
        load_vehicle(tmp_path / "a.yaml")
    (tmp_path / "c.yaml").write_text("extends: absent.yaml\n")
    with pytest.raises(InputError, match=r"c.yaml:1:10: no file"):
        load_vehicle(tmp_path / "c.yaml")
    (tmp_path / "a.yaml").write_text("extends: tractor5\nhinges:\n  pintle: null\n")
    with pytest.raises(InputError, match=r"a.yaml:3:3: null removes 'pintle'"):
        load_vehicle(tmp_path / "a.yaml")


@pytest.mark.parametrize("name", sorted(bundled_models()))
def test_bundled_models_are_whole(name):
    vehicle = load_vehicle(name)
    assert vehicle.title
    assert vehicle.source
    assert all(parameter.meaning for parameter in vehicle.parameters.values())


@pytest.mark.parametrize("seed", range(60))
def test_mutilated_models_are_read_or_refused(seed):
    rng = random.Random(seed)
    text = list(
        rng.choice(
            [GOOD, pathlib.Path(bundled_models()["tractor5_module"]).read_text(), pathlib.Path(bundled_models()["b_double"]).read_text()]
        )
    )
    for _ in range(rng.randint(1, 6)):
        place = rng.randrange(len(text))
        choice = rng.random()
        if choice < 0.4:
            del text[place : place + rng.randint(1, 12)]
        elif choice < 0.8:
            text.insert(place, rng.choice(list("{}[]:,-*&!|>'\"#%@ \n\t0a.m")))
        else:
            text[place] = rng.choice(list("{}[]:,-0a."))
    with contextlib.suppress(InputError):
        parse_vehicle("".join(text))
