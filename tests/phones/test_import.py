"""Phone exports of known passes, made by scipy alone (docs/examples/phones/make_exports.py), imported whole."""

import importlib
import importlib.util
import json
import re
import zipfile
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from vehgen.commands import main
from vehgen.fit.nuisances import Nuisances
from vehgen.fit.recording import read_recording
from vehgen.phones.gps import USUAL_SPEED_SHARE
from vehgen.phones.run_text import USUAL_CLOCK_S, _clock_deviation
from vehgen.simulate import Simulator, load_run, make_scenario
from vehgen.simulate.run_file.acquisition import channel_chains

from .exports import write_zip

FOLDER = Path(__file__).parents[2] / "docs" / "examples" / "phones"
L1 = "L1:body=tractor,behind=axle1,distance=-0.29,forward=y"
L2 = "L2:body=semitrailer,behind=fifth_wheel,distance=9.115,forward=x"
HUMP = ("--hump", "half_sine,length=0.5,height=0.03")


@pytest.fixture(autouse=True)
def _figures(request, monkeypatch):
    """Figures take long to draw; one test looks at them."""
    if "assumed" not in request.node.name:
        monkeypatch.setattr(importlib.import_module("vehgen.report"), "save_figure", lambda figure, path: None)


def command(out, exports, *options, sensors=(L1, L2), road=HUMP):
    places = [word for sensor in sensors for word in ("--sensor", sensor)]
    return main(["import", *map(str, exports), "--vehicle", "tractor5.yaml", *places, *road, "--out", str(out), *options])


def both(name):
    return [FOLDER / f"{name}_phone1.zip", FOLDER / f"{name}_phone2.zip"]


def facts(capsys, *arguments, **more):
    assert command(*arguments, "--json", **more) == 0
    return json.loads(capsys.readouterr().out)


def refusal(capsys, *arguments, **more):
    assert command(*arguments, **more) == 2
    error = capsys.readouterr().err
    assert error.startswith("error: ")
    assert error.count("\n") == 1
    return error


def changed(path, source, change):
    """Write a zip whose files are those of another, each text put through `change(name, text)`; None leaves it out."""
    with zipfile.ZipFile(source) as archive:
        files = {name: change(name, archive.read(name).decode()) for name in archive.namelist()}
    return write_zip(path, {name: text for name, text in files.items() if text is not None})


def rows(change):
    """Return a change of the data lines of an acceleration file."""

    def apply(name, text):
        if "Acceler" not in name:
            return text
        head, *lines = text.splitlines()
        return "\n".join([head, *change(lines)]) + "\n"

    return apply


