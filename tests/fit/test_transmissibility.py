"""Phones in a half-car of scipy's own on random roads, compared with each other and with vehgen's model of the same or another car."""

import json
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

import vehgen
from tests.measure.rough_half_car import PLACES, SEDAN, drive
from tests.phones.rough_phones import write_phone
from vehgen.commands import main
from vehgen.errors import InputError
from vehgen.fit import rough_drives
from vehgen.fit.ratio_bands import GAIN_RATIO_SIGMA, compared_ratio
from vehgen.fit.transmissibility_result import Transmissibility
from vehgen.measure.transmissibility import estimate_ratio, segment_transforms
from vehgen.phones import PhoneSensor
from vehgen.phones.rough_road import read_drive

DATA = "shared/data/phone-roads"
SHARED = next((parent / DATA for parent in Path(__file__).parents if (parent / DATA).is_dir()), Path(DATA))
SENSORS = tuple(PhoneSensor(name, "body", x=x) for name, x in PLACES.items())


def wandering(t):
    """Return a driver's speed [m/s] at times [s]."""
    return 14.0 + 2.5 * np.sin(2 * np.pi * t / 130.0)


def write_exports(folder, seed, parameters=SEDAN, speed=15.0, told=1.0, rattle=0.0, **options):
    """Write the exports of both phones; `told` is the GPS speed over the true one, `rattle` [m/s^2] noise of the second phone alone."""
    time, values = drive(parameters, 240.0, speed, seed)
    gps = (speed if np.isscalar(speed) else speed(np.arange(0.5, time[-1], 1.0))[: len(np.arange(0.5, time[-1], 1.0))]) * told
    random = np.random.default_rng(100 + seed)
    exports = []
    for i, name in enumerate(PLACES):
        upward = values[:, i] + (rattle * random.normal(size=len(time)) if i else 0.0)
        more = {"speed": gps} if i == 0 else {"shift": 1.3, "drift": 5e-5, **options}
        exports.append(write_phone(folder / f"{name}.zip", time, upward, values[:, 2], seed=10 * seed + i, **more))
    return exports


@pytest.fixture(scope="module", autouse=True)
def read_once():
    """Exports are read once: what is made of a drive is what these tests watch, and reading takes longest."""
    made = {}

    def read(*arguments):
        if repr(arguments) not in made:
            made[repr(arguments)] = read_drive(*arguments)
        return made[repr(arguments)]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(rough_drives, "read_drive", read)
        yield


@pytest.fixture(scope="module")
def exports(tmp_path_factory):
    return write_exports(tmp_path_factory.mktemp("drive"), 1)


@pytest.fixture(scope="module")
def right(exports):
    return vehgen.transmissibility(exports, vehicle="sedan2", sensors=SENSORS)


def slow(folder, seed=7):
    """Write the exports of a drive at 2 m/s: the rear axle follows by 1.4 s, and so does the clock that the recordings seem to show."""
    return write_exports(folder, seed, speed=2.0)


def apart(found):
    return {band.low for _, band in found.apart}


@pytest.mark.thorough
def test_the_right_model_lies_within(right):
    assert right.channels == ("F_az", "R_az")
    assert right.averages == pytest.approx(52, abs=4)
    assert right.speeds == pytest.approx((15.0, 15.0, 15.0))
    assert right.apart == ()
    for band in right.ratios[0].bands:
        assert band.coherence > 0.97
        assert band.model == pytest.approx(1.0, abs=0.02)
        assert band.lower < band.ratio < band.upper


@pytest.mark.slow
@pytest.mark.parametrize("seed", [2, pytest.param(3, marks=pytest.mark.slow)])
def test_nor_is_it_apart_with_pitch_rates_at_a_changing_speed_wrongly_told_and_with_a_phone_that_rattles(tmp_path, seed):
    """One drive shows it; the second is another road."""
    paths = write_exports(tmp_path, seed, speed=wandering, told=1.012, rattle=0.5)
    found = vehgen.transmissibility(paths, vehicle="sedan2", sensors=SENSORS, forward="y", reference="R")
    assert found.channels == ("R_az", "F_az", "F_q", "R_q")
    assert found.apart == ()
    assert found.speed_scale == pytest.approx(1 / 1.012, abs=0.006)
    assert min(band.coherence for band in found.ratios[0].bands) < 0.97


