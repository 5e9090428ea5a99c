"""Write api.md from the public names and their docstrings: `python docs/generate/api_page.py`."""

from __future__ import annotations

import inspect
import re
from pathlib import Path
from typing import NamedTuple

import vehgen

PAGE = Path(__file__).parents[1] / "api.md"
HEAD = """\
# From Python

Made by `python docs/generate/api_page.py` from the docstrings, which say more: `help(vehgen.calibrate)`.

The main arguments come first, all others are keywords. A vehicle is a `Vehicle`, its file, or the name of a bundled model; a run is a
`Run` or its file; equations of motion can stand for a vehicle. What cannot be used raises `InputError`, which names the file with line and
column, or the argument. Numbers are in SI units.

Results are values: `to_dict()` gives plain data for JSON and `from_dict()` takes them back, `to_dataframe()` gives a table (with pandas),
`plot()` a matplotlib figure, and a notebook shows the table. These are results: what `static_loads`, `natural_modes`, `state_space`,
`frequency_response`, `road_response`, `simulate`, `assess`, `import_phones`, `transmissibility`, `calibrate`, `validate`, `sensitivity`,
`advise_sensors`, `diagnose` and `build` return.

The snippets of this page run one after the other, in a folder with the files of [examples](examples), its folders `hidden`, `phones` and
`cargo` among them. [tutorial.py](tutorial.py) is the [tutorial](tutorial.md) in Python.
"""


class Section(NamedTuple):
    """Names that belong together, and a snippet that uses them all."""

    title: str
    names: tuple[str, ...]
    snippet: str


