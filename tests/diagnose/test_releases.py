"""A block on a spring that is released from three heights, stated a little wrong, with friction that the file does not know."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from vehgen.diagnose.api import diagnose
from vehgen.diagnose.detect.detection import detect
from vehgen.diagnose.inputs.amplitudes import drift_hypotheses
from vehgen.diagnose.inputs.refits import BaseRefits
from vehgen.fit.trial import load_trials

VEHICLE = """name: rig
parameters: {k: {value: 38 kN/m, range: [20 kN/m, 80 kN/m]}, c: {value: 250 N s/m, range: [50 N s/m, 1 kN s/m]}}
bodies: {block: {mass: 20 kg, motions: [heave]}}
links: {mount: {ground: {}, block: {}, k: k, c: c}}
"""
RUN = """vehicle: rig.yaml
acquisition: none
step: 0.1 ms
initial: {{block: {{displacement: {{value: {stated} m, tolerance: 2 mm}}}}}}
sensors: {{gauge: {{body: block, channels: {{displacement: y, velocity: v}}}}}}
recording: {name}.csv
"""
MASS, K, C, FRICTION = 20.0, 40e3, 200.0, 120.0
STATED = 1.03
"""Heights stand in the files so many times as large as they were."""
LATE, ZERO = 0.004, 5e-4
"""The recordings begin so long after the releases [s], and the gauge reads so much of nothing [m]."""


def released(begin, times):
    """Return displacement and velocity, half a swing at a time; the block sticks where the spring cannot overcome its friction."""
    state, start, found = np.array([begin, 0.0]), 0.0, np.zeros((len(times), 2))

    def stops(t, x, sign):
        return x[1] if t > start + 1e-6 else sign

    stops.terminal = True
    while start < times[-1]:
        if abs(K * state[0]) <= FRICTION:
            found[times >= start] = state[0], 0.0
            return found
        sign = -np.sign(state[0])

        def slope(t, x, sign):
            return x[1], (-K * x[0] - C * x[1] - FRICTION * sign) / MASS

        swing = solve_ivp(slope, (start, times[-1]), state, args=(sign,), events=stops, dense_output=True, rtol=1e-10, atol=1e-12)
        inside = (times >= start) & (times <= swing.t[-1])
        found[inside] = swing.sol(times[inside]).T
        start, state = swing.t[-1], np.array([swing.y[0, -1], 0.0])
    return found


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    folder, random, written = tmp_path_factory.mktemp("released"), np.random.default_rng(0), []
    (folder / "rig.yaml").write_text(VEHICLE, encoding="utf-8")
    times = np.arange(0.0, 3.0, 0.005)
    for name, height in (("low", 0.03), ("mid", 0.045), ("high", 0.06)):
        moved = released(height, times + LATE) + np.array([ZERO, 0.0])
        noisy = moved + np.array([2e-5, 1e-3]) * random.standard_normal((len(times), 2))
        table = np.column_stack([times, noisy])
        np.savetxt(folder / f"{name}.csv", table, delimiter=",", header="t,y,v", comments="", fmt="%.9g")
        (folder / f"{name}.yaml").write_text(RUN.format(name=name, stated=STATED * height), encoding="utf-8")
        written.append(folder / f"{name}.yaml")
    return written


def test_a_block_that_friction_holds_off_its_rest_is_no_drift(runs):
    case = BaseRefits(detect(load_trials(runs)))
    lefts = [(case.judge(item)[1], item.limit) for item in drift_hypotheses(case)]
    assert lefts
    assert all(left > limit for left, limit in lefts)


@pytest.mark.slow
def test_friction_is_named_and_the_heights_are_found(runs):
    found = diagnose(runs[0].with_name("rig.yaml"), runs)
    assert (found.verdict.verdict, [item.name for item in found.verdict.effects]) == ("named", ["dry_friction"])
    assert found.verdict.effects[0].parameters["force"].value == pytest.approx(FRICTION, rel=0.03)
    begins = {item.run: item for item in found.models.chosen[-1].least_squares.conditions() if item.name == "initial_displacement"}
    assert begins["low"].value == pytest.approx(0.03 * (1 - STATED), abs=2e-4)
