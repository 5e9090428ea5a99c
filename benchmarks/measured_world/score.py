"""Solve a set of cases, each in a process of its own, and lay every answer beside the truth, one JSON line a case."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import linear_sum_assignment

from benchmarks.measured_world.accepted import judged_effect, judged_fault
from benchmarks.measured_world.rigs.judging import judged_rig, rig_rows

ONE_THREAD = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")
Data = dict[str, Any]


def score_set(root: Path, out: Path, processes: int, limit: int | None, timeout: float, settings: Mapping[str, Any]) -> None:
    """Append the score of every case of `root` to `out`, but of those that are there; at most `limit` of them.

    A crash, or what takes longer than `timeout` [s], is recorded as such. `settings` are more arguments of calibrations.
    """
    known = {json.loads(line)["case"] for line in out.read_text(encoding="utf-8").splitlines()} if out.is_file() else set()
    waiting = [path for path in sorted((root / "truth").iterdir()) if path.name not in known and (path / "truth.json").is_file()]
    with ThreadPoolExecutor(processes) as pool, out.open("a", encoding="utf-8") as stream:
        tasks = [pool.submit(score_case, root, path.name, timeout, settings) for path in waiting[:limit]]
        for task in as_completed(tasks):
            record = task.result()
            stream.write(json.dumps(record) + "\n")
            stream.flush()
            print(f"{record['case']:14s} {record['vehicle']:9s} {record['recorder']:7s} {summary(record)}", flush=True)


def score_case(root: Path, name: str, timeout: float, settings: Mapping[str, Any]) -> Data:
    """Return the answer to a case beside its truth."""
    truth = json.loads((root / "truth" / name / "truth.json").read_text(encoding="utf-8"))
    record = {key: truth[key] for key in ("case", "kind", "vehicle", "recorder", "effects", "fault")}
    record |= {key: truth[key] for key in ("strength",) if key in truth}
    answer = _answer(root, name, truth["kind"], timeout, settings)
    record["answer"] = answer
    if truth["kind"] == "coverage":
        return record | {"rows": rows(truth, answer) if answer.get("outcome") == "calibrated" else []}
    if truth["kind"] == "faults":
        return record | {"judged": judged_fault(truth["fault"], answer)}
    if truth["kind"] == "rigs":
        return record | {"judged": judged_rig(truth, answer), "rows": rig_rows(truth, answer)}
    return record | {"judged": judged_effect(truth["effects"], answer)}


def _answer(root: Path, name: str, kind: str, timeout: float, settings: Mapping[str, Any]) -> Data:
    with tempfile.TemporaryDirectory() as scratch:
        out = Path(scratch) / "answer.json"
        command = [sys.executable, "-m", "benchmarks.measured_world.solve", str(root / "cases" / name), kind, str(out)]
        if kind == "coverage":
            command += ["--unseen", str(root / "truth" / name / "unseen"), "--settings", json.dumps(dict(settings))]
        try:
            done = subprocess.run(command, env={**os.environ, **ONE_THREAD}, capture_output=True, text=True, timeout=timeout, check=False)
        except subprocess.TimeoutExpired:
            return {"verdict": "too_slow", "outcome": "too_slow", "effects": [], "seconds": timeout}
        if not out.is_file():
            return {"verdict": "crash", "outcome": "crash", "effects": [], "reason": done.stderr[-2000:]}
        answer: Data = json.loads(out.read_text(encoding="utf-8"))
        return answer


def rows(truth: Data, answer: Data) -> list[Data]:
    """Return every estimate of a calibration beside the truth: family, name, truth, value and its 90 % interval (None without one)."""
    found = []
    for name, right in truth["invariants"].items():
        item = answer["combinations"].get(name) or answer["parameters"].get(name)
        found.append(_row(family(name), name, right, item))
    bodies = 2 if truth["vehicle"] == "sedan2" else 3
    ratios = damping_ratios(truth["modes"], answer["modes"])
    for i, (right, mode) in enumerate(zip(truth["modes"], answer["modes"], strict=True)):
        kind = "body modes" if i < bodies else "hop modes"
        hz = {"value": mode["undamped_hz"], "interval": mode["interval"]}
        ratio = {"value": mode["damping_ratio"], "interval": mode["damping_interval"]}
        found.append(_row(f"{kind}, frequency", f"mode {i + 1}", right["frequency"], hz))
        found.append(_row(f"{kind}, damping ratio", f"mode {i + 1} damping", ratios[i], ratio))
    return found


def damping_ratios(true_modes: Sequence[Data], found: Sequence[Data]) -> list[float]:
    """Return the true damping ratio of each mode that was found.

    Frequencies are in order. Which heavily damped pole belongs to which of two frequencies a few percent apart is a matter of how poles are
    followed, so that poles go to the modes that are nearest in frequency and damping together.
    """
    truth = np.log([[mode["frequency"], mode["damping_ratio"]] for mode in true_modes])
    answer = np.log([[mode["undamped_hz"], mode["damping_ratio"]] for mode in found])
    owners = linear_sum_assignment(np.abs(answer[:, None] - truth[None]).sum(axis=2))[1]
    return [float(true_modes[owner]["damping_ratio"]) for owner in owners]


def _row(kind: str, name: str, right: float, item: Data | None) -> Data:
    low, high = (None, None) if item is None or item["interval"] is None else item["interval"]
    return {"family": kind, "name": name, "truth": right, "value": None if item is None else item["value"], "low": low, "high": high}


def family(name: str) -> str:
    """Return which family of invariants a parameter or ratio belongs to."""
    letters = name.partition("/")[0].rstrip("0123456789")
    families = {"m": "unsprung masses", "k": "suspension stiffnesses", "c": "dampings", "kt": "tyre stiffnesses"}
    short = letters if letters in families else letters[:-1]
    return families.get(short, "distances and inertias")


def summary(record: Data) -> str:
    """Return one line on a scored case."""
    answer = record["answer"]
    spent = f"{answer.get('seconds', float('nan')):.0f} s"
    if record["kind"] == "coverage":
        known = [row for row in record["rows"] if row["low"] is not None]
        inside = sum(row["low"] <= row["truth"] <= row["high"] for row in known)
        return f"{answer['outcome']}: {inside} of {len(known)} intervals hold the truth  {spent}"
    hidden = ", ".join(f"{item['name']} at {item['place']}" for item in record["effects"])
    truth = hidden or (record["fault"]["kind"] if record["fault"] else "nothing")
    named = ", ".join(f"{item['name']} at {item['place']}" for item in answer.get("effects", []))
    return f"{truth}: {record['judged']} ({answer['verdict']} {named}) {spent}"
