"""The list of vehgen's own files: whatever stands in it, no foreign file counts as own and nothing fails."""

import hashlib
import json
import os
import subprocess
import sys

import pytest

from vehgen.errors import InputError
from vehgen.files import guarding_results, write_text
from vehgen.files.manifest import KEY, MANIFEST, MAX_MANIFEST_BYTES, is_own, mark_own, read_manifest

HASH = hashlib.sha256(b"mine").hexdigest()


@pytest.fixture
def mine(tmp_path):
    path = tmp_path / "mine.csv"
    path.write_text("mine")
    return path


def test_the_list_is_plain_and_forgets_what_is_gone(tmp_path):
    with guarding_results():
        write_text(tmp_path / "b.csv", "b")
        write_text(tmp_path / "a.csv", "a")
        (tmp_path / "b.csv").unlink()
        write_text(tmp_path / "c.csv", "c")
    found = json.loads((tmp_path / MANIFEST).read_text())
    assert found == {KEY: {f"{name}.csv": hashlib.sha256(name.encode()).hexdigest() for name in "ac"}}
    assert is_own(tmp_path / "a.csv")
    assert not is_own(tmp_path / "b.csv")


DAMAGED = {
    "empty": b"",
    "cut off": b'{"vehgen files": {"mine.csv": "',
    "not UTF-8": b"\xff\xfe\x00",
    "a list": b"[]",
    "a number": b"1",
    "files a list": b'{"vehgen files": ["mine.csv"]}',
    "hash a number": b'{"vehgen files": {"mine.csv": 1}}',
    "hash null": b'{"vehgen files": {"mine.csv": null}}',
    "hash wrong": json.dumps({KEY: {"mine.csv": "0" * 64}}).encode(),
    "hash empty": b'{"vehgen files": {"mine.csv": ""}}',
    "hash not ASCII": '{"vehgen files": {"mine.csv": "é"}}'.encode(),
    "deep": b"[" * 200_000,
    "too long": json.dumps({KEY: {"mine.csv": HASH}}).encode() + b" " * MAX_MANIFEST_BYTES,
    "huge number": b'{"vehgen files": ' + b"9" * 10_000 + b"}",
}


@pytest.mark.parametrize("text", DAMAGED.values(), ids=DAMAGED)
def test_a_damaged_list_makes_nothing_own_and_is_replaced(mine, text):
    (mine.parent / MANIFEST).write_bytes(text)
    assert not is_own(mine)
    with guarding_results():
        with pytest.raises(InputError, match="was not written by vehgen"):
            write_text(mine, "new")
        write_text(mine.parent / "other.csv", "other")
    assert mine.read_text() == "mine"
    assert is_own(mine.parent / "other.csv")


@pytest.mark.parametrize("name", ["../mine.csv", "sub/mine.csv", "/mine.csv", ".", "..", ""])
def test_a_list_speaks_of_its_own_folder_only(mine, name):
    folder = mine.parent / "folder"
    folder.mkdir()
    (folder / MANIFEST).write_text(json.dumps({KEY: {name: HASH, str(mine): HASH}}))
    assert set(read_manifest(folder)) <= {"..", ""}
    with guarding_results():
        for path in (mine, folder / ".." / "mine.csv"):
            with pytest.raises(InputError, match="was not written by vehgen"):
                write_text(path, "new")
    assert mine.read_text() == "mine"


@pytest.mark.skipif(os.name != "posix", reason="needs POSIX links and pipes")
@pytest.mark.parametrize("kind", ["link", "pipe", "folder"])
def test_a_list_that_is_no_regular_file_is_none(mine, tmp_path_factory, kind):
    elsewhere = tmp_path_factory.mktemp("elsewhere") / "list.json"
    text = json.dumps({KEY: {"mine.csv": HASH}})
    elsewhere.write_text(text)
    place = mine.parent / MANIFEST
    {"link": lambda: place.symlink_to(elsewhere), "pipe": lambda: os.mkfifo(place), "folder": place.mkdir}[kind]()
    assert not is_own(mine)
    mark_own(mine, b"mine")
    assert elsewhere.read_text() == text
    assert is_own(mine) == (kind != "folder")


@pytest.mark.skipif(os.name != "posix", reason="the lock is that of POSIX")
def test_writers_at_the_same_time_lose_no_mark(tmp_path):
    code = (
        "import pathlib, sys\nfrom vehgen.files import guarding_results, write_text\n"
        "with guarding_results():\n    for i in range(20):\n"
        "        write_text(pathlib.Path(sys.argv[1]) / f'{sys.argv[2]}_{i}.csv', sys.argv[2])\n"
    )
    writers = [subprocess.Popen([sys.executable, "-c", code, str(tmp_path), str(i)], env=os.environ) for i in range(3)]
    assert [writer.wait() for writer in writers] == [0, 0, 0]
    results = {f"{i}_{j}.csv" for i in range(3) for j in range(20)}
    assert {path.name for path in tmp_path.iterdir()} == results | {MANIFEST}
    assert set(read_manifest(tmp_path)) == results
