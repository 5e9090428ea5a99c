"""One case measured: detected as the diagnosis does, then the true law fitted, and what other laws reach."""

from __future__ import annotations

import json
import time
import traceback
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmarks.measured_world.solve import imported, vehicle_file, workplace
from benchmarks.measured_world.telling.falls import Falls, price
from benchmarks.measured_world.telling.rule import BESIDE, FITTED
from benchmarks.measured_world.telling.steps import steps_of_case
from benchmarks.measured_world.telling.true_law import true_candidate, true_start
from vehgen.diagnose.detect.detection import Detection, detect
from vehgen.diagnose.detect.splitting import kind_of_run
from vehgen.diagnose.fits.candidate import Candidate, has_room, list_candidates
from vehgen.effects import library
from vehgen.fit.parallel import one_blas_thread
from vehgen.fit.trial import load_trials
from vehgen.vehicle import as_vehicle

Data = dict[str, Any]
TOLD = 8
"""So many of the largest first-order gains are kept, with their laws."""


def measure_set(
    root: Path,
    out: Path,
    names: Sequence[str],
    twins_of: Path | None = None,
    judged: Mapping[str, str] | None = None,
    with_steps: bool = False,
) -> None:
    """Append the measurement of the cases `names` of `root` to `out`, but of those that are there; failures are recorded as such.

    Twins are asked for what is hidden in the cases of `twins_of` of the same names; `judged` are outcomes of scored cases, to be kept
    beside. `with_steps` the diagnosis's own steps are gone through, too, where something is hidden.
    """
    lines = out.read_text(encoding="utf-8").splitlines() if out.is_file() else []
    known = {(item["set"], item["case"]) for item in map(json.loads, lines)}
    for name in names:
        if (root.name, name) in known:
            continue
        asked = None if twins_of is None else next(iter(_truth(twins_of, name)["effects"]), None)
        record = measure_case(root, name, asked) | ({"judged": judged[name]} if judged and name in judged else {})
        if with_steps and record["hidden"] is not None and "failed" not in record:
            record["steps"] = steps_of_case(root, name, record["hidden"])
        with out.open("a", encoding="utf-8") as stream:
            stream.write(json.dumps(record) + "\n")
        print(summary(record), flush=True)


def measure_case(root: Path, name: str, asked: Data | None = None) -> Data:
    """Return what a case's recordings tell of what is hidden in it, or of what it is `asked` for."""
    truth = _truth(root, name)
    hidden = truth["effects"][0] if truth["effects"] else None
    record: Data = {"set": root.name, "case": name, "vehicle": truth["vehicle"], "recorder": truth["recorder"], "hidden": hidden}
    record |= {"asked": asked, "strength": truth.get("strength"), "fits": []}
    begun = time.perf_counter()
    try:
        with workplace(root / "cases" / name) as folder, one_blas_thread():
            record |= _measured(folder, truth, hidden or asked, FITTED if hidden is None else BESIDE)
    except Exception as error:  # a case that cannot be measured is a result
        record["failed"] = f"{error}\n{traceback.format_exc()[-1500:]}"
    return record | {"seconds": time.perf_counter() - begun}


def _truth(root: Path, name: str) -> Data:
    found: Data = json.loads((root / "truth" / name / "truth.json").read_text(encoding="utf-8"))
    return found


def _measured(folder: Path, truth: Data, asked: Data | None, fitted: int) -> Data:
    runs, refused = imported(folder)
    if len(runs) < 3:
        return {"failed": "; ".join(refused.values())}
    trials = load_trials(runs, as_vehicle(vehicle_file(folder)))
    detection = detect(sorted(trials, key=kind_of_run))
    candidates = list_candidates(trials[0].run.vehicle, detection.trials, list(library().values()), detection.floor.noises)
    return detected(detection) | laws_measured(detection, candidates, truth["parameters"], asked, fitted)


def detected(detection: Detection) -> Data:
    """Return what the base model leaves."""
    base = detection.base
    runs = {name: value**0.5 for name, value in base.mean_squares.items()}
    return {
        "chi": detection.chi,
        "quiet": detection.is_quiet,
        "nothing_missing": detection.nothing_missing,
        "training": base.training,
        "validation": base.validation,
        "runs": runs,
        "validation_runs": [trial.name for trial in detection.validation_runs],
        "residuals": base.n_residuals,
        "base_on_bound": list(base.least_squares.on_bound),
    }


def laws_measured(detection: Detection, candidates: Sequence[Candidate], parameters: Data, asked: Data | None, fitted: int) -> Data:
    """Return the first-order gains of all laws, and fits of the one asked for and of the `fitted` ones that gain most."""
    falls = Falls(detection, len(candidates), parameters)
    fitter = falls.fitter
    measured = fitter.first_order_gains()
    gains = sorted(((measured.of(item)[0], item) for item in candidates if has_room(item, fitter.locator)), key=lambda item: -item[0])
    runs, n = len(detection.problem.trials), detection.base.n_residuals
    hopeful = [item for item in gains if item[0] > 1.0]
    chosen = sorted(hopeful, key=lambda item: price(item[1].effect.n_numbers(runs), n) - item[0])[:fitted]
    found: list[Data] = []
    true: Candidate | None = None
    if asked is not None:
        true = true_candidate(asked, candidates)
        usual = true.effect.starts(true.place, falls.fitter.locator, falls.fitter.residual)[0]
        fit = falls.fit(true, true_start(true, asked, parameters, usual))
        found += [] if fit is None else [falls.measured(fit) | {"true": True}]
    for _, candidate in chosen:
        fit = None if candidate is true else falls.fit(candidate)
        found += [] if fit is None else [falls.measured(fit) | {"true": False}]
    largest: dict[str, float] = {}
    for gain, candidate in gains:
        largest.setdefault(candidate.effect.name, gain)
    own = next((gain for gain, candidate in gains if candidate is true), None)
    told = [{"name": item.effect.name, "place": item.place, "gain": gain} for gain, item in gains[:TOLD]]
    return {"fits": found, "first_order": told, "first_order_of_true": own, "first_order_by_effect": largest, "tried": len(candidates)}


def summary(record: Data) -> str:
    """Return one line on a measured case."""
    what = record["hidden"] or record["asked"]
    told = "nothing" if what is None else f"{what['name']} at {what['place']}{'' if record['hidden'] else ' left out'}"
    if "failed" in record:
        return f"{record['set']} {record['case']} {told}: failed, {record['failed'][:200]}"
    falls = ", ".join(
        f"{'TRUE ' if item['true'] else ''}{item['name']} at {item['place']} {item['beyond_price']:.0f}" for item in record["fits"]
    )
    return f"{record['set']} {record['case']} {record['vehicle']} {told}: chi {record['chi']:.3f}; {falls}  {record['seconds']:.0f} s"
