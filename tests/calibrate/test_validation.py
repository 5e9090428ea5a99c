"""A vehicle against recordings: what stands above noise, and above the road that nobody measured."""

import numpy as np
import pytest
import scipy.signal

from tests.fit.recordings import respond, sedan_truth, write_run
from vehgen.calibrate.validation import validate
from vehgen.fit.lead_in import lead_in
from vehgen.fit.trial import load_trials
from vehgen.simulate import simulate

BANDS = [(2.0, 5.0), (8.0, 12.0)]


def shaken(path, sigma, begin):
    """Add motion of 8 to 12 Hz to the accelerations from a moment on [s], as a rough road would."""
    table = path.with_suffix(".csv")
    rows = np.loadtxt(table, delimiter=",", skiprows=1)
    low_pass = scipy.signal.butter(4, (8.0, 12.0), "bandpass", fs=1 / (rows[1, 0] - rows[0, 0]), output="sos")
    motion = scipy.signal.sosfilt(low_pass, np.random.default_rng(5).normal(0, 1.0, (len(rows) + 500, 2)), axis=0)[500:]
    rows[:, [1, 3]] += sigma * motion / motion.std(axis=0) * (rows[:, :1] >= begin)
    np.savetxt(table, rows, delimiter=",", header="t,F_az,F_q,R_az,R_q", comments="")


@pytest.mark.parametrize(("begin", "told"), [(0.0, False), (1.6, True)])
def test_a_road_that_shook_the_vehicle_before_the_hump_is_no_error_of_the_model(tmp_path, begin, told):
    path = write_run(tmp_path, "rough", sedan_truth(), 2.5)
    quiet = {item.channel: item for item in validate("sedan2", path, bands=BANDS).channels}
    assert quiet["F_az"].audible.all()
    shaken(path, 2 * quiet["F_az"].measured_rms[1], begin)
    rough = {item.channel: item for item in validate("sedan2", path, bands=BANDS).channels}
    assert rough["F_az"].errors[1] < quiet["F_az"].errors[1] - 0.2
    assert rough["F_az"].audible.tolist() == [True, told]


def test_a_gyroscope_that_reads_a_little_at_rest_is_no_road(tmp_path):
    path = write_run(tmp_path, "offset", sedan_truth(), 2.5)
    table = path.with_suffix(".csv")
    rows = np.loadtxt(table, delimiter=",", skiprows=1)
    rows[:, 2] += 0.02
    np.savetxt(table, rows, delimiter=",", header="t,F_az,F_q,R_az,R_q", comments="")
    found = {item.channel: item for item in validate("sedan2", path, bands=[(0.1, 2.0)]).channels}
    assert found["F_q"].audible.all()


@pytest.mark.parametrize("at", ["4 m", "4.02 m"])
def test_a_band_may_reach_the_highest_frequency_whatever_comes_before_the_hump(tmp_path, at):
    path = write_run(tmp_path, "run", sedan_truth(), 2.5)
    path.write_text(path.read_text().replace("at: 4 m", f"at: {at}"))
    (trial,) = load_trials([path])
    assert len(lead_in(trial).recording.time) % 2 == (at != "4 m")
    assert len(validate("sedan2", path, bands=[(20.0, 50.0)]).channels) == 4


def changed(path, change):
    """Write a run's table anew, its rows `t, F_az, F_q, R_az, R_q` as `change` makes them."""
    table = path.with_suffix(".csv")
    np.savetxt(
        table, change(np.loadtxt(table, delimiter=",", skiprows=1)), delimiter=",", header="t,F_az,F_q,R_az,R_q", comments="", fmt="%.8g"
    )


def of(number, act):
    def change(rows):
        rows[:, number] = act(rows[:, number])
        return rows

    return change


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (of(3, lambda x: x), []),
        (of(3, lambda x: -x), ["run: R_az reads the vehicle's answer the other way round (correlation -"]),
        (of(3, lambda x: np.roll(x, 80)), ["run: R_az is like the vehicle's answer 0.80 s later (correlation 0."]),
        (of(3, lambda x: np.roll(x, -80)), ["run: R_az is like the vehicle's answer 0.80 s earlier (correlation 0."]),
        (of(3, lambda x: np.random.default_rng(3).normal(0, 0.002, len(x))), ["run: R_az reads 0.00"]),
        (of(3, lambda x: x + 9.81), []),
        (
            lambda rows: rows[:, [0, 3, 2, 1, 4]],
            ["run: F_az and R_az each read what the vehicle answers at the other's place: are they exch"],
        ),
    ],
    ids=["as it is", "turned", "late", "early", "dead", "with gravity", "exchanged"],
)
def test_a_channel_that_is_another_than_the_vehicles_answer_is_told(tmp_path, change, said):
    path = write_run(tmp_path, "run", sedan_truth(), 2.5)
    changed(path, change)
    doubts = validate("sedan2", path, bands=BANDS).doubtful_channels()
    assert [doubt[: len(begin)] for doubt, begin in zip(doubts, said, strict=True)] == said


