"""The command lines that are recorded. Where the rebuilt code calls a command otherwise, this table alone changes.

Each is split like a shell command, then `{...}` are filled in; it runs in a fresh folder. What stands before it is `python`.
"""

from __future__ import annotations

import shlex

COMMANDS = {
    "models": "-m vehgen models --json",
    "modes": "-m vehgen modes {vehicle} --json",
    "modes of a set": "-m vehgen modes {vehicle} --set {set} --json",
    "static": "-m vehgen static {vehicle} --json",
    "static of a set": "-m vehgen static {vehicle} --set {set} --json",
    "simulate": "-m vehgen simulate {run} --out {csv} --json",
    "response": "{response} run {run}",
    "population": "{response} population {vehicle} {precision}",
    "laden": "-m vehgen laden {vehicle} {cargo} --out {out} --json",
    "module": "-m vehgen module {module} --out {out} --json",
    "sensitivity": "-m vehgen sensitivity {vehicle} {run} --out sensitivity --json",
    "sensors": "-m vehgen sensors {vehicle} {run} --count 2 --json",
    # docs/diagnose.md
    "hidden": "-m vehgen diagnose sedan2.yaml low_2ms.yaml high_2.5ms.yaml high_4ms.yaml rough.yaml --out diagnosis --json",
    # docs/silverbox.md
    "prepare silverbox": "{examples}/silverbox/prepare.py {data} runs",
    "silverbox multisine": "-m vehgen diagnose {examples}/silverbox/silverbox.yaml "
    + " ".join(f"runs/multisine_{i}.yaml" for i in range(1, 8))
    + " --out diagnosis --json",
    "silverbox low": "-m vehgen diagnose {examples}/silverbox/silverbox.yaml "
    + " ".join(f"runs/low_{i}.yaml" for i in range(1, 5))
    + " --out diagnosis_low --json",
    "silverbox free run": "{examples}/silverbox/free_run.py {data}",
    # docs/calibrate.md
    "import hump": "-m vehgen import {crossing}_phone1.zip {crossing}_phone2.zip --vehicle tractor5.yaml"
    " --sensor L1:body=tractor,behind=axle1,distance=-0.29,forward=y"
    " --sensor L2:body=semitrailer,behind=fifth_wheel,distance=9.115,forward=x"
    " --hump half_sine,length=0.5,height=0.03 --out {crossing}.yaml --json",
    "import road": "-m vehgen import road_3ms_phone1.zip road_3ms_phone2.zip --vehicle tractor5.yaml"
    " --sensor L1:body=tractor,behind=axle1,distance=-0.29,forward=y"
    " --sensor L2:body=semitrailer,behind=fifth_wheel,distance=9.115,forward=x"
    " --profile road.csv --out road_3ms.yaml --json",
    "calibrate": "-m vehgen calibrate tractor5.yaml hump_2ms.yaml hump_3ms.yaml --out calibrated --json",
    "calibrate dhcm": "-m vehgen calibrate tractor5.yaml hump_2ms.yaml --method dhcm --size 30 --generations 20 --starts 2"
    " --bootstrap 3 --out calibrated_dhcm --json",
    "calibrate shcm": "-m vehgen calibrate tractor5.yaml hump_2ms.yaml --method shcm --sensors L1 --size 30 --generations 20"
    " --no-polish --seed 2 --out calibrated_shcm --json",
    "validate": "-m vehgen validate calibrated/tractor5_calibrated.yaml road_3ms.yaml --out validation --json",
}
"""Command lines by name."""


def command(name: str, **places: object) -> list[str]:
    """Return the arguments of a command line, its places filled in."""
    return [part.format(**places) for part in shlex.split(COMMANDS[name])]
