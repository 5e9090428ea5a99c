"""The form of entries and where their faults stand."""

from pathlib import Path

import pytest
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from vehgen.errors import InputError
from vehgen.files.entry import FileModel, read_entries


class Pair(FileModel):
    first: int = 0
    second: int = 0

    @model_validator(mode="after")
    def _ordered(self) -> "Pair":
        if self.first > self.second:
            raise PydanticCustomError("joint", "the first must not be above the second")
        return self


@pytest.mark.parametrize(
    ("text", "place", "message"),
    [
        ("- 1\n- 2\n", "1:1", "a file of `key: value` lines was expected"),
        ("first: 3\nsecond: 1\n", "1:1", "the first must not be above the second"),
        ("first: 3\nthird: 1\n", "2:1", "unknown key 'third'; known: first, second"),
    ],
)
def test_a_fault_of_the_whole_file_stands_at_its_begin(tmp_path: Path, text: str, place: str, message: str):
    path = tmp_path / "pair.yaml"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        read_entries(Pair, path)
    assert str(caught.value).startswith(f"{path}:{place}: {message}")
