"""Spectra of a model on a rough road against those that drives of scipy's half-car average to."""

from functools import cache

import numpy as np
import pytest

from tests.measure.rough_half_car import PLACES, SEDAN, drive, true_response
from vehgen.errors import InputError
from vehgen.files.expressions import parse
from vehgen.measure.transmissibility import segment_transforms
from vehgen.mechanics import Place, PointOutput, derive
from vehgen.simulate.rough_road import rough_road_spectra
from vehgen.vehicle import parse_vehicle

SEGMENT = 4.0
"""So short that it blurs the body's resonance and the axles' delay [s]."""


def outputs():
    places = [Place(name, "body", x=parse(f"{x} m")) for name, x in PLACES.items()]
    return [*(PointOutput(place.name, place, "acceleration") for place in places), PointOutput("q", places[0], "pitch_rate")]


@pytest.fixture(scope="module")
def model():
    return derive("sedan2", outputs())


@cache
def driven(speed, seed):
    """Return the averaged lines of a drive of 120 s."""
    _, values = drive(SEDAN, 120.0, speed, seed)
    return segment_transforms(values[:, :2], 0.01, SEGMENT).between(0.75, 8.0)


@pytest.mark.parametrize("speeds", [(4.0,), (4.0, 6.0, 9.0)])
def test_averaged_drives_approach_the_blurred_spectra(model, speeds):
    """Of 10 drives of 120 s a speed: ratios to a percent or so, and the coherence that the axles' delay and the speeds leave."""
    found = []
    for seed in range(10):
        for speed in speeds:
            lines = driven(speed, seed)
            found.append(lines.spectra())
    measured = np.mean(found, axis=0)
    blurred = rough_road_spectra(model, lines.frequency, speeds=np.array(speeds), segment=SEGMENT)
    sharp = rough_road_spectra(model, lines.frequency, speeds=np.array(speeds))

    def h1(spectra):
        return np.abs(spectra[:, 0, 1]) / spectra[:, 0, 0].real

    def coherence(spectra):
        return np.abs(spectra[:, 0, 1]) ** 2 / (spectra[:, 0, 0] * spectra[:, 1, 1]).real

    np.testing.assert_allclose(coherence(blurred), coherence(measured), atol=0.05)
    errors = [np.abs(np.log(h1(spectra) / h1(measured))) for spectra in (blurred, sharp)]
    assert errors[0].max() < 0.08
    assert errors[0].mean() < 0.015
    assert errors[1].mean() > 5 * errors[0].mean()


def test_unblurred_spectra_are_products_of_the_response(model):
    frequency = np.array([0.5, 1.3, 7.0, 11.0])
    found = rough_road_spectra(model, frequency, speeds=np.array([15.0]), delays=np.array([0.0, 0.2, 0.0]))
    response = true_response(SEDAN, frequency, 15.0) * np.exp(-2j * np.pi * frequency[:, None] * np.array([0.0, 0.2, 0.0]))
    for i in range(3):
        np.testing.assert_allclose(found[:, 0, i] / found[:, 0, 0], response[:, i] / response[:, 0], rtol=1e-6)


def test_a_rig_without_axles_is_refused():
    rig = parse_vehicle(
        "name: rig\nparameters: {m1: {value: 100 kg}, k1: {value: 10 kN/m}}\nbodies: {mass: {mass: m1, motions: [heave]}}\n"
        "links: {spring: {mass: {}, ground: {}, k: k1}}\n"
    )
    with pytest.raises(InputError, match="has no axles"):
        rough_road_spectra(derive(rig), np.array([1.0]), speeds=np.array([1.0]))
