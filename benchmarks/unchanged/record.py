"""Records sections of what a user computes, each from a fresh folder, by the command lines of `commands.py`."""

from __future__ import annotations

import hashlib
import json
import math
import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.unchanged.commands import command
from benchmarks.unchanged.inputs import SURVEY, write_runs

RESPONSE = Path(__file__).with_name("response.py")
FAILED = "failed"
"""The key under which the last line of a failed command's error output is recorded."""


@dataclass(frozen=True)
class Bench:
    """The code to be recorded, a clone at `tree`; the folder to work in; the Silverbox's file, if at hand."""

    tree: Path
    folder: Path
    silverbox: Path | None = None

    @property
    def examples(self) -> Path:
        """The examples of the documentation."""
        return self.tree / "docs" / "examples"

    def output(self, name: str, **places: object) -> str | dict[str, str]:
        """Run a command line; return what it printed, or how it failed."""
        path = os.pathsep.join(part for part in (str(self.tree / "src"), os.environ.get("PYTHONPATH", "")) if part)
        places = {"examples": self.examples, "response": RESPONSE, **places}
        arguments = [sys.executable, *command(name, **places)]
        environment = {**os.environ, "PYTHONPATH": path}
        done = subprocess.run(arguments, cwd=self.folder, env=environment, capture_output=True, encoding="utf-8", check=False)
        if done.returncode == 0:
            return done.stdout
        return {FAILED: (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1]}

    def json(self, name: str, **places: object) -> Any:
        """Run a command line that prints JSON; return it less the paths it wrote, or how the command failed."""
        printed = self.output(name, **places)
        found = json.loads(printed) if isinstance(printed, str) else printed
        return {key: value for key, value in found.items() if key != "files"}

    def hashes(self, pattern: str) -> dict[str, str]:
        """Return the hashes of files in the folder."""
        return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(self.folder.glob(pattern))}


def _of_models(bench: Bench, name: str) -> dict[str, Any]:
    found = {}
    for model in bench.json("models")["models"]:
        found[model["name"]] = bench.json(name, vehicle=model["name"])
        for values in model["sets"]:
            found[f"{model['name']}, {values}"] = bench.json(f"{name} of a set", vehicle=model["name"], set=values)
    return found


def modes(bench: Bench) -> dict[str, Any]:
    """Natural modes of every bundled vehicle and parameter set."""
    return _of_models(bench, "modes")


def static(bench: Bench) -> dict[str, Any]:
    """Static loads of every bundled vehicle and parameter set."""
    return _of_models(bench, "static")


def _axles(bench: Bench) -> dict[str, list[str]]:
    names = [model["name"] for model in bench.json("models")["models"]]
    return {name: list(bench.json("static", vehicle=name)["axles"]) for name in names}


def responses(bench: Bench) -> dict[str, Any]:
    """Responses of every bundled vehicle, force law and kind of input, bit for bit, and the CSV files of `simulate`."""
    found = {}
    for run in write_runs(bench.folder, _axles(bench)):
        csv = run.with_suffix(".csv")
        told = bench.json("simulate", run=run, csv=csv)
        digest = hashlib.sha256(csv.read_bytes()).hexdigest() if csv.is_file() else None
        found[run.stem.removeprefix("run ")] = {"csv": digest, "simulate": told, **bench.json("response", run=run)}
    return found


def populations(bench: Bench) -> dict[str, Any]:
    """Responses of populations, in double and single precision, with and without force laws."""
    write_runs(bench.folder, _axles(bench))
    vehicles = ("tractor5", "road_train", "tractor5_module_paper", "combined.yaml", "with_dry_friction.yaml", "with_bump_stop.yaml")
    return {
        f"{vehicle.removesuffix('.yaml')}, {precision}": bench.json("population", vehicle=vehicle, precision=precision)
        for vehicle in vehicles
        for precision in ("double", "single")
    }


def advice(bench: Bench) -> dict[str, Any]:
    """Cargo, finite elements, sensitivity and sensor places."""
    run = bench.folder / "survey.yaml"
    run.write_text(SURVEY, encoding="utf-8")
    cargo = bench.examples / "cargo"
    found = {}
    for name in ("pallets", "building_module"):
        out = bench.folder / f"{name}_laden.yaml"
        found[f"laden, {name}"] = bench.json("laden", vehicle="tractor5", cargo=cargo / f"{name}.yaml", out=out)
        found[f"modes, {name}"] = bench.json("modes", vehicle=out)
    found["module"] = bench.json("module", module=cargo / "steel_module.yaml", out=bench.folder / "module_cargo.yaml")
    found["sensitivity"] = condensed(bench.json("sensitivity", vehicle="tractor5", run=run))
    found["sensors"] = bench.json("sensors", vehicle="tractor5", run=run)
    return found


