"""The page of the example files: what each folder holds, to be read and downloaded."""

from __future__ import annotations

from pathlib import Path

HEAD = "# Files of the examples\n\nEverything that tutorials, how-tos and notebooks use.\n"


def examples_page(folder: Path) -> str:
    """Return the page in Markdown.

    Parameters
    ----------
    folder
        The folder of the examples.
    """
    lines = [HEAD]
    for place in (folder, *sorted(item for item in folder.iterdir() if item.is_dir())):
        files = sorted(item for item in place.iterdir() if item.is_file())
        if place != folder:
            lines += [f"## {place.name}", ""]
        lines += [f"- [{file.name}]({file.relative_to(folder.parent).as_posix()})" for file in files] + [""]
    return "\n".join(lines)
