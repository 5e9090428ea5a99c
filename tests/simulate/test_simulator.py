"""Runs, populations, inputs of every kind, and what is warned of."""

import csv
import re

import numpy as np
import pytest

from tests.fit.recordings import sedan_truth, write_run
from vehgen.errors import InputError, ModelWarning
from vehgen.fit.trial import load_trials
from vehgen.mechanics import ElementOutput, Place, PointOutput, derive, static_loads
from vehgen.simulate import Simulator, lint, load_run, make_scenario, simulate, write_csv
from vehgen.vehicle import load_vehicle, parse_vehicle


def run_of(tmp_path, text):
    path = tmp_path / "run.yaml"
    path.write_text(text)
    return load_run(path)


QUIET = "vehicle: tractor5\nspeed: 2 m/s\nduration: 0.5 s\n"


def test_a_harmonic_force_gives_the_steady_state(tmp_path):
    text = (
        "vehicle: quarter_car\nspeed: 1 m/s\nduration: 60 s\nforces: {push: {body: body, harmonic: {amplitude: 2 kN, frequency: 5 Hz}}}\n"
    )
    text += "sensors: {s: {body: body, channels: {displacement: z}}}\n"
    response = simulate(run_of(tmp_path, text))
    numeric = derive(load_vehicle("quarter_car")).numeric()
    w = 2 * np.pi * 5
    expected = 2000 * np.linalg.inv(numeric.K + 1j * w * numeric.C - w**2 * numeric.M)[0, 0]
    late = response.time > 40
    fit = np.exp(-1j * w * response.time[late])
    found = 2j * np.mean(response.values[0, late, 0] * fit)
    assert abs(found) == pytest.approx(abs(expected), rel=2e-3)
    assert np.angle(found / expected) == pytest.approx(0, abs=5e-3)


def test_a_moving_ground_shakes_a_rig(tmp_path):
    vehicle = "bodies: {table: {mass: 100 kg, motions: [heave]}}\nlinks: {rig: {ground: {}, table: {}, k: 1 MN/m, c: 2 kN s/m}}\n"
    (tmp_path / "rig.yaml").write_text(vehicle)
    text = "vehicle: rig.yaml\nspeed: 1 m/s\nduration: 20 s\ndisplacements: {rig: {harmonic: {amplitude: 5 mm, frequency: 6 Hz}}}\n"
    text += "sensors: {s: {body: table, channels: {displacement: z}}}\noutputs: {f: {link: rig, quantity: link_force}}\n"
    response = simulate(run_of(tmp_path, text))
    w = 2 * np.pi * 6
    gain = (1e6 + 2e3j * w) / (1e6 + 2e3j * w - 100 * w**2)
    late = response.time > 10
    assert np.abs(response.values[0, late, 0]).max() == pytest.approx(0.005 * abs(gain), rel=5e-3)
    assert np.abs(response.values[0, late, 1]).max() == pytest.approx(100 * w**2 * 0.005 * abs(gain), rel=1e-2)


def test_measured_forces_and_profiles(tmp_path):
    (tmp_path / "force.csv").write_text("t,F\n0,0\n0.1,1000\n100,1000\n")
    (tmp_path / "road.csv").write_text("s,h\n0,0\n1,0\n1.5,0.02\n500,0.02\n")
    text = "vehicle: quarter_car\nspeed: 10 m/s\nduration: 40 s\nroad: [{profile: {file: road.csv, distance: s, height: h}}]\n"
    text += "forces: {push: {body: body, file: force.csv, time: t, force: F}}\nsensors: {s: {body: body, channels: {displacement: z}}}\n"
    response = simulate(run_of(tmp_path, text))
    numeric = derive(load_vehicle("quarter_car")).numeric()
    assert response.values[0, -1, 0] == pytest.approx(0.02 + 1000 * np.linalg.inv(numeric.K)[0, 0], rel=1e-3)


def test_tyre_load_is_static_plus_dynamic(tmp_path):
    text = QUIET + "outputs: {a: {axle: axle1, quantity: tyre_load}, b: {axle: axle1, quantity: tyre_force}}\n"
    response = simulate(run_of(tmp_path, text))
    load = static_loads(derive(load_vehicle("tractor5"))).axles["axle1"]
    np.testing.assert_allclose(response.values[0, :, 0], load, rtol=1e-12)
    np.testing.assert_allclose(response.values[0, :, 1], 0, atol=1e-9)


