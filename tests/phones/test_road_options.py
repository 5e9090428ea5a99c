"""The road of an import may be a table of any format and unit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from vehgen.commands.option_strings import read_hump, read_profile
from vehgen.errors import InputError
from vehgen.phones.plan import hump_road, profile_road

S = np.linspace(0.0, 0.6, 13)
H = 0.03 * np.sin(np.pi * S / 0.6)


def test_units_of_profiles_and_points_of_humps_count(tmp_path: Path):
    rows = "".join(f"{s:.9f};{1000 * h:.9f}\n".replace(".", ",") for s, h in zip(S, H, strict=True))
    (tmp_path / "plain.csv").write_text("s;h\n" + rows)
    (tmp_path / "headed.csv").write_text("s [m];h [mm]\n" + rows)
    for file, unit in (("plain.csv", ",unit=mm"), ("headed.csv", "")):
        road = profile_road(read_profile(f"{tmp_path / file},distance=s,height=h{unit}"))
        assert road.profile is not None
        np.testing.assert_allclose(road.profile.heights, H, atol=1e-9)
        hump = hump_road(read_hump(f"points,file={tmp_path / file},distance=s,height_column=h{unit}")).hump
        assert hump is not None
        np.testing.assert_allclose(hump.height(S), H, atol=1e-9)
    assert profile_road(read_profile(f"{tmp_path / 'plain.csv'},distance=s,height=h,unit=mm")).entry["unit"] == "mm"


def test_a_unit_that_is_none_is_refused(tmp_path: Path):
    (tmp_path / "road.csv").write_text("s,h\n0,0\n1,1\n")
    with pytest.raises(InputError, match=r"unknown unit 'metre'.*height is measured in m, mm, cm, km, in, ft"):
        profile_road(read_profile(f"{tmp_path / 'road.csv'},distance=s,height=h,unit=metre"))


def test_a_profile_may_begin_within_its_table(tmp_path: Path):
    (tmp_path / "road.csv").write_text("".join(["distance,height\n", *(f"{1200 + s:.9f},{h:.9f}\n" for s, h in zip(S, H, strict=True))]))
    road = profile_road(read_profile(f"{tmp_path / 'road.csv'},start=1200.1 m,end=1.2005 km"))
    assert road.profile is not None
    assert road.entry["start"] == "1200.1 m"
    np.testing.assert_allclose(road.profile.distance, np.arange(0.0, 0.41, 0.05), atol=1e-9)
    np.testing.assert_allclose(road.profile.height(np.array([0.0, 0.2])), [0.0, H[6] - H[2]], atol=1e-8)
