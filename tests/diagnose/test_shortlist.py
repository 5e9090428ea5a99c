"""Which candidates are worth fitting, by what the place test found."""

from vehgen.diagnose.fits.candidate import list_candidates
from vehgen.diagnose.localise.localisation import shortlist
from vehgen.diagnose.localise.unknown_force import Place, PlaceResult
from vehgen.effects import EFFECTS


def test_a_channel_whose_absence_leaves_more_than_noise_excludes_nothing(detection_of):
    detection = detection_of()
    base = detection.base
    every = list_candidates(detection.trials[0].run.vehicle, detection.trials, list(EFFECTS.values()))

    def left(chi):
        without = [PlaceResult(Place("channel", "R_az", (), ("R_az",)), chi, 1, base.least_squares.x)]
        return shortlist(base, every, without, without)

    assert left(1.4) == every
    found = {item.label for item in left(1.05)}
    assert "sensor_gain at R_az" in found
    assert "dry_friction at rear" not in found
