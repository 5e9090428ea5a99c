"""Laden vehicles against published numbers, hand-written matrices, levers, and limits."""

import json
import math

import numpy as np
import pytest
import scipy.linalg

from vehgen.cargo import compare_laden, laden_text, load_cargo
from vehgen.errors import InputError
from vehgen.mechanics import derive, static_loads
from vehgen.simulate import natural_modes
from vehgen.vehicle import load_vehicle

MODULE = """\
on: semitrailer
behind: fifth_wheel
module: {mass: 5771 kg, stiffness: 8931 kN/m, damping: 9.1 kN s/m, cog: {behind_front: 4.35 m, above_floor: 0.98 m}, front: 1 m}
"""


def put(tmp_path, vehicle, text, name="laden"):
    """Put a cargo (YAML text) on a vehicle; returns the laden vehicle as read back from its file."""
    (tmp_path / "cargo.yaml").write_text(text, encoding="utf-8")
    path = tmp_path / f"{name}.yaml"
    path.write_text(laden_text(load_vehicle(vehicle), load_cargo(tmp_path / "cargo.yaml"), tmp_path, name), encoding="utf-8")
    return load_vehicle(path)


def hertz(vehicle):
    return np.array([mode.undamped_hz for mode in natural_modes(derive(vehicle))])


def test_module_on_the_papers_truck(tmp_path):
    """The nine frequencies that two independent derivations gave (energies; Newton-Euler with explicit hinge forces)."""
    laden = put(tmp_path, "tractor5", MODULE)
    found = [1.243297106, 2.627365595, 3.055570469, 6.787363978, 11.99764722, 13.05938722, 16.65229406, 17.03396126, 19.5549086]
    assert hertz(laden) == pytest.approx(found, rel=2e-9)
    assert hertz(laden) == pytest.approx(hertz(load_vehicle("tractor5_module")), rel=1e-12)


def test_frequency_and_damping_ratio_say_the_same_as_stiffness_and_damping(tmp_path):
    k, m, c = 8931e3, 5771.0, 9.1e3
    f0, zeta = math.sqrt(k / m) / (2 * math.pi), c / (2 * math.sqrt(k * m))
    other = MODULE.replace("stiffness: 8931 kN/m, damping: 9.1 kN s/m", f"frequency: {f0!r} Hz, damping_ratio: {zeta!r}")
    first, second = (put(tmp_path, "tractor5", text) for text in (MODULE, other))
    for matrix in ("K", "C", "M"):
        np.testing.assert_allclose(
            getattr(derive(first).numeric(None), matrix), getattr(derive(second).numeric(None), matrix), rtol=1e-13, atol=1e-6
        )
    assert f0 == pytest.approx(6.261, abs=5e-4)
    assert zeta == pytest.approx(0.0200, abs=5e-5)


def test_a_rigid_cargo_is_the_merged_semitrailer(tmp_path):
    """Wu & Li's Eq. 24 with the parallel axes it lacks, in matrices written by hand for eight degrees of freedom."""
    laden = put(
        tmp_path,
        "tractor5",
        "on: semitrailer\nbehind: fifth_wheel\nrigid: {mass: 10 t, length: 8 m, height: 1.4 m, front: 1.5 m, base: 0.3 m}\n",
    )
    v = load_vehicle("tractor5").all_values(load_vehicle("tractor5").values())
    m, length, height, b8, e = 10e3, 8.0, 1.4, 1.5, 0.3 + 0.7
    mS = v["mS"] + m
    gap = (b8 + length / 2 - v["b6"]) ** 2 + (e + v["a2"]) ** 2
    IS = v["IS"] + m * (length**2 + height**2) / 12 + v["mS"] * m / mS * gap
    b6 = ((b8 + length / 2) * m + v["b6"] * v["mS"]) / mS
    a2 = (v["a2"] * v["mS"] - e * m) / mS
    mT, a1, b7 = v["mT"], v["a1"], v["b7"]
    mu = mT * mS / (mT + mS)
    M = np.diag([0.0, 0, 0, *(v[f"m{i}"] for i in range(1, 6))])
    M[:3, :3] = [
        [mT + mS, b7 * mS, b6 * mS],
        [b7 * mS, v["IT"] + b7**2 * mS + mu * a1**2, b6 * b7 * mS - mu * a1 * a2],
        [b6 * mS, b6 * b7 * mS - mu * a1 * a2, IS + b6**2 * mS + mu * a2**2],
    ]
    rows = [[1, -v["b1"], 0], [1, v["b2"], 0], [1, v["b3"], 0], [1, b7, v["Lh4"]], [1, b7, v["Lh5"]]]
    K = np.zeros((8, 8))
    for i, row in enumerate(rows):
        travel = np.zeros(8)
        travel[:3], travel[3 + i] = row, -1
        K += v[f"k{i + 1}"] * np.outer(travel, travel)
        K[3 + i, 3 + i] += v[f"kt{i + 1}"]
    exact = np.sqrt(scipy.linalg.eigh(K, M, eigvals_only=True)) / (2 * np.pi)
    assert hertz(laden) == pytest.approx(exact, rel=1e-10)