@pytest.mark.parametrize(
    ("name", "road", "arrivals"),
    [
        ("hump_2ms", HUMP, (6.0, 7.7)),
        ("hump_3ms", HUMP, (4.0, 5.7)),
        ("road_3ms", ("--profile", str(FOLDER / "road.csv")), (3.0, 4.7)),
    ],
)
def test_clocks_speed_tilt_and_noise_are_found(tmp_path, capsys, name, road, arrivals):
    """The numbers of make_exports.py: phone 2 began 1.7 s earlier, tilts of 3.6 and 4.3 deg, noise of 0.012 m/s^2 and 0.0007 rad/s."""
    found = facts(capsys, tmp_path / "run.yaml", both(name), "--speed", "axles", road=road)
    speed = 3.0 if "3ms" in name else 2.0
    assert found["speed"] == pytest.approx(speed, rel=0.003)
    assert found["warnings"] == []
    for phone, arrival, tilt in zip(found["phones"], arrivals, (3.6, 4.27), strict=True):
        assert phone["zero"] + (found["at"] or 0.0) / found["speed"] == pytest.approx(arrival, abs=0.008)
        assert phone["tilt"] == pytest.approx(tilt, abs=0.35)
        for channel, sigma in phone["noise"].items():
            assert sigma["sigma"] == pytest.approx(0.0125 if channel.endswith("az") else 0.00072, rel=0.15)
    assert "by the apps' own clocks it crossed" in "".join(found["phones"][1]["notes"])
    run = load_run(tmp_path / "run.yaml")
    measurement = read_recording(run)
    assert measurement.time[0] == 0.0
    assert measurement.dt == pytest.approx(0.01)
    assert [item.name for item in measurement.channels] == ["L1_az", "L1_q", "L2_az", "L2_q"]


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("name", "options", "road", "count"),
    [
        ("hump_2ms", (), HUMP, 8),
        ("hump_3ms", (), HUMP, 5),
        ("hump_2ms", ("--speed", "axles"), HUMP, 0),
        ("road_3ms", (), ("--profile", str(FOLDER / "road.csv")), 0),
    ],
)
def test_a_run_states_how_well_a_gps_knows_its_speed(tmp_path, capsys, name, options, road, count):
    """A reading is off by 0.1 m/s; the median of so many by that over the root of their number, unless that is below the usual 1 %."""
    found = facts(capsys, tmp_path / "run.yaml", both(name), *options, road=road)
    assert (found["speed_deviation"] is None) == ("axles" in options)
    stated = load_run(tmp_path / "run.yaml").file.uncertainty
    assert Nuisances().speed == USUAL_SPEED_SHARE
    if count:
        assert f"of {count} GPS readings" in found["speed_source"]
        assert found["speed_deviation"] == pytest.approx(0.1 / count**0.5)
        assert stated.speed.value == pytest.approx(0.1 / count**0.5, rel=0.02)
    else:
        assert stated is None or stated.speed is None


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("name", "road", "low", "high"),
    [("hump_2ms", HUMP, 0.025, 0.04), ("hump_3ms", HUMP, 0.017, 0.027), ("road_3ms", ("--profile", str(FOLDER / "road.csv")), None, None)],
)
def test_clocks_of_phones_that_feel_the_hump_seconds_apart_are_known_less_well(tmp_path, capsys, name, road, low, high):
    """They are laid over an answer at one speed, and a driver's wanders: by 1 %, 9 m of way between them err by 30 ms at 2 m/s."""
    facts(capsys, tmp_path / "run.yaml", both(name), road=road)
    stated = load_run(tmp_path / "run.yaml").file.uncertainty
    clock = None if stated is None else stated.clock
    assert Nuisances().clock == USUAL_CLOCK_S
    assert (clock is None) if low is None else (low < clock < high)


@pytest.mark.parametrize("loudness", [0.0, 0.2, 0.35])
def test_a_rough_road_does_not_bring_loud_moments_closer(loudness):
    """Two phones feel a hump 6 s apart; the road shakes both all the way."""
    time = np.arange(0.0, 12.5, 0.01)
    hump = np.column_stack([np.where(np.abs(time - at) < 0.5, np.sin(40 * time), 0.0) for at in (3.0, 9.0)])
    values = hump + loudness * np.sin(np.outer(time, [31.0, 37.0]))
    trusted = SimpleNamespace(is_trusted=True)
    outputs = [SimpleNamespace(outputs=lambda pitched, name=name: [SimpleNamespace(name=name)]) for name in ("L1_az", "L2_az")]
    phones = [SimpleNamespace(phone=SimpleNamespace(sensor=sensor), match=trusted) for sensor in outputs]
    imported = SimpleNamespace(at=0.0, phones=phones, channels=["L1_az", "L2_az"], values=values, time=time)
    assert _clock_deviation(imported) == pytest.approx(np.hypot(0.01, 0.007 * 6.0), rel=0.05)