@pytest.mark.parametrize(
    ("begin", "seed", "said"),
    [
        (0.0, 0, []),
        (60.0, 0, ["run: F_az is like the vehicle's answer 6.00 s earlier (correlation 0.9"]),
        (80.0, 0, ["run: F_az is like the vehicle's answer 8.00 s earlier (correlation 0.9"]),
        (0.0, 1, ["run: F_az is nowhere like the vehicle's answer (correlation up to 0."]),
    ],
)
def test_a_recording_of_another_part_of_a_road_is_told_from_one_of_another_road(tmp_path, begin, seed, said):
    """At 10 m/s, from where the stated road begins on, or metres further."""
    p = sedan_truth()
    profile = np.arange(0.0, 500.0, 0.05)
    for name, number in (("stated", 0), ("driven", seed)):
        heights = scipy.signal.lfilter([1.0], [1.0, -0.99], np.random.default_rng(number).standard_normal(len(profile))) * 5e-4
        np.savetxt(tmp_path / f"{name}.csv", np.column_stack([profile, heights]), delimiter=",", header="s,h", comments="")
    driven = np.loadtxt(tmp_path / "driven.csv", delimiter=",", skiprows=1)
    t, values = respond(p, lambda s: np.interp(s, *driven.T), 10.0, 45.0, {"F": p["Lf"]})
    kept = (t >= 1.0 + begin / 10.0) & (t < 26.0 + begin / 10.0)
    rows = np.column_stack([t[kept] - begin / 10.0, values[kept]])
    np.savetxt(tmp_path / "run.csv", rows, delimiter=",", header="t,F_az,F_q", comments="", fmt="%.8g")
    (tmp_path / "run.yaml").write_text(
        "vehicle: sedan2\nspeed: 10 m/s\nroad: [{profile: {file: stated.csv, distance: s, height: h}}]\nrecording: run.csv\n"
        "sensors: {F: {body: body, behind: front, channels: {acceleration: F_az}}}\nacquisition: none\n",
        encoding="utf-8",
    )
    doubts = validate("sedan2", tmp_path / "run.yaml", bands=BANDS).doubtful_channels()
    assert [doubt[: len(start)] for doubt, start in zip(doubts, said, strict=True)] == said


def test_a_motion_that_was_not_recorded_is_no_noise(tmp_path):
    path = write_run(tmp_path, "run", sedan_truth(), 2.5)
    changed(path, of(3, lambda x: np.random.default_rng(3).normal(0, 0.002, len(x))))
    found = {item.channel: item for item in validate("sedan2", path, bands=BANDS).channels}
    assert found["R_az"].audible.all()
    assert (found["R_az"].errors > 5).all()


def test_what_a_sensor_reads_at_rest_is_no_error_of_the_model(tmp_path):
    path = write_run(tmp_path, "run", sedan_truth(), 2.5)
    plain = {item.channel: item.errors for item in validate("sedan2", path, bands=[(0.1, 2.0)]).channels}
    changed(path, of(1, lambda x: x + 9.81))
    offset = {item.channel: item.errors for item in validate("sedan2", path, bands=[(0.1, 2.0)]).channels}
    assert offset["F_az"] == pytest.approx(plain["F_az"], abs=1e-3)


def test_a_motion_with_a_mean_and_no_rest_before_it_is_compared_whole(tmp_path):
    """A rig that falls from its first moment: a recording of the very same motion has no error."""
    (tmp_path / "rig.yaml").write_text("extends: drop_test\n", encoding="utf-8")
    run = tmp_path / "run.yaml"
    lines = "vehicle: rig.yaml\nspeed: 1 m/s\nduration: 0.12 s\nsample: 1 ms\ninitial: {car: {displacement: 40 mm}}\n"
    run.write_text(lines + "sensors: {s: {body: car, channels: {acceleration: az}}}\n", encoding="utf-8")
    response = simulate(run)
    table = np.column_stack([response.time, response.values[0]])
    np.savetxt(tmp_path / "run.csv", table, delimiter=",", header="t,az", comments="", fmt="%.9g")
    run.write_text(run.read_text() + "recording: run.csv\nacquisition: none\n", encoding="utf-8")
    (found,) = validate(tmp_path / "rig.yaml", run, bands=[(0.0, 50.0)]).channels
    assert abs(response.values[0].mean()) > 0.1 * response.values[0].std()
    assert found.errors == pytest.approx([0.0], abs=1e-4)
