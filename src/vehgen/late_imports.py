"""When is a package's name imported? When it is first used: a command loads only what it needs."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping
from importlib import import_module
from types import ModuleType
from typing import Any


class LatePackage(ModuleType):
    """A package whose names are imported when they are first used.

    Names stand before modules that are called alike: `vehgen.simulate` is the function. An import of such a module would set the
    attribute to the module itself; `from vehgen.simulate import ...` needs none.
    """

    def __setattr__(self, name: str, value: Any) -> None:
        if not (name in vars(self).get("_late_homes", ()) and isinstance(value, ModuleType)):
            super().__setattr__(name, value)

    def __getattr__(self, name: str) -> Any:
        home = vars(self).get("_late_homes", {}).get(name)
        if home is None:
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")
        return getattr(import_module(home), name)

    def __dir__(self) -> list[str]:
        return sorted({*vars(self), *vars(self).get("_late_homes", ())})


def import_late(package: str, homes: Mapping[str, Iterable[str]]) -> None:
    """Let a package import its names when they are first used.

    Parameters
    ----------
    package
        Its `__name__`; called from its own `__init__`.
    homes
        The module of each name: module -> names.
    """
    module = sys.modules[package]
    vars(module)["_late_homes"] = {name: home for home, names in homes.items() for name in names}
    module.__class__ = LatePackage
