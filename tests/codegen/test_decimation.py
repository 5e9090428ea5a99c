"""The decimating filter against numpy's convolution."""

import numpy as np
import pytest

from vehgen.codegen.decimation import Phases, decimate


@pytest.mark.parametrize("ratio", [1, 2, 5])
@pytest.mark.parametrize("firsts", [(0, 0), (-7, 3), (-40, -11), (6, 60)])
def test_samples_are_those_of_a_whole_convolution(ratio, firsts):
    random = np.random.default_rng(0)
    fine = random.standard_normal((3, 230, 2))
    filters = [(first, random.standard_normal(size)) for first, size in zip(firsts, (13, 38), strict=True)]
    count = 200 // ratio
    found = decimate(fine, Phases.of(filters, ratio), count)
    for channel, (first, taps) in enumerate(filters):
        for individual in range(3):
            whole = np.concatenate([np.zeros(300), np.convolve(fine[individual, :, channel], taps), np.zeros(300)])
            expected = whole[300 - first + ratio * np.arange(count)]
            np.testing.assert_allclose(found[individual, :, channel], expected, atol=1e-12)


def test_an_individual_is_filtered_as_it_is_alone_and_a_failed_one_spoils_no_other():
    fine = np.random.default_rng(1).standard_normal((4, 300, 3))
    fine[2, 50:] = np.nan
    filters = [(-3, np.ones(20) / 20)] * 3
    together = decimate(fine, Phases.of(filters, 5), 55)
    assert np.isnan(together[2]).any()
    for individual in (0, 1, 3):
        np.testing.assert_array_equal(
            decimate(fine[individual : individual + 1], Phases.of(filters, 5), 55, threads=1)[0], together[individual]
        )
