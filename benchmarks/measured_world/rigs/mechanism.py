"""Masses, joints and dry friction over time: Filippov's solution between events at which friction begins to stick or to slip."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from benchmarks.measured_world.chain import RATE
from benchmarks.measured_world.rigs.laws import LAWS, Law, slip_forces
from benchmarks.measured_world.rigs.signals import REST, Signal

Array = NDArray[np.float64]
Push = Callable[[Any, Array, Array], Array]
LONGEST_STEP = 4e-3
"""Of the integration [s]: short enough that no reversal is stepped over."""
SLIPS_OR_STICKS = (0, 1, -1)
MOST_SWITCHES = 50_000
JUST_BEGUN = 1e-12
"""By which a friction that has just begun to stick or slip is short of its end [m/s or N]."""


@dataclass(frozen=True)
class Joint:
    """A spring, a damper and a law along a row over the coordinates: d = row @ q + base(t), the force f gives -row*f on them."""

    row: tuple[float, ...]
    k: float = 0.0
    c: float = 0.0
    law: str = "none"
    values: Mapping[str, float] = field(default_factory=dict)
    base: Signal = REST

    @cached_property
    def _law(self) -> tuple[Law, Mapping[str, float], float]:
        law = LAWS[self.law]
        return law, {**self.values, "c": self.c}, 0.0 if law.replaces_dashpot else self.c

    def force(self, d: Array, v: Array, z: Array) -> Array:
        """Return the force without dry friction [N], compression positive."""
        law, values, dashpot = self._law
        return self.k * d + dashpot * v + law.force(values, d, v, z)

    def flow(self, d: Array, v: Array, z: Array) -> Array:
        """Return the rate of the law's internal state; zero of a law without one."""
        law, values, _ = self._law
        return 0.0 * d if law.flow is None else law.flow(values, d, v, z)


@dataclass(frozen=True)
class Motion:
    """What moved, at RATE from t = 0 on: coordinates, rates and accelerations `shape (n, samples)`, the joints' travels and forces
    `shape (joints, samples)`."""

    t: Array
    q: Array
    v: Array
    a: Array
    travel: Array
    force: Array


def marked(event: Any) -> Any:
    """Return an event of solve_ivp that ends the integration where it rises through zero."""
    event.terminal, event.direction = True, 1.0
    return event


