"""What a diagnosis found: a value that can be written, read and drawn, and the fitted models behind it."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import Annotated, Any, ClassVar

from vehgen.diagnose.detect.detection import Detection
from vehgen.diagnose.evidence import Evidence
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.localise.free_form import FreeForm
from vehgen.diagnose.localise.unknown_force import PlaceResult
from vehgen.diagnose.select.ranking import SearchRound
from vehgen.diagnose.verdict import Verdict
from vehgen.errors import InputError
from vehgen.files.result_fields import IN_MEMORY
from vehgen.files.results import Result, Table
from vehgen.fit.trial import Trial


@dataclass(frozen=True)
class DiagnosisModels:
    """The fitted models of a diagnosis, kept in memory only.

    `rounds` are the looks for one effect each, the first on the base; `chosen` the fits that were added, each on top of the one before.
    `law` describes an unknown force that no effect of the library explains. `libraries` are the files that effects were read from.
    `left_out` are runs that were not looked at, for what their recordings show.
    """

    detection: Detection
    rounds: tuple[SearchRound, ...]
    chosen: tuple[ModelFit, ...]
    law: FreeForm | None = None
    libraries: tuple[str, ...] = ()
    left_out: tuple[Trial, ...] = ()

    @property
    def last(self) -> ModelFit:
        """The model with all effects found."""
        return self.chosen[-1] if self.chosen else self.detection.base


@dataclass(frozen=True)
class Decided:
    """What the stages of a diagnosis end with; `stopped` tells that Ctrl-C ended them."""

    models: DiagnosisModels
    verdict: Verdict
    stopped: bool = False


@dataclass(frozen=True, eq=False)
class Diagnosis(Result):
    """A finished or stopped diagnosis.

    `stopped` tells that Ctrl-C ended it: verdict and evidence are then of what was done. `models` are the fitted models, None in a
    diagnosis that was read from a file.
    """

    KIND: ClassVar[str] = "diagnosis"
    DRAWING: ClassVar[str] = "vehgen.report.plots.diagnosis_plots:plot_waterfall"

    verdict: Verdict
    stopped: bool
    evidence: Evidence
    models: Annotated[DiagnosisModels | None, IN_MEMORY] = field(default=None, repr=False)

    @classmethod
    def _unpacked(cls, data: dict[str, Any]) -> dict[str, Any]:
        own = {item.name for item in fields(Verdict)}
        others = {key: value for key, value in data.items() if key not in own}
        return {**others, "verdict": {key: value for key, value in data.items() if key in own}}

    def _packed(self, data: dict[str, Any]) -> dict[str, Any]:
        verdict: dict[str, Any] = data.pop("verdict")
        return {**verdict, **data}

    def table(self) -> Table:
        """Return the named effects' parameters, a row each."""
        return self.verdict.table()

    def _fitted(self) -> DiagnosisModels:
        if self.models is None:
            raise InputError("this diagnosis was read from a file, without its fitted models: diagnose again")
        return self.models

    @property
    def trials(self) -> tuple[Trial, ...]:
        """All runs that were looked at, those for fitting first."""
        return self.detection.trials

    @property
    def detection(self) -> Detection:
        """The first stage: the noise floor and how far the base model is above it."""
        return self._fitted().detection

    @property
    def rounds(self) -> tuple[SearchRound, ...]:
        """The looks for one effect each, the first on the base."""
        return self._fitted().rounds

    @property
    def chosen(self) -> tuple[ModelFit, ...]:
        """The fits that were added, each on top of the one before."""
        return self._fitted().chosen

    @property
    def law(self) -> FreeForm | None:
        """The unknown force that no effect of the library explains."""
        return self._fitted().law

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
