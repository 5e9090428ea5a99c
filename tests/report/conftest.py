"""Pages of builds that several tests read."""

import pytest

from tests.report.vehicles import build


@pytest.fixture(scope="session")
def pages(tmp_path_factory):
    kept = {}

    def page(name):
        if name not in kept:
            folder = tmp_path_factory.mktemp(name)
            build(folder, name, ["a warning of <b>2 & 3</b>"])
            kept[name] = (folder / "index.html").read_text(encoding="utf-8")
        return kept[name]

    return page
