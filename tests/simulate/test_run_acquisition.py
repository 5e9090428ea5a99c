"""What a run file says of its recorders: which channel has which chain, and each fault at its place."""

import pytest

from tests.simulate.run_files import GOOD, load
from vehgen.errors import InputError
from vehgen.fit.recording import read_recording
from vehgen.measure.acquisition import POINT_SAMPLES, UNKNOWN, AcquisitionChain
from vehgen.simulate import load_run
from vehgen.simulate.run_file.acquisition import channel_chains

FULL = "{filter: butterworth, order: 4, cut_off: 45 Hz, delay: 5 ms, range: 39 m/s^2, resolution: 0.01 m/s^2}"
SENSOR = "  L1: {body: frame, behind: front, distance: -0.29 m, channels: {acceleration: L1_az, pitch_rate: L1_q}}"


def chains(tmp_path, text, rate=100.0):
    return channel_chains(load(tmp_path, text), rate)


def test_a_sensors_recorder_acquires_its_channels(tmp_path):
    found = chains(tmp_path, GOOD.replace(SENSOR, SENSOR[:-1] + f", acquisition: {FULL}}}"))
    assert found["L1_az"] == AcquisitionChain("butterworth", 4, 45.0, 0.005, 39.0, 0.01)
    assert found["L1_q"] == AcquisitionChain("butterworth", 4, 45.0, 0.005)
    assert found["v2"] is UNKNOWN


def test_a_channels_recorder_stands_before_its_sensors_and_the_runs(tmp_path):
    own = "acceleration: {column: L1_az, acquisition: none}"
    text = GOOD.replace(SENSOR, SENSOR[:-1] + ", acquisition: bosch_bmi160}").replace("acceleration: L1_az", own)
    found = chains(tmp_path, text + "acquisition: {filter: bessel, order: 2, cut_off: 30 Hz}\n", rate=200.0)
    assert found["L1_az"] is POINT_SAMPLES
    assert found["L1_q"] == AcquisitionChain("butterworth", 2, 81.0)
    assert found["v2"] == AcquisitionChain("bessel", 2, 30.0)


def test_what_was_recorded_is_unknown_and_what_was_not_is_sampled(tmp_path):
    assert set(chains(tmp_path, GOOD).values()) == {UNKNOWN}
    assert set(chains(tmp_path, GOOD.replace("recording: measured.csv\n", "")).values()) == {POINT_SAMPLES}


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ("@butterwort", "unknown recorder 'butterwort'"),
        ("@bosch_bmi16", "unknown recorder 'bosch_bmi16'; did you mean 'bosch_bmi160'?"),
        ("@bessel", "a bessel low-pass needs its cut-off"),
        ("{filter: @butterworht, cut_off: 45 Hz}", "unknown filter 'butterworht'; did you mean 'butterworth'?"),
        ("{filter: bessel, cut_off: 45 Hz, order: @13}", "input should be less than or equal to 12"),
        ("{filter: bessel, cut_off: 45 Hz, order: @0}", "input should be greater than or equal to 1"),
        ("{filter: bessel, cut_off: @45 s}", "expected 1/s, found s"),
        ("{filter: bessel, cut_off: 45 Hz, range: @4 m}", "a range in m/s^2 or rad/s was expected, found '4 m'"),
        ("{filter: bessel, cut_off: 45 Hz, range: @4}", "a range in m/s^2 or rad/s was expected, found 4"),
        ("{filter: bessel, cut_off: 45 Hz, resolution: @-1 m/s^2}", "a resolution above 0 was expected"),
        ("{filter: bessel, cut_off: 45 Hz, delay: @5 m}", "expected s, found m"),
        ("{filter: bessel, cut_off: 45 Hz, delay: @50 s}", "the delay of a recorder is at most 1 s"),
        ("@{filter: bessel}", "a bessel low-pass lacks the key cut_off"),
        ("@{filter: none, cut_off: 45 Hz}", "a filter that is none has no cut_off"),
        ("@{filter: ideal, cut_off: 45 Hz, order: 4}", "an ideal low-pass has no order"),
        ("{filter: bessel, @cutoff: 45 Hz}", "unknown key 'cutoff'; did you mean 'cut_off'?"),
    ],
)
def test_a_recorder_that_cannot_be_is_refused_at_its_place(tmp_path, entry, message):
    text = GOOD.replace(SENSOR, SENSOR[:-1] + f", acquisition: {entry}}}")
    line = next(i for i, item in enumerate(text.splitlines(), 1) if "@" in item)
    column = text.splitlines()[line - 1].index("@") + 1
    with pytest.raises(InputError) as caught:
        load(tmp_path, text.replace("@", ""))
    assert str(caught.value.position).endswith(f":{line}:{column}")
    assert message in caught.value.message


RUN = """vehicle: sedan2.yaml
speed: 2 m/s
road: [{hump: {shape: half_sine, length: 0.5 m, height: 0.03 m, at: 4 m}}]
sensors:
  F: {body: body, channels: {acceleration: az}, acquisition: ENTRY}
recording: data.csv
"""


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ("{filter: bessel, cut_off: 51 Hz}", "a cut-off of 51 Hz, but the recording was sampled at 100 Hz"),
        ("{filter: bessel, cut_off: 51 Hz, rate: 100 Hz}", "the chip samples at 100 Hz"),
        ("{filter: none, range: 5 m/s^2}", "az is -20, beyond the range of 5"),
        ("{filter: none, resolution: 5 m/s^2}", "finer than the resolution of 5"),
        ("{filter: bessel, cut_off: 51 Hz, rate: 200 Hz, range: 19.6 m/s^2, resolution: 0.01 m/s^2}", None),
    ],
)
def test_a_recorder_that_contradicts_the_recording_is_refused(tmp_path, entry, message):
    values = "".join(f"{0.01 * i:.2f},{(i * 7 % 401) / 10 - 20:.2f}\n" for i in range(600))
    (tmp_path / "data.csv").write_text("t,az\n" + values, encoding="utf-8")
    run = write_run(tmp_path, RUN.replace("ENTRY", entry))
    if message is None:
        assert len(read_recording(run).time) == 600
        return
    with pytest.raises(InputError) as caught:
        read_recording(run)
    assert message in caught.value.message
    assert caught.value.position is not None


def write_run(folder, text):
    (folder / "run.yaml").write_text(text, encoding="utf-8")
    return load_run(folder / "run.yaml")