@pytest.mark.parametrize(("vehicle", "on", "behind"), [("tractor5", "semitrailer", "fifth_wheel"), ("sedan2", "body", "front")])
def test_a_stiff_module_is_a_rigid_cargo(tmp_path, vehicle, on, behind):
    place = f"on: {on}\nbehind: {behind}\n"
    rigid = put(
        tmp_path, vehicle, place + "rigid: {mass: 900 kg, length: 2 m, height: 1 m, front: 0.4 m, base: 0.2 m, pitch_inertia: 300 kg m^2}\n"
    )
    module = "mass: 900 kg, stiffness: %s, damping: 0, cog: {behind_front: 1 m, above_floor: 0.5 m}, front: 0.4 m, base: 0.2 m"
    soft = f"module: {{{module}, pitch_inertia: 300 kg m^2}}\n"
    errors = []
    for stiffness in ("1e8 N/m", "1e9 N/m", "1e10 N/m"):
        module = put(tmp_path, vehicle, place + soft % stiffness)
        errors.append(np.abs(hertz(module)[:-1] / hertz(rigid) - 1).max())
    assert errors[2] < 1e-5
    assert errors[0] / errors[1] == pytest.approx(10, rel=0.2)
    assert errors[1] / errors[2] == pytest.approx(10, rel=0.2)


def test_levers_of_a_sedan(tmp_path):
    """A mass midway between the axles loads both alike; behind an axle it counts from there."""
    vehicle = load_vehicle("sedan2")
    laden = put(
        tmp_path, "sedan2", "on: body\nbehind: front\nrigid: {mass: 400 kg, length: 1 m, height: 1 m, front: 0.9 m, base: -0.5 m}\n"
    )
    values = vehicle.all_values(vehicle.values())
    x = {name: axle.x.evaluate(values) for name, axle in vehicle.axles.items()}
    share = 1.4 / (x["front"] - x["rear"])
    found = compare_laden(vehicle, laden, "body")
    change = {name: after - before for name, (before, after) in found.axles.items()}
    assert change["rear"] == pytest.approx(400 * 9.81 * share)
    assert change["front"] == pytest.approx(400 * 9.81 * (1 - share))
    before, after = found.carrier
    forward, up = found.cog_shift
    assert (before.x, before.z) == (0.0, 0.0)
    assert forward == pytest.approx(400 * (x["front"] - 1.4) / (before.mass + 400))
    assert up == pytest.approx(0.0)
    assert after.mass == before.mass + 400
    higher = put(
        tmp_path, "sedan2", "on: body\nbehind: front\nrigid: {mass: 400 kg, length: 1 m, height: 1 m, front: 0.9 m, base: 0.3 m}\n", "high"
    )
    assert compare_laden(vehicle, higher, "body").cog_shift == pytest.approx((forward, 400 * 0.8 / (before.mass + 400)))


@pytest.mark.parametrize(
    ("vehicle", "on", "behind"),
    [
        ("b_double", None, None),
        ("truck_dolly_trailer", None, None),
        ("quarter_car", "body", "body"),
        ("tractor5_cargo", "semitrailer", "axle4"),
    ],
)
def test_every_vehicle_can_be_laden(tmp_path, vehicle, on, behind):
    unladen = load_vehicle(vehicle)
    if on is None:
        behind, hinge = list(unladen.hinges.items())[-1]
        on = list(hinge.points)[-1]
    text = f"on: {on}\nbehind: {behind}\nrigid: {{mass: 2 t, length: 3 m, height: 1 m, front: 0.5 m}}\n"
    laden = put(tmp_path, vehicle, text)
    light, heavy = (sum(static_loads(derive(item)).axles.values()) for item in (unladen, laden))
    assert heavy - light == pytest.approx(2000 * 9.81, rel=1e-9)


def test_cargo_beside_cargo(tmp_path):
    first = put(tmp_path, "tractor5", MODULE, "once")
    second = put(tmp_path, tmp_path / "once.yaml", MODULE, "twice")
    assert set(second.bodies) - set(first.bodies) == {"module2"}
    assert set(second.links) == {"module_mount", "module2_mount"}
    assert len(hertz(second)) == len(hertz(first)) + 1


def test_sets_and_ranges_stay(tmp_path):
    laden, unladen = put(tmp_path, "tractor5", MODULE), load_vehicle("tractor5")
    assert laden.ranges() == unladen.ranges()
    found = compare_laden(unladen, laden, "semitrailer", "SHCM-1")
    assert [light for _, light, _ in found.modes if light is not None] != [mode.undamped_hz for mode in natural_modes(derive(unladen))]


