"""One hidden case from recordings to verdict."""

from __future__ import annotations

import tempfile
import time
import warnings
from pathlib import Path

from benchmarks.hidden_effects.cases import HiddenCase


def solve(item: HiddenCase) -> dict:
    """Write a case, diagnose it, return what came out beside the truth."""
    from benchmarks.hidden_effects.generator import write_case
    from vehgen.diagnose.pipeline import diagnose_trials
    from vehgen.fit.trial import load_trials

    warnings.simplefilter("ignore")
    start = time.perf_counter()
    record = {
        "case": item.name,
        "kind": item.kind,
        "vehicle": item.vehicle,
        "truth": [{"name": effect.name, "place": effect.place, "values": dict(effect.values)} for effect in item.effects],
    }
    with tempfile.TemporaryDirectory() as seen, tempfile.TemporaryDirectory() as hidden:
        write_case(item.case, Path(seen), Path(hidden))
        try:
            found = diagnose_trials(load_trials(sorted(Path(seen).glob("*.yaml"))))
        except Exception as error:  # a crash is a result too
            return {**record, "verdict": "crash", "error": f"{type(error).__name__}: {error}", "seconds": time.perf_counter() - start}
    data = found.verdict.to_dict()
    data["passed"] = [item.place.label for item in found.passed]
    data["tried"] = [[fit.label, fit.training, fit.validation] for fit in found.fits[:5]]
    return {**record, **data, "seconds": time.perf_counter() - start}
