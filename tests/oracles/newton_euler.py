"""A second derivation: force and moment balances of free bodies with explicit constraint forces, in plain numpy.

Every body keeps its own fore-aft, heave and pitch motion; pins and carriers are constraint equations with reaction forces. The reactions
and the dependent motions are eliminated numerically, so nothing is shared with the symbolic derivation but the vehicle's description.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
GRAVITY = 9.81


@dataclass(frozen=True)
class FreeBodies:
    """Balances of all bodies, each with its own motions: diag(mass) a + C v + K u = P w + Q w' + gravity + G^T reactions, G a = 0."""

    slots: dict[str, int]
    inputs: list[str]
    mass: Array
    C: Array
    K: Array
    P: Array
    Q: Array
    gravity: Array
    G: Array


@dataclass(frozen=True)
class Equations:
    coordinates: list[str]
    inputs: list[str]
    M: Array
    C: Array
    K: Array
    P: Array
    Q: Array
    weight: Array
    follow: Array
    """The motions of all bodies per unit of each coordinate."""


def assemble(layout: dict) -> Equations:
    """Return the equations of a layout of plain numbers in SI units (see tests/oracles/layouts.py for its form)."""
    return _eliminate(balance(layout), _independent(layout))


def hinge_reactions(layout: dict, q: Array, v: Array, w: Array, dw: Array) -> dict[str, float]:
    """Return what each hinge presses upwards on its second body [N], at coordinates, inputs and rates about static equilibrium."""
    if not layout["hinges"]:
        return {}
    free, found = balance(layout), assemble(layout)
    load = free.P @ w + free.Q @ dw - free.K @ (found.follow @ q) - free.C @ (found.follow @ v)
    size, rows = len(free.mass), len(free.G)
    system = np.block([[np.diag(free.mass), -free.G.T], [free.G, np.zeros((rows, rows))]])
    reactions = np.linalg.lstsq(system, np.concatenate([load, np.zeros(rows)]), rcond=None)[0][size:]
    # The first constraint of every hinge is rise(first) - rise(second) = 0: its reaction presses the first body up, the second down.
    return {name: -float(reactions[2 * i]) for i, name in enumerate(layout["hinges"])}


def balance(layout: dict) -> FreeBodies:
    """Return the balances of the free bodies of a layout."""
    bodies, hinges, axles, links = (layout[key] for key in ("bodies", "hinges", "axles", "links"))
    slots: dict[str, int] = {}
    for name in bodies:
        for motion in ("fore", "heave", "pitch"):
            slots[f"{motion}.{name}"] = len(slots)
    for name, axle in axles.items():
        if axle["mass"] is not None:
            slots[f"hop.{name}"] = len(slots)
    size = len(slots)

    def e(name: str) -> Array:
        row = np.zeros(size)
        row[slots[name]] = 1.0
        return row

    def rise(body: str, x: float) -> Array:
        return np.zeros(size) if body == "ground" else e(f"heave.{body}") - x * e(f"pitch.{body}")

    def advance(body: str, z: float) -> Array:
        return e(f"fore.{body}") + z * e(f"pitch.{body}")

    mass = np.zeros(size)
    gravity = np.zeros(size)
    for name, body in bodies.items():
        mass[slots[f"fore.{name}"]] = mass[slots[f"heave.{name}"]] = body["mass"]
        mass[slots[f"pitch.{name}"]] = body["pitch_inertia"]
        gravity[slots[f"heave.{name}"]] = -GRAVITY * body["mass"]
    for name, axle in axles.items():
        if axle["mass"] is not None:
            mass[slots[f"hop.{name}"]] = axle["mass"]
            gravity[slots[f"hop.{name}"]] = -GRAVITY * axle["mass"]

    constraints = _constraints(layout, e, rise, advance)
    names = [f"road.{name}" for name in axles] + [f"ground.{name}" for name, link in links.items() if "ground" in link["points"]]
    # A spring pushes its two ends apart with k*compression: a force +f on the upper end's balance, -f on the lower end's.
    forces = {key: np.zeros((size, size)) for key in "CK"}
    pushes = {key: np.zeros((size, len(names))) for key in "CK"}

    def connect(upper: Array, lower: Array, k: float, c: float, source: str | None = None) -> None:
        for key, value in (("K", k), ("C", c)):
            forces[key] += value * np.outer(upper - lower, upper - lower)
            if source is not None:
                pushes[key][:, names.index(source)] += value * (upper - lower)

    for name, axle in axles.items():
        top = rise(axle["body"], axle["x"])
        wheel = top if axle["mass"] is None else e(f"hop.{name}")
        if axle["suspension"] is not None:
            connect(top, wheel, axle["suspension"]["k"], axle["suspension"]["c"])
        connect(wheel, np.zeros(size), axle["tyre"]["k"], axle["tyre"]["c"], f"road.{name}")
    for name, link in links.items():
        (first, x1), (second, x2) = link["points"].items()
        if second == "ground":
            (first, x1), (second, x2) = (second, x2), (first, x1)
        connect(rise(second, x2), rise(first, x1), link["k"], link["c"], f"ground.{name}" if first == "ground" else None)
    for hinge in hinges.values():
        one, two = hinge["points"]
        connect(e(f"pitch.{one}"), e(f"pitch.{two}"), hinge["k"], hinge["c"])

    return FreeBodies(slots, names, mass, forces["C"], forces["K"], pushes["K"], pushes["C"], gravity, constraints)