def test_a_population_with_different_wheelbases(tmp_path):
    (tmp_path / "two.yaml").write_text("extends: sedan2\n")
    run = run_of(tmp_path, "vehicle: two.yaml\nspeed: 3 m/s\nroad: [{hump: {shape: versine, length: 0.5 m, height: 2 cm, at: 1 m}}]\n")
    simulator = Simulator(run.vehicle, [PointOutput("z", Place("s", "body"), "acceleration")])
    name = "wheelbase"
    assert name in run.vehicle.free_parameters
    scenario = make_scenario(run, simulator.model, simulator.model.values())
    population = simulator.parameters([{}, {name: 3.4}, {}])
    together = simulator.run(population, scenario).responses
    for i in range(3):
        np.testing.assert_array_equal(simulator.run(population[i : i + 1], scenario).responses[0], together[i])
    assert np.abs(together[0] - together[1]).max() > 0.01
    np.testing.assert_array_equal(together[0], together[2])


def test_failed_individuals_warn(tmp_path):
    run = run_of(tmp_path, QUIET + "road: [{hump: {shape: versine, length: 0.5 m, height: 2 cm, at: 0.1 m}}]\n")
    simulator = Simulator(run.vehicle, [ElementOutput("f", "axle1", "tyre_load")])
    scenario = make_scenario(run, simulator.model, simulator.model.values())
    population = simulator.parameters([{}, {"k1": float("nan")}])
    with pytest.warns(ModelWarning, match="1 of 2 individuals failed; individual 1: its parameter k1"):
        result = simulator.run(population, scenario)
    assert np.isfinite(result.responses[0]).all()


SHARP = (
    "vehicle: sedan2\nspeed: 50 km/h\nroad: [{hump: {shape: half_sine, length: 0.3 m, height: 3 cm, at: 2 m}}]\n"
    "outputs: {force: {axle: front, quantity: tyre_force}}\n"
)


def test_a_peak_between_samples_is_told_and_lifts_a_tyre_off(tmp_path):
    every = simulate(run_of(tmp_path, SHARP + "sample: 1 ms\n"))
    assert not any("between samples" in text for text in every.warnings)
    peak = np.abs(every.values).max()
    sparse = simulate(run_of(tmp_path, SHARP + "sample: 25 ms\n"))
    share = peak / np.abs(sparse.values).max() - 1
    assert share > 0.1
    (told,) = [text for text in sparse.warnings if "between samples" in text]
    assert float(told.partition(" reaches ")[2].partition(" N")[0]) == pytest.approx(peak, rel=1e-4)
    assert told.startswith("between samples every 25 ms force reaches ")
    assert f" N, {share:.0%} more than the largest of them; `sample: 1 ms`" in told
    assert [text for text in sparse.warnings if "leave the road" in text] == [text for text in every.warnings if "leave the road" in text]


@pytest.mark.parametrize(
    ("line", "table", "message"),
    [
        ("forces: {f: {body: body, file: x.csv, time: t, force: v}}\n", "t,v\n1.7e9,0\n1.70001e9,5\n", "lie outside of the run, 0 to 2 s"),
        ("speed: {file: x.csv, speed: v}\n", "t,v\n1.7e9,3\n1.70001e9,3\n", "lie outside of the run, 0 to 2 s"),
        ("forces: {f: {body: body, file: x.csv, time: t, force: v}}\n", "t,v\n0,0\n1,1e12\n", "a force is at most 1e+09 N"),
        ("road: [{profile: {file: x.csv, distance: t, height: v}}]\n", "t,v\n0,0\n5,1e4\n", "the height of a profile is at most"),
    ],
    ids=["epoch times", "speeds of another day", "a force of no machine", "a mountain"],
)
def test_tables_that_cannot_belong_to_a_run_are_refused(tmp_path, line, table, message):
    (tmp_path / "x.csv").write_text(table, encoding="utf-8")
    speed = "" if line.startswith("speed") else "speed: 3 m/s\n"
    with pytest.raises(InputError, match=re.escape(message)):
        simulate(run_of(tmp_path, f"vehicle: sedan2\n{speed}duration: 2 s\n{line}"))


