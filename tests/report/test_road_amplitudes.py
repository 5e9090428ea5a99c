"""The response to a road on the page of a build: its numbers from exported matrices, its section, and when it is left out."""

import html
import json
import re

import numpy as np
import pytest
import scipy.signal

from tests.bundled import few
from tests.report.vehicles import EVERY, build, model
from vehgen.export import export
from vehgen.simulate.road_amplitudes import road_amplitudes
from vehgen.vehicle import bundled_models, load_vehicle, parse_vehicle

SPEED = 20.0
ROW = re.compile(r'<tr><td class="w">(body heave|axle hop|tyre load)</td><td class="w">(.*?)</td>' + 2 * r'<td class="n">(.*?)</td>')
DRIVEN = [name for name in bundled_models() if load_vehicle(name).axles]
UNDAMPED = """
name: lift
bodies: {body: {mass: 400 kg, motions: [heave]}}
axles: {only: {body: body, tyre: {k: 400 kN/m}}}
"""


class Exported:
    """|H| of one road under all wheels from the matrices that an export holds: M q'' + C q' + K q = P w + Q w'."""

    def __init__(self, name, folder):
        export(name, "json", folder / "out.json")
        data = json.loads((folder / "out.json").read_text(encoding="utf-8"))
        self.M, self.C, self.K, self.P, self.Q = (np.array(data[key]) for key in "MCKPQ")
        self.delays = np.array(list(data["axle_offsets"].values())) / SPEED
        self.axles = list(data["axle_offsets"])
        self.coordinates = [item["name"] for item in data["coordinates"]]
        outputs = [item["name"] for item in data["outputs"]]
        self.rises = dict(zip(outputs, data["output_matrices"]["acceleration"], strict=True))
        vehicle = load_vehicle(name)
        values = vehicle.all_values(vehicle.values())
        self.tyres = {key: (axle.tyre.k.evaluate(values), axle.tyre.c.evaluate(values)) for key, axle in vehicle.axles.items()}

    def states(self, frequency):
        s = 2j * np.pi * frequency[:, None, None]
        road = np.exp(-2j * np.pi * frequency[:, None] * self.delays)[:, :, None]
        return np.linalg.solve(s**2 * self.M + s * self.C + self.K, (self.P + s * self.Q) @ road)[:, :, 0], road[:, :, 0], s[:, :, 0]

    def amplitude(self, group, name, found):
        q, road, s = found
        if group == "body heave":
            return np.abs(q @ self.rises[f"{name}_acceleration"])
        if group == "axle hop":
            return np.abs(q[:, self.coordinates.index(f"hop.{name}")])
        number, (k, c) = self.axles.index(name), self.tyres[name]
        felt = (self.P[:, number] + s * self.Q[:, number]) * q
        return 1e-6 * np.abs((k + c * s[:, 0]) * road[:, number] - felt.sum(axis=1))


def highest(frequency, amplitude):
    peaks, _ = scipy.signal.find_peaks(amplitude)
    top = max(peaks, key=lambda i: amplitude[i])
    return frequency[top], amplitude[top]


@pytest.mark.parametrize("name", few(DRIVEN))
def test_peaks_and_curves_are_those_of_the_exported_matrices(name, pages, tmp_path):
    known = Exported(name, tmp_path)
    frequency = np.geomspace(0.2, 30.0, 6000)
    states = known.states(frequency)
    rows = ROW.findall(pages(name))
    assert {owner for group, owner, *_ in rows if group == "body heave"} == set(load_vehicle(name).bodies)
    for group, owner, at, height in rows:
        expected = highest(frequency, known.amplitude(group, owner, states))
        assert (float(at), float(height)) == pytest.approx(expected, rel=6e-3)
    loads = {axle: highest(frequency, known.amplitude("tyre load", axle, states))[1] for axle in known.axles}
    first, last = known.axles[known.delays.argmin()], known.axles[known.delays.argmax()]
    assert {owner for group, owner, *_ in rows if group == "tyre load"} == {first, last, max(loads, key=loads.get)}
    for panel in json.loads(html.unescape(re.findall(r'<svg data-curves="([^"]*)"', pages(name))[0])):
        group = panel["y"]["label"].split(" |H|")[0]
        for curve in panel["curves"]:
            expected = known.amplitude(group, curve["name"], known.states(np.array(curve["x"])))
            assert curve["y"] == pytest.approx(expected, rel=2e-3, abs=2e-3 * max(expected))


@pytest.mark.thorough
@pytest.mark.parametrize("name", few(EVERY))
def test_every_page_has_the_section_or_says_why_not(name, pages):
    source, m = pages(name), model(name)
    section = source.split('<h2 id="road">')[1].split("<h2")[0]
    assert '<a href="#road">' in source
    if not m.vehicle.axles:
        assert "no wheel of this rig meets a road" in section
        assert "<svg" not in section
        return
    assert "at 20 m/s" in section
    assert "<code>vehgen response " in section
    assert section.count("<svg") == 1
    laws = {term.law.name for element in m.elements for term in element.laws}
    assert ("the force laws are left out" in section) == bool(laws - {"relaxation"})
    panels = json.loads(html.unescape(re.findall(r'data-curves="([^"]*)"', section)[0]))
    assert panels[-1]["x"]["label"] == "frequency [Hz]"
    assert [re.sub(r".*\[", "[", panel["y"]["label"]) for panel in panels] == ["[m/m]", "[m/m]", "[kN/mm]"]


def test_the_page_gives_a_command_for_more(pages):
    (command,) = re.findall(r"<code>vehgen response (.*?)</code>", pages("tractor5"))
    assert html.unescape(command) == "tractor5.yaml --speed 20"


@pytest.mark.parametrize("name", ["tractor5", "rig"])
def test_without_drawings_there_is_none(name, tmp_path):
    build(tmp_path, name, plots=False)
    source = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert 'id="road"' not in source
    assert "#road" not in source


def test_an_axle_without_mass_has_no_hop_and_an_undamped_peak_stays_a_number():
    vehicle = parse_vehicle(UNDAMPED)
    found = road_amplitudes(vehicle, vehicle.values())
    assert list(found.groups()) == ["body heave", "tyre load"]
    frequency, height = found.curves[0].peak
    natural = np.sqrt(400e3 / 400.0) / (2 * np.pi)
    assert frequency == pytest.approx(natural, rel=1e-3)
    assert height == pytest.approx(1.0 / abs(1.0 - (frequency / natural) ** 2), rel=1e-6)
    assert found.curves[0].amplitude == pytest.approx(1.0 / np.abs(1.0 - (found.frequency / natural) ** 2), rel=1e-9)


@pytest.mark.parametrize("ratio", [0.1, 1e-3, 1e-5])
def test_the_peak_of_a_mode_is_seen_however_little_it_is_damped(ratio):
    """One mass on a damped tyre, k + i w c over k - m w^2 + i w c: at resonance sqrt(1 + 1/(4 ratio^2)), and hardly more at its peak."""
    damped = UNDAMPED.replace("k: 400 kN/m", f"k: 400 kN/m, c: {2 * ratio * np.sqrt(400e3 * 400):.9g} N s/m")
    vehicle = parse_vehicle(damped)
    found = road_amplitudes(vehicle, vehicle.values())
    (heave,) = [item for item in found.curves if item.group == "body heave"]
    assert heave.peak == pytest.approx((np.sqrt(1000) / (2 * np.pi), np.sqrt(1 + 1 / (4 * ratio**2))), rel=1.5e-2)
    assert heave.amplitude.max() == pytest.approx(heave.peak[1], rel=2e-2)
