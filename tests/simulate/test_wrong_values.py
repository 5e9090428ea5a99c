"""Values and names given in Python that cannot be are refused as those of files are: in one line that says what was expected."""

import numpy as np
import pytest

import vehgen
from vehgen.errors import InputError


@pytest.mark.parametrize("asked", [vehgen.natural_modes, vehgen.static_loads])
@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("300 kN/m", "kS takes a number in SI units here, found '300 kN/m'"),
        (None, "kS takes a number in SI units here, found None"),
        (float("nan"), "`values`: kS must be a finite number, found nan"),
        (float("inf"), "`values`: kS must be a finite number, found inf"),
    ],
)
def test_a_value_that_is_no_number_in_si_is_refused(asked, value, message):
    with pytest.raises(InputError, match=message):
        asked("quarter_car", {"kS": value})


@pytest.mark.parametrize("asked", [vehgen.natural_modes, vehgen.static_loads, vehgen.state_space])
@pytest.mark.parametrize(
    ("name", "message"),
    [("kS", "negative k: axles.axle1.suspension.k is -1"), ("cS", "negative c"), ("mG", "negative mass: axles.axle1.mass")],
)
def test_a_value_that_cannot_be_of_a_spring_a_damper_or_a_mass_is_refused(asked, name, message):
    with pytest.raises(InputError, match=message):
        asked("quarter_car", values={name: -1.0})


def test_a_channel_that_there_is_not_is_told_with_the_nearest(tmp_path):
    (tmp_path / "run.yaml").write_text(
        "vehicle: quarter_car\nspeed: 2 m/s\nroad: [{hump: {shape: versine, length: 0.5 m, height: 2 cm, at: 1 m}}]\n"
        "outputs: {travel: {axle: axle1, quantity: suspension_travel}}\n",
        encoding="utf-8",
    )
    response = vehgen.simulate(tmp_path / "run.yaml")
    name = response.channels[0].name
    assert response.channel(name).shape == (1, len(response.time))
    with pytest.raises(InputError, match=f"did you mean '{name}'"):
        response.channel(f"{name}s")


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: vehgen.load_vehicle(3), "`name`: a file or the name of a bundled model was expected, found int"),
        (lambda: vehgen.road_response("quarter_car", speed="20"), "`speed`: a number in m/s was expected, found '20'"),
        (lambda: vehgen.derive("quarter_car", ["x"]), "`outputs`: a list of PointOutput or ElementOutput was expected, found str"),
        (lambda: vehgen.state_space("quarter_car", forces=["x"]), "`forces`: a list of Place was expected, found str"),
        (lambda: vehgen.frequency_response("sedan2", speed="20 m/s"), "`speed`: a number in m/s was expected, found '20 m/s'"),
    ],
    ids=range(5),
)
def test_an_argument_of_another_kind_is_refused(call, message):
    with pytest.raises(InputError, match=message):
        call()


FORCE = [vehgen.ElementOutput("f", "axle1", "tyre_force")]
ROAD = np.zeros((101, 1))
NO_FORCES = np.zeros((101, 0))


@pytest.fixture(scope="module")
def simulator():
    return vehgen.Simulator("quarter_car", FORCE)


@pytest.fixture(scope="module")
def scenario(simulator, tmp_path_factory):
    path = tmp_path_factory.mktemp("runs") / "run.yaml"
    hump = "{hump: {shape: versine, length: 0.5 m, height: 2 cm, at: 1 m}}"
    path.write_text(f"vehicle: quarter_car\nspeed: 2 m/s\nroad: [{hump}]\noutputs: {{f: {{axle: axle1, quantity: tyre_force}}}}\n")
    return vehgen.make_scenario(vehgen.load_run(path), simulator.model, simulator.model.values())


@pytest.mark.parametrize(
    ("parameters", "found"),
    [
        (lambda six: six[0], r"shape \(6,\)"),
        (lambda six: six.T, r"shape \(6, 2\)"),
        (lambda six: six[:0], r"shape \(0, 6\)"),
        (lambda _: [{"kS": 1e6}], "list"),
    ],
)
def test_a_population_of_another_shape_is_refused(simulator, scenario, parameters, found):
    six = simulator.parameters([{}, {"kS": 1e6}])
    assert simulator.run(six.tolist(), scenario).responses.shape[0] == 2
    with pytest.raises(InputError, match=rf"`parameters`: an array of shape \(n_individuals, 6\) was expected.*found {found}"):
        simulator.run(parameters(six), scenario)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ([], r"found shape \(0, 6\)"),
        (["kS", "cS"], r"of a table: `to_dict\('records'\)`.* found list of str"),
        ([{}, {"mG": -5.0}], "negative mass: axles.axle1.mass is -5 in individual 1"),
        ({"kT": -5.0}, "negative k: axles.axle1.tyre.k is -5 with the given values"),
    ],
)
def test_values_that_make_no_population_are_refused(simulator, values, message):
    with pytest.raises(InputError, match=message):
        simulator.parameters(values)