def test_a_harmonic_of_few_steps_is_warned_of(tmp_path):
    force = "forces: {f: {body: body, harmonic: {amplitude: 1 kN, frequency: %d Hz}}}\n"
    few = simulate(run_of(tmp_path, QUIET.replace("tractor5", "sedan2") + force % 150)).warnings
    assert any(text == "a cycle of 150 Hz takes 6.67 steps of 1 ms; take at least 10" for text in few)
    assert not any("a cycle of" in text for text in simulate(run_of(tmp_path, QUIET.replace("tractor5", "sedan2") + force % 50)).warnings)


def test_a_road_that_is_not_met_is_warned_of(tmp_path):
    (tmp_path / "x.csv").write_text("t,v\n100,0\n120,0.02\n", encoding="utf-8")
    road = "road: [{hump: {shape: versine, length: 0.5 m, height: 2 cm, at: 40 m}}, {profile: {file: x.csv, distance: t, height: v}}]\n"
    told = [
        text for text in simulate(run_of(tmp_path, f"vehicle: sedan2\nspeed: 5 m/s\nduration: 3 s\n{road}")).warnings if "not met" in text
    ]
    assert [text.partition(":")[0] for text in told] == ["the hump at 40 m is not met", "the profile at 100 m is not met"]
    far = simulate(run_of(tmp_path, f"vehicle: sedan2\nspeed: 5 m/s\nduration: 30 s\n{road}")).warnings
    assert not [text for text in far if "not met" in text]


def test_a_tyre_that_may_lift_off_is_not_warned_of(tmp_path):
    run = "speed: 50 km/h\nroad: [{hump: {shape: half_sine, length: 0.3 m, height: 6 cm, at: 2 m}}]\n"
    linear = simulate(run_of(tmp_path, f"vehicle: sedan2\n{run}"))
    assert any("tyre of front would leave the road" in text for text in linear.warnings)
    laws = "axles: {front: {tyre: {laws: [{tyre_liftoff: {}}]}}, rear: {tyre: {laws: [{tyre_liftoff: {}}]}}}\n"
    (tmp_path / "lifting.yaml").write_text(f"extends: sedan2\nname: lifting\n{laws}", encoding="utf-8")
    lifting = simulate(run_of(tmp_path, f"vehicle: lifting.yaml\n{run}"))
    assert not any("leave the road" in text for text in lifting.warnings)


def test_doubts_are_voiced(tmp_path):
    hump = "road: [{hump: {shape: half_sine, length: 0.4 m, height: 4 cm, at: 1 m}}]\n"
    warnings = simulate(run_of(tmp_path, "vehicle: tractor5\nspeed: 2 m/s\n" + hump)).warnings
    assert any("would leave the road" in text for text in warnings)
    assert any("null at 12.50 Hz" in text and "axle4 hop" in text for text in warnings)
    assert not any("too coarse" in text for text in warnings)
    other = hump.replace("]", ", {hump: {shape: versine, length: 0.6 m, height: 4 cm, at: 9 m}}]")
    both = simulate(run_of(tmp_path, "vehicle: tractor5\nspeed: 2 m/s\n" + other)).warnings
    assert not any("null at" in text for text in both)  # one hump excites what the other leaves out
    coarse = simulate(run_of(tmp_path, "vehicle: tractor5\nspeed: 2 m/s\nstep: 10 ms\nsample: 10 ms\n" + hump)).warnings
    assert any("too coarse" in text for text in coarse)
    gentle = (
        "vehicle: tractor5\nspeed: 2 m/s\nfootprint: 0.24 m\nroad: [{hump: {shape: half_sine, length: 0.5 m, height: 5 mm, at: 1 m}}]\n"
    )
    assert not any("leave the road" in text for text in simulate(run_of(tmp_path, gentle)).warnings)


