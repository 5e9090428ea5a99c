"""Moving pictures move as the equations say."""

import json
import re

import numpy as np
import pytest

from tests.report.vehicles import model
from vehgen.codegen import Excitation
from vehgen.mechanics import Place, PointOutput, derive
from vehgen.report.drawing.animation import drive_picture, mode_pictures
from vehgen.report.drawing.sketch import make_sketch
from vehgen.simulate import natural_modes
from vehgen.simulate.exact import exact_response
from vehgen.simulate.hump_drive import FRAMES_PER_SECOND, hump_drive
from vehgen.vehicle import load_vehicle


def test_a_mode_moves_wheels_as_its_shape_says():
    m = model("tractor5")
    modes = natural_modes(m)
    pictures = mode_pictures(m, modes, m.values())
    hops = [i for i, item in enumerate(m.coordinates) if item.motion == "hop"]
    for mode, picture in zip(modes, pictures, strict=True):
        moves = re.findall(r'class="wheel"[^>]*data-move="([^"]*)"', picture)
        rises = np.array([-float(move.split(",")[1]) for move in moves])
        shape = mode.shape[hops]
        scale = rises[np.argmax(np.abs(shape))] / shape[np.argmax(np.abs(shape))]
        assert rises == pytest.approx(scale * shape, abs=0.06)


def test_a_drive_is_the_exact_response():
    vehicle = load_vehicle("sedan2")
    m = derive(vehicle, [PointOutput("z", Place("z", "body"), "displacement")])
    drive = hump_drive(m, m.values())
    dt = 0.002
    steps = round((len(drive.q) - 1) / FRAMES_PER_SECOND / dt)
    time = np.arange(steps + 1) * dt
    along = 2.5 * time[:, None] - m.wheel_offsets() - drive.start
    on = (along > 0) & (along < 0.5)
    road = np.where(on, 0.05 * np.sin(np.pi * along / 0.5), 0.0)
    rate = np.where(on, 0.05 * np.pi / 0.5 * 2.5 * np.cos(np.pi * along / 0.5), 0.0)
    found = exact_response(m, Excitation(dt, road, rate, np.zeros((steps + 1, 0))), decimation=20)
    heave = [item.name for item in m.coordinates].index("heave.body")
    peak = np.abs(found).max()
    assert peak > 1e-3
    assert drive.q[:, heave] == pytest.approx(found[:, 0], abs=0.01 * peak)


def test_the_picture_of_a_drive_holds_what_moves_it():
    m = model("sedan2")
    drive = hump_drive(m, m.values())
    picture = drive_picture(m, m.values(), drive)
    frames = json.loads(re.search(r'data-frames="([^"]*)"', picture)[1])
    assert len(frames) == len(drive.q)
    assert np.array(frames) == pytest.approx(6.0 * drive.q, abs=1e-4)
    wheels = re.findall(r'class="wheel"[^>]*cx="([^"]*)"', picture)
    assert [float(x) / 100 for x in wheels] == pytest.approx(list(make_sketch(m, m.values()).axles.values()), abs=1e-3)


def test_a_rig_without_axles_does_not_drive():
    m = model("shaker")
    with pytest.raises(ValueError, match="cannot drive"):
        hump_drive(m, m.values())
