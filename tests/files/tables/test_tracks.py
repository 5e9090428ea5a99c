"""Speed of GPS tracks: GPX with and without recorded speeds, NMEA, and what is wrong with either at its line."""

from __future__ import annotations

import math
from functools import reduce
from pathlib import Path

import numpy as np
import pytest

from vehgen.errors import InputError
from vehgen.files.tables import read_columns
from vehgen.road import SpeedHistory
from vehgen.simulate import load_run, make_scenario
from vehgen.simulate.simulator import Simulator

PUBLISHED = "$GPRMC,123519,A,4807.038,N,01131.000,E,022.4,084.4,230394,003.1,W*6A"
"""The example that most descriptions of NMEA 0183 give, with its check sum."""


def gpx(points: list[tuple[float, float, str, str]], head: str = "") -> str:
    lines = [f'  <trkpt lat="{lat:.9f}" lon="{lon:.9f}"><time>{time}</time>{speed}</trkpt>' for lat, lon, time, speed in points]
    return "\n".join(
        [
            '<?xml version="1.0" encoding="UTF-8"?>',
            head + '<gpx version="1.1" xmlns="http://www.topografix.com/GPX/1/1" xmlns:gpxtpx="http://www.garmin.com/x"><trk><trkseg>',
            *lines,
            "</trkseg></trk></gpx>\n",
        ]
    )


def rmc(second: float, knots: float | str, status: str = "A") -> str:
    body = f"GNRMC,1200{second:05.2f},{status},4807.038,N,01131.000,E,{knots},084.4,010524,,"
    return f"${body}*{reduce(lambda a, b: a ^ b, body.encode()):02X}"


def read(path: Path, text: str) -> tuple[np.ndarray, np.ndarray]:
    path.write_text(text, encoding="utf-8")
    found = read_columns(path, ("t", "speed"))
    assert found.units == ("s", "m/s")
    return found.values[0], found.values[1]


def test_speeds_that_a_receiver_recorded(tmp_path: Path):
    inside = "<extensions><gpxtpx:TrackPointExtension><gpxtpx:speed>{}</gpxtpx:speed></gpxtpx:TrackPointExtension></extensions>"
    points = [(48.0, 11.0, f"2024-05-01T12:00:{10 + i:02d}.500Z", inside.format(2.0 + i)) for i in range(3)]
    time, speed = read(tmp_path / "a.gpx", gpx(points))
    np.testing.assert_allclose(time, [0, 1, 2], atol=1e-6)
    np.testing.assert_array_equal(speed, [2, 3, 4])


@pytest.mark.parametrize("along", ["meridian", "parallel"])
def test_speeds_from_the_way_between_points(tmp_path: Path, along: str):
    """A minute of arc of a great circle is a nautical mile, 1852 m, but for 0.1 % of the earth's form."""
    minute = 1 / 60
    steps = [(48.0 + i * minute / 100, 11.0) if along == "meridian" else (60.0, 11.0 + i * minute / 50) for i in range(5)]
    time, speed = read(tmp_path / "a.gpx", gpx([(*place, f"2024-05-01T14:00:0{i}+02:00", "") for i, place in enumerate(steps)]))
    np.testing.assert_allclose(speed, 18.52, rtol=2e-3)
    assert time[-1] == 4.0


def test_a_log_of_sentences(tmp_path: Path):
    log = [rmc(0, 10), "$GPGGA,120001,,,,,,,,*00", rmc(0.2, 12.5), rmc(0.4, 99, "V"), rmc(0.6, 15), ""]
    time, speed = read(tmp_path / "a.nmea", "\r\n".join(log))
    np.testing.assert_allclose(time, [0, 0.2, 0.6], atol=1e-6)
    np.testing.assert_allclose(speed, np.array([10, 12.5, 15]) * 1852 / 3600)
    later = PUBLISHED.replace("123519", "123520").replace("*6A", "*60")
    _, speed = read(tmp_path / "b.nmea", f"{PUBLISHED}\n{later}\n")
    assert speed[0] == pytest.approx(11.5235, abs=1e-3)