@pytest.mark.thorough
def test_where_the_vehicle_fits_too_badly_for_its_axles_to_tell_the_speed_the_gps_does(tmp_path, capsys, monkeypatch):
    by_gps = facts(capsys, tmp_path / "gps.yaml", both("hump_2ms"))
    monkeypatch.setattr("vehgen.phones.clocks.TRUSTED", 0.9999)
    found = facts(capsys, tmp_path / "run.yaml", both("hump_2ms"), "--speed", "axles")
    assert (found["speed"], found["speed_deviation"]) == (by_gps["speed"], by_gps["speed_deviation"])
    assert any("so the GPS's stands" in warning for warning in found["warnings"])


def without_speeds(text):
    """Return a file of a GPS that told none: the apps write -1."""
    head, *lines = [line.split(",") for line in text.splitlines()]
    column = next(i for i, name in enumerate(head) if name == "speed" or "Velocity" in name)
    told = [[*line[:column], "-1.0", *line[column + 1 :]] for line in lines]
    return "".join(",".join(line) + "\n" for line in (head, *told))


@pytest.mark.thorough
@pytest.mark.parametrize(("gps", "given"), [(lambda text: text, "axles"), (lambda text: None, "2.00"), (without_speeds, "2.00")])
def test_a_wrong_speed_is_told_with_what_to_give_instead(tmp_path, capsys, gps, given):
    """Without a GPS's speed, near which the marks would tell it, the speed by the axles is refused."""
    exports = [
        changed(tmp_path / path.name, path, lambda name, text: gps(text) if "Location" in name else text) for path in both("hump_2ms")
    ]
    found = facts(capsys, tmp_path / "run.yaml", exports, "--speed", "2.08")
    [warning] = [text for text in found["warnings"] if "the axles' marks fit" in text]
    assert f"give `{given}" in warning
    again = warning.split("`")[1]
    assert facts(capsys, tmp_path / "again.yaml", exports, "--speed", again)["speed"] == pytest.approx(2.0, rel=0.005)


def test_the_recording_is_the_true_vehicles_answer(tmp_path, capsys):
    """With the true parameters, and the last milliseconds of each clock, nothing is left but noise: signs, axes and scales are right."""
    assert command(tmp_path / "run.yaml", both("hump_2ms"), "--speed", "2.0") == 0
    capsys.readouterr()
    specification = importlib.util.spec_from_file_location("make_exports", FOLDER / "make_exports.py")
    script = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(script)
    _, _, _, _, true = script.matrices()
    run = load_run(tmp_path / "run.yaml")
    measured = read_recording(run)
    simulator = Simulator(run.vehicle, run.outputs())
    values = {**run.values(), **true}
    scenario = make_scenario(run, simulator.model, simulator.model.values(overrides=values))
    parameters = simulator.parameters(values)
    residuals = []
    for delay in np.arange(-0.008, 0.00801, 0.0005):
        response = simulator.run(parameters, scenario.adjusted(delay=float(delay))).responses[0]
        residuals.append((measured.values - response[: len(measured.time)]).std(axis=0))
    best = np.min(residuals, axis=0)
    assert best == pytest.approx([0.012, 0.0007, 0.012, 0.0007], rel=0.2)
    assert (np.abs(measured.values).max(axis=0) > 40 * best).all()  # so the agreement is not for want of a signal


def test_clocks_without_metadata_minutes_apart(tmp_path, capsys):
    """Phone 2's stamps are no epoch and its clock begins 300 s later."""

    def without_epoch(name, text):
        head, *lines = text.splitlines()
        if "seconds_elapsed" not in head:
            return None if "Metadata" in name else text
        cells = [line.split(",") for line in lines]
        return "\n".join([head, *(",".join(["0", f"{float(c[1]) + 300:.6f}", *c[2:]]) for c in cells)]) + "\n"

    other = changed(tmp_path / "b.zip", both("hump_2ms")[1], without_epoch)
    sensors = (L1, L2 + ",up=z")
    found = facts(capsys, tmp_path / "run.yaml", [both("hump_2ms")[0], other], sensors=sensors)
    assert found["phones"][1]["zero"] - found["phones"][0]["zero"] == pytest.approx(301.7, abs=0.008)
    assert "the apps' clocks cannot be compared" in "".join(found["phones"][1]["notes"])


