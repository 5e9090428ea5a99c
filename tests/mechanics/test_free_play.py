"""A damper with play: what it does is said by the play operator alone, and it can only take energy."""

from itertools import pairwise

import numpy as np
import pytest
import sympy as sp

from vehgen.mechanics.laws import LAWS
from vehgen.mechanics.laws.base import LawState

STEP, DAMPING = 1e-3, 2e3
D, V, Y = sp.symbols("d v y", real=True)


def stepped(travel, play):
    """Return the law's mean force in each step and the damper's travel behind it, as the spring is moved along `travel shape (n,)`."""
    motion = LawState(D, V, sp.Float(STEP), sp.S.Zero, sp.S.Zero, sp.S.Zero, {"y": Y})
    step = LAWS["damper_free_play"].write(motion, {"c": sp.Float(DAMPING), "play": sp.Float(play)})
    move = sp.lambdify((D, V, Y), (step.force, step.states["y"]))
    now = sp.lambdify((D, V, Y), step.now)
    forces, at, y = [], [0.0], 0.0
    for before, after in pairwise(travel):
        force, y = move((before + after) / 2, (after - before) / STEP, y)
        forces.append(force)
        at.append(y)
    return np.array(forces, dtype=float), np.array(at, dtype=float), now


def test_a_sweep_there_and_back_is_damped_but_for_the_play():
    """By hand: of 10 mm there and back the damper moves 8 mm there and 6 mm back: play of 4 mm is closed from its middle, then across."""
    travel = np.concatenate([np.linspace(0, 0.01, 101), np.linspace(0.01, 0, 101)[1:]])
    forces, at, _ = stepped(travel, 0.004)
    rate = 1e-4 / STEP
    assert at[100] == pytest.approx(0.008)
    assert at[-1] == pytest.approx(0.002)
    assert np.count_nonzero(np.isclose(forces, DAMPING * rate)) == 80
    assert np.count_nonzero(np.isclose(forces, -DAMPING * rate)) == 60
    assert forces @ np.diff(travel) == pytest.approx(DAMPING * rate * 0.014)


@pytest.mark.parametrize("play", [0.0, 0.001, 0.006])
def test_it_takes_energy_and_never_gives_any(play):
    travel = 0.01 * np.cumsum(np.random.default_rng(2).standard_normal(2000)) / 20
    forces, at, _ = stepped(travel - travel[0], play)
    assert (forces * np.diff(travel) >= -1e-9).all()
    assert np.abs(travel - travel[0] - at).max() <= play / 2 + 1e-12
    if play == 0.0:
        np.testing.assert_allclose(forces, DAMPING * np.diff(travel) / STEP, rtol=1e-9, atol=1e-6)


def test_what_it_reads_at_an_instant_does_not_jump_as_the_play_closes():
    """From open to closed it rises within one step's way: readings follow parameters smoothly, as fits need it."""
    *_, now = stepped(np.zeros(2), 0.004)
    way = np.linspace(0.0018, 0.002, 201)  # up to the end of the play, at 0.1 m/s: the last step is 0.1 mm
    read = np.array([now(d, 0.1, 0.0) for d in way])
    assert (read[:100] == 0).all()
    assert read[-1] == pytest.approx(DAMPING * 0.1)
    assert np.diff(read).max() <= 1.01 * DAMPING * 0.1 / 100
    assert now(0.002, -0.1, 0.0) == now(0.0, 0.1, 0.0) == 0.0
    assert now(-0.002, -0.1, 0.0) == pytest.approx(-DAMPING * 0.1)
