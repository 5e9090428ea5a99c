"""Assessed runs: against closed forms of shaken rigs, against the road's linear response, and of recordings as of simulations."""

import json
import re
from importlib import import_module

import numpy as np
import pytest
from matplotlib.figure import Figure

from tests.commands.calls import run_json
from vehgen.assess import Assessment, assess
from vehgen.assess.tables import assessment_tables
from vehgen.commands import main
from vehgen.errors import InputError
from vehgen.measure.ride_comfort import WEIGHTINGS
from vehgen.simulate import simulate
from vehgen.simulate.road_response import road_response

ROUGH = """\
vehicle: {vehicle}
title: rough
speed: 15 m/s
duration: 120 s
road: [{{iso8608: {{class: B, seed: 5}}}}]
sensors:
  seat: {{body: body, x: 0.4 m, channels: {{acceleration: az, pitch_rate: q}}}}
  nose: {{body: body, x: 1.2 m, channels: {{pitch_rate: nq}}}}
"""
SHAKER = """\
name: shaker
bodies: {table: {mass: 100 kg, motions: [heave]}}
links: {spring: {ground: {x: 0 m}, table: {x: 0 m}, k: 4 MN/m, c: 20 kN s/m}}
"""
PINNED = """\
name: shaker
bodies: {table: {mass: 60 kg, pitch_inertia: 20 kg m^2}, rider: {mass: 40 kg, pitch_inertia: 8 kg m^2}}
hinges: {pin: {table: {x: 0 m}, rider: {x: 0 m}, k: 20 kN m/rad}}
links:
  left: {ground: {x: 1 m}, table: {x: 1 m}, k: 2 MN/m, c: 10 kN s/m}
  right: {ground: {x: -1 m}, table: {x: -1 m}, k: 2 MN/m, c: 10 kN s/m}
"""
SHAKEN = """\
vehicle: shaker.yaml
duration: 60 s
step: 0.5 ms
displacements: {spring: {harmonic: {amplitude: 5 mm, frequency: 4 Hz}}}
sensors:
  T: {body: table, channels: {acceleration: az}}
"""
BOTH = SHAKEN.replace("{spring: {", "{left: &motion {").replace("4 Hz}}}", "4 Hz}}, right: *motion}")


@pytest.fixture(scope="module")
def rough(tmp_path_factory):
    path = tmp_path_factory.mktemp("rough") / "rough.yaml"
    path.write_text(ROUGH.format(vehicle="sedan2"))
    return path


@pytest.fixture(scope="module")
def assessed(rough):
    return assess(rough, start=10.0)


def of(items, name):
    return next(item for item in items if getattr(item, "name", None) == name or getattr(item, "axle", None) == name)


@pytest.mark.thorough
def test_a_shaken_table_has_the_numbers_of_algebra(tmp_path):
    (tmp_path / "shaker.yaml").write_text(SHAKER)
    (tmp_path / "run.yaml").write_text(SHAKEN)
    found = assess(tmp_path / "run.yaml", start=10.0)
    s = 2j * np.pi * 4.0
    spring = 4e6 + 2e4 * s
    table = abs(spring / (100 * s**2 + spring) * s**2 * 5e-3)
    (ride,) = found.ride
    weighted = table * abs(WEIGHTINGS["Wk"].response(np.array([4.0])))[0]
    assert ride.rms == pytest.approx(weighted / np.sqrt(2), rel=3e-3)
    assert ride.vdv == pytest.approx(weighted * (50.0 * 3 / 8) ** 0.25, rel=3e-3)
    assert of(found.channels, "az").peak == pytest.approx(table, rel=3e-3)
    assert of(found.channels, "az").crest == pytest.approx(np.sqrt(2), rel=3e-3)
    assert found.transport[0].rms == pytest.approx(table / np.sqrt(2) / 9.80665, rel=0.01)
    assert found.shock[0].largest == pytest.approx(table * np.sqrt(101.0), rel=0.06)
    assert found.shock[0].largest_hz == pytest.approx(4.0)
    travel = abs(100 * s**2 / (100 * s**2 + spring)) * 5e-3
    (cycles,) = found.cycles
    assert cycles.largest == pytest.approx(2 * travel, rel=0.01)
    assert cycles.equivalent == pytest.approx(2 * travel * 4 ** (1 / 5), rel=0.01)
    assert found.rate == pytest.approx(1000.0)
    assert found.tyres == ()
    assert not any("RMS alone" in text for text in found.notes)


