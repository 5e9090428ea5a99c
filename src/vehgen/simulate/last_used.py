"""Keeps what was computed last, by what it was computed from: a fit needs the same road, and the same response, many times."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from threading import Lock
from typing import Generic, TypeVar

Kept = TypeVar("Kept")
MOST_BYTES = 100_000_000
"""What was used longest ago is forgotten, beyond this size [bytes]."""


class LastUsed(Generic[Kept]):
    """Remembers what was made last, up to MOST_BYTES.

    A key may hold ids of objects: `alive` is kept as long as the key, so that no other object takes their places.

    Parameters
    ----------
    size
        Returns how many bytes something takes.
    """

    def __init__(self, size: Callable[[Kept], int]) -> None:
        self._size = size
        self._known: OrderedDict[Hashable, tuple[Kept, object]] = OrderedDict()
        self._bytes = 0
        self._lock = Lock()

    def find(self, key: Hashable, alive: object, make: Callable[[], Kept]) -> Kept:
        """Return what belongs to a key, made if it is not known; not to be written to."""
        with self._lock:
            if key in self._known:
                self._known.move_to_end(key)
                return self._known[key][0]
        made = make()
        with self._lock:
            if key not in self._known:
                self._known[key] = made, alive
                self._bytes += self._size(made)
            while self._bytes > MOST_BYTES and len(self._known) > 1:
                self._bytes -= self._size(self._known.popitem(last=False)[1][0])
        return made
