"""Every result of a vehicle and of a run: written and read again, as a table and as a picture."""

import importlib.util
import json

import numpy as np
import pytest
from matplotlib.figure import Figure

from tests.fit.recordings import sedan_truth, write_run
from vehgen.calibrate.sensitivity import SensitivityIndices, sensitivity
from vehgen.calibrate.sensor_placement import SensorAdvice, advise_sensors
from vehgen.calibrate.validation import Validation, reference_spectrum, validate
from vehgen.mechanics import StaticLoads, derive, static_loads
from vehgen.simulate import Response, load_run, natural_modes, simulate
from vehgen.simulate.modes import Modes
from vehgen.vehicle import load_vehicle


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    path = write_run(tmp_path_factory.mktemp("run"), "hump", sedan_truth())
    model = derive(load_vehicle("tractor5"))
    run = load_run(path)
    return {
        "modes": natural_modes(model),
        "static loads": static_loads(model),
        "response": simulate(run),
        "sensitivity": sensitivity(run, ("kf", "mr")),
        "sensor advice": advise_sensors(run, 2),
        "validation": validate("sedan2", path),
    }


@pytest.mark.parametrize("cls", [Modes, StaticLoads, Response, SensitivityIndices, SensorAdvice, Validation])
def test_a_result_survives_json_and_shows_itself(results, cls):
    result = results[cls.KIND]
    again = cls.from_dict(json.loads(json.dumps(result.to_dict(), allow_nan=False)))
    assert again == result
    assert isinstance(again.plot(), Figure)
    columns, rows = again.table()
    assert rows
    assert {len(row) for row in rows} == {len(columns)}
    assert again._repr_html_().count("<th>") == len(columns)
    if importlib.util.find_spec("pandas"):
        assert list(again.to_dataframe().columns) == list(columns)


def test_numbers_come_back_bit_for_bit(results):
    again = Response.from_dict(json.loads(json.dumps(results["response"].to_dict())))
    np.testing.assert_array_equal(again.values, results["response"].values)
    loads = StaticLoads.from_dict(json.loads(json.dumps(results["static loads"].to_dict())))
    assert loads.elements == results["static loads"].elements


def test_modes_are_a_sequence(results):
    modes = results["modes"]
    assert len(modes) == len(modes.coordinates) == len(modes[0].shape)
    assert [mode.undamped_hz for mode in modes] == sorted(mode.undamped_hz for mode in modes)
    assert modes[-1] is list(modes)[-1]
    assert modes[:2] == (modes[0], modes[1])


def test_a_reference_spectrum_ends_where_the_standard_does(results):
    reference = reference_spectrum("level II")
    assert np.isfinite(reference.psd).any()
    with_reference = Validation("v", results["validation"].bands, results["validation"].channels, reference)
    again = Validation.from_dict(json.loads(json.dumps(with_reference.to_dict())))
    np.testing.assert_array_equal(again.reference.psd, reference.psd)