def test_a_pin_has_the_cycles_of_the_mass_that_it_carries(tmp_path):
    (tmp_path / "shaker.yaml").write_text(PINNED)
    (tmp_path / "run.yaml").write_text(BOTH)
    found = assess(tmp_path / "run.yaml", start=10.0)
    s = 2j * np.pi * 4.0
    spring = 4e6 + 2e4 * s
    force = 40 * abs(spring / (100 * s**2 + spring) * s**2 * 5e-3)
    cycles, channel = of(found.cycles, "hinge pin"), of(found.channels, "hinge pin")
    assert (cycles.unit, channel.unit) == ("N", "N")
    assert cycles.largest == pytest.approx(2 * force, rel=0.01)
    assert cycles.cycles == pytest.approx(50 * 4, abs=1)
    assert cycles.equivalent == pytest.approx(2 * force * 4 ** (1 / 5), rel=0.01)
    assert channel.rms == pytest.approx(force / np.sqrt(2), rel=3e-3)
    assert (channel.peak, channel.crest) == (pytest.approx(force, rel=3e-3), pytest.approx(np.sqrt(2), rel=3e-3))


def test_the_cycles_of_a_pin_are_counted_once_with_or_without_its_weight(tmp_path):
    (tmp_path / "shaker.yaml").write_text(PINNED)
    (tmp_path / "plain.yaml").write_text(BOTH)
    (tmp_path / "cell.yaml").write_text(BOTH + "  cell: {hinge: pin, channels: {hinge_load: load}}\n")
    plain, cell = assess(tmp_path / "plain.yaml", start=10.0), assess(tmp_path / "cell.yaml", start=10.0)
    (loaded,) = [item for item in cell.cycles if item.quantity.startswith("hinge")]
    assert loaded.name == "load"
    assert loaded.largest == pytest.approx(of(plain.cycles, "hinge pin").largest, rel=1e-9)
    assert [item.name for item in cell.channels] == ["az", "load"]


def test_a_rough_road_gives_what_the_linear_response_expects(assessed):
    from vehgen.files.expressions import parse
    from vehgen.mechanics import Place

    expected = {
        item.name: item for item in road_response("sedan2", speed=15.0, roughness="B", places=[Place("s", "body", parse("0.4 m"))]).outputs
    }
    assert of(assessed.ride, "az").rms == pytest.approx(expected["s"].weighted_rms, rel=0.06)
    assert of(assessed.channels, "az").rms == pytest.approx(expected["s"].rms, rel=0.06)
    for tyre in assessed.tyres:
        assert tyre.coefficient * tyre.static == pytest.approx(expected[f"{tyre.axle} tyre"].rms, rel=0.06)
        assert tyre.fourth_power == pytest.approx(tyre.road_stress, rel=0.03)
        assert tyre.least < 1 - 2 * tyre.coefficient < 1 + tyre.coefficient < tyre.high < 1 + 2 * tyre.coefficient


def test_what_is_needed_is_chosen_by_itself(assessed):
    assert [item.axle for item in assessed.tyres] == ["front", "rear"]
    assert {item.name for item in assessed.ride} == {"az", "nose acceleration"} == {item.name for item in assessed.shock}
    assert {item.name for item in assessed.channels} == {"az", "q", "nq", "nose acceleration"}
    assert {item.name for item in assessed.cycles} == {"front tyre", "rear tyre", "front travel", "rear travel"}
    assert {level.name for level in assessed.transport[0].levels} >= {"ASTM D4169 truck, level II"}
    assert set(assessed.inputs) == {"rough.yaml", "sedan2.yaml"}
    assert assessed.versions["vehgen"]
    assert assessed.duration == pytest.approx(110.0, abs=0.01)


