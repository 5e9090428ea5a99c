"""The kernel cache: what is damaged or foreign is not read, what cannot be written costs time, and it stays small."""

from __future__ import annotations

import errno
import os
import pickle
import subprocess
import sys
import tempfile
import time
import warnings
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import ModuleType

import numba
import pytest

from vehgen.codegen import cache_pruning, kernel_store
from vehgen.codegen.cache import cache_folder, import_kernel, is_compiled, kernel_name
from vehgen.errors import CacheWarning

TEXT = """import numba


@numba.njit("f8(f8)", cache=True)
def advance(x):
    return 2.0 * x + {constant}
"""
SMALL = TEXT.format(constant=1.0)
LINE = 1 + SMALL[: SMALL.index("@")].count("\n")


class Trap:
    """Makes a file when it is unpickled."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def __reduce__(self) -> tuple[object, tuple[object, ...]]:
        return os.mkdir, (str(self.path),)


def fresh(text: str, folder: Path) -> ModuleType:
    """Import a kernel as a new process would, and check that it computes."""
    sys.modules.pop(f"vehgen_{kernel_name(text)}", None)
    module = import_kernel(text, folder)
    assert module.advance(3.0) == 7.0
    return module


def hits(module: ModuleType) -> int:
    return sum(module.advance.stats.cache_hits.values())


def bundle(folder: Path) -> Path:
    return folder / f"{kernel_name(SMALL)}.bundle"


@pytest.fixture(autouse=True)
def new_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """Forget which folders were found unusable, and the private one used instead."""
    monkeypatch.setattr(kernel_store, "_private", {})
    monkeypatch.setattr(kernel_store, "_writable", {})


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A cache that holds the small kernel."""
    place = tmp_path / "cache"
    assert hits(fresh(SMALL, place)) == 0
    return place


def test_compiled_code_is_found_again_and_is_the_users_own(folder: Path):
    assert hits(fresh(SMALL, folder)) == 1
    assert is_compiled(SMALL, folder)
    assert folder.stat().st_mode & 0o777 == 0o700
    assert {path.stat().st_mode & 0o077 for path in folder.iterdir()} == {0}
    assert [path.suffix for path in folder.iterdir() if path.name != cache_pruning.STAMP] == [".bundle"]


def other_kernels(path: Path) -> bytes:
    other = TEXT.format(constant=5.0)
    import_kernel(other, path.parent)
    return (path.parent / f"{kernel_name(other)}.bundle").read_bytes()


DAMAGE = {
    "empty": lambda path: b"",
    "the mark alone": lambda path: kernel_store.MARK,
    "truncated": lambda path: path.read_bytes()[:-100],
    "garbage": lambda path: os.urandom(5000),
    "garbage behind the mark": lambda path: kernel_store.MARK + os.urandom(5000),
    "one bit": lambda path: path.read_bytes()[:4000] + bytes([path.read_bytes()[4000] ^ 1]) + path.read_bytes()[4001:],
    "another kernel": other_kernels,
}


@pytest.mark.parametrize("damage", sorted(DAMAGE))
def test_a_damaged_entry_is_a_miss_and_is_replaced(damage: str, folder: Path):
    sys.modules.pop(f"vehgen_{kernel_name(SMALL)}")
    bundle(folder).write_bytes(DAMAGE[damage](bundle(folder)))
    assert not is_compiled(SMALL, folder)
    assert hits(fresh(SMALL, folder)) == 0
    assert hits(fresh(SMALL, folder)) == 1


@pytest.mark.parametrize("content", [b"", b"\x80", b"garbage"], ids=["empty", "truncated", "garbage"])
@pytest.mark.parametrize("suffix", ["nbi", "1.nbc"])
def test_loose_files_of_numba_are_not_read(suffix: str, content: bytes, tmp_path: Path):
    """Where numba itself would look: beside a source in the cache folder."""
    loose = tmp_path / "__pycache__"
    loose.mkdir()
    name = f"{kernel_name(SMALL)}.advance-{LINE}.py{sys.version_info.major}{sys.version_info.minor}.{suffix}"
    (loose / name).write_bytes(content)
    fresh(SMALL, tmp_path)
    (loose / name).write_bytes(pickle.dumps(Trap(tmp_path / "TRAPPED")))
    bundle(tmp_path).unlink()
    fresh(SMALL, tmp_path)
    assert not (tmp_path / "TRAPPED").exists()


def set_trap(folder: Path) -> Path:
    """Put an entry with an intact digest into the cache whose index, unpickled, makes a folder."""
    trap = folder.parent / "TRAPPED"
    parts = kernel_store.read_parts(folder, kernel_name(SMALL))
    data = pickle.dumps(Trap(trap))
    kernel_store.write_parts(folder, kernel_name(SMALL), {item: data if item.endswith(".nbi") else parts[item] for item in parts})
    return trap


def test_the_trap_works(folder: Path):
    trap = set_trap(folder)
    with pytest.raises(FileExistsError):  # numba reads it twice
        fresh(SMALL, folder)
    assert trap.exists()


