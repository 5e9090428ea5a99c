import numpy as np
import pytest

from vehgen.errors import InputError
from vehgen.measure import ARTICULATED_BANDS, SPECTRA, TWO_AXLE_BANDS, Spectrum, band_rms, record_psd, relative_errors, welch_psd


@pytest.mark.parametrize("n", [500, 501])
def test_the_area_of_a_record_psd_is_the_mean_square(n):
    x = np.random.default_rng(0).standard_normal(n)
    frequency, density = record_psd(x, 0.01)
    assert density.sum() * (frequency[1] - frequency[0]) == pytest.approx(np.mean(x**2), rel=1e-12)


def test_welch_gives_the_level_of_white_noise():
    x = 0.3 * np.random.default_rng(1).standard_normal(200_000)
    frequency, density = welch_psd(x, 0.01)
    inside = (frequency > 1) & (frequency < 49)
    assert density[inside].mean() == pytest.approx(2 * 0.01 * 0.3**2, rel=0.01)


def test_a_sine_has_its_rms_in_its_band_and_nothing_beside():
    t = np.arange(2000) * 0.01
    frequency, density = record_psd(3.0 * np.sin(2 * np.pi * 6.5 * t), 0.01)
    rms = band_rms(frequency, density, ARTICULATED_BANDS)
    assert rms == pytest.approx([0, 3 / np.sqrt(2), 0, 0, 0], abs=1e-9)


def test_band_rms_integrates_a_straight_line_exactly_between_samples():
    frequency = np.linspace(0, 10, 21)
    rms = band_rms(frequency, 2.0 * frequency, [(1.3, 7.1)])
    assert rms[0] == pytest.approx(np.sqrt(7.1**2 - 1.3**2), rel=1e-12)


def test_a_band_beyond_the_psd_is_refused():
    with pytest.raises(InputError, match="not within"):
        band_rms(np.linspace(0, 10, 21), np.ones(21), [(8, 12)])


def test_relative_errors_follow_equation_32():
    assert relative_errors(np.array([1.2, 0.9, 1.0]), np.array([1.0, 1.0, 0.0])) == pytest.approx([0.2, -0.1, np.nan], nan_ok=True)


def test_the_papers_bands_are_the_same_for_both_kinds_of_vehicles_and_touch():
    assert TWO_AXLE_BANDS[1:-1] == ARTICULATED_BANDS
    assert [low for low, _ in TWO_AXLE_BANDS[1:]] == [high for _, high in TWO_AXLE_BANDS[:-1]]


def test_a_spectrum_that_falls_as_the_inverse_of_frequency_has_equal_shares_in_equal_ratios():
    found = Spectrum("pink", np.array([1.0, 10.0, 100.0]), np.array([1.0, 0.1, 0.01]))
    assert found.rms == pytest.approx(np.sqrt(np.log(100.0)))
    assert found.rms_within(2.0, 20.0) == pytest.approx(np.sqrt(np.log(10.0)))


@pytest.mark.parametrize(
    ("name", "rms"),
    [("level I", 0.73), ("level II", 0.52), ("level III", 0.37), ("2016 medium", 0.54), ("2016 low", 0.40), ("2016 high", 0.70)],
)
def test_astm_spectra_have_the_overall_rms_that_goes_with_them(name, rms):
    spectrum = SPECTRA[name]
    assert spectrum.rms == pytest.approx(rms, abs=0.006)
    frequency = np.geomspace(spectrum.frequency[0], spectrum.frequency[-1], 200_001)
    assert np.sqrt(np.trapezoid(spectrum.at(frequency), frequency)) / 9.80665 == pytest.approx(spectrum.rms, rel=1e-4)
