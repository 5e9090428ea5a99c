"""Do the walk of docs/calibrate.md and put its output and figures there: `python docs/generate/calibrate_walk.py`.

What stands in the page between `<!-- NAME -->` and `<!-- end NAME -->` is written anew; the runs' files go to a temporary folder. The truth
that the last numbers are compared with is that of docs/examples/phones/make_exports.py, which vehgen has not seen.
"""

from __future__ import annotations

import contextlib
import importlib.util
import io
import json
import re
import shutil
import tempfile
import textwrap
from pathlib import Path
from typing import Any

from vehgen.commands import main as vehgen

HERE = Path(__file__).resolve().parents[1]
PAGE = HERE / "calibrate.md"
PHONES = HERE / "examples" / "phones"
IMAGES = HERE / "images" / "calibrate"
SENSORS = [
    "--sensor", "L1:body=tractor,behind=axle1,distance=-0.29,forward=y",
    "--sensor", "L2:body=semitrailer,behind=fifth_wheel,distance=9.115,forward=x",
]  # fmt: skip
HUMP = ["--hump", "half_sine,length=0.5,height=0.03"]


def call(*arguments: str) -> str:
    """Run a command; return what it printed, warnings included, without spaces at the ends of lines and in lines of a page's width."""
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
        code = vehgen(list(arguments))
    if code:
        raise SystemExit(f"vehgen {' '.join(arguments)} ended with {code}")
    lines = (line.rstrip() for line in printed.getvalue().splitlines())
    return "\n".join(textwrap.fill(line, 120) if len(line) > 120 else line for line in lines).strip()


def walk(folder: Path) -> dict[str, str]:
    """Do the walk in a folder; return what it printed, by the name of its place in the page."""
    for path in PHONES.glob("*.*"):
        shutil.copy(path, folder)
    with contextlib.chdir(folder):
        for name, road in (("hump_2ms", HUMP), ("hump_3ms", HUMP), ("road_3ms", ["--profile", "road.csv"])):
            exports = [f"{name}_phone{number}.zip" for number in (1, 2)]
            call("import", *exports, "--vehicle", "tractor5.yaml", *SENSORS, *road, "--out", f"{name}.yaml")
        runs = ["tractor5.yaml", "hump_2ms.yaml", "hump_3ms.yaml"]
        alone = call("calibrate", *runs, "--combination", "kt1/k1", "--out", "calibrated")
        weighed = call("calibrate", *runs, "--facts", "facts.yaml", "--out", "weighed")
        road = call("validate", "weighed/tractor5_calibrated.yaml", "road_3ms.yaml", "--out", "validation")
    result = json.loads((folder / "weighed" / "calibration.json").read_text(encoding="utf-8"))
    return {
        "calibrate": f"```text\n{alone}\n```",
        "weighed": f"```text\n{table(weighed, 'parameters')}\n```",
        "truth": against_the_truth(result),
        "validate": f"```text\n{road.partition('wrote ')[0].strip()}\n```",
    }


def table(printed: str, title: str) -> str:
    """Return the table of a command's output whose title has a word."""
    parts = re.split(r"\n\n(?=\S[^\n]*\n\n)", printed)
    return next(part for part in parts if title in part.partition("\n")[0])


def truth() -> dict[str, float]:
    """Return the parameters [SI] of the truck that the exports were made from."""
    specification = importlib.util.spec_from_file_location("make_exports", PHONES / "make_exports.py")
    assert specification is not None
    assert specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    over_mass = set(module.FILE) - {"a1", "a2", "b1", "b6"}
    return {name: value * module.OFF[name] * (module.MT if name in over_mass else 1.0) for name, value in module.FILE.items()}


def against_the_truth(result: dict[str, Any]) -> str:
    """Say how far the parameters of a calibration's JSON are off the truth, and how many intervals hold it."""
    true, found = truth(), result["parameters"]
    errors = {name: found[name]["value"] / value - 1 for name, value in true.items()}
    held = [name for name, value in true.items() if (ends := found[name]["interval"]) and ends[0] <= value <= ends[1]]
    worst = sorted(errors, key=lambda name: -abs(errors[name]))
    ordered = sorted(abs(error) for error in errors.values())
    farthest = ", ".join(f"{name} {100 * errors[name]:+.1f} %" for name in worst[:4])
    return (
        f"Against the truth, which vehgen has not seen, the parameters are {100 * ordered[len(ordered) // 2]:.1f} % off in the median; "
        f"farthest off are {farthest}.\n{len(held)} of the {len(true)} intervals hold it."
    )


def main() -> None:
    """Write the page's blocks and figures."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        blocks = walk(folder)
        for image, path in (
            ("import", "hump_2ms.png"),
            ("psd", "calibrated/psd.png"),
            ("intervals", "calibrated/intervals.png"),
            ("bands", "validation/validation_bands.png"),
        ):
            shutil.copy(folder / path, IMAGES / f"{image}.png")
    text = PAGE.read_text(encoding="utf-8")
    for name, block in blocks.items():
        marked = re.compile(rf"(<!-- {name} -->\n).*?(\n<!-- end {name} -->)", re.DOTALL)
        text, count = marked.subn(lambda match, block=block: f"{match[1]}{block}{match[2]}", text)
        if count != 1:
            raise SystemExit(f"{PAGE.name} has no place {name}")
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