def test_levels_are_compared_in_the_same_band(assessed):
    item = of(assessed.transport, "az")
    level = next(level for level in item.levels if level.name.endswith("level II"))
    assert level.rms == pytest.approx(0.517, abs=2e-3)
    i = int(np.argmin(abs(item.frequency - level.excess_hz)))
    log = np.interp(np.log(level.excess_hz), np.log([1, 4, 16, 40, 80, 200]), np.log([5e-5, 0.01, 0.01, 0.001, 0.001, 1e-5]))
    assert level.excess_db == pytest.approx(10 * np.log10(item.density[i] / np.exp(log)), abs=0.01)


def test_a_recording_of_the_simulation_is_assessed_alike(rough, assessed, tmp_path):
    folder = rough.parent
    response = simulate(rough)
    names = ["t", *(item.name for item in response.channels)]
    rows = [",".join(f"{value:.9g}" for value in (t, *row)) for t, row in zip(response.time, response.values[0], strict=True)]
    (folder / "drive.csv").write_text("\n".join([",".join(names), *rows]) + "\n")
    path = folder / "recorded.yaml"
    path.write_text(rough.read_text() + "recording: drive.csv\n")
    found = assess(path, recorded=True, start=10.0)
    assert found.source == "recording"
    assert of(found.ride, "az").rms == pytest.approx(of(assessed.ride, "az").rms, rel=0.01)
    assert of(found.ride, "az").vdv == pytest.approx(of(assessed.ride, "az").vdv, rel=0.01)
    assert found.tyres == found.cycles == ()
    assert any("sampled at 100 Hz" in text for text in found.notes)
    assert of(found.transport, "az").band == (1.0, 50.0)
    assert set(found.inputs) == {"recorded.yaml", "sedan2.yaml", "drive.csv"}


def test_a_recorded_tyre_load_is_its_force_and_its_static_load(tmp_path):
    run = ROUGH.format(vehicle="sedan2").partition("sensors:")[0]
    sensors = "sensors: {cell: {axle: rear, channels: {tyre_load: load}}}\n"
    (tmp_path / "run.yaml").write_text(run + sensors)
    response = simulate(tmp_path / "run.yaml")
    rows = [f"{t:.9g},{value:.9g}" for t, value in zip(response.time, response.values[0, :, 0], strict=True)]
    (tmp_path / "cell.csv").write_text("\n".join(["t,load", *rows]) + "\n")
    (tmp_path / "recorded.yaml").write_text(run + sensors + "recording: cell.csv\n")
    (simulated,) = [item for item in assess(tmp_path / "run.yaml").tyres if item.axle == "rear"]
    (recorded,) = assess(tmp_path / "recorded.yaml", recorded=True).tyres
    assert recorded.static == simulated.static
    assert recorded.coefficient == pytest.approx(simulated.coefficient, rel=0.01)
    assert recorded.high == pytest.approx(simulated.high, rel=0.01)


RECORDED = """\
vehicle: sedan2
speed: 15 m/s
recording: drive.csv
sensors:
  seat: {body: body, x: 0.4 m, channels: {acceleration: az, fore_aft_acceleration: ax}}
  strut: {axle: rear, channels: {suspension_force: strut}}
  cell: {axle: front, channels: {tyre_load: load}}
"""


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """Assess 20 s of sines, some about a mean, and of a strut's force whose turning points lie on samples."""
    folder, t = tmp_path_factory.mktemp("recorded"), np.arange(4000) / 200
    sines = ((9.8, 2.0, 4.0), (0.5, 1.5, 5.0), (4e3, 800.0, 1.0))  # mean, amplitude, frequency
    az, ax, load = (mean + size * np.sin(2 * np.pi * hertz * t) for mean, size, hertz in sines)
    sizes = np.repeat([1000.0, 15.0, 5.0], [2000, 1000, 1000])  # 10 cycles, then 10 each of 1.5 and 0.5 % of their range
    strut = sizes * (1 - 4 * np.abs(np.mod(np.r_[t[:2000], 2 * t[2000:]], 1) - 0.5))
    rows = [",".join(f"{value:.9g}" for value in row) for row in zip(t, az, ax, strut, load, strict=True)]
    (folder / "drive.csv").write_text("\n".join(["t,az,ax,strut,load", *rows]) + "\n")
    (folder / "run.yaml").write_text(RECORDED)
    return assess(folder / "run.yaml", recorded=True)


