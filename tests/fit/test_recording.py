import numpy as np
import pytest

from vehgen.errors import InputError
from vehgen.fit.recording import REFUSED_IN_A_ROW, read_recording
from vehgen.measure.quality import find_clipping
from vehgen.simulate import load_run

RUN = """vehicle: sedan2.yaml
speed: 2 m/s
road: [{hump: {shape: half_sine, length: 0.5 m, height: 0.03 m, at: 4 m}}]
sensors:
  F: {body: body, channels: {acceleration: az, pitch_rate: {column: q, unit: deg/s, sign: -1}}}
recording: data.csv
"""


def write(folder, t=None, az=None, q=None, text=RUN, heading="t,az,q"):
    t = np.arange(600) * 0.01 if t is None else t
    az = np.sin(t) if az is None else az
    q = np.cos(t) if q is None else q
    np.savetxt(folder / "data.csv", np.column_stack([t, az, q]), delimiter=",", header=heading, comments="")
    (folder / "run.yaml").write_text(text, encoding="utf-8")
    return load_run(folder / "run.yaml")


def test_channels_come_in_si_units_with_their_sign(tmp_path):
    found = read_recording(write(tmp_path))
    assert [channel.name for channel in found.channels] == ["az", "q"]
    assert found.values[:, 1] == pytest.approx(-np.cos(found.time) * np.pi / 180)
    assert found.dt == pytest.approx(0.01)


def test_a_column_is_found_by_any_heading_and_its_channel_has_a_name(tmp_path):
    heading = "=Acceleration z (m/s^2)"
    run = write(tmp_path, text=RUN.replace("acceleration: az", f"acceleration: '{heading}'"))
    (tmp_path / "data.csv").write_text((tmp_path / "data.csv").read_text().replace("t,az,q", f"t,{heading},q"))
    found = read_recording(run)
    assert [channel.name for channel in found.channels] == ["F_acceleration", "q"]
    assert found.values[:, 0] == pytest.approx(np.sin(found.time))


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"t": np.arange(600) * 0.4}, "2.5 Hz; at least 50 Hz"),
        ({"t": np.arange(600) * 10.0}, r"0.1 Hz, if 't' is in s: if it is in ms, head the column `t \[ms\]`"),
        ({"t": 1.7e9 + np.arange(600) * 0.01}, "'t' begins at 1700000000 s, but a run's time counts from where its way does"),
        ({"t": np.cumsum(np.random.default_rng(0).uniform(0.005, 0.015, 600))}, "uneven clock"),
        ({"t": np.r_[np.arange(300), np.arange(300)] * 0.01}, "ascend"),
        ({"az": np.clip(10 * np.sin(np.arange(600) * 0.3) * np.exp(-((np.arange(600) - 300) ** 2) / 500), -1.5, 1.5)}, "clipped"),
        ({"az": np.r_[np.nan, np.ones(599)]}, "not a finite number"),
        ({"az": np.full(600, 9.81)}, "constant"),
        ({"text": RUN.replace("deg/s", "deg")}, "pitch_rate is measured in rad/s, found .deg., an angle"),
        ({"text": RUN.replace("deg/s", "dge/s")}, "unknown unit 'dge/s'"),
        ({"text": RUN.replace("az,", "ax,")}, r"data.csv:1:1: no column 'ax'; known: az, q, t \(asked for by .*run.yaml:6:12\)$"),
        ({"text": RUN.replace("{column: q,", "{column: w,")}, r"no column 'w'; .* \(asked for by .*run.yaml:6:12\)$"),
        ({"heading": "Time,az,q"}, r"data.csv:1:1: no column 't'; .*; head the times 't', or let `vehgen import` read .* \(asked for by"),
        (
            {"t": np.arange(600) * 0.01 - (np.arange(600) == 7)},
            r"data.csv:9:1: 't' must ascend; -0.93 comes after 0.06; `vehgen import` sets a clock right",
        ),
        ({"q": np.r_[np.ones(599), 1e13]}, r"data.csv:601:3: .* which nothing measures \(asked for by .*run.yaml:6:12\)$"),
        ({"text": RUN.replace("data.csv", "date.csv")}, "no file"),
        ({"text": RUN.replace("recording: data.csv\n", "")}, "no `recording`"),
    ],
)
def test_a_recording_that_cannot_be_used_says_why(tmp_path, change, said):
    with pytest.raises(InputError, match=said) as caught:
        read_recording(write(tmp_path, **change))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("step", [0.01, 0.03, 0.05])
def test_the_round_top_of_a_slow_motion_in_steps_of_a_resolution_is_not_clipped(tmp_path, step):
    """As of a gyroscope behind a low-pass at 8 Hz."""
    after = np.arange(600) * 0.01 - 3
    values = step * np.round(np.cos(2 * np.pi * 0.7 * after) * np.exp(-((after / 1.5) ** 2)) / step)
    assert find_clipping(values, REFUSED_IN_A_ROW)
    read_recording(write(tmp_path, az=values))
    with pytest.raises(InputError, match=r"az is clipped at 0\.6"):
        read_recording(write(tmp_path, az=np.clip(values, -0.6, 0.6)))


@pytest.mark.parametrize(
    ("change", "place", "said"),
    [
        ({"t": np.r_[np.arange(300), np.arange(300)] * 0.01}, "302:1", "'t' must ascend; 0 comes after 2.99"),
        ({"t": np.arange(600) * 0.4}, "3:1", "logged at 2.5 Hz"),
        ({"t": np.r_[np.arange(300), np.arange(400, 700)] * 0.01}, "302:1", "an uneven clock"),
        ({"az": np.full(600, 9.81)}, "1:2", "az is constant"),
        ({"q": np.r_[np.sin(np.arange(500) * 0.1), np.full(100, 3.0)]}, "502:3", "q is clipped"),
        ({"t": np.arange(3) * 0.01, "az": np.arange(3), "q": np.arange(3)}, "4:1", "3 rows of numbers; at least 16 were expected"),
    ],
)
def test_it_is_refused_at_its_row(tmp_path, change, place, said):
    with pytest.raises(InputError) as caught:
        read_recording(write(tmp_path, **change))
    assert f"data.csv:{place}: {said}" in str(caught.value)