def test_a_run_is_no_scenario(simulator):
    with pytest.raises(InputError, match="what `make_scenario` makes of a run was expected, found str"):
        simulator.run(simulator.parameters(), "run.yaml")


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"dt": "1 ms"}, "`dt`: a step in seconds above 0 was expected, found '1 ms'"),
        ({"dt": 0}, "found 0"),
        ({"inputs": ROAD[:, 0]}, r"`inputs`: an array of shape \(n_steps \+ 1, n\) was expected, found shape \(101,\)"),
        ({"forces": None}, "`forces`: .* found NoneType"),
        ({"rates": [["x"]]}, "`rates`: .* found list"),
        ({"rates": ROAD[1:]}, "`inputs`, `rates`, `forces`: a row each .* found 101 of inputs, 100 of rates, 101 of forces"),
        ({"inputs": ROAD[:0], "rates": ROAD[:0], "forces": NO_FORCES[:0]}, "a row each .* found 0 of inputs, 0 of rates, 0 of forces"),
        ({"dt": True}, "`dt`: a step in seconds above 0 was expected, found True"),
    ],
    ids=range(8),
)
def test_what_cannot_drive_a_vehicle_is_refused(changed, message):
    with pytest.raises(InputError, match=message):
        vehgen.Excitation(**{"dt": 1e-3, "inputs": ROAD, "rates": ROAD, "forces": NO_FORCES, **changed})


def test_a_kernel_takes_lists_and_tells_of_a_road_and_a_beginning_that_cannot_be(simulator):
    kernel, two = simulator.kernel, simulator.parameters([{}, {}])
    drive = vehgen.Excitation(1e-3, ROAD.tolist(), ROAD, NO_FORCES)
    assert kernel.run(two, drive, initial=[[0.0] * 4] * 2).responses.shape == (2, 11, 1)
    with pytest.raises(InputError, match="displacements, then velocities, of every individual were expected"):
        kernel.run(two, drive, initial=[["x"] * 4] * 2)
    for wrong in (np.zeros(4), np.zeros((1, 4)), np.zeros((2, 3))):
        with pytest.raises(InputError, match=r"`initial` has shape .*; \(n_individuals, 2 n_dof\) = \(2, 4\) was expected"):
            kernel.run(two, drive, initial=wrong)
    gap = np.where(np.arange(101)[:, None] == 50, np.nan, ROAD)
    failures = kernel.run(two, vehgen.Excitation(1e-3, gap, ROAD, NO_FORCES)).failures
    assert failures == dict.fromkeys((0, 1), "what drives it, road or forces, is not finite")


def test_outputs_are_a_list_and_have_names_of_their_own():
    with pytest.raises(InputError, match="`outputs`: a list of PointOutput or ElementOutput was expected, found ElementOutput"):
        vehgen.derive("quarter_car", FORCE[0])
    with pytest.raises(InputError, match="`outputs`: two are named 'f'"):
        vehgen.derive("quarter_car", FORCE * 2)


@pytest.mark.parametrize("name", ["", None, 3])
def test_an_output_has_a_name(name):
    with pytest.raises(InputError, match="`outputs`: a name was expected"):
        vehgen.derive("quarter_car", [vehgen.PointOutput(name, vehgen.Place("a", "body"), "acceleration")])


@pytest.mark.parametrize(
    ("place", "message"),
    [
        ({"distance": 2.0}, "`distance` counts from what `behind` names, and nothing is named: from the COG the place is `x: -2 m`"),
        ({"x": "1 m", "behind": "axle1"}, "a place has `x`, or `behind` with `distance`, not both"),
        ({"behind": "axle1", "distance": float("nan")}, "`distance`: a finite number in m was expected, found nan"),
        ({"behind": "axle1", "distance": None}, "`distance`: expected a number in m"),
        ({"behind": "axle1", "distance": 1e5}, "`distance`: a length on a vehicle is at most 1000 m in magnitude, found 100000 m"),
        ({"height": float("inf")}, "`height`: a finite number in m was expected, found inf"),
        ({"x": float("nan")}, "`x`: a finite number in m was expected, found nan"),
    ],
)
def test_a_place_that_cannot_be_is_refused_where_it_is_made(place, message):
    with pytest.raises(InputError, match=message):
        vehgen.Place("a", "body", **place)


def test_lengths_of_a_place_are_numbers_or_texts():
    plain = vehgen.Place("a", "body", behind="axle1", distance=0.5, height=0.25)
    assert vehgen.Place("a", "body", behind="axle1", distance=np.float64(0.5), height=np.float32(0.25)) == plain
    assert vehgen.Place("a", "body", behind="axle1", distance="50 cm", height="0.25 m") == plain
    assert vehgen.Place("a", "body", x=0.3) == vehgen.Place("a", "body", x="0.3 m")


@pytest.mark.parametrize(
    "change", [{"speed": 0.0}, {"speed": -1.0}, {"speed": float("nan")}, {"delay": float("nan")}, {"height": float("inf")}]
)
def test_a_scenario_is_adjusted_to_what_can_be_driven(scenario, change):
    with pytest.raises(InputError, match="a finite `delay` and `height` and a `speed` above 0 were expected"):
        scenario.adjusted(**change)