FOREIGN = {
    "folder for all": lambda folder: folder.chmod(0o777),
    "folder for the group": lambda folder: folder.chmod(0o770),
    "file for all": lambda folder: bundle(folder).chmod(0o666),
    "file for the group": lambda folder: bundle(folder).chmod(0o660),
    "a parent for all": lambda folder: folder.parent.chmod(0o777),
}


@pytest.mark.parametrize("way", sorted(FOREIGN))
def test_what_another_user_could_have_written_is_not_read(way: str, folder: Path):
    trap = set_trap(folder)
    FOREIGN[way](folder)
    with warnings.catch_warnings(record=True, action="always") as told:
        kernel_store._writable.clear()
        fresh(SMALL, folder)
    assert not trap.exists()
    assert [item.category for item in told] == ([] if way.startswith("file") else [CacheWarning])
    assert hits(fresh(SMALL, folder)) == 1  # from the replaced entry, or from this process's own folder


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="only root can give a file away")
@pytest.mark.parametrize("what", ["folder", "file"])
def test_what_belongs_to_another_user_is_not_read(what: str, folder: Path, monkeypatch: pytest.MonkeyPatch):
    trap = set_trap(folder)
    os.chown(folder if what == "folder" else bundle(folder), 65534, -1)
    monkeypatch.setattr(kernel_store, "_writable", {})
    with warnings.catch_warnings(record=True, action="always") as told:
        fresh(SMALL, folder)
    assert not trap.exists()
    assert ["it belongs to another user" in str(item.message) for item in told] == [True] * (what == "folder")


def test_a_sticky_parent_is_trusted(folder: Path):
    folder.parent.chmod(0o1777)
    assert kernel_store.distrust(folder) is None


def fill_up(monkeypatch: pytest.MonkeyPatch, function: str, place: Path | None) -> None:
    """Let a function of `tempfile` find no space in a folder."""
    make = getattr(tempfile, function)

    def full(*arguments: object, **options: object) -> object:
        if options.get("dir") == place:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return make(*arguments, **options)

    monkeypatch.setattr(tempfile, function, full)


@pytest.mark.parametrize("way", ["a file in its place", "a place that cannot be made", "a full disk"])
def test_a_folder_that_cannot_be_written_costs_time_only(way: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    place = tmp_path / "cache"
    if way == "a file in its place":
        place.write_text("mine")
    elif way == "a place that cannot be made":
        place = Path("/proc/vehgen")
    else:
        fill_up(monkeypatch, "TemporaryFile", place)
    with pytest.warns(CacheWarning, match=r"the kernel cache .* is not used: .*VEHGEN_CACHE chooses another folder"):
        fresh(SMALL, place)
    assert hits(fresh(SMALL, place)) == 1  # this process keeps it, and warns once
    assert way != "a file in its place" or place.read_text() == "mine"


def test_a_disk_that_fills_up_while_it_is_written(folder: Path, monkeypatch: pytest.MonkeyPatch):
    text = TEXT.format(constant=1.0) + "\n"
    fill_up(monkeypatch, "mkstemp", folder)
    with pytest.warns(CacheWarning, match="No space left on device"):
        fresh(text, folder)
    assert not list(folder.glob(".*"))


def test_the_private_folder_and_the_stage_go_with_the_process(tmp_path: Path):
    (tmp_path / "taken").write_text("mine")
    (tmp_path / "temporary").mkdir()
    program = (
        "import sys; from pathlib import Path; from vehgen.codegen.cache import import_kernel; from vehgen.codegen import kernel_store;"
        f"print(import_kernel({SMALL!r}, Path('taken')).advance(3.0), kernel_store.private_folder().parent.name)"
    )
    environment = {**os.environ, "TMPDIR": str(tmp_path / "temporary")}
    found = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, env=environment, capture_output=True, text=True, check=True)
    assert found.stdout == "7.0 temporary\n"
    assert "CacheWarning" in found.stderr
    assert list((tmp_path / "temporary").iterdir()) == []


def test_a_user_without_a_home_gets_a_private_folder(monkeypatch: pytest.MonkeyPatch):
    def no_home() -> Path:
        raise RuntimeError("Could not determine home directory.")

    for name in ("VEHGEN_CACHE", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(Path, "home", no_home)
    monkeypatch.setattr(sys, "platform", "linux")
    assert kernel_store.distrust(cache_folder()) is None


def test_numbas_own_cache_folder_is_left_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "numba"))
    fresh(SMALL, tmp_path / "cache")
    assert not (tmp_path / "numba").exists()
    assert str(tmp_path / "numba") == numba.config.CACHE_DIR


@pytest.mark.thorough
def test_processes_and_threads_may_import_at_once(tmp_path: Path):
    program = (
        f"from pathlib import Path; from vehgen.codegen.cache import import_kernel; print(import_kernel({SMALL!r}, Path('c')).advance(3.0))"
    )
    running = [subprocess.Popen([sys.executable, "-c", program], cwd=tmp_path, stdout=subprocess.PIPE, text=True) for _ in range(3)]
    assert [process.communicate()[0] for process in running] == ["7.0\n"] * 3
    sys.modules.pop(f"vehgen_{kernel_name(SMALL)}", None)
    with ThreadPoolExecutor(4) as pool:
        modules = list(pool.map(lambda _: import_kernel(SMALL, tmp_path / "c"), range(8)))
    assert len(set(map(id, modules))) == 1
    assert hits(modules[0]) == 1