def test_the_modules_own_mode_has_no_partner(tmp_path):
    found = compare_laden(load_vehicle("tractor5"), put(tmp_path, "tractor5", MODULE), "semitrailer")
    assert [name for name, light, _ in found.modes if light is None] == ["module heave"]
    assert len(found.modes) == 9


def test_a_fixed_part_weighs_and_does_not_move(tmp_path):
    whole = put(tmp_path, "tractor5", MODULE)
    split = put(tmp_path, "tractor5", MODULE.replace("mass: 5771 kg,", "mass: 3000 kg, fixed_mass: 2771 kg,"))
    assert static_loads(derive(split)).axles == pytest.approx(static_loads(derive(whole)).axles, rel=1e-12)
    assert split.bodies["module_fixed"].motions == ()
    assert len(hertz(split)) == 9


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (MODULE.replace("on: semitrailer", "on: semitrailr"), "1:5: tractor5 has no body 'semitrailr'; did you mean 'semitrailer'"),
        (
            MODULE.replace("fifth_wheel", "fith_wheel"),
            "2:9: 'fith_wheel' is no hinge or axle of 'semitrailer', nor 'semitrailer' itself; did you mean",
        ),
        (
            MODULE.replace("fifth_wheel", "axle1"),
            "2:9: 'axle1' is no hinge or axle of 'semitrailer', nor 'semitrailer' itself; it is on another body",
        ),
        ("name: axle5\n" + MODULE, "1:7: tractor5 has a part named 'axle5' already; choose another name for the cargo"),
    ],
)
def test_a_cargo_that_does_not_fit_the_vehicle(tmp_path, text, message):
    with pytest.raises(InputError, match=r"cargo\.yaml:") as caught:
        put(tmp_path, "tractor5", text)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("on: a\nbehind: b\n", "1:1: a cargo is either `rigid` or a `module`"),
        ("on: a\nbehind: b\nrigid: {mas: 1 kg}\n", "3:9: unknown key 'mas'; did you mean 'mass'"),
        (
            "on: a\nbehind: b\nrigid: {mass: 5, length: 1 m, height: 1 m, front: 0 m}\n",
            "3:15: expected kg, found no unit in 5; write e.g. '5 kg'",
        ),
        ("on: a\nbehind: b\nrigid: {mass: 5 m, length: 1 m, height: 1 m, front: 0 m}\n", "3:15: expected kg, found m in '5 m'"),
        (
            "on: a\nbehind: b\nrigid: {mass: -5 kg, length: 1 m, height: 1 m, front: 0 m}\n",
            "3:15: expected a finite number above 0, found -5.0",
        ),
        (MODULE.replace("stiffness: 8931 kN/m, ", ""), "3:9: a module has either `stiffness` or `frequency`"),
        (MODULE.replace("damping:", "damping_ratio: 0.02, damping:"), "3:9: a module has either `damping` or `damping_ratio`"),
        ("name: 2x\n" + MODULE, "1:7: '2x' cannot be a name"),
        ("[]", "1:1: a file of `key: value` lines was expected"),
    ],
)
def test_a_bad_cargo_file(tmp_path, text, message):
    (tmp_path / "bad.yaml").write_text(text)
    with pytest.raises(InputError) as caught:
        load_cargo(tmp_path / "bad.yaml")
    assert f"bad.yaml:{message}" in str(caught.value)


def test_texts_and_names_of_a_cargo_are_written_so_that_they_read_back(tmp_path):
    """A body may be called as a word that YAML reads as nothing, and a title may hold any sign."""
    odd = """'"\\ {}: # - </script> ${x} \U0001f69a"""
    (tmp_path / "base.yaml").write_text(
        "bodies:\n  null: {mass: 900 kg, pitch_inertia: 500 kg m^2}\n"
        "axles:\n  front: {body: 'null', x: 1 m, tyre: {k: 100 kN/m}}\n  rear: {body: 'null', x: -1 m, tyre: {k: 100 kN/m}}\n"
    )
    cargo = json.dumps({"name": "true", "title": odd, "source": odd, "on": "null", "behind": "null"}, ensure_ascii=False)[1:-1]
    module = "mass: 1 t, fixed_mass: 9 kg, stiffness: 9 kN/m, damping: 9 N s/m, cog: {behind_front: 0 m, above_floor: 0 m}, front: 0 m"
    loads = (
        "rigid: {mass: 1 t, length: 1 m, height: 1 m, front: 0 m}",
        f"module: {{{module}}}",
    )
    for load in loads:
        laden = put(tmp_path, tmp_path / "base.yaml", "{" + f"{cargo}, {load}" + "}", "on")
        assert laden.name == "on"
        assert laden.title == f"base, laden: {odd}"
        assert laden.source == odd
        assert laden.bodies["true"].title == odd
        assert laden.bodies["true"].carried_by.body == "null"
    with pytest.raises(InputError, match="choose a shorter name"):
        put(tmp_path, tmp_path / "base.yaml", f"{{{cargo.replace('true', 'x' * 64)}, {loads[1]}}}")