def _constraints(layout: dict, e, rise, advance) -> Array:
    rows = []
    for hinge in layout["hinges"].values():
        (one, (x1, z1)), (two, (x2, z2)) = hinge["points"].items()
        rows += [rise(one, x1) - rise(two, x2), advance(one, z1) - advance(two, z2)]
    hinged = {name for hinge in layout["hinges"].values() for name in hinge["points"]}
    for name, body in layout["bodies"].items():
        carrier = body["carried_by"]
        if carrier is not None:
            rows.append(advance(carrier["body"], carrier["z"]) - e(f"fore.{name}"))
            if "heave" not in body["motions"]:
                rows.append(rise(carrier["body"], carrier["x"]) - e(f"heave.{name}"))
            if "pitch" not in body["motions"]:
                rows.append(e(f"pitch.{carrier['body']}") - e(f"pitch.{name}"))
        elif name not in hinged:
            rows += [e(f"{motion}.{name}") for motion in ("heave", "pitch") if motion not in body["motions"]]
    return np.array(rows)


def _independent(layout: dict) -> list[str]:
    """Name the coordinates: of a hinged group only the first-declared body keeps its heave."""
    first: dict[str, str] = {name: name for name in layout["bodies"]}
    changed = True
    order = list(layout["bodies"])
    while changed:
        changed = False
        for hinge in layout["hinges"].values():
            one, two = hinge["points"]
            best = min(first[one], first[two], key=order.index)
            if first[one] != best or first[two] != best:
                first[one] = first[two] = best
                changed = True
    chosen = []
    for name, body in layout["bodies"].items():
        if "heave" in body["motions"] and first[name] == name:
            chosen.append(f"heave.{name}")
        if "pitch" in body["motions"]:
            chosen.append(f"pitch.{name}")
    return chosen + [f"hop.{name}" for name, axle in layout["axles"].items() if axle["mass"] is not None]


def _eliminate(free_bodies: FreeBodies, chosen: list[str]) -> Equations:
    """Solve the constrained balances for unit accelerations of the kept coordinates and read off what forces they take.

    With reactions r: diag(mass) a = f + G^T r, G a = 0. All motions compatible with the constraints are the null space of G; fore-aft
    motion that no force drives follows from the balance itself, so the null space splits into the kept coordinates and free fore-aft
    translations.
    """
    mass, G = free_bodies.mass, free_bodies.G
    kept, size = [free_bodies.slots[name] for name in chosen], len(mass)
    if len(G):
        _, singular, vt = np.linalg.svd(G)
        null = vt[int((singular > 1e-9 * singular[0]).sum()) :].T
    else:
        null = np.eye(size)
    # Coordinates of the null space: kept motions exactly, plus free translations in which no kept coordinate moves.
    at = null[kept]
    particular = null @ np.linalg.pinv(at)
    _, s, vt = np.linalg.svd(at)
    free = null @ vt[int((s > 1e-9 * s[0]).sum()) :].T
    # Balance along the free translations: free^T diag(mass) (particular a + free b) = 0, since no external force works on them.
    inertia = free.T @ (mass[:, None] * free)
    follow = particular - free @ np.linalg.solve(inertia, free.T @ (mass[:, None] * particular)) if free.shape[1] else particular
    M = follow.T @ (mass[:, None] * follow)
    matrices = [follow.T @ matrix for matrix in (free_bodies.C @ follow, free_bodies.K @ follow, free_bodies.P, free_bodies.Q)]
    return Equations(chosen, free_bodies.inputs, M, *matrices, follow.T @ free_bodies.gravity, follow)