@pytest.mark.parametrize(
    ("how", "message"),
    [
        ({"decimation": 2.5}, "`decimation`: a whole number of at least 1 was expected, found 2.5"),
        ({"decimation": 0}, "`decimation`: a whole number of at least 1 was expected, found 0"),
        ({"threads": 0}, "`threads`: a whole number from 1 to 10000 was expected, found 0"),
        ({"threads": 1.5}, "`threads`: a whole number from 1 to 10000 was expected, found 1.5"),
    ],
)
def test_a_kernel_runs_in_whole_steps_and_threads(how, message):
    model = vehgen.derive("quarter_car")
    still = np.zeros((11, len(model.inputs)))
    with pytest.raises(InputError, match=message):
        vehgen.Kernel(model).run([list(model.values().values())], vehgen.Excitation(1e-3, still, still, np.zeros((11, 0))), **how)


def test_a_place_is_where_its_text_says():
    rows = [
        vehgen.derive("sedan2", [vehgen.PointOutput("a", vehgen.Place("p", "body", x=x), "acceleration")]) for x in ("Lf - 20 cm", None)
    ]
    pitch = [model.numeric().outputs["acceleration"][0, 1] for model in rows]
    assert pitch == pytest.approx([-(1.18 - 0.2), 0.0])
    with pytest.raises(InputError, match="`x`: "):
        vehgen.Place("p", "body", x="1 m +")
    for wrong, said in (
        ("3 kg", "Place p.x: x must be in m, found kg in '3 kg'"),
        ("Lff - 1 m", "Place p.x: unknown symbol 'Lff'; did you mean 'Lf'"),
    ):
        with pytest.raises(InputError, match=said):
            vehgen.derive("sedan2", [vehgen.PointOutput("a", vehgen.Place("p", "body", x=wrong), "acceleration")])


@pytest.mark.parametrize(
    ("values", "found"),
    [({"kS": 1e6}, "every parameter by name was expected, .*; found no 'mB'"), (np.ones(6), "by name were expected, found ndarray")],
    ids=["some", "an array"],
)
def test_matrices_need_all_values_by_name(simulator, values, found):
    with pytest.raises(InputError, match=found):
        simulator.model.numeric(values)


class Column:
    """As a column of a table: values by name, but no mapping."""

    def items(self):
        return iter([("kS", 2e6)])


def test_modes_take_a_column_of_a_table():
    assert vehgen.natural_modes("quarter_car", Column())[0].undamped_hz == vehgen.natural_modes("quarter_car", {"kS": 2e6})[0].undamped_hz


def test_modes_take_values_by_name_only():
    with pytest.raises(InputError, match="`values`: numbers in SI units by name were expected, found ndarray"):
        vehgen.natural_modes("quarter_car", np.ones(6))


RUBBING = """\
extends: sedan2
name: rubbing
parameters: {F0: {value: 200 N}, gap: {value: 10 mm}, kb: {value: 1 MN/m}}
axles: {front: {suspension: {laws: [{dry_friction: {force: F0}}]}}, rear: {tyre: {laws: [{bump_stop: {k: kb, clearance: gap}}]}}}
links: {stay: {ground: {}, body: {x: 0 m}, k: 1 N/m, laws: [{bump_stop: {k: 2*kb, clearance: gap}}]}}
"""


@pytest.mark.parametrize(
    ("parameter", "value", "said"),
    [
        ("F0", "-200 N", "force of dry_friction must not be below 0, found -200"),
        ("kb", "-1 MN/m", "k of bump_stop must not be below 0, found -1e+06"),
        ("F0", "0 N", ""),
        ("gap", "-1 mm", ""),  # a stop that is pressed at rest
    ],
)
def test_force_laws_of_a_run_and_of_an_individual_are_no_less_physical_than_a_files(tmp_path, parameter, value, said):
    (tmp_path / "rubbing.yaml").write_text(RUBBING, encoding="utf-8")
    run = f"vehicle: rubbing.yaml\nspeed: 3 m/s\nduration: 0.1 s\nroad: [{{iso8608: {{class: A}}}}]\nparameters: {{{parameter}: {value}}}\n"
    (tmp_path / "run.yaml").write_text(run, encoding="utf-8")
    vehicle = vehgen.load_vehicle(tmp_path / "rubbing.yaml")
    number = {"-200 N": -200.0, "-1 MN/m": -1e6, "0 N": 0.0, "-1 mm": -1e-3}[value]
    calls = (lambda: vehgen.load_run(tmp_path / "run.yaml"), lambda: vehgen.Simulator(vehicle, ()).parameters([{}, {parameter: number}]))
    for call, where in zip(calls, (rf"run\.yaml:5:1: .*{said} in this run", f"`values`: {said} in individual 1"), strict=True):
        if not said:
            call()
            continue
        with pytest.raises(InputError, match=where.replace("1e+06", r"1e\+06")):
            call()
