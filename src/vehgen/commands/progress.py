"""Progress bars of long work, on the terminal's error stream; silent where nobody looks."""

from __future__ import annotations

from vehgen.commands.terminal import console
from vehgen.errors import printable


class Bars:
    """A progress bar for every piece of work, with the best result so far, the time it took and the time that is left.

    Parameters
    ----------
    quiet
        Show nothing.
    """

    def __init__(self, quiet: bool) -> None:
        from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

        self._console = console(stderr=True)
        self._bars = Progress(
            TextColumn("{task.description}", markup=False),
            BarColumn(),
            TextColumn("{task.completed:.0f}/{task.total:.0f}  {task.fields[best]}", markup=False),
            TimeElapsedColumn(),
            TextColumn("left"),
            TimeRemainingColumn(),
            console=self._console,
            disable=quiet or not self._console.is_terminal,
        )
        self._tasks: dict[str, int] = {}

    def __enter__(self) -> Bars:
        self._bars.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._bars.stop()

    def tell(self, label: str, done: int, total: int, best: str = "") -> None:
        """Show what is done."""
        from rich.progress import TaskID

        if label not in self._tasks:
            self._tasks[label] = int(self._bars.add_task(printable(label), total=total, best=""))
        self._bars.update(TaskID(self._tasks[label]), completed=done, total=total, best=printable(best))

    def say(self, text: str) -> None:
        """Print a line."""
        self._console.print(printable(text))
