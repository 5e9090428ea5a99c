"""The limits of kernels: counts against those of a kernel's text, and what a table makes of times and rates."""

import numpy as np
import pytest
from benchmarks.limits import machine
from benchmarks.limits.__main__ import table
from benchmarks.limits.machine import Rates, Work, work_of
from benchmarks.limits.worker import models

from vehgen.codegen import write_kernel


def test_a_steps_work_is_within_what_its_kernel_counts():
    own = work_of(["sedan2"])["sedan2"]
    source = write_kernel(models()["sedan2"])
    operations = source.operation_counts["step"] + source.operation_counts["sample"] / 10
    assert 0.5 * operations <= own.instructions < operations
    assert own.products < own.instructions
    assert 0 < own.constants <= source.n_constants


def test_the_slower_of_arithmetic_and_reading_is_the_limit():
    best = Rates(fused=20.0, mixed=40.0, read=10.0).better(Rates(fused=10.0, mixed=50.0, read=25.0))
    assert best == Rates(20.0, 50.0, 25.0)
    assert best.arithmetic(Work(100, 10, 0)) == pytest.approx(2.0)
    assert best.arithmetic(Work(100, 60, 0)) == pytest.approx(3.0)
    rows = table({"car": 8.0, "friction": 9.0}, {"car": 4.0, "friction": 6.0}, {"car": Work(100, 60, 50)}, best)
    assert rows[2] == "| car | 8.00 | 4.00 | 0.50 | 100 | 50 | 3.00 | 2.00 | 0.75 |"
    assert rows[3] == "| friction | 9.00 | 6.00 | 0.67 |  |  |  |  |  |"


def test_the_loops_do_what_their_rates_count(monkeypatch):
    x = np.zeros(2 * machine.WIDTH)
    machine._mixed(x, 0.5, 3)
    assert set(x[: machine.WIDTH]) == {0.875}  # 0.5, 0.75, 0.875
    assert set(x[machine.WIDTH :]) == {1.5}
    assert machine._fused(np.zeros(machine.WIDTH), 0.5, 2) == 0.75
    half = 8 * machine.WIDTH
    assert machine._read(np.ones(2 * half), 0.5, 2) == 1.5 * 1.5 * half  # every number is read, once each time
    monkeypatch.setattr(machine, "TIMES", 20_000)
    assert min(vars(machine.rates()).values()) > 0