@pytest.mark.slow
def test_clocks_that_the_road_shifted_are_shifted_back(tmp_path):
    found = vehgen.transmissibility(slow(tmp_path), vehicle="sedan2", sensors=SENSORS)
    assert found.apart == ()
    assert np.abs(found.ratios[0].bands[1].model - 1) < 0.03
    with pytest.raises(InputError, match=r"the last axle meets the road 1\.4 s after the first; `segment` must be 4 times as long"):
        vehgen.transmissibility(tmp_path / "F.zip", vehicle="sedan2", sensors=SENSORS[:1], forward="y", segment=4.0)


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("name", "factor", "bands"), [("ktr", 1.3, {8.0, 12.0, 15.0}), ("kr", 1.3, {0.5, 2.0}), ("mf", 1.5, {8.0, 12.0, 15.0})]
)
def test_a_model_with_a_wrong_value_is_apart_where_that_matters(exports, name, factor, bands):
    """Tyres and wheels' masses make the hop, from 8 Hz on; suspensions the body's motions below 5 Hz."""
    text = f"extends: sedan2\nname: other\nparameters: {{{name}: {{value: {factor * SEDAN[name]} {'kg' if name == 'mf' else 'N/m'}}}}}\n"
    found = vehgen.transmissibility(exports, vehicle=vehgen.parse_vehicle(text), sensors=SENSORS)
    assert bands <= apart(found)
    distances = {band.low: band.distance for band in found.ratios[0].bands}
    assert max(distances, key=distances.get) in bands
    assert (0.5 in apart(found)) == (name == "kr")


@pytest.mark.thorough
def test_all_masses_and_springs_by_one_factor_change_nothing(exports, right):
    """What it cannot tell: the scale."""
    units = {"m": "kg", "I": "kg m^2", "k": "N/m", "c": "N s/m"}
    lines = [f"  {name}: {{value: {1.1 * value} {units[name[0]]}}}" for name, value in SEDAN.items() if name != "Lf"]
    heavier = vehgen.parse_vehicle("extends: sedan2\nname: heavier\nparameters:\n" + "\n".join(lines) + "\n")
    found = vehgen.transmissibility(exports, vehicle=heavier, sensors=SENSORS)
    for own, other in zip(found.ratios[0].bands, right.ratios[0].bands, strict=True):
        assert own.distance == pytest.approx(other.distance, rel=1e-4)


@pytest.mark.thorough
def test_without_a_vehicle_the_measured_alone(exports, right):
    found = vehgen.transmissibility(exports)
    assert found.channels == ("S1_az", "S2_az")
    np.testing.assert_array_equal(found.ratios[0].h1, right.ratios[0].h1)
    assert found.ratios[0].model_h1 is None
    assert found.ratios[0].bands[0].distance is None
    assert found.vehicle is found.speed_scale is None
    assert any("scale of masses" in text for text in found.cannot_tell)
    assert not any("model" in text for text in found.tells)


@pytest.mark.slow
def test_a_hole_costs_its_segments(tmp_path, right):
    found = vehgen.transmissibility(write_exports(tmp_path, 1, hole=(80.0, 81.0)), vehicle="sedan2", sensors=SENSORS)
    assert any(text.startswith("2 of 58 segments are left out: a phone did not record") for text in found.notes)
    assert found.averages < right.averages - 1
    assert found.apart == ()


def test_one_phone_is_refused_and_told_what_to_record(exports, tmp_path, capsys):
    assert main(["transmissibility", str(exports[0]), "--out", str(tmp_path / "out")]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    for text in ("one channel only (S1_az)", "a second phone", "one pass over a known hump", "--forward"):
        assert text in error
    assert not (tmp_path / "out").exists()
    found = vehgen.transmissibility(exports[:1], forward="y")
    assert found.channels == ("S1_az", "S1_q")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"vehicle": "sedan2"}, "`sensors` must say where each phone lay"),
        ({"vehicle": "sedan2", "sensors": SENSORS[:1]}, "2 exports and 1 sensors"),
        ({"vehicle": "sedan2", "sensors": (SENSORS[0], PhoneSensor("R", "boddy"))}, "no body 'boddy'; did you mean 'body'"),
        ({"parameter_set": "SHCM-M"}, "`parameter_set` needs a `vehicle`"),
        ({"reference": "S3"}, r"no channel S3; did you mean S1|no channel 'S3'"),
        ({"bands": ((0.5, 60.0),)}, r"they must end between 1 and 40 Hz, found 60 Hz"),
        ({"bands": ((5.0, 2.0),)}, "ascending, were expected"),
        ({"bands": ((0.1, 2.0),)}, "the first begin at two"),
        ({"segment": 0.0}, "`segment`: from 0.2 to 120 s"),
        ({"segment": 60.0}, r"at least 240 s together|7 of 7 half-overlapping|at least 8 are needed"),
        ({"speed": -3.0}, "`speed`: from 1 to 100 m/s was expected"),
    ],
)
def test_what_does_not_fit_is_refused(exports, arguments, message):
    with pytest.raises(InputError, match=message):
        vehgen.transmissibility(exports, **arguments)


def test_a_model_needs_a_speed(tmp_path):
    time, values = drive(SEDAN, 80.0, 15.0, 5)
    paths = [write_phone(tmp_path / f"{i}.zip", time, values[:, i], values[:, 2], seed=i) for i in (0, 1)]
    with pytest.raises(InputError, match="a model needs `speed` in m/s"):
        vehgen.transmissibility(paths, vehicle="sedan2", sensors=SENSORS)
    assert vehgen.transmissibility(paths, vehicle="sedan2", sensors=SENSORS, speed=15.0).apart == ()