def test_clocks_that_disagree_are_reported(tmp_path, capsys):
    late = changed(tmp_path / "a.zip", both("hump_2ms")[0], lambda name, text: text.replace("179000", "179001") if "time" in name else text)
    found = facts(capsys, tmp_path / "run.yaml", [late, both("hump_2ms")[1]])
    assert "are both of one pass?" in found["warnings"][0]


def test_a_vehicle_that_does_not_fit_falls_back_to_the_onset(tmp_path, capsys):
    """A phone said to lie backwards does not fit, and the warning says where to look."""
    sensors = (L1.replace("forward=y", "forward=-y"), L2)
    found = facts(capsys, tmp_path / "run.yaml", both("hump_2ms"), sensors=sensors)
    assert "check vehicle, place and forward axis" in found["warnings"][0]
    assert found["phones"][0]["zero"] + found["at"] / found["speed"] == pytest.approx(6.0, abs=0.05)


def test_a_phone_that_writes_gravity_downwards_lay_face_down(tmp_path, capsys):
    """Phyphox is known to write +9.8 face up, so -9.8 is face down; that this one was not shows in a bad fit."""

    def turned(lines):
        return [",".join([*line.split(",")[:3], f"-{line.split(',')[3]}"]) for line in lines]

    found = facts(capsys, tmp_path / "run.yaml", [changed(tmp_path / "a.zip", both("hump_2ms")[0], rows(turned))], sensors=(L1,))
    assert "check vehicle, place and forward axis" in found["warnings"][0]


def test_clipping_is_reported(tmp_path, capsys):
    def clip(lines):
        return [
            ",".join([*cells[:3], "1.250000E1" if float(cells[3]) > 12.5 else cells[3]]) for cells in (line.split(",") for line in lines)
        ]

    found = facts(capsys, tmp_path / "run.yaml", [changed(tmp_path / "a.zip", both("hump_2ms")[0], rows(clip))], sensors=(L1,))
    assert "acceleration z is clipped at 12.5 m/s^2" in found["warnings"][0]


def test_a_second_pass_is_told(tmp_path, capsys):
    def twice(name, text):
        rest = [line.partition(",") for line in text.splitlines()[1:]] if "/" not in name else []
        return text + "".join(f"{float(time) + 20},{values}\n" for time, _, values in rest)

    export = changed(tmp_path / "a.zip", both("hump_2ms")[0], twice)
    assert "as loud at" in facts(capsys, tmp_path / "run.yaml", [export], sensors=(L1,))["warnings"][0]
    assert facts(capsys, tmp_path / "run.yaml", [export], sensors=(L1 + ",to=19.9",))["warnings"] == []


def scaled(factor):
    """Return a change of the last three numbers of every line, its accelerations."""

    def change(lines):
        cells = (line.split(",") for line in lines)
        return [",".join([*times, *(f"{factor * float(cell):.9e}" for cell in own)]) for *times, x, y, z in cells for own in [(x, y, z)]]

    return rows(change)


def test_a_phone_whose_gain_is_wrong_is_read_with_a_warning(tmp_path, capsys):
    """Its accelerations come out as much too large as its gravity; all else is found as without."""
    true = facts(capsys, tmp_path / "true.yaml", both("hump_2ms"))
    found = facts(capsys, tmp_path / "run.yaml", [both("hump_2ms")[0], changed(tmp_path / "b.zip", both("hump_2ms")[1], scaled(1.24))])
    assert true["warnings"] == []
    (warning,) = found["warnings"]
    assert warning.startswith("b.zip: at rest gravity reads 12.")
    assert float(warning.partition("a gain of ")[2].partition(",")[0]) == pytest.approx(1.24, rel=0.01)
    assert found["phones"][1]["zero"] == pytest.approx(true["phones"][1]["zero"], abs=1e-3)
    own, others = (np.genfromtxt(tmp_path / f"{name}_recording.csv", delimiter=",", names=True) for name in ("run", "true"))
    assert np.linalg.lstsq(others["L2_az"][:, None], own["L2_az"], rcond=None)[0] == pytest.approx(1.24, rel=0.01)
    assert own["L1_az"] == pytest.approx(others["L1_az"], abs=1e-6)


