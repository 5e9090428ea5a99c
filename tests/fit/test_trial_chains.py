"""A trial's frequency responses pass the same chain as its simulated channels."""

from tests.fit.recordings import *  # noqa: F403
