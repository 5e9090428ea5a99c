"""Samples that a phone lost: bridged where it is quiet, refused where it is shaken."""

import pytest

from .test_import import L1, both, changed, facts, refusal, rows


def without(begin, length):
    """Return a change that leaves out the samples of some moments of the phone's clock [s]."""

    def apply(lines):
        first = float(lines[0].split(",")[0])
        return [line for line in lines if not begin < float(line.split(",")[0]) - first < begin + length]

    return rows(apply)


@pytest.mark.parametrize(("begin", "refused"), [(6.15, True), (5.0, False)], ids=["on the hump", "before it"])
def test_a_hole_is_refused_where_the_phone_is_shaken(tmp_path, capsys, begin, refused):
    """Over 50 ms on the hump a quarter of it was lost, and a healthy van became one that no effect explains."""
    export = changed(tmp_path / "a.zip", both("hump_2ms")[0], without(begin, 0.06))
    if refused:
        assert "ms from 6.1" in refusal(capsys, tmp_path / "run.yaml", [export], sensors=(L1,))
        assert not (tmp_path / "run.yaml").exists()
    else:
        found = facts(capsys, tmp_path / "run.yaml", [export], sensors=(L1,))
        assert "were bridged" in "".join(found["phones"][0]["notes"])


def test_one_lost_sample_on_the_hump_is_bridged(tmp_path, capsys):
    export = changed(tmp_path / "a.zip", both("hump_2ms")[0], without(6.145, 0.01))
    assert facts(capsys, tmp_path / "run.yaml", [export], sensors=(L1,))["phones"]
