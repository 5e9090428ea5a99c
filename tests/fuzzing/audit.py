"""An audit hook that writes down what Python is asked to do beside reading: it can be armed, never taken off."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from types import CodeType

from tests.fuzzing.hostile import MARK

WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
STARTING = (
    "subprocess.Popen",
    "os.system",
    "os.exec",
    "os.posix_spawn",
    "os.spawn",
    "os.fork",
    "os.forkpty",
    "os.startfile",
    "pty.spawn",
    "os.kill",
)
CHANGING = (
    "os.remove",
    "os.rename",
    "os.rmdir",
    "os.mkdir",
    "os.link",
    "os.symlink",
    "os.truncate",
    "os.chmod",
    "os.chown",
    "os.utime",
    "shutil.",
)
LOADING = ("pickle.find_class", "ctypes.dlopen", "marshal.loads", "webbrowser.open", "code.__new__")
SHELTERED = ("/dev/null",)
IGNORED = ("socket.__new__", "socket.gethostname")


class Audit:
    """What a file made Python do.

    Parameters
    ----------
    folders
        Where writing is allowed.
    kernels
        Whether kernels may be imported: numba then reads its own pickles, loads machine code, and executes generated sources.
    """

    def __init__(self) -> None:
        self.armed = False
        self.folders: tuple[str, ...] = ()
        self.kernels = False
        self.found: list[str] = []
        self.known: set[str] = set()
        self._inside = False
        sys.addaudithook(self._hook)

    def arm(self, folders: Iterable[str], kernels: bool) -> None:
        """Begin to write down."""
        self.folders = tuple(os.path.realpath(folder) for folder in folders)
        self.kernels = kernels
        self.armed = True

    def _hook(self, event: str, arguments: tuple[object, ...]) -> None:
        if not self.armed or self._inside:
            return
        self._inside = True
        try:
            if fault := self._fault(event, arguments):
                self.found.append(fault)
        finally:
            self._inside = False

    def _fault(self, event: str, arguments: tuple[object, ...]) -> str | None:
        if event == "open":
            return self._opened(*arguments)
        if event.startswith(STARTING) or (event.startswith("socket.") and event not in IGNORED):
            return f"{event} {arguments!r}"[:300]
        if event in ("os.remove", "os.rmdir") and isinstance(arguments[1], int) and arguments[1] >= 0:
            arguments = (os.path.join(os.readlink(f"/proc/self/fd/{arguments[1]}"), os.fsdecode(str(arguments[0]))), -1)
        if event.startswith(CHANGING):
            outside = [item for item in arguments[:2] if isinstance(item, (str, bytes, os.PathLike)) and not self._allowed(item)]
            return f"{event} outside --out: {os.fspath(outside[0])!r}"[:300] if outside else None
        if event.startswith(LOADING):
            return None if self.kernels or event == "marshal.loads" else f"{event} {arguments!r}"[:300]
        if event == "exec" and isinstance(arguments[0], CodeType):
            return self._executed(arguments[0])
        if event == "compile" and isinstance(arguments[0], (str, bytes)):
            return self._compiled(arguments[0], str(arguments[1]))
        return None

    def _opened(self, path: object, mode: object, flags: object) -> str | None:
        if not isinstance(path, (str, bytes, os.PathLike)):
            return None
        writing = (isinstance(flags, int) and flags & WRITING) or (isinstance(mode, str) and set(mode) & set("wax+"))
        return f"open for writing outside --out: {os.fspath(path)!r}"[:300] if writing and not self._allowed(path) else None

    def _allowed(self, path: str | bytes | os.PathLike[str]) -> bool:
        real = os.path.realpath(os.fsdecode(path))
        return real in SHELTERED or any(real == folder or real.startswith(folder + os.sep) for folder in self.folders)

    def _executed(self, code: CodeType) -> str | None:
        if holds_mark(code):
            return f"exec of code that holds a text of the file, {code.co_filename}"
        if "kernel_" in os.path.basename(code.co_filename) and not self.kernels:
            return f"a kernel is imported: {code.co_filename}"
        generated = code.co_filename.startswith("<") and not code.co_filename.startswith("<frozen")
        return f"exec of {code.co_filename}" if generated and not self.kernels and not self._library() else None

    def _compiled(self, source: str | bytes, filename: str) -> str | None:
        text = source.decode("utf-8", "replace") if isinstance(source, bytes) else source
        if MARK in text and filename != "<unknown>":  # ast.parse alone compiles `<unknown>`, and executes nothing
            return f"compile of a text of the file, {filename}"
        return None

    def _library(self) -> bool:
        """Whether the code is executed by a library that makes classes of texts of its own (namedtuple, dataclass)."""
        frame = sys._getframe(4)
        while frame is not None:
            name = frame.f_globals.get("__name__", "")
            if name in {"collections", "dataclasses", "typing", "enum"} or name.startswith("importlib"):
                return True
            if name.startswith(("vehgen", "sympy")):
                return False
            frame = frame.f_back
        return False


def holds_mark(code: CodeType) -> bool:
    """Whether names or constants of a code object hold MARK."""
    words = [*code.co_names, *code.co_varnames, *(item for item in code.co_consts if isinstance(item, str))]
    return any(MARK in word for word in words) or any(holds_mark(item) for item in code.co_consts if isinstance(item, CodeType))