def test_a_phone_that_writes_another_unit_is_refused_with_it(tmp_path, capsys):
    export = changed(tmp_path / "a.zip", both("hump_2ms")[0], scaled(10.0))
    assert "is its unit m/s^2?" in refusal(capsys, tmp_path / "run.yaml", [export], sensors=(L1,))
    export = changed(tmp_path / "b.zip", both("hump_2ms")[0], scaled(1 / 0.3048))
    assert "it seems to be in ft/s^2; these files are read in m/s^2" in refusal(capsys, tmp_path / "run.yaml", [export], sensors=(L1,))


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("change", "options", "message"),
    [
        (rows(lambda lines: lines[::40]), (), "was logged at 2.51 Hz; at least 50 Hz is needed"),
        (rows(lambda lines: lines[:700] + lines[760:]), (), "samples for 0.6"),
        (rows(lambda lines: lines[:590]), (), "shows no hump"),
        (rows(lambda lines: lines[:1000]), (), "the recording ends"),
        (rows(lambda lines: lines[560:]), (), "no 1 s of quiet before"),
        (lambda name, text: None if "Location" in name else text, (), "recorded no GPS speed; give"),
        (lambda name, text: text, ("--lead", "40"), "the lead must be"),
        (lambda name, text: text, ("--rate", "30"), "the rate must be"),
        (lambda name, text: text, ("--speed", "fast"), "--speed: expected a number in m/s or 'axles', found 'fast'"),
        (lambda name, text: text, ("--speed", "0"), "--speed must be a positive number"),
    ],
)
def test_recordings_that_cannot_be_used(tmp_path, capsys, change, options, message):
    export = changed(tmp_path / "a.zip", both("hump_2ms")[0], change)
    assert message in refusal(capsys, tmp_path / "run.yaml", [export], *options, sensors=(L1,))
    assert not (tmp_path / "run.yaml").exists()


@pytest.mark.parametrize(
    ("sensors", "road", "message"),
    [
        (("L1:body=tractor",), HUMP, "say with --forward which of its axes pointed forward"),
        ((L1, L2), HUMP, "1 exports and 2 sensors"),
        (("L1:body=tracter",), HUMP, "tractor5 has no body 'tracter'; did you mean 'tractor'?"),
        (("L1:body=tractor,behind=axle9",), HUMP, "did you mean"),
        (("L1:bdy=tractor",), HUMP, "unknown key 'bdy'; did you mean 'body'?"),
        (("L1:body=tractor,x=abc",), HUMP, "--sensor L1: x=abc"),
        (("tractor",), HUMP, "expected NAME:body=BODY"),
        ((L1,), ("--hump", "half_sin,length=0.5,height=0.03"), "did you mean 'half_sine'?"),
        ((L1,), ("--hump", "half_sine,length=0.5"), "a half_sine hump lacks the key height"),
        ((L1,), ("--hump", "half_sine,length=5 kg,height=0.03"), "--hump length: expected a finite number in m"),
        ((L1,), ("--profile", "none.csv"), "no file none.csv"),
    ],
)
def test_options_that_cannot_be_used(tmp_path, capsys, sensors, road, message):
    assert message in refusal(capsys, tmp_path / "run.yaml", both("hump_2ms")[:1], sensors=sensors, road=road)