SECTIONS = (
    Section(
        "Vehicles",
        ("load_vehicle", "parse_vehicle", "bundled_models", "Vehicle", "Parameter", "Body", "Axle", "Hinge", "Link", "Spring"),
        """\
import vehgen

print(list(vehgen.bundled_models()))
truck = vehgen.load_vehicle("my_truck.yaml")
assert isinstance(truck, vehgen.Vehicle) and isinstance(truck.parameters["kf"], vehgen.Parameter)
body, front = truck.bodies["body"], truck.axles["front"]
assert isinstance(body, vehgen.Body) and isinstance(front, vehgen.Axle) and isinstance(front.suspension, vehgen.Spring)
train = vehgen.load_vehicle("my_road_train.yaml")
assert all(isinstance(item, vehgen.Hinge) for item in train.hinges.values())
assert all(isinstance(item, vehgen.Link) for item in train.links.values())
stiff = vehgen.parse_vehicle("extends: tractor5\\nparameters: {k1: {value: 800 kN/m}}")
""",
    ),
    Section(
        "Equations of motion",
        ("derive", "EquationsOfMotion", "Place", "PointOutput", "ElementOutput", "static_loads", "natural_modes"),
        """\
driver = vehgen.Place("driver", "body", behind="front", distance=0.4)
outputs = [vehgen.PointOutput("az", driver, "acceleration"), vehgen.ElementOutput("load", "rear", "tyre_load")]
model = vehgen.derive(truck, outputs)
assert isinstance(model, vehgen.EquationsOfMotion)
print(model.M, model.C, model.K, model.P)  # sympy; Q belongs to the rates of the inputs, F to forces
print(model.numeric(model.values(overrides={"kf": 350e3})).K)  # numpy
print(vehgen.static_loads("tractor5", parameter_set="SHCM-1").axles)
print(vehgen.natural_modes(truck, {"kf": 350e3}).to_dataframe())
""",
    ),
    Section(
        "Linear systems",
        ("state_space", "frequency_response", "road_response", "export"),
        """\
system = vehgen.state_space(truck, outputs=outputs[:1])
print(system.states, system.inputs, system.outputs, system.poles)
response = vehgen.frequency_response(truck, [0.5, 1.5, 11.0], outputs=outputs[:1], speed=15.0)
print(abs(response.values))
print(vehgen.road_response(truck, speed=20.0, roughness="C").to_dataframe())
print(vehgen.export(truck, "json", "my_truck.json", outputs=outputs[:1]))
""",
    ),
    Section(
        "Simulations",
        ("load_run", "Run", "simulate", "assess", "Response", "Simulator", "make_scenario", "Kernel", "Excitation"),
        """\
import numpy as np

run = vehgen.load_run("two_humps.yaml")
assert isinstance(run, vehgen.Run)
driven = vehgen.simulate(run)
assert isinstance(driven, vehgen.Response)
print(driven.channel("cab_az").shape, driven.warnings)
slower = vehgen.simulate(run.changed(speed=5.0))  # the same run at 5 m/s
assessed = vehgen.assess(run)
print(assessed.ride[0].rms, assessed.tyres[0].fourth_power, assessed.to_dataframe())

simulator = vehgen.Simulator(run.vehicle, run.outputs())
scenario = vehgen.make_scenario(run, simulator.model, simulator.model.values())
population = simulator.parameters([{"k_trailer": 1.3e6}, {"k_trailer": 1.5e6}])
print(simulator.run(population, scenario).responses.shape)  # (individuals, samples, channels)
faster = scenario.adjusted(speed=1.2)  # the same run, 1.2 times as fast
print(abs(simulator.run(population, faster).responses).max(axis=1))

kernel = vehgen.Kernel(model)
road = np.zeros((1001, 2))
road[100:, 0] = 0.01
drive = vehgen.Excitation(1e-3, road, np.zeros_like(road), np.zeros((1001, 0)))
print(kernel.run(np.array([list(model.values().values())]), drive).responses.shape)  # loads without their static part
""",
    ),
    Section(
        "Recordings of phones",
        ("import_phones", "PhoneSensor", "transmissibility"),
        """\
found = vehgen.import_phones(
    ["phones/hump_2ms_phone1.zip", "phones/hump_2ms_phone2.zip"],
    vehicle="tractor5",
    sensors=[
        vehgen.PhoneSensor("L1", "tractor", behind="axle1", distance=-0.29, forward="y"),
        vehgen.PhoneSensor("L2", "semitrailer", behind="fifth_wheel", distance=9.115, forward="x"),
    ],
    hump={"shape": "half_sine", "length": 0.5, "height": 0.03},
    out="imported.yaml",
)
print(found.speed, found.to_dataframe())

rough = vehgen.transmissibility(
    ["phones/road_3ms_phone1.zip", "phones/road_3ms_phone2.zip"], forward="y", bands=[(2, 8), (8, 20)], segment=2.0
)  # no road is told, nor a vehicle; a drive of some minutes allows longer segments
print(rough.to_dataframe(), rough.cannot_tell)
""",
    ),
    Section(
        "Calibration",
        ("calibrate", "validate", "sensitivity", "advise_sensors"),
        """\
humps = ["hidden/low_2ms.yaml", "hidden/high_4ms.yaml"]
calibrated = vehgen.calibrate("sedan2", humps, size=20, generations=5, starts=2)  # small, so that it is quick
print(calibrated.to_dataframe())
print(vehgen.validate("sedan2", "hidden/high_2.5ms.yaml").worst)
print(vehgen.sensitivity(humps[0], ["kf", "kr"]).to_dataframe())
print(vehgen.advise_sensors(humps[0], 2, parameters=["kf", "kr"]).to_dataframe())
""",
    ),
    Section(
        "Diagnosis",
        ("effects", "Effect", "diagnose"),
        """\
assert isinstance(vehgen.effects()["dry_friction"], vehgen.Effect)
diagnosis = vehgen.diagnose("sedan2", [*humps, "hidden/high_2.5ms.yaml"], effects=["dry_friction"])
print(diagnosis.verdict.reason)
""",
    ),
    Section(
        "Cargo, pages and drawings",
        ("laden", "build", "draw_vehicle", "read_result", "report"),
        """\
import json
from pathlib import Path

heavy = vehgen.laden("tractor5", "cargo/pallets.yaml", out="laden.yaml")
vehgen.draw_vehicle(heavy).savefig("laden.svg")
print(vehgen.build(truck, "build/my_truck").loads.axles)
Path("diagnosis.json").write_text(json.dumps(diagnosis.to_dict()), encoding="utf-8")
again = vehgen.read_result("diagnosis.json")
print(vehgen.report(again, "pages"))
""",
    ),
    Section(
        "What can go wrong",
        ("InputError", "ModelWarning"),
        """\
import warnings

try:
    vehgen.load_vehicle("tracter5")
except vehgen.InputError as error:
    print(error)
with warnings.catch_warnings():
    warnings.simplefilter("error", vehgen.ModelWarning)  # answers that deserve doubt become errors
    vehgen.natural_modes(truck)
""",
    ),
)


def signature(name: str) -> str:
    """Return how a public name is called; classes that are not called by users stand alone."""
    item = getattr(vehgen, name)
    if inspect.isclass(item) and name not in ("Place", "PointOutput", "ElementOutput", "Simulator", "Kernel", "Excitation", "PhoneSensor"):
        return name
    parts, keywords = [], False
    for parameter in inspect.signature(item).parameters.values():
        if parameter.kind is parameter.KEYWORD_ONLY and not keywords:
            parts.append("*")
            keywords = True
        default = parameter.default
        is_long = len(repr(default)) > 20 or "<" in repr(default)
        parts.append(parameter.name if default is parameter.empty else f"{parameter.name}={'...' if is_long else repr(default)}")
    return f"{name}({', '.join(parts)})"


def meaning(name: str) -> str:
    """Return the first line of a name's docstring."""
    text = inspect.getdoc(getattr(vehgen, name)) or ""
    return re.sub(r":\w+:`~?([^`]*)`", r"\1", text.partition("\n\n")[0].replace("\n", " ")).replace("|", "\\|")


def page() -> str:
    """Return the page's text."""
    lines = [HEAD]
    for section in SECTIONS:
        lines += [f"## {section.title}", ""]
        lines += [f"- `{signature(name)}`: {meaning(name)}" for name in section.names]
        lines += ["", "```python", section.snippet.rstrip(), "```", ""]
    return "\n".join(lines)


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
