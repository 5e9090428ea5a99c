"""The kernel cache is kept small: what was not used for long goes, then the least recently used beyond a size."""

from __future__ import annotations

import re
import sys
import time
from contextlib import suppress
from pathlib import Path

from vehgen.codegen.kernel_store import SECONDS_PER_DAY

MAX_UNUSED_DAYS = 60.0
MAX_CACHE_BYTES = 1_000_000_000
STAMP = "pruned"
_OWN = re.compile(r"\.?((?:kernel|model)_[0-9a-f]{20})\..+")
"""Files of vehgen's cache, those of former versions and unfinished ones (with a dot in front) included."""


def prune(folder: Path, max_unused_days: float = MAX_UNUSED_DAYS, max_bytes: int = MAX_CACHE_BYTES) -> None:
    """Remove kernels that were not used lately, at most once a day; never those that this process has loaded, nor any other file.

    Parameters
    ----------
    folder
        A cache folder; reading a kernel renews its time of change at most a day late.
    max_unused_days
        Kernels unused for longer are removed [days].
    max_bytes
        Beyond this total the least recently used are removed.
    """
    now = time.time()
    stamp = folder / STAMP
    with suppress(OSError):
        if 0 <= now - stamp.stat().st_mtime < SECONDS_PER_DAY:
            return
    with suppress(OSError):
        stamp.touch(mode=0o600)
        _remove_old(folder, now, max_unused_days, max_bytes)


def _remove_old(folder: Path, now: float, max_unused_days: float, max_bytes: int) -> None:
    found: list[tuple[float, int, Path]] = []
    for path in [*folder.iterdir(), *(folder / "__pycache__").glob("kernel_*")]:
        match = _OWN.fullmatch(path.name)
        if match is None or f"vehgen_{match[1]}" in sys.modules:
            continue
        with suppress(OSError):  # another process may have removed it
            state = path.lstat()
            found.append((now - state.st_mtime, state.st_size, path))
    total = 0
    for age, size, path in sorted(found, key=lambda item: item[0]):
        total += size
        unfinished = path.name.startswith(".") and age > SECONDS_PER_DAY
        if unfinished or age > max_unused_days * SECONDS_PER_DAY or total > max_bytes:
            with suppress(OSError):
                path.unlink()