def test_csv_columns(tmp_path):
    response = simulate(run_of(tmp_path, QUIET + "sensors: {L1: {body: tractor, channels: {acceleration: a, pitch_rate: {column: q}}}}\n"))
    write_csv(tmp_path / "out.csv", response)
    rows = list(csv.reader((tmp_path / "out.csv").read_text().splitlines()))
    assert rows[0] == ["t", "a", "q"]
    assert len(rows) == 52
    assert [float(row[0]) for row in rows[1:4]] == [0.0, 0.01, 0.02]


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("speed: 2", r"run.yaml:2:8: expected m/s, found no unit in 2"),
        ("speed: 0 m/s", r"run.yaml:2:8: expected a finite number above 0"),
        ("sped: 2 m/s", r"run.yaml:2:1: unknown key 'sped'; did you mean 'speed'"),
        ("speed: 2 m/s\nset: SHCM-9", r"run.yaml:3:6: tractor5 has no parameter set 'SHCM-9'; did you mean"),
        ("speed: 2 m/s\nsensors: {L1: {body: trctor}}", r"run.yaml:3:22: tractor5 has no body 'trctor'; did you mean 'tractor'"),
        ("speed: 2 m/s\nsensors: {L1: {body: tractor, behind: axle9}}", r"did you mean 'axle"),
        ("speed: 2 m/s\nroad: [{hump: {shape: half_sine, at: 1 m}}]", r"lacks the key length"),
        ("speed: 2 m/s\nroad: [{}]", r"one of hump, iso8608, profile"),
        ("speed: 2 m/s\nparameters: {k9: 3 N/m}", r"no parameter with a value 'k9'"),
        ("speed: 2 m/s\nparameters: {k1: 3 kg}", r"k1 must be in N/m, found kg"),
        ("speed: 2 m/s\nsample: 1.5 ms", r"whole number of steps"),
        ("speed: 2 m/s\noutputs: {a: {axle: axle7, quantity: tyre_load}}", r"no axle 'axle7'"),
    ],
)
def test_bad_run_files(tmp_path, line, message):
    with pytest.raises(InputError, match=message):
        run_of(tmp_path, f"vehicle: tractor5\n{line}\n")


def test_a_run_without_end_is_refused(tmp_path):
    with pytest.raises(InputError, match="needs `duration`"):
        simulate(run_of(tmp_path, "vehicle: tractor5\nspeed: 2 m/s\n"))


def test_a_run_without_hump_lasts_as_long_as_its_recording(tmp_path):
    text = "vehicle: tractor5\nspeed: 2 m/s\nroad: [{iso8608: {class: A}}]\nrecording: measured.csv\n"
    (tmp_path / "measured.csv").write_text("t [ms],a\n-500,0\n250,1\n1200,2\n")
    assert simulate(run_of(tmp_path, text)).time[-1] == pytest.approx(1.2)
    assert simulate(run_of(tmp_path, text + "duration: 0.3 s\n")).time[-1] == pytest.approx(0.3)
    hump = "{hump: {shape: half_sine, length: 0.4 m, height: 4 cm, at: 1 m}}, "
    assert simulate(run_of(tmp_path, text.replace("[", "[" + hump))).time[-1] > 3
    (tmp_path / "measured.csv").unlink()
    with pytest.raises(InputError, match=r"run.yaml:4:12: no file .*measured.csv"):
        simulate(run_of(tmp_path, text))


def test_lint_finds_what_is_odd():
    model = derive(
        parse_vehicle(
            "extends: sedan2\naxles: {third: {body: body, x: Lf + 0.1 m, mass: 90 kg, suspension: {k: 1 N/m}, tyre: {k: 1 MN/m}}}\n"
        )
    )
    findings = lint(model)
    assert any(
        "overlapping axles: third and front are 0.10 m apart" in text or "overlapping axles: front and third" in text for text in findings
    )
    model = derive(parse_vehicle("extends: quarter_car\naxles: {axle1: {tyre: {k: 0 N/m}}}\n"))
    assert any("singular stiffness" in text for text in lint(model))
    assert any("radius of gyration of semitrailer" in text for text in lint(derive(load_vehicle("vbi2d_2A3"))))
    assert any(
        "negative load" in text for text in lint(derive(load_vehicle("sedan2")), {**derive(load_vehicle("sedan2")).values(), "Lf": -2.0})
    )


@pytest.mark.parametrize(
    ("driven", "told"),
    [
        ("", 1),
        ("initial: {body: {velocity: 1 mm/s}}", 0),
        ("forces: {push: {body: body, harmonic: {amplitude: 1 N, frequency: 1 Hz}}}", 0),
        ("road: [{iso8608: {class: A, seed: 1}}]", 0),
    ],
)
def test_a_run_in_which_nothing_moves_is_told(tmp_path, driven, told):
    (tmp_path / "run.yaml").write_text(f"vehicle: sedan2\nspeed: 2 m/s\nduration: 1 s\n{driven}\n", encoding="utf-8")
    assert sum("nothing drives the vehicle" in item for item in simulate(tmp_path / "run.yaml").warnings) == told


