"""The last excitations, by what they were made from: a fit asks for the same road under the same wheels again and again."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from threading import Lock

from vehgen.codegen import Excitation

MAX_CACHED_BYTES = 100_000_000
"""Excitations are forgotten, the oldest first, beyond this size [bytes]."""


class ExcitationCache:
    """Remembers excitations up to MAX_CACHED_BYTES.

    A key may hold ids of objects: `alive` is kept as long as the key, so that no other object takes their places.
    """

    def __init__(self) -> None:
        self._known: OrderedDict[Hashable, tuple[Excitation, object]] = OrderedDict()
        self._bytes = 0
        self._lock = Lock()

    def find(self, key: Hashable, alive: object, make: Callable[[], Excitation]) -> Excitation:
        """Return the excitation of a key, made if it is not known."""
        with self._lock:
            if key in self._known:
                self._known.move_to_end(key)
                return self._known[key][0]
        excitation = make()
        with self._lock:
            if key not in self._known:
                self._known[key] = excitation, alive
                self._bytes += _size(excitation)
            while self._bytes > MAX_CACHED_BYTES and len(self._known) > 1:
                self._bytes -= _size(self._known.popitem(last=False)[1][0])
        return excitation


def _size(excitation: Excitation) -> int:
    return int(excitation.inputs.nbytes + excitation.rates.nbytes + excitation.forces.nbytes)
