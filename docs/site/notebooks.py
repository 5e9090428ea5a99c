"""The notebooks: percent scripts of docs/notebooks, executed, as pages of the site and as .ipynb to download."""

from __future__ import annotations

import shutil
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory

import jupytext
import nbformat
from nbclient import NotebookClient
from nbconvert import MarkdownExporter
from traitlets.config import Config

HERE = Path(__file__).parents[1]
FOLDER, EXAMPLES = HERE / "notebooks", HERE / "examples"
SECONDS = 300
"""Longest time for a cell; all cells of a notebook take less than a minute on two cores."""


def notebook_files(executed: bool) -> dict[str, str | bytes]:
    """Return pages, pictures and notebooks by their paths on the site.

    Parameters
    ----------
    executed
        Whether to execute them, two at a time; else they are shown without results.
    """
    with ThreadPoolExecutor(2) as pool:
        made = pool.map(lambda script: _made(script, executed), sorted(FOLDER.glob("*.py")))
    return {path: content for files in made for path, content in files.items()}


def _made(script: Path, executed: bool) -> dict[str, str | bytes]:
    notebook = jupytext.read(script, fmt="py:percent")
    notebook.metadata["kernelspec"] = {"name": "python3", "display_name": "Python 3", "language": "python"}
    name = script.stem
    if executed:
        _execute(notebook)
    page, resources = MarkdownExporter().from_notebook_node(notebook, {"output_files_dir": f"{name}_files"})
    title, _, rest = page.lstrip().partition("\n")
    text = f"{title}\n\nRun in a folder with [the example files](../examples.md). [This page as a notebook]({name}.ipynb).\n{rest}"
    pictures = {f"notebooks/{path}": content for path, content in resources["outputs"].items()}
    return {f"notebooks/{name}.md": text, f"notebooks/{name}.ipynb": nbformat.writes(notebook) + "\n", **pictures}


def _execute(notebook: nbformat.NotebookNode) -> None:
    """Execute one in a copy of the examples, so that what it writes stays out of them."""
    with TemporaryDirectory() as folder:
        shutil.copytree(EXAMPLES, folder, dirs_exist_ok=True)
        ipc = {"KernelManager": {"transport": "ipc", "ip": f"{folder}/kernel"}}  # no port of the machine is opened
        NotebookClient(notebook, timeout=SECONDS, resources={"metadata": {"path": folder}}, config=Config(ipc)).execute()