@pytest.mark.parametrize(
    ("at", "said"),
    [
        (-0.2, "the hump at -0.2 m lies under front as the run begins, which it meets as a sudden step"),
        (-3.0, "the hump at -3 m lies under rear as the run begins"),
        (-1.0, "the hump at -1 m lies behind the first wheel as the run begins: it is met from rear on alone"),
        (-100.0, "the hump at -100 m lies behind the first wheel as the run begins: it is not met"),
        (0.05, "the hump at 0.05 m lies under front as the run begins"),
        (0.5, None),
    ],
)
def test_humps_at_the_start_are_told(tmp_path, at, said):
    hump = f"{{shape: half_sine, length: 0.5 m, height: 5 cm, at: {at} m}}"
    (tmp_path / "run.yaml").write_text(
        f"vehicle: sedan2\nspeed: 2 m/s\nduration: 3 s\nfootprint: 0.2 m\nroad: [{{hump: {hump}}}]\n", encoding="utf-8"
    )
    found = [item for item in simulate(tmp_path / "run.yaml").warnings if "as the run begins" in item]
    assert [item[: len(said or "")] for item in found] == ([said] if said else [])


@pytest.mark.parametrize(
    ("place", "told"),
    [
        ("x: 3.9 m", ""),
        ("x: 60 m", "58.8 m ahead of"),
        ("behind: front, distance: 8 m", "5.2 m behind"),
        ("behind: front, distance: -2 m", ""),
    ],
)
def test_a_sensor_or_force_far_from_the_vehicle_is_doubted_once(tmp_path, place, told):
    """The sedan's axles span 2.8 m, its front axle is 1.18 m ahead of the COG."""
    push = "{body: body, x: -30 m, harmonic: {amplitude: 10 N, frequency: 2 Hz}}"
    run = "vehicle: sedan2\nspeed: 1 m/s\nduration: 1 s\n"
    run += f"sensors: {{S: {{body: body, {place}, channels: {{acceleration: a, pitch_rate: q}}}}}}\n"
    warnings = simulate(run_of(tmp_path, f"{run}forces: {{push: {push}}}\n")).warnings
    found = [text for text in warnings if "all axles, hinges and COGs" in text]
    assert [text.startswith(("S is", "push is")) for text in found] == [True] * (1 + bool(told))
    assert found[-1].startswith("push is 28.4 m behind")
    assert told in found[0]


def test_a_recording_of_a_sensor_far_from_the_vehicle_is_doubted(tmp_path):
    path = write_run(tmp_path, "hump", sedan_truth())
    path.write_text(path.read_text().replace("behind: rear,", "behind: rear, distance: 30 m,"))
    with pytest.warns(ModelWarning, match=r"hump: R is 30 m behind all axles, hinges and COGs of the vehicle, which span 2.8 m"):
        load_trials(path)


def test_a_vehicle_that_deserves_a_second_look_is_doubted_where_it_is_simulated(tmp_path):
    """With its rear axle ahead of the COG the front tyre would have to pull it down."""
    text = "extends: sedan2\nname: nosed\nparameters: {{wheelbase: {{value: 1.05 m}}}}\n{silence}"
    run = "vehicle: nosed.yaml\nspeed: 3 m/s\nduration: 0.5 s\nroad: [{iso8608: {class: A}}]\n"
    for silence, told in (("", True), ("silence: [negative_load, gyration, body_mode, deflection]\n", False)):
        (tmp_path / "nosed.yaml").write_text(text.format(silence=silence), encoding="utf-8")
        warnings = simulate(run_of(tmp_path, run)).warnings
        assert any("negative load on front" in text or "negative load on rear" in text for text in warnings) == told


def test_a_response_that_grows_without_end_is_refused_with_what_may_feed_it(tmp_path):
    """An own law feeds in more than the damper takes out."""
    law = "{law: {force: -c1*v, parameters: {c1: 3 kN s/m}}}"
    (tmp_path / "fed.yaml").write_text(
        "name: fed\nbodies: {body: {mass: 400 kg, motions: [heave]}}\naxles: {axle: {body: body, x: 0 m, mass: 40 kg, "
        f"suspension: {{k: 20 kN/m, c: 1.2 kN s/m, laws: [{law}]}}, tyre: {{k: 180 kN/m}}}}}}\n",
        encoding="utf-8",
    )
    run = "vehicle: fed.yaml\nspeed: 5 m/s\nduration: 3 s\nroad: [{iso8608: {class: A}}]\n"
    with pytest.raises(InputError, match=r"run.yaml:1:10: .* take a smaller step, or does a law push along with its motion\?$"):
        simulate(run_of(tmp_path, run))
