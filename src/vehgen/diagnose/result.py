"""What a diagnosis found, with the evidence of all stages."""

from __future__ import annotations

from dataclasses import dataclass

from vehgen.diagnose.detect.detection import Detection
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.localise.free_form import FreeForm
from vehgen.diagnose.localise.unknown_force import PlaceResult
from vehgen.diagnose.select.search import SearchRound
from vehgen.diagnose.verdict import Verdict
from vehgen.fit.trial import Trial


@dataclass(frozen=True)
class Diagnosis:
    """A finished diagnosis with the evidence of all stages.

    `rounds` are the looks for one effect each, the first on the base; `chosen` the fits that were added, each on top of the one before.
    `stopped` tells that Ctrl-C ended it; `law` describes an unknown force that no effect of the library explains.
    """

    trials: tuple[Trial, ...]
    detection: Detection
    rounds: tuple[SearchRound, ...]
    chosen: tuple[ModelFit, ...]
    verdict: Verdict
    stopped: bool = False
    law: FreeForm | None = None

    @property
    def places(self) -> tuple[PlaceResult, ...]:
        """The places tested on the base, best first."""
        return self.rounds[0].places if self.rounds else ()

    @property
    def passed(self) -> tuple[PlaceResult, ...]:
        """The smallest hypotheses that reach the floor on the base."""
        return self.rounds[0].passed if self.rounds else ()

    @property
    def fits(self) -> tuple[ModelFit, ...]:
        """The candidates tried on the base, best first."""
        return self.rounds[0].fits if self.rounds else ()