def condensed(value: Any) -> Any:
    """Return JSON with a hash, the sum and the length in place of each list of more than 20 numbers."""
    if isinstance(value, dict):
        return {key: condensed(item) for key, item in value.items()}
    if not isinstance(value, list):
        return value
    if len(value) > 20 and all(isinstance(item, int | float) for item in value):
        return {"sha256": hashlib.sha256(json.dumps(value).encode()).hexdigest()[:16], "sum": math.fsum(value), "length": len(value)}
    return [condensed(item) for item in value]


def _diagnosis(bench: Bench, name: str, folder: str) -> dict[str, Any]:
    """Return a diagnosis, and the modes of the vehicle that it wrote."""
    found = {"diagnosis": bench.json(name)}
    found |= {f"modes of {path.stem}": bench.json("modes", vehicle=path) for path in sorted((bench.folder / folder).glob("*.yaml"))}
    return found


def hidden(bench: Bench) -> dict[str, Any]:
    """The walk of docs/diagnose.md."""
    shutil.copytree(bench.examples / "hidden", bench.folder, dirs_exist_ok=True)
    return _diagnosis(bench, "hidden", "diagnosis")


def silverbox(bench: Bench) -> dict[str, Any]:
    """The commands of docs/silverbox.md."""
    if bench.silverbox is None:
        raise SystemExit("the section silverbox needs --silverbox SNLS80mV.csv, the benchmark's file")
    prepared = bench.output("prepare silverbox", data=bench.silverbox)
    found: dict[str, Any] = {"prepared": bench.hashes("runs/*.csv")}
    if isinstance(prepared, dict):
        found["prepare"] = prepared
    found["multisine"] = _diagnosis(bench, "silverbox multisine", "diagnosis")
    found["low"] = _diagnosis(bench, "silverbox low", "diagnosis_low")
    printed = bench.output("silverbox free run", data=bench.silverbox)
    found["free run"] = numbers(printed) if isinstance(printed, str) else printed
    return found


def numbers(text: str) -> list[float]:
    """Return the numbers in a text that stand by themselves."""
    return [float(item) for item in re.findall(r"(?<![\w.])-?\d+\.?\d*(?:e[+-]?\d+)?(?![\w.])", text)]


def phones(bench: Bench) -> dict[str, Any]:
    """The walk of docs/calibrate.md, and the paper's methods with few generations."""
    shutil.copytree(bench.examples / "phones", bench.folder, dirs_exist_ok=True)
    found = {f"import {name}": bench.json("import hump", crossing=name) for name in ("hump_2ms", "hump_3ms")}
    found["import road"] = bench.json("import road")
    recordings = bench.hashes("*ms.csv") | bench.hashes("*ms_recording.csv")  # as 0.1.0 called them, and as they are called since
    found["recordings"] = {name.replace("_recording", ""): digest for name, digest in recordings.items()}
    found["calibrate"] = bench.json("calibrate")
    found["modes"] = bench.json("modes", vehicle="calibrated/tractor5_calibrated.yaml")
    found["validate"] = bench.json("validate")
    found |= {f"calibrate {method}": bench.json(f"calibrate {method}") for method in ("dhcm", "shcm")}
    return found


SECTIONS: dict[str, Callable[[Bench], dict[str, Any]]] = {
    section.__name__: section for section in (modes, static, responses, populations, advice, hidden, silverbox, phones)
}
"""What is recorded, by name."""


def failures(entry: Any, place: str = "") -> list[str]:
    """Return the failed commands of a record."""
    if not isinstance(entry, dict):
        return []
    if set(entry) == {FAILED}:
        return [f"{place}: {entry[FAILED]}"]
    return [text for key, value in entry.items() for text in failures(value, f"{place} / {key}" if place else key)]


def machine() -> dict[str, str]:
    """Return what the bits depend on besides the code."""
    import numba
    import numpy
    import scipy

    names = {"processor": platform.processor() or platform.machine(), "python": platform.python_version()}
    info = Path("/proc/cpuinfo")
    if info.is_file():
        found = re.search(r"model name\s*:\s*(.+)", info.read_text(encoding="utf-8"))
        names["processor"] = found[1] if found else names["processor"]
    return names | {module.__name__: module.__version__ for module in (numpy, scipy, numba)}


def record(path: Path, sections: list[str], tree: Path, data: Path | None) -> list[str]:
    """Record sections into a JSON file, which is written after each of them; return what failed.

    Sections that the file already holds are replaced if named, and kept otherwise.
    """
    known = json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}
    failed = []
    for name in sections:
        with tempfile.TemporaryDirectory() as folder:
            known[name] = SECTIONS[name](Bench(tree.resolve(), Path(folder), data.resolve() if data else None))
        known["machine"] = machine()
        text = json.dumps(known, indent=0, ensure_ascii=False, allow_nan=False)
        path.write_text(text + "\n", encoding="utf-8")
        failed += [f"{name} / {item}" for item in failures(known[name])]
        print(f"recorded {name}", flush=True)
    return failed
