"""A trial's frequency responses pass the same chain as its simulated channels."""

from dataclasses import replace

import numpy as np
import pytest

from tests.fit.recordings import *  # noqa: F403