def test_a_run_file_stands_for_exports(tmp_path):
    time, values = drive(SEDAN, 120.0, 15.0, 6)
    rows = "\n".join(f"{t:.2f},{front:.6g},{rear:.6g}" for t, (front, rear, _) in zip(time, values, strict=True))
    (tmp_path / "drive.csv").write_text(f"t,F_az,R_az\n{rows}\n", encoding="utf-8")
    sensors = "".join(f"  {name}: {{body: body, x: {x} m, channels: {{acceleration: {name}_az}}}}\n" for name, x in PLACES.items())
    (tmp_path / "drive.yaml").write_text(
        "vehicle: sedan2\nspeed: 15 m/s\nduration: 119 s\nroad: [{iso8608: {class: C, seed: 1}}]\nrecording: drive.csv\nsensors:\n"
        + sensors,
        encoding="utf-8",
    )
    found = vehgen.transmissibility(tmp_path / "drive.yaml")
    assert found.channels == ("F_az", "R_az")
    assert found.apart == ()
    assert vehgen.transmissibility(vehgen.load_run(tmp_path / "drive.yaml")) == found
    with pytest.raises(InputError, match="a run file says itself where its sensors are"):
        vehgen.transmissibility(tmp_path / "drive.yaml", sensors=SENSORS)


def test_a_result_survives_json_and_shows_itself(right):
    again = Transmissibility.from_dict(json.loads(json.dumps(right.to_dict(), allow_nan=False)))
    assert again == right
    assert isinstance(again.plot(), Figure)
    columns, rows = again.table()
    assert {len(row) for row in rows} == {len(columns)}


@pytest.mark.thorough
def test_the_command_writes_its_result_and_draws_it_again(exports, tmp_path, capsys):
    words = [word for sensor in ("F:body=body,x=1.1", "R:body=body,x=-1.5") for word in ("--sensor", sensor)]
    out = tmp_path / "out"
    assert main(["transmissibility", *map(str, exports), "--vehicle", "sedan2", *words, "--out", str(out)]) == 0
    text = capsys.readouterr().out
    for part in ("R_az over F_az", "within", "this cannot tell the scale of masses", "this can tell whether the model", "wrote"):
        assert part in text
    picture = (out / "transmissibility.png").read_bytes()
    assert main(["report", str(out / "transmissibility.json"), "--out", str(tmp_path / "again")]) == 0
    assert (tmp_path / "again" / "transmissibility.png").read_bytes() == picture
    capsys.readouterr()
    assert main(["transmissibility", *map(str, exports), "--json", "--out", str(tmp_path / "alone")]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["files"][0].endswith("transmissibility.json")
    assert "h1" not in data["ratios"][0]
    assert len(data["ratios"][0]["bands"]) == 6


@pytest.mark.thorough
@pytest.mark.skipif(not SHARED.is_dir(), reason="the recordings are not here")
def test_two_real_roads_give_one_ratio():
    """Roads of middling and bad quality at 12 m/s, 1 phone: the level cancels, so that pitch rate over acceleration is the same."""
    found = [vehgen.transmissibility([SHARED / name], forward="y") for name in ("rsq_q2_01.zip", "rsq_q3_02.zip")]
    for one, other in zip(found[0].ratios[0].bands, found[1].ratios[0].bands, strict=True):
        assert one.lower < other.upper
        assert other.lower < one.upper
    assert found[0].ratios[0].bands[0].coherence > 0.7
    with pytest.raises(InputError, match="one channel only"):
        vehgen.transmissibility([SHARED / "rsq_q1_00.zip"])


def test_gains_that_are_off_as_sensors_may_be_are_no_difference_to_a_model():
    random, dt, found = np.random.default_rng(0), 0.01, 0
    bands = ((0.5, 2.0), (2.0, 5.0), (5.0, 8.0), (8.0, 12.0), (12.0, 15.0), (15.0, 20.0))
    for _ in range(40):
        shaken = random.standard_normal(round(300 / dt))
        pair = np.column_stack([shaken, (1 + GAIN_RATIO_SIGMA * random.standard_normal()) * shaken])
        lines = segment_transforms(pair + 0.03 * random.standard_normal(pair.shape), dt, 8.0).between(0.5, 20.0)
        estimate = estimate_ratio(lines.spectra(), lines.averages(), 0, 1)
        model = np.ones((len(lines.frequency), 2, 2), dtype=complex)
        found += any(band.is_apart for band in compared_ratio("y", "1", lines.frequency, estimate, bands, model, 1, len(bands)).bands)
        other = compared_ratio("y", "1", lines.frequency, estimate, bands, model * [[1, 1.25], [1.25, 1.25**2]], 1, len(bands))
        assert all(band.is_apart for band in other.bands)
    assert found == 0