def test_channels_and_shocks_are_about_their_means(recorded):
    load, az = of(recorded.channels, "load"), of(recorded.channels, "az")
    assert (load.rms, load.peak) == (pytest.approx(800 / np.sqrt(2), rel=1e-3), pytest.approx(800, rel=1e-3))
    assert (az.rms, az.crest) == (pytest.approx(np.sqrt(2), rel=1e-3), pytest.approx(np.sqrt(2), rel=5e-3))
    (shock,) = recorded.shock
    assert shock.largest == pytest.approx(2 * np.sqrt(101.0), rel=0.06)
    assert shock.maximax[0] < 1.0  # far below the sine an oscillator hardly moves; beginning with the mean, it would by 9.8 m/s^2 and more


def test_fore_aft_motion_is_weighted_by_wd(recorded):
    """0.409 is what ISO 2631-1 gives Wd at 5 Hz, in its Table 3."""
    found = of(recorded.ride, "ax")
    assert found.weighting == "Wd"
    assert found.rms == pytest.approx(0.409 * 1.5 / np.sqrt(2), rel=0.01)


def test_cycles_count_from_a_hundredth_of_the_largest_range(recorded):
    strut = of(recorded.cycles, "strut")
    assert strut.largest == pytest.approx(2000.0)
    assert strut.cycles == pytest.approx(20, abs=1)
    assert strut.levels == pytest.approx(2000 * np.arange(1, 41) / 40, rel=1e-4)
    assert strut.cumulative == pytest.approx(np.full(40, 10.0), abs=1)


def test_tables_are_in_the_units_that_they_name(assessed, recorded):
    found, other = ({item.title: item for item in assessment_tables(result)} for result in (assessed, recorded))

    def cells(table, name):
        return dict(zip(table.columns, next(row for row in table.rows if row[0] == name), strict=True))

    tyre, load, shock = of(assessed.tyres, "front"), of(assessed.cycles, "front tyre"), of(assessed.shock, "az")
    assert float(cells(found["Tyre loads and road damage"], "front")["static [kN]"]) == pytest.approx(tyre.static / 1e3, rel=1e-3)
    assert float(cells(found["Shock response"], "az")["largest [g]"]) == pytest.approx(shock.largest / 9.80665, rel=1e-3)
    for name, unit, factor in (("front tyre", "kN", 1e-3), ("front travel", "mm", 1e3)):
        row = cells(found["Cycles"], name)
        assert row["unit"] == unit
        assert float(row["largest range"]) == pytest.approx(of(assessed.cycles, name).largest * factor, rel=1e-3)
    assert load.largest > 100.0
    ratio = cells(other["Transport vibration"], "az")["/ II"]
    assert float(ratio) == pytest.approx(np.sqrt(2) / 9.80665 / of(recorded.transport, "az").levels[1].rms, rel=0.01)


HUMP = "road: [{hump: {shape: half_sine, length: 0.6 m, height: HEIGHT, at: 3 m}}]\n"


@pytest.mark.parametrize(
    ("road", "said"),
    [
        (HUMP.replace("HEIGHT", "15 cm"), "the tyre of front would leave the road"),
        (HUMP.replace("HEIGHT", "1 mm") + "step: 10 ms\n", "the step of 10 ms is too coarse"),
        ("road: [{profile: {file: road.csv, distance: s, height: h}}]\n", "the measured profile has a hole from 6 to 8 m"),
    ],
    ids=["a tyre that lifts off", "a coarse step", "a hole of a profile"],
)
def test_what_makes_a_motion_doubtful_is_noted(tmp_path, road, said):
    s = np.delete(np.arange(0, 12.05, 0.1), slice(61, 80))
    np.savetxt(tmp_path / "road.csv", np.column_stack([s, 1e-3 * np.sin(s)]), delimiter=",", header="s,h", comments="")
    (tmp_path / "run.yaml").write_text(f"vehicle: sedan2\nspeed: 5 m/s\nduration: 2 s\n{road}")
    found = assess(tmp_path / "run.yaml")
    assert any(text.startswith(said) for text in found.notes)


