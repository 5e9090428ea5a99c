"""The pages of the API: every public name, and every class that one of them returns, with its docstring."""

from __future__ import annotations

import importlib.util
import inspect
import typing
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import vehgen


def api_pages() -> dict[str, tuple[str, str]]:
    """Return the pages in the Markdown of mkdocstrings, by path: title and text."""
    pages, shown = {}, {getattr(vehgen, name) for name in vehgen.__all__}
    for section in _sections():
        items = [getattr(vehgen, name) for name in section.names]
        results = [item for item in dict.fromkeys(found for made in items for found in _results(made)) if item not in shown]
        shown.update(results)
        path = f"api/{section.title.lower().replace(',', '').replace(' ', '_')}.md"
        lines = [f"# {section.title}", "", "With examples in [From Python](../api.md).", ""]
        for name, item in zip(section.names, items, strict=True):
            lines += _entry(item, f"vehgen.{name}")
        for item in results:
            lines += _entry(item, item.__name__)
        pages[path] = section.title, "\n".join(lines)
    return pages


def _sections() -> Any:
    path = Path(__file__).parents[1] / "generate" / "api_page.py"
    specification = importlib.util.spec_from_file_location("api_page", path)
    assert specification is not None
    assert specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module.SECTIONS


def _results(item: Any) -> Iterator[type]:
    """Yield the package's own classes that a function returns."""
    if inspect.isclass(item):
        return
    packages = [importlib.import_module(f"vehgen.{name}") for name in ("mechanics", "simulate", "vehicle")]
    late = {name: getattr(package, name) for package in packages for name in package.__all__}
    returned = typing.get_type_hints(item, localns=late).get("return")
    for kind in (returned, *typing.get_args(returned)):
        if inspect.isclass(kind) and kind.__module__.startswith("vehgen."):
            yield kind


def _entry(item: Any, title: str) -> list[str]:
    return [f"::: {item.__module__}.{item.__qualname__}", "    options:", f"      heading: {title}", f"      toc_label: {title}", ""]
