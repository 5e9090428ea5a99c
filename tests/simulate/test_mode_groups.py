"""Modes of one frequency have a basis that does not depend on how they were computed, and are told in one line."""

import numpy as np
import pytest

from vehgen.mechanics import derive
from vehgen.simulate import natural_modes
from vehgen.simulate.mode_groups import alike_modes, group_name, settled_shapes
from vehgen.vehicle import load_vehicle


@pytest.fixture(scope="module")
def train():
    model = derive(load_vehicle("road_train"))
    return model.numeric(model.values()), natural_modes(model)


def test_any_mixture_gives_the_same_shapes(train):
    numeric, modes = train
    squares = np.array([(2 * np.pi * mode.undamped_hz) ** 2 for mode in modes])
    shapes = np.array([mode.shape / np.sqrt(mode.shape @ numeric.M @ mode.shape) for mode in modes]).T
    low, high = next((i, i + len(group)) for i, group in first_of(modes) if len(group) == 9)
    turn = np.linalg.qr(np.random.default_rng(1).standard_normal((9, 9)))[0]
    mixed = shapes.copy()
    mixed[:, low:high] = shapes[:, low:high] @ turn
    found = settled_shapes(squares, mixed, numeric.M)
    assert np.abs(found) == pytest.approx(np.abs(settled_shapes(squares, shapes, numeric.M)), abs=1e-9)
    assert found.T @ numeric.M @ found == pytest.approx(np.eye(len(squares)), abs=1e-9)
    residual = numeric.K @ found - numeric.M @ found * squares
    assert np.abs(residual).max() < 1e-8 * np.abs(numeric.K @ found).max()


def first_of(modes):
    start = 0
    for group in alike_modes(modes):
        yield start, group
        start += len(group)


def test_nine_hops_of_the_road_train_are_one_line(train):
    _, modes = train
    groups = list(alike_modes(modes))
    assert sum(map(len, groups)) == len(modes)
    (nine,) = [group for group in groups if len(group) > 1]
    assert len(nine) == 9
    assert group_name(nine).startswith("9 alike hops: axle")
    assert group_name(nine[:1]) == nine[0].name
