"""A vehicle against recordings: what stands above noise, and above the road that nobody measured."""

import numpy as np
import pytest
import scipy.signal

from tests.fit.recordings import sedan_truth, write_run
from vehgen.calibrate.validation import validate

BANDS = [(2.0, 5.0), (8.0, 12.0)]


def shaken(path, sigma, begin):
    """Add motion of 8 to 12 Hz to the accelerations from a moment on [s], as a rough road would."""
    table = path.with_suffix(".csv")
    rows = np.loadtxt(table, delimiter=",", skiprows=1)
    low_pass = scipy.signal.butter(4, (8.0, 12.0), "bandpass", fs=1 / (rows[1, 0] - rows[0, 0]), output="sos")
    motion = scipy.signal.sosfilt(low_pass, np.random.default_rng(5).normal(0, 1.0, (len(rows) + 500, 2)), axis=0)[500:]
    rows[:, [1, 3]] += sigma * motion / motion.std(axis=0) * (rows[:, :1] >= begin)
    np.savetxt(table, rows, delimiter=",", header="t,F_az,F_q,R_az,R_q", comments="")


@pytest.mark.parametrize(("begin", "told"), [(0.0, False), (1.6, True)])
def test_a_road_that_shook_the_vehicle_before_the_hump_is_no_error_of_the_model(tmp_path, begin, told):
    path = write_run(tmp_path, "rough", sedan_truth(), 2.5)
    quiet = {item.channel: item for item in validate("sedan2", path, bands=BANDS).channels}
    assert quiet["F_az"].audible.all()
    shaken(path, 2 * quiet["F_az"].measured_rms[1], begin)
    rough = {item.channel: item for item in validate("sedan2", path, bands=BANDS).channels}
    assert rough["F_az"].errors[1] < quiet["F_az"].errors[1] - 0.2
    assert rough["F_az"].audible.tolist() == [True, told]
