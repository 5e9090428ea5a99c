"""Files appear whole or not at all, with the permissions of the umask, and what killed processes left is removed."""

import os
import signal
import stat
import subprocess
import sys
import time

import pytest
from matplotlib.figure import Figure

from vehgen.errors import InputError
from vehgen.files import write_bytes, write_text
from vehgen.files.atomic import DEAD_AFTER, STALE_AFTER, TEMPORARY, replace_file, temporary_file
from vehgen.report import save_figure

posix = pytest.mark.skipif(os.name != "posix", reason="needs POSIX permissions, processes and devices")


def names(folder):
    return {path.name for path in folder.iterdir()}


def leftover(folder, process, age, name=None):
    """Put a temporary file of a process into a folder, untouched for `age` seconds."""
    path = folder / (name or f".vehgen-{process}-0123456789ab.tmp")
    path.write_bytes(b"half")
    os.utime(path, (time.time() - age, time.time() - age))
    return path


@pytest.fixture
def dead():
    """The number of a process that has ended."""
    child = subprocess.Popen([sys.executable, "-c", ""])
    child.wait()
    return child.pid


@posix
@pytest.mark.parametrize(("mask", "mode"), [(0o022, 0o644), (0o077, 0o600), (0o002, 0o664)])
def test_texts_and_figures_have_the_mode_that_the_umask_leaves(tmp_path, mask, mode):
    before = os.umask(mask)
    try:
        write_text(tmp_path / "a.txt", "a")
        save_figure(Figure(), tmp_path / "a.png")
    finally:
        os.umask(before)
    assert {stat.S_IMODE(path.stat().st_mode) for path in tmp_path.iterdir()} == {mode}


def test_folders_are_made_and_texts_are_utf8_with_plain_line_ends(tmp_path):
    write_text(tmp_path / "a" / "b" / "c.txt", "é\n")
    assert (tmp_path / "a" / "b" / "c.txt").read_bytes() == b"\xc3\xa9\n"


def test_what_utf8_cannot_hold_is_said_in_one_line(tmp_path):
    with pytest.raises(InputError, match="is no character"):
        write_text(tmp_path / "a.txt", "\udcff")
    assert names(tmp_path) == set()


def test_a_name_that_is_too_long_is_an_input_error(tmp_path):
    with pytest.raises(InputError, match=r"cannot write .*: File name too long"):
        write_text(tmp_path / ("a" * 300), "a")
    assert names(tmp_path) == set()


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a device that is always full")
def test_a_full_disk_is_an_input_error_and_leaves_the_old_file(tmp_path, monkeypatch):
    write_text(tmp_path / "a.txt", "old")

    def on_full_device(path, data):
        with open("/dev/full", "wb") as stream:
            stream.write(data)

    monkeypatch.setattr("pathlib.Path.write_bytes", on_full_device)
    with pytest.raises(InputError, match="No space left on device"):
        write_text(tmp_path / "a.txt", "new")
    assert names(tmp_path) == {"a.txt"}
    assert (tmp_path / "a.txt").read_text() == "old"


def test_an_interruption_leaves_nothing(tmp_path):
    def interrupted():
        with temporary_file(tmp_path) as draft:
            assert TEMPORARY.fullmatch(draft.name)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert names(tmp_path) == set()


@posix
def test_what_a_killed_process_left_is_removed_by_the_next_write(tmp_path):
    code = (
        "import pathlib, sys, time\nfrom vehgen.files.atomic import temporary_file\n"
        "with temporary_file(pathlib.Path(sys.argv[1])):\n    print('writing', flush=True)\n    time.sleep(600)\n"
    )
    child = subprocess.Popen([sys.executable, "-c", code, str(tmp_path)], stdout=subprocess.PIPE, env=os.environ)
    assert child.stdout.readline() == b"writing\n"
    (left,) = tmp_path.iterdir()
    write_text(tmp_path / "first.txt", "while it runs")
    assert left.exists()
    child.send_signal(signal.SIGKILL)
    child.communicate()
    old = time.time() - DEAD_AFTER - 10
    os.utime(left, (old, old))
    write_text(tmp_path / "second.txt", "after")
    assert names(tmp_path) == {"first.txt", "second.txt"}


@posix
def test_only_what_is_surely_left_over_is_removed(tmp_path, dead):
    kept = [
        leftover(tmp_path, dead, DEAD_AFTER / 2),
        leftover(tmp_path, os.getpid(), STALE_AFTER / 2),
        leftover(tmp_path, dead, 10 * STALE_AFTER, ".vehgen-12-of-mine.tmp"),
        leftover(tmp_path, dead, 10 * STALE_AFTER, "vehgen-12-0123456789ab.tmp"),
    ]
    folder = tmp_path / f".vehgen-{dead}-aaaaaaaaaaaa.tmp"
    folder.mkdir()
    link = tmp_path / f".vehgen-{dead}-bbbbbbbbbbbb.tmp"
    link.symlink_to(kept[2])
    gone = [
        leftover(tmp_path, dead, 2 * DEAD_AFTER, f".vehgen-{dead}-cccccccccccc.tmp"),
        leftover(tmp_path, os.getpid(), 2 * STALE_AFTER, f".vehgen-{os.getpid()}-dddddddddddd.tmp"),
        leftover(tmp_path, 9999999999, 2 * STALE_AFTER, ".vehgen-9999999999-eeeeeeeeeeee.tmp"),
    ]
    write_bytes(tmp_path / "a.bin", b"a")
    assert names(tmp_path) == {path.name for path in (*kept, folder, link)} | {"a.bin"}
    assert not any(path.exists() for path in gone)


def test_a_file_in_place_of_the_folder_is_an_input_error(tmp_path):
    (tmp_path / "file").write_text("mine")
    with pytest.raises(InputError, match="cannot write"):
        replace_file(tmp_path / "file" / "a.txt", b"a")
    assert (tmp_path / "file").read_text() == "mine"
