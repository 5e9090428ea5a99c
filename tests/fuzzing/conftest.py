"""One worker process for all tests of this folder."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.fuzzing.harness import Worker


@pytest.fixture(scope="session")
def worker(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Worker]:
    """A process that has vehgen imported and reads hostile files."""
    with Worker(tmp_path_factory.mktemp("fuzzing")) as found:
        yield found