def test_a_path_in_an_entry_does_not_lead_out_of_the_stage(folder: Path):
    kernel_store.write_parts(folder, "kernel_x", {"../up.nbi": b"1", "/tmp/vehgen_up.nbi": b"2", "kernel_x.nbi": b"3"})
    assert kernel_store.read_parts(folder, "kernel_x") == {"kernel_x.nbi": b"3"}


@pytest.mark.parametrize("way", ["full", "open to everybody"])
def test_a_folder_of_temporary_files_that_cannot_be_used(way: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """The cache takes its place; where it cannot be trusted either, nothing is imported."""
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    temporary.chmod(0o777 if way == "open to everybody" else 0o700)
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    if way == "full":
        fill_up(monkeypatch, "TemporaryDirectory", None)
    fresh(SMALL, tmp_path / "cache")
    assert list(temporary.iterdir()) == []
    if way == "open to everybody":
        (tmp_path / "taken").write_text("mine")
        text = SMALL + "\n\n"
        with pytest.warns(CacheWarning, match="File exists"), pytest.raises(OSError, match=r"not safe: .*temporary has mode 0777"):
            import_kernel(text, tmp_path / "taken")


DAY = 86_400


def put(folder: Path, name: str, days: float, size: int = 10) -> Path:
    path = folder / name
    path.write_bytes(bytes(size))
    when = time.time() - days * DAY
    os.utime(path, (when, when))
    return path


def test_the_cache_is_pruned_by_age_and_size_but_not_of_what_is_in_use(folder: Path):
    (folder / cache_pruning.STAMP).unlink()
    (folder / "__pycache__").mkdir()
    kernel = "kernel_" + "0123456789" * 2
    old = [put(folder, f"{kernel}.bundle", 70), put(folder, f".{kernel}.half", 2), put(folder, f"__pycache__/{kernel}.advance-4.nbi", 61)]
    large = [put(folder, f"kernel_{i:020d}.bundle", 10 + i, 1000) for i in range(5)]
    foreign = [put(folder, name, 900) for name in ("notes.txt", "kernel_of_mine.py", "kernel_0123.bundle")]
    os.utime(bundle(folder), (0, 0))
    cache_pruning.prune(folder, max_bytes=3500)
    assert not any(path.exists() for path in old)
    assert [path.exists() for path in large] == [True, True, True, False, False]
    assert all(path.exists() for path in foreign)
    assert bundle(folder).exists()  # this process has loaded it
    again = put(folder, f"{kernel}.bundle", 70)
    cache_pruning.prune(folder)
    assert again.exists()  # once a day


def test_reading_renews_the_time_of_use(folder: Path):
    os.utime(bundle(folder), (0, 0))
    fresh(SMALL, folder)
    assert time.time() - bundle(folder).stat().st_mtime < DAY


@pytest.mark.thorough
def test_without_numbas_compiler_plain_python_gives_the_same(tmp_path: Path):
    """With force laws (lower, upper, sign, step) and in both precisions, against the compiled kernel."""
    program = """
import sys
from pathlib import Path
import numpy as np
from vehgen.codegen import Excitation, Kernel
from vehgen.mechanics import PointOutput, Place, derive
from vehgen.vehicle import parse_vehicle
laws = "[{dry_friction: {force: 300 N}}, {bump_stop: {k: 1 MN/m, clearance: 8 mm}}, {quadratic_damping: {c2: 5e3 N s^2/m^2}}]"
vehicle = parse_vehicle(f"extends: quarter_car\\naxles: {{axle1: {{suspension: {{laws: {laws}}}}}}}\\n")
model = derive(vehicle, [PointOutput("a", Place("s", "body"), "acceleration")])
inputs = 0.02 * np.sin(np.linspace(0, np.pi, 61))[:, None] ** 2
drive = Excitation(1e-3, inputs, np.gradient(inputs, 1e-3, axis=0), np.zeros((61, 0)))
for precision in ("double", "single"):
    kernel = Kernel(model, Path(sys.argv[1]), precision=precision)
    print(" ".join(repr(float(value)) for value in kernel.run([list(model.values().values())], drive, threads=1).responses.ravel()))
"""
    lines = []
    for disabled in ("0", "1"):
        environment = {**os.environ, "NUMBA_DISABLE_JIT": disabled}
        command = [sys.executable, "-W", "ignore", "-c", program.replace("\\\\", "\\"), str(tmp_path)]
        found = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
        lines.append([[float(word) for word in line.split()] for line in found.stdout.splitlines()])
    assert max(map(abs, lines[0][0])) > 0.1
    assert lines[1][0] == pytest.approx(lines[0][0], rel=1e-9, abs=1e-9)
    assert lines[1][1] == pytest.approx(lines[0][1], rel=1e-3, abs=1e-3)