def test_a_plain_csv_in_the_vehicles_axes(tmp_path, capsys):
    """What an import wrote can be imported again, and stays what it was."""
    assert command(tmp_path / "run.yaml", both("hump_2ms")[:1], sensors=(L1,)) == 0
    columns = ("--columns", "time=t,acceleration=L1_az,pitch_rate=L1_q", "--speed", "2")
    place = ("L1:body=tractor,behind=axle1,distance=-0.29 m",)
    assert command(tmp_path / "again.yaml", [tmp_path / "run_recording.csv"], *columns, sensors=place) == 0
    capsys.readouterr()
    first, again = (np.loadtxt(tmp_path / f"{name}_recording.csv", delimiter=",", skiprows=1) for name in ("run", "again"))
    late = load_run(tmp_path / "run.yaml").file.road[0].hump.at - load_run(tmp_path / "again.yaml").file.road[0].hump.at
    shifted = np.interp(again[:, 0] + late / 2.0, first[:, 0], first[:, 1])
    assert np.corrcoef(shifted[:900], again[:900, 1])[0, 1] > 0.995
    assert "plain CSV" in (tmp_path / "again.yaml").read_text(encoding="utf-8")


def test_the_run_file_says_what_was_assumed(tmp_path, capsys):
    assert command(tmp_path / "deep" / "run.yaml", both("hump_2ms"), "--footprint", "0.2") == 0
    text = (tmp_path / "deep" / "run.yaml").read_text(encoding="utf-8")
    for words in (
        "readings, ", "the axles' marks fit", "put on 100 Hz", "tilted 3.", "sign reversed by the app", "noise sigma", "47-50 Hz band",
        "ahead of that of", "footprint: 0.2 m", "vehicle: tractor5.yaml",
    ):  # fmt: skip
        assert words in text
    assert (tmp_path / "deep" / "run.png").stat().st_size > 10_000
    assert "hump_2ms_phone2.zip (Sensor Logger)" in capsys.readouterr().out


@pytest.mark.parametrize(("rate", "kept"), [("100", "unknown"), ("50", "ideal")])
def test_the_run_file_says_through_which_low_pass_the_phone_was_put_on_the_grid(tmp_path, capsys, rate, kept):
    """Phones sampled at about 100 Hz: on 100 Hz nobody knows their low-pass, on 50 Hz the import's own stands before all others."""
    assert command(tmp_path / "run.yaml", both("hump_2ms"), "--speed", "2.0", "--rate", rate, "--top", "20") == 0
    capsys.readouterr()
    chains = channel_chains(load_run(tmp_path / "run.yaml"), float(rate))
    assert {chain.filter for chain in chains.values()} == {kept}
    assert {chain.cut_off for chain in chains.values()} == {None if kept == "unknown" else 25.0}


@pytest.mark.thorough
def test_a_phone_that_the_vehicle_matches_badly_is_laid_roughly_or_set_by_its_energy(tmp_path, capsys, monkeypatch):
    """As where a law is missing that the file lacks: the match still tells the time, but its clock less well."""
    good = facts(capsys, tmp_path / "good.yaml", both("hump_2ms"))
    monkeypatch.setattr("vehgen.phones.clocks.TRUSTED", 0.9999)
    rough = facts(capsys, tmp_path / "rough.yaml", both("hump_2ms"))
    assert [phone["zero"] for phone in rough["phones"]] == pytest.approx([phone["zero"] for phone in good["phones"]], abs=1e-6)
    stated = [load_run(tmp_path / name).file.uncertainty.clock for name in ("rough.yaml", "good.yaml")]
    assert stated[0] == stated[1] > 0.03  # of phones so far apart no match tells more
    facts(capsys, tmp_path / "faster.yaml", both("hump_3ms"))
    assert load_run(tmp_path / "faster.yaml").file.uncertainty.clock == pytest.approx(0.03)
    with monkeypatch.context() as later:  # energy set in at once, where the response lets a phone at the rear wait for its own wheel
        later.setattr("vehgen.phones.locating.expected_onset", lambda *known: 2.5)
        waited = facts(capsys, tmp_path / "waited.yaml", both("hump_2ms"))
    assert waited["phones"][0]["zero"] == pytest.approx(good["phones"][0]["zero"], abs=1e-6)
    monkeypatch.setattr("vehgen.phones.locating.ONSET_TOLERANCE_S", 0.0)
    onset = facts(capsys, tmp_path / "onset.yaml", both("hump_2ms"))
    for phone, other in zip(onset["phones"], good["phones"], strict=True):
        assert phone["zero"] != other["zero"]
        assert phone["zero"] == pytest.approx(other["zero"], abs=0.15)


