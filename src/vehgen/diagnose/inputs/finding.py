"""What is wrong with the inputs of a diagnosis, in words."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Finding:
    """Something wrong with the inputs, or a note on what they cannot tell.

    `run` and `channel` say where (None: all runs, no channel in particular; `channel` may list several, or name sensors); `fatal` means
    that no effect should be named before it is put right.
    """

    kind: str
    run: str | None
    channel: str | None
    message: str
    fatal: bool
