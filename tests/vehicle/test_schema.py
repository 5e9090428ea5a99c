"""The JSON Schema is valid, accepts the bundled models, and refuses what the loader refuses."""

import jsonschema
import pytest

from vehgen.files.document import read_document
from vehgen.simulate.run_file import RunFile
from vehgen.vehicle import bundled_models
from vehgen.vehicle.schema import vehicle_schema


def test_schemas_are_valid():
    jsonschema.Draft202012Validator.check_schema(vehicle_schema())
    jsonschema.Draft202012Validator.check_schema(RunFile.model_json_schema())


@pytest.mark.parametrize("name", sorted(bundled_models()))
def test_bundled_models_pass(name):
    jsonschema.validate(read_document(bundled_models()[name]).plain(), vehicle_schema())


def test_unknown_keys_do_not_pass():
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate({"bodies": {"frame": {"mas": "1 kg"}}}, vehicle_schema())
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate({"wheels": {}}, vehicle_schema())