@pytest.mark.thorough
def test_a_hump_that_does_not_stand_out_is_found_where_the_vehicles_answer_is_like_the_recording(tmp_path, capsys, monkeypatch):
    """As a low one after a rough road; else it is refused as what does not stand out."""
    good = facts(capsys, tmp_path / "good.yaml", both("hump_2ms"))
    monkeypatch.setattr("vehgen.phones.hump_event.SMALLEST_CONTRAST", 1000.0)
    found = facts(capsys, tmp_path / "low.yaml", both("hump_2ms"))
    arrivals = [[phone["zero"] + item["at"] / item["speed"] for phone in item["phones"]] for item in (found, good)]
    assert arrivals[0] == pytest.approx(arrivals[1], abs=0.01)
    assert found["speed"] == pytest.approx(good["speed"], rel=0.02)
    told = [any("energy sets in" in note for phone in item["phones"] for note in phone["notes"]) for item in (good, found)]
    assert told == [True, False]
    monkeypatch.setattr("vehgen.phones.clocks.TRUSTED", 0.9999)
    assert "shows no hump" in refusal(capsys, tmp_path / "none.yaml", both("hump_2ms"))


def divided(factor, unit):
    """Return a change of a sensor's file into another unit: `unit` in its headings, or as it was where that is None."""

    def apply(text):
        head, *lines = text.splitlines()
        scaled = [
            ",".join([cells[0], *(f"{float(cell) / factor:.9g}" for cell in cells[1:])]) for cells in (line.split(",") for line in lines)
        ]
        return "\n".join([re.sub(r"\((?!s\))[^()]*\)", f"({unit})", head) if unit else head, *scaled]) + "\n"

    return apply


@pytest.mark.thorough
def test_other_units_of_phyphox_are_read_as_headings_say_and_seen_where_they_do_not(tmp_path, capsys):
    source = FOLDER / "hump_2ms_phone1.zip"
    in_g, in_degrees = divided(9.80665, "g"), divided(np.pi / 180, "°/s")
    stated = changed(tmp_path / "stated.zip", source, lambda name, text: {"A": in_g, "G": in_degrees}.get(name[0], str)(text))
    own, same = (facts(capsys, tmp_path / f"{path.stem}.yaml", [path], "--speed", "2", sensors=(L1,)) for path in (source, stated))
    assert same["warnings"] == own["warnings"] == []
    assert same["phones"][0]["zero"] == pytest.approx(own["phones"][0]["zero"], abs=1e-4)
    silent = changed(tmp_path / "silent.zip", source, lambda name, text: divided(np.pi / 180, None)(text) if name[0] == "G" else text)
    (warning,) = facts(capsys, tmp_path / "silent.yaml", [silent], "--speed", "2", sensors=(L1,))["warnings"]
    assert "L1_q" in warning
    assert "as if in deg/s" in warning


@pytest.mark.thorough
def test_a_profile_in_another_unit_is_seen(tmp_path, capsys):
    road = tmp_path / "road.csv"
    head, *lines = (FOLDER / "road.csv").read_text(encoding="utf-8").splitlines()
    road.write_text("\n".join([head, *(f"{a},{1000 * float(b):.9g}" for a, b in (line.split(",") for line in lines))]), encoding="utf-8")
    found = facts(capsys, tmp_path / "run.yaml", both("road_3ms"), "--speed", "3", road=("--profile", str(road)))
    assert sum("check the units of the recording and of the road" in text for text in found["warnings"]) == 4
