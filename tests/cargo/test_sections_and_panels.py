"""Sections against integrals on a fine raster, equivalent layers against pieces of beams."""

import math

import numpy as np
import pytest

from vehgen.cargo.frame_file import DampingPoint, rayleigh
from vehgen.cargo.panels import Layer, equivalent_layer
from vehgen.cargo.sections import Bar, Channel, SectionEntry, Tube
from vehgen.errors import InputError


def raster(inside, height, width, n=1200):
    """Area and second moments about the centroid, counted in cells; `inside(y, z)` with y along the width, z along the height."""
    y, z = np.meshgrid((np.arange(n) + 0.5) * width / n, (np.arange(n) + 0.5) * height / n)
    mask = inside(y, z)
    cell = height * width / n**2
    y, z = y[mask], z[mask]
    return mask.sum() * cell, ((z - z.mean()) ** 2).sum() * cell, ((y - y.mean()) ** 2).sum() * cell


@pytest.mark.parametrize("kind", ["bar", "tube", "channel"])
def test_areas_and_second_moments(kind):
    h, b, t = 0.15, 0.06, 0.005

    def flange(z):
        return (z < t) | (z > h - t)

    if kind == "bar":
        found = Bar(height="150 mm", width="60 mm").section()
        exact = raster(lambda y, z: z > 0, h, b)
    elif kind == "tube":
        found = Tube(height="150 mm", width="60 mm", thickness="5 mm").section()
        exact = raster(lambda y, z: flange(z) | (y < t) | (y > b - t), h, b)
    else:
        found = Channel(height="150 mm", width="60 mm", thickness="5 mm").section()
        exact = raster(lambda y, z: flange(z) | (y < t), h, b)
    assert (found.area, found.strong, found.weak) == pytest.approx(exact, rel=2e-4)


def test_torsion_constants():
    """A square bar: 0.1406 a^4; a thin square tube: t a^3 (Timoshenko & Goodier)."""
    assert Bar(height="0.1 m", width="0.1 m").section().torsion == pytest.approx(0.1406e-4, rel=2e-3)
    assert Tube(height="101 mm", width="101 mm", thickness="1 mm").section().torsion == pytest.approx(0.001 * 0.1**3, rel=1e-12)


@pytest.mark.parametrize(("height", "width"), [(0.1, 0.05), (0.05, 0.1)])
def test_a_bar_resists_torsion_upright_as_lying(height, width):
    """0.229 a b^3 of sides of two to one (Timoshenko & Goodier)."""
    assert Bar(height=f"{height} m", width=f"{width} m").section().torsion == pytest.approx(0.229 * 0.1 * 0.05**3, rel=5e-3)


def test_a_channel_resists_torsion_as_its_three_walls_do():
    """Each is a narrow bar that ends where another begins: their ends take off some percent."""
    channel = Channel(height="150 mm", width="60 mm", thickness="3 mm").section()
    walls = [Bar(height=height, width="3 mm").section().torsion for height in ("60 mm", "144 mm", "60 mm")]
    assert channel.torsion == pytest.approx(sum(walls), rel=0.03)


def test_numbers_of_a_table_of_sections_stay_as_they_are():
    entry = SectionEntry(plain={"area": "10 cm^2", "strong": "80 cm^4", "weak": "20 cm^4", "torsion": "3 cm^4"})
    found = entry.section()
    assert (found.area, found.strong, found.weak, found.torsion) == pytest.approx((1e-3, 80e-8, 20e-8, 3e-8))


def test_a_full_section_is_no_tube():
    with pytest.raises(InputError, match="less than half as thick"):
        Tube(height="100 mm", width="40 mm", thickness="20 mm")
    assert Tube(height="100 mm", width="40 mm", thickness="19 mm").section().area == pytest.approx(0.1 * 0.04 - 0.062 * 0.002)


def bending(layers):
    """Bending stiffness of a stack about its neutral axis, by sampling the thickness."""
    edges = np.concatenate([[0], np.cumsum([layer.thickness for layer in layers])])
    z = (np.arange(400_000) + 0.5) * edges[-1] / 400_000
    q = np.array([layer.modulus / (1 - layer.poisson**2) for layer in layers])[np.searchsorted(edges, z) - 1]
    neutral = (q * z).sum() / q.sum()
    return q.mean() * edges[-1], (q * (z - neutral) ** 2).mean() * edges[-1]


@pytest.mark.parametrize(
    "layers",
    [
        [Layer(0.02, 10e9, 0.3, 500.0)],
        [Layer(0.012, 4e9, 0.25, 800.0), Layer(0.1, 0.0, 0.0, 40.0), Layer(0.018, 9e9, 0.25, 650.0)],
        [Layer(0.01, 70e9, 0.3, 2700.0), Layer(0.03, 2e9, 0.1, 600.0)],
    ],
)
def test_an_equivalent_layer_stretches_bends_and_weighs_the_same(layers):
    one = equivalent_layer(layers)
    stretch, bend = bending(layers)
    plane = one.modulus / (1 - one.poisson**2)
    assert plane * one.thickness == pytest.approx(stretch, rel=1e-5)
    assert plane * one.thickness**3 / 12 == pytest.approx(bend, rel=1e-4)
    across = sum(item.modulus / (1 - item.poisson**2) * item.thickness * item.poisson for item in layers)  # held there while stretched
    assert plane * one.thickness * one.poisson == pytest.approx(across, rel=1e-9)
    assert one.density * one.thickness == pytest.approx(sum(layer.density * layer.thickness for layer in layers), rel=1e-12)


def test_layers_that_slide_bend_one_by_one():
    layer = Layer(0.01, 10e9, 0.2, 700.0)
    one, both = equivalent_layer([layer, layer], bonded=False), equivalent_layer([layer, layer])
    stiffness = [item.modulus / (1 - item.poisson**2) * item.thickness**3 for item in (one, both)]
    assert stiffness[1] / stiffness[0] == pytest.approx(4)


def test_rayleigh_damping_goes_through_both_points():
    points = [DampingPoint(frequency="2 Hz", ratio=0.03), DampingPoint(frequency="15 Hz", ratio=0.02)]
    alpha, beta = rayleigh(*points)
    for point in points:
        w = 2 * math.pi * point.frequency
        assert (alpha / w + beta * w) / 2 == pytest.approx(point.ratio, rel=1e-12)
