"""How a command ends: done, refused in one line, stopped, or with nobody left to read what it prints."""

from __future__ import annotations

import argparse
import logging
import select
import signal
import sys
import threading
import traceback
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from types import FrameType
from typing import Any, NoReturn, TextIO

from vehgen.commands.terminal import one_line, say_on_stderr, silence
from vehgen.errors import CacheWarning, InputError, ModelWarning, did_you_mean, shortened, shown

UNUSABLE, STOPPED, TERMINATED = 2, 130, 143
"""Exit codes; the last two are those of shells, 128 and the number of the signal."""


class OneLineParser(argparse.ArgumentParser):
    """A parser whose refusals are lines as all others, with what they quote escaped."""

    def error(self, message: str) -> NoReturn:
        """Refuse the arguments."""
        raise InputError(f"{shortened(message, 300)}; `{self.prog} --help` lists what is known")

    def parse(self, words: Sequence[str]) -> argparse.Namespace:
        """Return the options; what is none is refused by the parser of its command, with the nearest name."""
        options, left = self.parse_known_args(words)
        if left:
            parser = getattr(options, "parser", self)
            unknown = [word.partition("=")[0] for word in left if word.startswith("-")]
            hint = did_you_mean(unknown[0], parser.option_names) if unknown else ""
            parser.error(f"unrecognized arguments: {' '.join(left)}{f'; {hint}' if hint.startswith('did you mean') else ''}")
        return options

    @property
    def option_names(self) -> list[str]:
        """The options that it knows."""
        return [name for name in self._option_string_actions if name.startswith("--")]

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        """Refuse a value that is none of its choices, with the nearest ones."""
        if action.choices is not None and value not in action.choices:
            known = did_you_mean(str(value), map(str, action.choices))
            raise argparse.ArgumentError(action, f"invalid choice: {shown(value)}; {known}")


def end_of(work: Callable[[], int | None], debug: bool = False) -> int:
    """Do a command's work, print what ends it in one line on stderr, and return the exit code.

    Parameters
    ----------
    work
        What the command does; it may return an exit code.
    debug
        Print where it ended, too.
    """
    try:
        with _terminable():
            try:
                code = work()
            finally:
                if sys.stdout is not None:
                    sys.stdout.flush()
    except KeyboardInterrupt:
        _say("stopped")
        return STOPPED
    except SystemExit as left:
        if isinstance(left.__context__, BrokenPipeError):  # rich ends so, with stdout already silenced
            return 0
        raise
    except Exception as error:
        if isinstance(error, BrokenPipeError) and _nobody_reads():
            silence(sys.stdout)
            return 0
        if debug:
            with suppress(OSError):
                traceback.print_exc()
        _say(f"error: {fault(error)}")
        if isinstance(error, OSError):
            silence(sys.stdout)
        return UNUSABLE
    if code == STOPPED:
        _say("stopped")
    return code or 0


def fault(error: Exception) -> str:
    """Say what an error means to who called the command."""
    if isinstance(error, InputError):
        return str(error)
    if isinstance(error, MemoryError):
        details = f" ({error})" if str(error) else ""
        return f"there is not enough memory for this{details}; a shorter duration, a coarser step or fewer runs need less"
    if isinstance(error, RecursionError):
        return "the input is nested too deeply: bodies, parameters or files that rest one on the other in a long chain"
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename}: {error.strerror}" if error.filename else f"cannot read or write: {error.strerror}"
    return f"internal fault: {type(error).__name__}: {error} (please report it; --debug shows where)"


def show_warning(
    message: Warning | str, category: type[Warning], filename: str, lineno: int, file: TextIO | None = None, line: str | None = None
) -> None:
    """Print vehgen's own warnings in one line each, and no other: what `warnings.showwarning` is on the command line."""
    if issubclass(category, ModelWarning | CacheWarning):
        _say(f"warning: {message}")


def show_warnings() -> None:
    """Print every warning of vehgen from now on, and none of Matplotlib (of fonts, of a home that it cannot write to)."""
    logging.getLogger("matplotlib").setLevel(logging.ERROR)
    for category in (ModelWarning, CacheWarning):
        warnings.simplefilter("always", category)
    warnings.showwarning = show_warning


def _say(text: str) -> None:
    say_on_stderr(one_line(text))


def _nobody_reads() -> bool:
    """Whether the other end of stdout is closed: a worker's broken pipe is a fault, a closed `| head` is none."""
    if not hasattr(select, "poll"):
        return True
    try:
        poll = select.poll()
        poll.register(sys.stdout.fileno(), select.POLLOUT)
        return any(event & (select.POLLERR | select.POLLHUP) for _, event in poll.poll(0))
    except (OSError, ValueError):
        return False


@contextmanager
def _terminable() -> Iterator[None]:
    """End by SIGTERM as by any other error, so that temporary files are removed."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def terminate(number: int, frame: FrameType | None) -> None:
        raise SystemExit(TERMINATED)

    former = signal.signal(signal.SIGTERM, terminate)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, former)
