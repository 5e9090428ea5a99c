"""Lines on the error stream, whatever has become of it."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from typing import TextIO


def say_on_stderr(line: str) -> None:
    """Print a line on stderr; where it is closed or full nothing is said, and the exit code must tell."""
    try:
        print(line, file=sys.stderr, flush=True)
    except (OSError, ValueError):
        silence(sys.stderr)


def silence(stream: TextIO) -> None:
    """Send what is still to be written nowhere, so that Python does not complain of it when it ends."""
    with suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        try:
            os.dup2(nowhere, stream.fileno())
        finally:
            os.close(nowhere)
