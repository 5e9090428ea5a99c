"""A car's body that bends is found, though it is far longer than its wheelbase."""

import pytest
from benchmarks.hidden_effects.generator import Effect

from tests.diagnose.conftest import HUMPS
from vehgen.diagnose.fits.candidate import list_candidates
from vehgen.diagnose.select.fitter import Fitter
from vehgen.effects import EFFECTS

BENDING = {"frequency": 9.2, "damping": 0.011, "modal_mass_share": 0.98, "participation": 1.0}


@pytest.mark.thorough
def test_a_fit_of_all_motions_at_once_finds_a_lightly_damped_body(detection_of):
    """From the length of a trailer's frame alone it left a thousand times the mean square of noise."""
    detection = detection_of(Effect("frame_bending", "body", BENDING), runs=HUMPS)
    (candidate,) = list_candidates(detection.trials[0].run.vehicle, detection.trials, [EFFECTS["frame_bending"]])
    fit = Fitter(detection, detection.base, ()).fit(candidate, slow_first=False)
    assert fit.training < 1.5
    found = dict(zip(fit.least_squares.misfit.problem.space.names, fit.least_squares.values, strict=True))
    assert found["frame_bending_body_frequency"] == pytest.approx(9.2, rel=2e-3)
    assert found["frame_bending_body_damping_ratio"] == pytest.approx(0.011, rel=0.03)
