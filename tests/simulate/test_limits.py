"""What would cost minutes or gigabytes is refused before the work, at its line and column, with what was found and the limit."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from vehgen.errors import InputError
from vehgen.fit.recording import read_recording
from vehgen.mechanics import derive
from vehgen.road import ConstantSpeed, Hump, Iso8608Road, SpeedHistory, Track, pass_time
from vehgen.simulate import load_run
from vehgen.simulate.budgets import check_population
from vehgen.simulate.run_scenario import make_scenario
from vehgen.simulate.scenario import Scenario
from vehgen.vehicle import load_vehicle, parse_vehicle

ENTRY = "{hump: {shape: half_sine, length: 0.5 m, height: 0.03 m, at: 4 m}}"
HUMP = f"road: [{ENTRY}]\n"
RUN = "vehicle: quarter_car\nspeed: 2 m/s\n" + HUMP

# (what, old text of RUN, new text with the mark @ where the error must point, how the message begins)
CASES = [
    (
        "hump of a thousand kilometres",
        "length: 0.5 m",
        "length: @1e6 m",
        "the length of a hump is 0.001 to 50 m in magnitude, found 1e+06 m",
    ),
    ("hump of a hundred metres", "length: 0.5 m", "length: @100 m", "the length of a hump is 0.001 to 50 m"),
    ("hump of a mountain", "height: 0.03 m", "height: @-30 m", "the height of a hump is at most 2 m in magnitude, found -30 m"),
    ("hump in space", "at: 4 m", "at: @1e12 m", "a place along the road is at most 1e+06 m"),
    ("creeping", "2 m/s", "@1e-6 m/s", "a speed is 0.01 to 150 m/s in magnitude, found 1e-06 m/s: a question of units?"),
    ("flying", "2 m/s", "@1e6 m/s", "a speed is 0.01 to 150 m/s"),
    ("footprint", "road:", "footprint: @1e9 m\nroad:", "a tyre's footprint is 0.001 to 2 m"),
    ("duration of nothing", "road:", "duration: @1e-9 s\nroad:", "a duration is 0.001 to 100000 s"),
    ("sample of years", "road:", "sample: @1e9 s\nroad:", "the time between samples is 1e-06 to 100 s"),
    ("step", "road:", "step: @1e-12 s\nroad:", "a step is 1e-06 to 0.1 s"),
    ("no sample kept", "road:", "duration: @4 ms\nroad:", "a run of 0.004 s keeps no sample: they are 0.01 s apart"),
    ("derived steps", "2 m/s\n" + HUMP, "@0.01 m/s\n" + HUMP.replace("at: 4", "at: 1000"), "a run has at most 10000000 steps; 100053 s"),
    (
        "no end in sight",
        "2 m/s\n" + HUMP,
        "0.2 m/s\n@" + HUMP.replace("at: 4", "at: 1e6"),
        "the last axle has not left the road's last hump",
    ),
    ("numbers in memory", "road:", "duration: @9000 s\nsample: 1 ms\nroad:", "9000000 steps of this vehicle are"),
    ("random road", "2 m/s\n" + HUMP, "100 m/s\nduration: 1000 s\nroad: [{@iso8608: {class: A}}]\n", "random roads are made up to 50000 m"),
    (
        "random roads",
        HUMP,
        "duration: 300 s\nroad: [{@iso8608: {class: A}}"
        + "".join(f", {{iso8608: {{class: B, seed: {i}}}}}" for i in range(1, 101))
        + "]\n",
        "random roads are made up to 50000 m",
    ),
    (
        "negative seed",
        HUMP,
        "duration: 1 s\nroad: [{iso8608: {class: A, seed: @-1}}]\n",
        "input should be greater than or equal to 0 (found '-1')",
    ),
    (
        "endless seed",
        HUMP,
        "duration: 1 s\nroad: [{iso8608: {class: A, seed: @9223372036854775808}}]\n",
        "input should be less than or equal to 9223372036854775807",
    ),
    ("a thousand humps", HUMP, "road: @[" + ENTRY + 999 * f", {ENTRY}" + "]\n", "list should have at most 200 items"),
    (
        "radius of an edge",
        "half_sine, length: 0.5 m",
        "rectangle, radius: @1 mm, length: 0.5 m",
        "the edges of a rectangle of height 0.03 m need a radius",
    ),
    ("long path", "road:", "recording: @" + "a" * 5000 + "\nroad:", "string should have at most 1000 characters"),
    (
        "channel of time",
        HUMP,
        HUMP + "sensors: {A: {body: body, channels: {@acceleration: t}}}\n",
        "a channel cannot be named 't', as the column of the time is",
    ),
    (
        "many channels",
        HUMP,
        HUMP + "@sensors:\n" + "".join(f"  A{i}: {{body: body}}\n" for i in range(251)),
        "502 channels; a run has at most 500",
    ),
    ("far sensor", HUMP, HUMP + "sensors: {A: {body: body, x: @1e9 m}}\n", "a length on a vehicle is at most 1000 m"),
]


def scenario_of(path: Path) -> Scenario:
    run = load_run(path)
    model = derive(run.vehicle, run.outputs())
    return make_scenario(run, model, model.values())


@pytest.mark.parametrize(("old", "new", "message"), [case[1:] for case in CASES], ids=[case[0] for case in CASES])
def test_refused_at_its_place(old, new, message, tmp_path, monkeypatch):
    assert old in RUN
    text = RUN.replace(old, new, 1)
    place = None
    if "@" in text:
        before, _, after = text.partition("@")
        place = f"{before.count(chr(10)) + 1}:{len(before) - before.rfind(chr(10))}"
        text = before + after
    (tmp_path / "run.yaml").write_text(text)
    monkeypatch.setattr(Hump, "spectral_nulls", None)
    with pytest.raises(InputError) as caught:
        scenario_of(tmp_path / "run.yaml")
    assert caught.value.message.startswith(message)
    assert caught.value.position is not None
    if place:
        assert f"{caught.value.position.line}:{caught.value.position.column}" == place


WORST = {
    "hang": RUN.replace("2 m/s", "1e-6 m/s"),
    "crawl": RUN.replace("2 m/s", "0.01 m/s").replace("at: 4 m", "at: 1e6 m"),
    "random road": "vehicle: quarter_car\nspeed: 100 m/s\nduration: 1e5 s\nstep: 0.1 s\nroad: [{iso8608: {class: A}}]\n",
    "device": RUN.replace("shape: half_sine, length: 0.5 m, height: 0.03 m", "shape: points, file: /dev/zero"),
    "footprint": RUN.replace("road", "footprint: 0.2 m\nduration: 1e5 s\nsample: 100 s\nstep: 0.1 s\nroad").replace("2 m/s", "140 m/s"),
}


@pytest.mark.thorough
@pytest.mark.skipif(sys.platform != "linux", reason="needs limits of memory and time")
@pytest.mark.parametrize("name", sorted(WORST))
def test_the_worst_are_refused_within_little_memory_and_time(name, tmp_path):
    (tmp_path / "run.yaml").write_text(WORST[name])
    code = (
        "import resource, sys\n"
        "from vehgen.errors import InputError\n"
        "from vehgen.mechanics import derive\n"
        "from vehgen.simulate import load_run\n"
        "from vehgen.simulate.run_scenario import make_scenario\n"
        "used = int(open('/proc/self/statm').read().split()[0]) * resource.getpagesize()\n"
        "seconds = int(sum(resource.getrusage(resource.RUSAGE_SELF)[:2])) + 6\n"
        "resource.setrlimit(resource.RLIMIT_AS, (used + 2**28, used + 2**28))\n"
        "resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))\n"
        "try:\n"
        "    run = load_run('run.yaml')\n"
        "    model = derive(run.vehicle, run.outputs())\n"
        "    make_scenario(run, model, model.values())\n"
        "except InputError as error:\n"
        "    sys.exit(f'refused {error.position}')\n"
    )
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    found = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False, env=environment)
    assert found.stderr.startswith("refused run.yaml:"), found.stderr[-500:]


def test_nulls_cost_nothing_until_they_are_asked_for(tmp_path, monkeypatch):
    (tmp_path / "run.yaml").write_text(RUN)
    asked = []
    monkeypatch.setattr(Hump, "spectral_nulls", lambda self, speed, f_max: asked.append(speed) or np.array([6.0]))
    scenario = scenario_of(tmp_path / "run.yaml")
    assert asked == []
    assert scenario.nulls == scenario.nulls == (6.0,)
    assert asked == [pytest.approx(2.0)]


def test_nulls_of_many_humps_are_sought_among_few_lobes(tmp_path, monkeypatch):
    sought = []
    monkeypatch.setattr(Hump, "spectral_nulls", lambda self, speed, f_max: sought.append(f_max * self.length / speed) or np.array([]))
    for count, most in ((1, 30.0 * 50.0 / 0.5), (200, 2000.0)):
        humps = ", ".join(f"{{hump: {{shape: half_sine, length: 50 m, height: 1 cm, at: {i} m}}}}" for i in range(count))
        (tmp_path / "run.yaml").write_text(f"vehicle: quarter_car\nspeed: 0.5 m/s\nduration: 1 s\nroad: [{humps}]\n")
        sought.clear()
        assert scenario_of(tmp_path / "run.yaml").nulls == ()
        assert len(sought) == count
        assert sum(sought) <= min(most, 2000.0) * (1 + 1e-9)


@pytest.mark.parametrize(("length", "speed"), [(0.5, 2.0), (0.37, 1.7), (3.0, 5.0), (50.0, 0.5)])
def test_nulls_of_a_half_sine_are_where_they_are_known_to_be(length, speed):
    found = Hump.from_shape("half_sine", 0.0, length, 0.1).spectral_nulls(speed, 30.0)
    lobes = np.arange(1.5, min(30.0 * length / speed, 500.0), 1.0)
    np.testing.assert_allclose(found[: len(lobes)], lobes * speed / length, atol=6e-4 * speed / length)


def test_a_long_road_is_averaged_piece_by_piece_alike(monkeypatch):
    road = Iso8608Road("C", 3, 400.0)
    s = np.linspace(0.0, 390.0, 4000).reshape(2, 2000)
    whole = Track((road,), 0.24).height(s)
    monkeypatch.setattr("vehgen.road.track._PIECE_LENGTH_M", 37.0)
    np.testing.assert_allclose(Track((road,), 0.24).height(s), whole, atol=1e-12)


@pytest.mark.parametrize("speed", [ConstantSpeed(1e-9), SpeedHistory(np.array([0.0, 1.0]), np.array([1e-9, 1e-9]))])
def test_the_time_of_a_pass_is_found_or_refused(speed):
    track = Track((Hump.from_shape("half_sine", 1e6, 0.5, 0.03),))
    assert pass_time(track, ConstantSpeed(2.0), np.zeros(1)) == pytest.approx(500_000.25, abs=1e-5)
    with pytest.raises(InputError, match="has not left the road's last hump"):
        pass_time(track, speed, np.zeros(1))


def test_a_population_that_fills_the_memory_is_refused():
    check_population(300, 1000, 10)
    with pytest.raises(InputError, match=r"100000 individuals with 10000 samples of 10 channels are 1e\+10 numbers"):
        check_population(100_000, 10_000, 10)


def carried(count: int) -> str:
    bodies = "".join(f"  b{i}: {{mass: 1 kg, motions: [], carried_by: {{body: b{i - 1}, x: 1 m}}}}\n" for i in range(1, count))
    return (
        "bodies:\n  b0: {mass: 1 t, motions: [heave, pitch], pitch_inertia: 1 t m^2}\n"
        + bodies
        + "axles: {front: {body: b0, tyre: {k: 1 MN/m}}}\n"
    )


@pytest.mark.thorough
def test_a_thousand_bodies_are_refused_and_a_hundred_are_derived():
    with pytest.raises(InputError, match="1:1: 1000 bodies; a vehicle has at most 100"):
        parse_vehicle(carried(1000), "")
    model = derive(parse_vehicle(carried(100)))
    mass = model.numeric(model.values()).M
    assert mass[0, 0] == pytest.approx(1000 + 99)


def test_singular_stiffness_has_its_place():
    from vehgen.mechanics import static_loads

    vehicle = parse_vehicle("bodies:\n  free: {mass: 1 kg, motions: [heave]}\n", "a.yaml")
    with pytest.raises(InputError, match=r"^a\.yaml:2:3: singular stiffness: nothing holds heave\.free"):
        static_loads(derive(vehicle))


def test_an_unreadable_folder_of_a_recording_has_the_place_of_its_name(tmp_path, monkeypatch):
    (tmp_path / "run.yaml").write_text(RUN + "sensors: {A: {body: body}}\nrecording: folder/data.csv\n")
    run = load_run(tmp_path / "run.yaml")
    stat = os.stat

    def refuse(path, **options):
        if Path(path).name == "data.csv":
            raise PermissionError(13, "Permission denied")
        return stat(path, **options)

    monkeypatch.setattr(os, "stat", refuse)
    with pytest.raises(InputError, match=r"run\.yaml:5:12: cannot read .*data\.csv: Permission denied"):
        read_recording(run)


def test_numbers_beyond_measure_in_a_recording_are_refused(tmp_path):
    rows = "".join(f"{i / 100},{i % 7},{'1e300' if i == 40 else i % 5}\n" for i in range(100))
    (tmp_path / "data.csv").write_text("t,A_acceleration,A_pitch_rate\n" + rows)
    (tmp_path / "run.yaml").write_text(RUN + "sensors: {A: {body: body}}\nrecording: data.csv\n")
    with pytest.raises(InputError, match=r"data\.csv:42:3: '1e300' in column 'A_pitch_rate' is beyond"):
        read_recording(load_run(tmp_path / "run.yaml"))


@pytest.mark.parametrize("name", ["quarter_car", "tractor5", "sedan2"])
def test_bundled_models_and_their_sets_are_within_limits(name):
    assert load_vehicle(name).bodies
