"""Tables that a run file names, in any format and unit, mean what the same numbers in a plain CSV in SI mean."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from vehgen.errors import InputError
from vehgen.fit.recording import read_recording
from vehgen.simulate import load_run, simulate

S = np.linspace(0.0, 30.0, 400)
H = 0.01 * np.sin(2 * np.pi * S / 15)
TIME = np.linspace(0.0, 4.0, 400)
FORCE = 500 * np.sin(2 * np.pi * 3 * TIME)
RUN = """\
vehicle: sedan2
duration: 3 s
speed: {file: v.csv, time: t, speed: vSPEED}
road: [{profile: {file: road.csv, distance: s, height: hROAD}}]
forces: {f: {body: body, file: f.csv, time: t, force: FFORCE}}
sensors: {L: {body: body, channels: {acceleration: CHANNEL}}}
"""
PLAIN = {"SPEED": "", "ROAD": "", "FORCE": "", "CHANNEL": "az"}


def response(folder: Path, stated: dict[str, str], factors: tuple[float, float, float, float], **dialect: str) -> np.ndarray:
    folder.mkdir()
    pd.DataFrame({"t": TIME * factors[0], "v": (5 + TIME) * factors[1]}).to_csv(folder / "v.csv", index=False, **dialect)
    pd.DataFrame({"s": S, "h": H * factors[2]}).to_csv(folder / "road.csv", index=False, **dialect)
    pd.DataFrame({"t": TIME * factors[0], "F": FORCE * factors[3]}).to_csv(folder / "f.csv", index=False, **dialect)
    return simulate(load_run(run_file(folder, stated))).values[0]


def run_file(folder: Path, stated: dict[str, str], more: str = "") -> Path:
    text = RUN
    for key, value in {**PLAIN, **stated}.items():
        text = text.replace(key, value, 1)
    (folder / "run.yaml").write_text(text + more, encoding="utf-8")
    return folder / "run.yaml"


def test_units_and_dialects_change_nothing(tmp_path: Path):
    plain = response(tmp_path / "plain", {}, (1.0, 1.0, 1.0, 1.0))
    stated = {"SPEED": ", time_unit: ms, unit: km/h", "ROAD": ", unit: in, distance_unit: m", "FORCE": ", time_unit: ms, unit: lbf"}
    other = response(tmp_path / "other", stated, (1e3, 3.6, 1 / 0.0254, 1 / 4.4482216152605), sep=";", decimal=",")
    assert abs(plain).max() > 0.1
    np.testing.assert_allclose(other, plain, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize(
    ("stated", "said"),
    [
        ({"SPEED": ", unit: banana"}, "run.yaml:3:47: unknown unit 'banana'; known: "),
        ({"SPEED": ", time_unit: m"}, "run.yaml:3:52: time is measured in s, found 'm', a unit of m"),
        ({"ROAD": ", unit: mph"}, "run.yaml:4:65: height is measured in m, found 'mph', a unit of m/s"),
        ({"ROAD": ", distance_unit: metre"}, "run.yaml:4:74: unknown unit 'metre'"),
        ({"FORCE": ", time_unit: kN"}, "time is measured in s, found 'kN', a unit of N"),
    ],
)
def test_a_wrong_unit_is_told_at_its_place(tmp_path: Path, stated: dict[str, str], said: str):
    with pytest.raises(InputError) as caught:
        response(tmp_path / "run", stated, (1.0, 1.0, 1.0, 1.0))
    assert said in str(caught.value)


def recorded(folder: Path, channel: str) -> np.ndarray:
    return read_recording(load_run(run_file(folder, {"FORCE": ", unit: N", "CHANNEL": channel}, "recording: measured.dat\n"))).values[:, 0]


def test_a_recording_may_be_any_table_with_its_own_units(tmp_path: Path):
    pytest.importorskip("pyarrow")
    response(tmp_path / "run", {}, (1.0, 1.0, 1.0, 1.0))
    az = 2 * np.sin(20 * TIME)
    frame = pd.DataFrame({"t [ms]": np.arange(400) * 10.0, "az [g]": az / 9.80665})
    frame.to_parquet(tmp_path / "run" / "measured.dat")
    np.testing.assert_allclose(recorded(tmp_path / "run", "{column: az, sign: -1}"), -az, rtol=1e-12)
    np.testing.assert_allclose(recorded(tmp_path / "run", "{column: az, unit: g}"), az, rtol=1e-12)
    with pytest.raises(InputError, match=r"run\.yaml:6:\d+: the column 'az' is in 'g' as its file says .*, and in 'm/s\^2' as stated here"):
        recorded(tmp_path / "run", "{column: az, unit: m/s^2}")


def over(folder: Path, table: pd.DataFrame, keys: str) -> np.ndarray:
    table.to_csv(folder / "road.csv", index=False)
    (folder / "run.yaml").write_text(
        "vehicle: sedan2\nspeed: 10 m/s\nduration: 2 s\n"
        f"road: [{{profile: {{file: road.csv, distance: s, height: h{keys}}}}}]\n"
        "sensors: {L: {body: body, channels: {acceleration: az}}}\n",
        encoding="utf-8",
    )
    return simulate(folder / "run.yaml").values[0]


def test_a_survey_may_begin_and_end_anywhere(tmp_path: Path):
    """The first wheel begins between two rows at 1212.34 m; what comes after the end is as if it had not been surveyed."""
    survey = pd.DataFrame({"s": 1200.0 + S, "h": 40.0 + H})
    ahead = S > 12.34
    moved = np.concatenate([[0.0], S[ahead] - 12.34])
    heights = np.concatenate([[np.interp(12.34, S, H)], H[ahead]])
    whole = over(tmp_path, pd.DataFrame({"s": moved, "h": heights}), "")
    assert np.abs(whole).max() > 0.1
    np.testing.assert_allclose(over(tmp_path, survey, ", start: 1212.34 m"), whole, rtol=0, atol=1e-6)
    np.testing.assert_allclose(over(tmp_path, survey, ", start: 1.21234 km, end: 1.23 km"), whole, rtol=0, atol=1e-6)
    last = np.searchsorted(moved, 1220.03 - 1212.34) + 1
    short = over(tmp_path, pd.DataFrame({"s": moved[:last], "h": heights[:last]}), "")
    assert np.abs(short - whole).max() > 0.1
    np.testing.assert_allclose(over(tmp_path, survey, ", start: 1212.34 m, end: 1220.03 m"), short, rtol=0, atol=1e-6)


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        (", start: 3 m", "run.yaml:4:66: `start` and `end` must lie within 1200 m to 1230 m of the file, the start first"),
        (", start: 1220 m, end: 1210 m", "run.yaml:4:66: `start` and `end` must lie"),
        (", end: 1240 m", "run.yaml:4:64: `start` and `end` must lie"),
        (", start: 3 s", "run.yaml:4:66: "),
    ],
)
def test_a_place_that_a_survey_lacks_is_told(tmp_path: Path, keys: str, said: str):
    with pytest.raises(InputError) as caught:
        over(tmp_path, pd.DataFrame({"s": 1200.0 + S, "h": H}), keys)
    assert said in str(caught.value)