class Mechanism:
    """Masses on joints, pushed by what depends on time, place and rate: `push(t, q, v)` `shape (n,)` or `(n, samples)` [N]."""

    def __init__(self, mass: Sequence[float], joints: Sequence[Joint], push: Push) -> None:
        self.mass = np.array(mass)
        self.joints = tuple(joints)
        self.push = push
        self.rows = np.array([joint.row for joint in joints])
        slips = [(i, slip_forces(joint.law, joint.values)) for i, joint in enumerate(joints)]
        self.rubbing = [i for i, limits in slips if limits is not None]
        self.limits = [limits for _, limits in slips if limits is not None]

    def run(self, q: Sequence[float], v: Sequence[float], duration: float) -> Motion:
        """Return the motion from displacements [m, rad] and rates on, for a duration [s]."""
        moments = np.arange(round(duration * RATE) + 1) / RATE
        state = np.concatenate([q, v, np.zeros(len(self.joints))])
        modes = self._settled(0.0, state, (), list(range(len(self.rubbing))))
        parts, start = [], 0.0
        for _ in range(MOST_SWITCHES):
            end, state_end, cause, solution = self._until_event(start, state, modes, moments[-1])
            inside = moments[(moments >= start) & ((moments < end) if cause is not None else True)]
            if len(inside):
                parts.append(self._sampled(inside, solution(inside), modes))
            if cause is None:
                return self._joined(parts)
            modes, state = self._switched(end, state_end, modes, cause)
            start = end
        raise RuntimeError(f"friction stuck and slipped {MOST_SWITCHES} times until {start:.6f} s")

    def _joined(self, parts: Sequence[tuple[Array, ...]]) -> Motion:
        t, q_all, v_all, a, travel, force = (np.concatenate(items, axis=-1) for items in zip(*parts, strict=True))
        return Motion(t, q_all, v_all, a, travel, force)

    def _parts(self, state: Array) -> tuple[Array, Array, Array]:
        n = len(self.mass)
        return state[:n], state[n : 2 * n], state[2 * n :]

    def _joint_motion(self, t: Any, q: Array, v: Array) -> tuple[Array, Array]:
        d, rate = self.rows @ q, self.rows @ v
        for i, joint in enumerate(self.joints):
            if joint.base is not REST:
                d[i] += joint.base.value(t)
                rate[i] += joint.base.rate(t)
        return d, rate

    def _loads(self, t: Any, state: Array, modes: Sequence[int]) -> tuple[Array, Array, Array, Array]:
        """Return travels, joint forces with the friction that slips or sticks, accelerations, and rates of internal states."""
        q, v, z = self._parts(state)
        d, rate = self._joint_motion(t, q, v)
        force = np.array([joint.force(d[i], rate[i], z[i]) for i, joint in enumerate(self.joints)])
        flow = np.array([joint.flow(d[i], rate[i], z[i]) for i, joint in enumerate(self.joints)])
        for i, mode, limits in zip(self.rubbing, modes, self.limits, strict=True):
            force[i] += limits[0] if mode > 0 else -limits[1] if mode < 0 else 0.0
        mass = self.mass.reshape(-1, *([1] * (q.ndim - 1)))
        a = (self.push(t, q, v) - self.rows.T @ force) / mass
        stuck = [i for i, mode in zip(self.rubbing, modes, strict=True) if mode == 0]
        if stuck:
            rows = self.rows[stuck]
            sliding = rows @ a + np.array([self.joints[i].base.acceleration(t) + np.zeros(a.shape[1:]) for i in stuck])
            held = np.linalg.solve((rows / self.mass) @ rows.T, sliding)
            force[stuck] += held
            a = a - (rows.T @ held) / mass
        return d, force, a, flow

    def _held(self, t: float, state: Array, modes: Sequence[int], which: int) -> float:
        """Return the force by which friction `which` sticks [N]."""
        q, v, z = self._parts(state)
        i = self.rubbing[which]
        d, rate = self._joint_motion(t, q, v)
        _, force, _, _ = self._loads(t, state, modes)
        return float(force[i] - self.joints[i].force(d[i], rate[i], z[i]))

    def _sliding(self, t: float, state: Array, which: int) -> float:
        q, v, _ = self._parts(state)
        return float(self._joint_motion(t, q, v)[1][self.rubbing[which]])

    def _sliding_acceleration(self, t: float, state: Array, modes: Sequence[int], which: int) -> float:
        i = self.rubbing[which]
        _, _, a, _ = self._loads(t, state, modes)
        return float(self.rows[i] @ a + self.joints[i].base.acceleration(t))

    def _until_event(self, start: float, state: Array, modes: Sequence[int], end: float) -> tuple[float, Array, Any, Any]:
        n = len(self.mass)

        def derivative(t: float, y: Array) -> Array:
            _, _, a, flow = self._loads(t, y, modes)
            return np.concatenate([y[n : 2 * n], a, flow])

        events, causes = [], []
        for which, mode in enumerate(modes):
            for sign in (1, -1) if mode == 0 else (mode,):
                events.append(self._event(modes, which, sign, start))
                causes.append((which, sign))
        if start >= end:
            return end, state, None, lambda t: np.repeat(state[:, None], len(t), axis=1)
        found = solve_ivp(
            derivative, (start, end), state, method="DOP853", events=events or None, dense_output=True,
            rtol=1e-7, atol=1e-9, max_step=LONGEST_STEP,
        )  # fmt: skip
        if not found.success:
            raise RuntimeError(f"the motion could not be followed beyond {found.t[-1]:.4f} s: {found.message}")
        cause = next((cause for cause, times in zip(causes, found.t_events or [], strict=False) if len(times)), None)
        return float(found.t[-1]), found.y[:, -1], cause, found.sol

    def _event(self, modes: Sequence[int], which: int, sign: int, start: float) -> Any:
        """Return the event at which friction stops to stick towards `sign`, or to slip in its direction `sign`, later than `start` [s]."""
        forward, backward = self.limits[which]
        limit = forward if sign > 0 else backward

        def breaks(t: float, y: Array) -> float:
            return sign * self._held(t, y, modes, which) - limit

        def stops(t: float, y: Array) -> float:
            return -sign * self._sliding(t, y, which)

        crossed = breaks if modes[which] == 0 else stops

        def event(t: float, y: Array) -> float:
            return crossed(t, y) if t > start else min(crossed(t, y), -JUST_BEGUN)

        return marked(event)

    def _switched(self, t: float, state: Array, modes: Sequence[int], cause: tuple[int, int]) -> tuple[tuple[int, ...], Array]:
        which, sign = cause
        still = [i for i, mode in enumerate(modes) if mode == 0 and i != which]
        state = self._stopped(t, state, [which, *still])
        if modes[which] == 0:
            return self._settled(t, state, modes, still, {which: sign}), state
        return self._settled(t, state, modes, [which, *still]), state

    def _stopped(self, t: float, state: Array, which: Sequence[int]) -> Array:
        """Return the state with no sliding at all in some frictions, where rounding left a trace of it."""
        n, rows = len(self.mass), self.rows[[self.rubbing[i] for i in which]]
        sliding = np.array([self._sliding(t, state, i) for i in which])
        state = state.copy()
        state[n : 2 * n] -= (rows / self.mass).T @ np.linalg.solve((rows / self.mass) @ rows.T, sliding)
        return state

    def _settled(
        self, t: float, state: Array, modes: Sequence[int], open_: Sequence[int], forced: Mapping[int, int] | None = None
    ) -> tuple[int, ...]:
        """Return modes in which frictions at rest stick within their limits, or slip as their joints accelerate."""
        base = list(modes) or [0] * len(self.rubbing)
        for which, sign in (forced or {}).items():
            base[which] = sign
        moving = {i: self._sliding(t, state, i) for i in open_}
        at_rest = [i for i in open_ if abs(moving[i]) < 1e-9]
        for i in set(open_) - set(at_rest):
            base[i] = int(np.sign(moving[i]))
        for choice in itertools.product(SLIPS_OR_STICKS, repeat=len(at_rest)):
            for i, mode in zip(at_rest, choice, strict=True):
                base[i] = mode
            if all(self._consistent(t, state, base, i) for i in at_rest):
                return tuple(base)
        raise RuntimeError(f"no state of the frictions is consistent at {t:.6f} s")

    def _consistent(self, t: float, state: Array, modes: Sequence[int], which: int) -> bool:
        forward, backward = self.limits[which]
        if modes[which] == 0:
            return -backward <= self._held(t, state, modes, which) <= forward
        return modes[which] * self._sliding_acceleration(t, state, modes, which) >= 0.0

    def _sampled(self, t: Array, states: Array, modes: Sequence[int]) -> tuple[Array, ...]:
        q, v, _ = self._parts(states)
        d, force, a, _ = self._loads(t, states, modes)
        return t, q, v, a, d, force