def test_recorders_have_no_part_in_the_motion(rough, assessed, tmp_path):
    path = tmp_path / "soft.yaml"
    path.write_text(rough.read_text() + "acquisition: {filter: butterworth, cut_off: 1 Hz}\n")
    assert of(assess(path, start=10.0).ride, "az").rms == pytest.approx(of(assessed.ride, "az").rms, rel=1e-9)


def test_a_result_survives_json_and_shows_itself(assessed):
    again = Assessment.from_dict(json.loads(json.dumps(assessed.to_dict(), allow_nan=False)))
    assert again == assessed
    assert isinstance(again.plot(), Figure)
    columns, rows = again.table()
    assert {len(row) for row in rows} == {len(columns)}
    for table in assessment_tables(again):
        assert {len(row) for row in table.rows} == {len(table.columns)}


def test_a_vehicle_at_rest_has_zeros(tmp_path):
    (tmp_path / "run.yaml").write_text("vehicle: sedan2\nspeed: 10 m/s\nduration: 5 s\n")
    found = assess(tmp_path / "run.yaml")
    assert found.ride[0].rms == 0.0
    assert found.tyres[0].fourth_power == pytest.approx(1.0)
    assert found.cycles[0].largest == 0.0
    assert isinstance(found.plot(), Figure)


def test_a_run_that_would_fill_the_memory_is_refused_at_its_duration(rough, monkeypatch):
    monkeypatch.setattr(import_module("vehgen.assess.motion"), "MAX_RESPONSE_NUMBERS", 100_000)
    with pytest.raises(InputError, match=r"rough.yaml:4:11: 120001 samples of 8 channels are 9.6e\+05 numbers"):
        assess(rough)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"weighting": "Wz"}, "unknown frequency weighting 'Wz'"),
        ({"slope": 0.0}, "`slope`"),
        ({"slope": float("nan")}, "`slope`"),
        ({"start": 120.0}, "`start`"),
        ({"start": -1.0}, "`start`"),
        ({"start": float("nan")}, "`start`"),
        ({"recorded": True}, r"rough.yaml:1:1: this run has no `recording`"),
    ],
)
def test_what_cannot_be_is_refused(rough, arguments, said):
    with pytest.raises(InputError, match=said) as caught:
        assess(rough, **arguments)
    assert "\n" not in str(caught.value)


@pytest.mark.thorough
def test_the_command_writes_a_page_a_table_and_a_figure(rough, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    found = run_json(capsys, "assess", str(rough), "--from", "100", "--weighting", "Wb", "--slope", "3", "--out", "out")
    names = [path.rpartition("/")[2] for path in found["files"]]
    assert names == ["assessment.json", "assessment.html", "assessment.csv", "assessment.png"]
    assert found["ride"][0]["weighting"] == "Wb"
    assert found["cycles"][0]["slope"] == 3.0
    assert "density" not in found["transport"][0]
    assert found["transport"][0]["levels"][0]["rms"] > 0
    page = (tmp_path / "out" / "assessment.html").read_text()
    assert "Tyre loads and road damage" in page
    assert re.search("SHA-256 [0-9a-f]{64}", page)
    assert (tmp_path / "out" / "assessment.csv").read_text().startswith("of,number,value,unit,defined by\n")
    assert main(["report", "out/assessment.json", "--out", "again"]) == 0
    for name in names[1:]:
        assert (tmp_path / "again" / name).read_bytes() == (tmp_path / "out" / name).read_bytes()
    capsys.readouterr()
    assert main(["assess", str(rough), "--from", "130", "--out", "late"]) == 2
    assert capsys.readouterr().err.startswith("error: --from: from 0 to less than the 120 s")
    assert not (tmp_path / "late").exists()


def test_names_of_strangers_stay_text_on_the_page(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    title = "<script>alert(1)</script> $\\\\frac$"
    (tmp_path / "run.yaml").write_text(
        f'vehicle: sedan2\ntitle: "{title}"\nspeed: 10 m/s\nduration: 2 s\nroad: [{{iso8608: {{class: A}}}}]\n'
    )
    assert main(["assess", "run.yaml", "--out", "out"]) == 0
    assert (tmp_path / "out" / "assessment.html").read_text().count("<script") == 1
