"""Roads of OpenCRG: the heights under wheel paths, from files that pyopencrg wrote and one that was written by hand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from vehgen.errors import InputError
from vehgen.files.tables import read_columns

BY_HAND = """\
$CT
a road of five cross sections, a metre apart
$
$ROAD_CRG
reference_line_start_u = 0.0
reference_line_end_u = 4.0
reference_line_increment = 1.0
long_section_v_right = -1.0
long_section_v_left = 1.0
long_section_v_increment = 1.0
$
$KD_DEFINITION
#:LRFI
U:reference line u,m,0,1.0
D:long section 1,m
D:long section 2,m
D:long section 3,m
$
$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$
 0.0000000 0.0000000 0.0000000
 0.0100000 0.0200000 0.0400000
 0.0200000 0.0300000 0.0600000
 0.0100000 0.0100000 0.0200000
 0.0000000 0.0000000 0.0100000
"""


def test_a_road_written_by_hand(tmp_path: Path):
    pytest.importorskip("pyopencrg")
    (tmp_path / "road.crg").write_text(BY_HAND)
    found = read_columns(tmp_path / "road.crg", ("distance", "height", "height at -1", "height at 1 and -1", "height at 0.5"))
    assert found.units == ("m",) * 5
    np.testing.assert_allclose(found.values[0], [0, 1, 2, 3, 4])
    np.testing.assert_allclose(found.values[1], [0, 0.02, 0.03, 0.01, 0], atol=1e-9)
    np.testing.assert_allclose(found.values[2], [0, 0.01, 0.02, 0.01, 0], atol=1e-9)
    np.testing.assert_allclose(found.values[3], [0, 0.025, 0.04, 0.015, 0.005], atol=1e-9)
    np.testing.assert_allclose(found.values[4], [0, 0.03, 0.045, 0.015, 0.005], atol=1e-9)


@pytest.mark.parametrize("kind", ["KRBI", "KDBI", "LRFI", "LDFI"])
def test_all_kinds_of_data(tmp_path: Path, kind: str):
    pyopencrg = pytest.importorskip("pyopencrg")
    u, v = np.arange(0, 40.01, 0.1), np.linspace(-2, 2, 9)
    z = 0.02 * np.sin(u)[:, None] + 0.01 * np.cos(0.3 * u)[:, None] * v[None, :]
    pyopencrg.CrgRoad(z, u_inc=0.1, v=v).save(tmp_path / "road.crg", fmt=kind)
    found = read_columns(tmp_path / "road.crg", ("distance", "height at 1 and -1", "height at 1.5"))
    np.testing.assert_allclose(found.values[0], u, atol=1e-6)
    np.testing.assert_allclose(found.values[1], 0.02 * np.sin(u), atol=1e-6)
    np.testing.assert_allclose(found.values[2], 0.02 * np.sin(u) + 0.015 * np.cos(0.3 * u), atol=1e-6)


@pytest.mark.parametrize(
    ("text", "name", "said"),
    [
        (BY_HAND, "h", "no column 'h'; an OpenCRG file has `distance`, `height`, or e.g. `height at 0.9 and -0.9`"),
        (BY_HAND, "height at 1.2", "1.2 m lies beside the road, which reaches from -1 to 1 m"),
        (BY_HAND[:-62], "height", "the header tells of a road to 4 m, its data end at 2 m: the file was cut"),
        (BY_HAND.replace("$ROAD_CRG\n", "$ROAD_CRG_FILE\n/etc/passwd\n$\n$ROAD_CRG\n"), "height", "the road's data stand in another file"),
        (BY_HAND.replace("0.0300000", "      nan"), "height at 0.5", "road.crg:3:1: the road has no height 2 m along it, 0.5 m across"),
    ],
)
def test_what_cannot_be_read_is_told(tmp_path: Path, text: str, name: str, said: str):
    pytest.importorskip("pyopencrg")
    (tmp_path / "road.crg").write_text(text)
    with pytest.raises(InputError) as caught:
        read_columns(tmp_path / "road.crg", ("distance", name))
    assert said in str(caught.value)