BOMB = '<!DOCTYPE gpx [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;&a;">]>\n'
GOOD = [(48.0, 11.0, f"2024-05-01T12:00:0{i}Z", "<speed>2</speed>") for i in range(3)]
FAULTS = [
    (gpx(GOOD, BOMB), "run.gpx:2:15: a GPX file has no DOCTYPE; one with entities is refused"),
    (gpx(GOOD)[:-30], "not XML: "),
    (gpx(GOOD).replace("UTF-8", "foo"), "run.gpx:1:1: not XML: an encoding that cannot be read; UTF-8 was expected"),
    (gpx(GOOD).replace("UTF-8", "utf-7"), "run.gpx:1:1: not XML: an encoding that cannot be read; UTF-8 was expected"),
    (gpx(GOOD[:1]), "a track of at least two points was expected"),
    (gpx([GOOD[0], GOOD[0]]), "run.gpx:4:1: the times of a track must ascend"),
    (gpx([GOOD[0], (91.0, 0.0, "", "")]), "run.gpx:4:3: a number of at most 90 was expected, found '91.000000000'"),
    (gpx(GOOD).replace('lat="48.0', 'lat="4_8.0'), "run.gpx:3:3: a number of at most 90 was expected, found '4_8.000000000'"),
    (f"{rmc(0, 1)}\n{rmc(1, '1_0')}\n", "date, time and speed were expected, found '010524', '120001.00', '1_0'"),
    (gpx([GOOD[0], (1.0, 1.0, "noon", "")]), "a time such as 2024-05-01T12:00:00Z was expected, found 'noon'"),
    (gpx([GOOD[0], (1.0, 1.0, "10:00:00", "")]), "a time such as 2024-05-01T12:00:00Z was expected, found '10:00:00'"),
    (gpx(GOOD).replace("<time>2024-05-01T12:00:01Z</time>", ""), "run.gpx:4:"),
    (PUBLISHED.replace("022.4", "122.4"), "run.gpx:1:1: the check sum of the sentence is '6A', its text has 6B: the log is damaged"),
    (f"{rmc(0, 1)}\n{rmc(1, 1, 'V')}\n", "a log with at least two valid RMC sentences was expected"),
    (f"{rmc(1, 1)}\n{rmc(0, 1)}\n", "run.gpx:2:1: the times of a log must ascend"),
]


@pytest.mark.parametrize(("text", "said"), FAULTS, ids=range(len(FAULTS)))
def test_what_is_wrong_with_a_track_is_told_at_its_line(tmp_path: Path, text: str, said: str):
    with pytest.raises(InputError) as caught:
        read(tmp_path / "run.gpx", text)
    assert said in str(caught.value)


def test_a_run_takes_its_speed_from_a_part_of_a_track(tmp_path: Path):
    """The vehicle stands at both ends of the track; the pass is from 10 to 20 s, at speeds that rise by 0.1 m/s^2."""
    speeds = [max(0.0, 2 + 0.1 * (i - 10)) if 5 < i < 25 else 0.0 for i in range(30)]
    points = [(48.0, 11.0, f"2024-05-01T12:00:{i:02d}Z", f"<speed>{speed:.6f}</speed>") for i, speed in enumerate(speeds)]
    (tmp_path / "drive.gpx").write_text(gpx(points), encoding="utf-8")
    run = "vehicle: sedan2\nduration: 5 s\nspeed: {file: drive.gpx%s}\n"
    (tmp_path / "run.yaml").write_text(run % ", start: 10.5 s, end: 20 s")
    found = load_run(tmp_path / "run.yaml")
    model = Simulator(found.vehicle, found.outputs()).model
    law = make_scenario(found, model, model.values()).speed
    assert isinstance(law, SpeedHistory)
    assert law.distance(np.array([4.0]))[0] == pytest.approx(4 * 2.05 + 0.1 * 4**2 / 2, rel=1e-9)
    assert math.isfinite(law.distance(np.array([5.0]))[0])
    faults = (
        ("", r"drive\.gpx:3:2: every speed of a history must be above 0; `start`"),
        (", start: 40 s", r"run\.yaml:3:33: `start` and `end` must lie within 0 s to 29 s"),
    )
    for more, said in faults:
        (tmp_path / "run.yaml").write_text(run % more)
        found = load_run(tmp_path / "run.yaml")
        with pytest.raises(InputError, match=said):
            make_scenario(found, model, model.values())
