"""Chains of acquisition: taps and responses agree with each other and with scipy's filters."""

import numpy as np
import pytest
import scipy.signal
import scipy.special

from vehgen.measure.acquisition import POINT_SAMPLES, UNKNOWN, AcquisitionChain
from vehgen.measure.recorders import RECORDERS

CHAINS = [
    AcquisitionChain("butterworth", 4, 45.0),
    AcquisitionChain("butterworth", 1, 20.0, delay=0.0123),
    AcquisitionChain("bessel", 8, 40.0),
    AcquisitionChain("chebyshev1", 6, 30.0, delay=0.005),
    AcquisitionChain("ideal", cut_off=48.0),
    AcquisitionChain("ideal", cut_off=45.0, delay=0.0077),
    AcquisitionChain("none", delay=0.0042),
]


def transform(first, taps, dt, frequency):
    """Return the sum of taps times their phases, written out."""
    return np.exp(-2j * np.pi * frequency[:, None] * dt * (first + np.arange(len(taps)))) @ taps


@pytest.mark.parametrize("chain", CHAINS, ids=lambda chain: f"{chain.filter}{chain.order}")
@pytest.mark.parametrize("dt", [0.001, 0.002])
def test_taps_and_response_agree(chain, dt):
    first, taps = chain.taps(dt)
    frequency = np.linspace(0.0, 0.3 / dt, 400)
    assert abs(transform(first, taps, dt, frequency) - chain.response(frequency)).max() < 2e-4
    assert taps.sum() == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize(
    ("kind", "design"),
    [
        ("butterworth", lambda n, w: scipy.signal.butter(n, w, analog=True)),
        ("bessel", lambda n, w: scipy.signal.bessel(n, w, analog=True, norm="mag")),
    ],
)
@pytest.mark.parametrize("order", [1, 2, 5, 12])
def test_a_low_pass_is_down_by_3_db_at_its_cut_off_and_is_scipys(kind, design, order):
    chain, frequency = AcquisitionChain(kind, order, 45.0), np.array([0.0, 10.0, 45.0, 120.0])
    found = chain.response(frequency)
    assert abs(found[2]) == pytest.approx(np.sqrt(0.5), rel=1e-6)
    expected = scipy.signal.freqs(*design(order, 2 * np.pi * 45.0), worN=2 * np.pi * frequency)[1]
    assert found == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("order", [3, 6])
def test_a_chebyshev_low_pass_ripples_by_half_a_decibel(order):
    """|H|^2 is (1 + e^2 T(0)^2)/(1 + e^2 T(f/cut-off)^2) with Chebyshev's polynomial T and 1 + e^2 half a decibel, 1 at 0 Hz."""
    frequency = np.array([0.0, 7.0, 20.0, 30.0, 45.0, 70.0])
    ripple = (10**0.05 - 1) * scipy.special.eval_chebyt(order, np.append(0.0, frequency / 30.0)) ** 2
    found = abs(AcquisitionChain("chebyshev1", order, 30.0).response(frequency))
    assert found == pytest.approx(np.sqrt((1 + ripple[0]) / (1 + ripple[1:])), rel=1e-9)


def test_filtered_motion_is_what_an_analog_filter_gives():
    """A pulse through the taps is the analog filter's answer, integrated by scipy at a step twenty times as fine."""
    dt, fine = 0.002, 0.0001
    time, sharp = np.arange(0, 1.0, dt), np.arange(0, 1.0, fine)

    def pulse(t):
        return np.exp(-(((t - 0.3) / 0.012) ** 2)) * np.sin(2 * np.pi * 30 * t)

    zeros_poles_gain = scipy.signal.butter(4, 2 * np.pi * 45.0, analog=True, output="zpk")
    expected = scipy.signal.lsim(scipy.signal.ZerosPolesGain(*zeros_poles_gain).to_ss(), pulse(sharp), sharp)[1][::20]
    first, taps = AcquisitionChain("butterworth", 4, 45.0).taps(dt)
    whole = np.convolve(pulse(time), taps)
    found = whole[-first : -first + len(time)]
    assert abs(found - expected).max() < 1e-4 * abs(expected).max()


def test_an_ideal_low_pass_passes_and_stops():
    chain = AcquisitionChain("ideal", cut_off=50.0)
    gain = abs(chain.response(np.array([1.0, 47.9, 50.0, 52.1, 300.0])))
    assert gain == pytest.approx([1.0, 1.0, 0.5, 0.0, 0.0], abs=2e-3)
    assert chain.response(np.array([30.0])).imag == pytest.approx(0.0, abs=1e-12)
    beside = abs(chain.response(np.array([49.0, 51.0])))  # half-way to the ends of its transition, 48 and 52 Hz
    assert beside == pytest.approx([0.85, 0.15], abs=0.1)


@pytest.mark.parametrize(
    ("name", "cut_off", "delay"),
    [("bosch_bmi160", 40.5, None), ("st_lsm6ds", 50.0, None), ("invensense_icm206", 44.8, 4.88e-3), ("resampled", 50.0, 0.0)],
)
def test_recorders_are_those_of_the_data_sheets_at_100_hz(name, cut_off, delay):
    """Cut-off [Hz] and, where it is stated, delay of slow motions [s], which is a phase over a frequency; at twice the rate half of it."""
    for factor in (1.0, 2.0):
        chain = RECORDERS[name].chain(100.0 * factor)
        assert chain.cut_off == pytest.approx(cut_off * factor)
        late = -np.angle(chain.response(np.array([1.0])))[0] / (2 * np.pi)
        assert delay is None or late == pytest.approx(delay / factor, rel=0.04, abs=1e-9)


def test_an_unknown_chain_stops_below_half_the_rate_and_keeps_what_is_known():
    chain = AcquisitionChain("unknown", delay=0.01, range=39.0).assumed(100.0)
    assert chain.filter == "ideal"
    assert abs(chain.response(np.array([44.0, 48.0, 50.0, 60.0]))) == pytest.approx([1.0, 0.5, 0.0, 0.0], abs=2e-3)
    assert (chain.delay, chain.range) == (0.01, 39.0)
    assert POINT_SAMPLES.assumed(100.0) is POINT_SAMPLES
    with pytest.raises(ValueError, match="unknown"):
        UNKNOWN.response(np.array([1.0]))


def test_point_samples_are_left_as_they_are():
    first, taps = POINT_SAMPLES.taps(0.001)
    assert (first, taps.tolist()) == (0, [1.0])
    assert POINT_SAMPLES.is_point_sample
    assert not AcquisitionChain("none", delay=0.001).is_point_sample


@pytest.mark.parametrize(
    "bad", [{"filter": "brick"}, {"filter": "bessel"}, {"cut_off": 5.0}, {"filter": "bessel", "cut_off": 5.0, "order": 13}]
)
def test_a_chain_that_cannot_be_is_refused(bad):
    with pytest.raises(ValueError, match=r"expected|filter"):
        AcquisitionChain(**bad)
