"""What a command may write over: its own unchanged results, anything with force, never what it read and never what is no file."""

import os
import socket

import pytest

from vehgen.errors import InputError
from vehgen.files import check_result, check_results, guarding_results, note_read, noting_reads, was_read, write_bytes, write_text
from vehgen.files.manifest import MANIFEST

FOREIGN = r"exists and was not written by vehgen \(or was changed since\); name another file or add --force"
posix = pytest.mark.skipif(os.name != "posix", reason="needs POSIX links, pipes and devices")


@pytest.fixture
def mine(tmp_path):
    """A file of the user's."""
    path = tmp_path / "mine.csv"
    path.write_text("mine")
    return path


@pytest.fixture
def command():
    """What the command line puts around a command without --force."""
    with noting_reads(), guarding_results():
        yield


@pytest.mark.usefixtures("command")
def test_a_foreign_file_is_kept(mine):
    with pytest.raises(InputError, match=FOREIGN):
        check_result(mine)
    with pytest.raises(InputError, match=FOREIGN):
        write_text(mine, "new")
    assert mine.read_text() == "mine"
    assert [path.name for path in mine.parent.iterdir()] == ["mine.csv"]


def test_force_replaces_a_foreign_file_and_makes_it_own(mine):
    with guarding_results(force=True):
        write_text(mine, "new")
    with guarding_results():
        write_text(mine, "newer")
    assert mine.read_text() == "newer"


def test_a_result_is_replaced_until_somebody_changes_it(tmp_path):
    path = tmp_path / "result.yaml"
    for text in ("first", "second"):
        with guarding_results():
            check_results([path])
            write_text(path, text)
    path.write_text("edited by hand")
    with guarding_results(), pytest.raises(InputError, match=FOREIGN):
        write_text(path, "third")
    assert path.read_text() == "edited by hand"


def test_a_result_that_was_moved_is_the_users(tmp_path):
    with guarding_results():
        write_text(tmp_path / "a.csv", "a")
    (tmp_path / "kept").mkdir()
    (tmp_path / "a.csv").rename(tmp_path / "kept" / "a.csv")
    with guarding_results(), pytest.raises(InputError, match=FOREIGN):
        check_result(tmp_path / "kept" / "a.csv")


def test_a_command_may_write_its_own_result_again_even_where_no_list_can_be_kept(tmp_path):
    (tmp_path / MANIFEST).mkdir()
    with guarding_results():
        write_text(tmp_path / "search.json", "1")
        write_text(tmp_path / "search.json", "2")
    with guarding_results(), pytest.raises(InputError, match=FOREIGN):
        write_text(tmp_path / "search.json", "3")


@pytest.mark.parametrize("force", [False, True])
def test_what_was_read_is_never_written_over(mine, tmp_path, force):
    (tmp_path / "folder").mkdir()
    others = [mine, tmp_path / "folder" / ".." / "mine.csv", tmp_path / "hard.csv"]
    os.link(mine, others[-1])
    with noting_reads(), guarding_results(force):
        note_read(mine)
        for path in others:
            with pytest.raises(InputError, match="is a file that this command reads"):
                write_bytes(path, b"new")
    assert {path.read_text() for path in others} == {"mine"}


@posix
def test_what_was_read_through_a_link_is_known(mine, tmp_path):
    (tmp_path / "link.csv").symlink_to(mine)
    (tmp_path / "linked").symlink_to(tmp_path)
    with noting_reads():
        assert not was_read(mine)
        note_read(tmp_path / "linked" / "link.csv")
        assert was_read(mine)
        assert was_read(tmp_path / "linked" / "mine.csv")
        with guarding_results(force=True), pytest.raises(InputError, match="is a file that this command reads"):
            write_text(tmp_path / "linked" / "mine.csv", "new")
        with noting_reads():
            assert not was_read(mine)
    assert not was_read(mine)


def test_a_file_that_was_named_but_is_not_there_may_be_written(tmp_path):
    with noting_reads(), guarding_results():
        note_read(tmp_path / "recording.csv")
        note_read("a\0b")
        write_text(tmp_path / "recording.csv", "first")
    assert (tmp_path / "recording.csv").read_text() == "first"


@posix
@pytest.mark.parametrize("guarded", [False, True])
@pytest.mark.parametrize("kind", ["folder", "pipe", "socket", "device", "link", "broken link", "link to a device"])
def test_only_regular_files_are_written_over(tmp_path, monkeypatch, kind, guarded):
    monkeypatch.chdir(tmp_path)  # a socket's name is short
    (tmp_path / "real").write_text("mine")
    path = tmp_path / "out.csv"
    bound = None
    if kind == "folder":
        path.mkdir()
    elif kind == "pipe":
        os.mkfifo(path)
    elif kind == "socket":
        bound = socket.socket(socket.AF_UNIX)
        bound.bind("out.csv")
    elif kind == "device":
        path = path.__class__("/dev/null")
    else:
        path.symlink_to({"link": tmp_path / "real", "broken link": tmp_path / "absent", "link to a device": "/dev/null"}[kind])
    before = path.lstat().st_ino
    words = kind if kind in ("folder", "pipe", "socket", "device") else "symbolic link"
    try:
        with noting_reads():
            if guarded:
                with guarding_results(force=True), pytest.raises(InputError, match=f"it is a {words}; the name of a file was expected"):
                    write_text(path, "new")
            else:
                with pytest.raises(InputError, match=f"it is a {words}; the name of a file was expected"):
                    write_text(path, "new")
    finally:
        if bound is not None:
            bound.close()
    assert path.lstat().st_ino == before
    assert (tmp_path / "real").read_text() == "mine"
    assert not (tmp_path / "absent").exists()


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("mine.csv/out/a.csv", "is not a folder"),
        ("a" * 300, "File name too long"),
        (MANIFEST, "vehgen keeps this name for itself"),
        (".vehgen-1-0123456789ab.tmp", "vehgen keeps this name for itself"),
        (".", "it is a folder"),
    ],
)
@pytest.mark.usefixtures("command")
def test_names_that_cannot_be_written_are_refused_before_the_work(mine, tmp_path, name, message):
    with pytest.raises(InputError, match=message):
        check_results([tmp_path / name])
    assert [path.name for path in tmp_path.iterdir()] == ["mine.csv"]


@pytest.mark.skipif(os.name != "posix" or os.getuid() == 0, reason="needs a user whom permissions bind")
def test_a_folder_without_permission_is_refused_before_the_work(tmp_path):
    tmp_path.chmod(0o555)
    with pytest.raises(InputError, match="without permission to write"):
        check_results([tmp_path / "new" / "a.csv"])


def test_two_results_of_one_name_are_refused(tmp_path):
    (tmp_path / "x").mkdir()
    with pytest.raises(InputError, match="two results would be written to"):
        check_results([tmp_path / "a.png", tmp_path / "x" / ".." / "a.png"])


def test_in_a_python_session_files_are_replaced_and_not_marked(mine):
    note_read(mine)
    write_text(mine, "new")
    assert mine.read_text() == "new"
    assert [path.name for path in mine.parent.iterdir()] == ["mine.csv"]
