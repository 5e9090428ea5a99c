"""A building module's m0, k0, c0 and centre of gravity from its finite-element model.

Follows Wu & Li 2023 (doi:10.3390/s23249691), Sect. 2.5 and Fig. 9: four bottom corners held in translation, the principal vertical mode's
frequency f0, k0 = (2 pi f0)^2 m0, and c0 = 2 zeta0 (2 pi f0) m0 with Rayleigh's damping ratio zeta0 = (alpha/w0 + beta w0)/2.
"""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vehgen.cargo.box_mesh import Mesh, box_mesh, box_node_count
from vehgen.cargo.eigenmodes import Eigenmodes, RigidBody, eigenmodes, rigid_body
from vehgen.cargo.elements import assemble
from vehgen.cargo.frame_file import FrameModule, rayleigh
from vehgen.errors import InputError
from vehgen.files.yaml_writer import even_text, yaml_document

BYTES_PER_NODE = 80_000
"""Memory that assembly and factorisation take (about 50 kB a node at 13 000 nodes), with room for growth."""
MOST_NODES = 50_000
DOUBTFUL_SHARE = 0.5
COARSE_HOURGLASS = 0.05


@dataclass(frozen=True)
class ModuleModel:
    """What the finite-element model of a module says [SI].

    `frequency` f0 [Hz] and `damping_ratio` zeta0 are the principal vertical mode's; `effective_mass` is what it moves vertically;
    `mass` m0 sits on the spring `stiffness` k0 with the damper `damping` c0, `fixed_mass` beside it moves with the carrier.
    """

    frame: FrameModule
    mesh: Mesh
    mesh_size: float
    corners: NDArray[np.int64]
    body: RigidBody
    modes: Eigenmodes
    frequency: float
    damping_ratio: float
    effective_mass: float
    mass: float
    fixed_mass: float
    warnings: tuple[str, ...]

    @property
    def effective_share(self) -> float:
        """The principal mode's effective mass over the whole mass."""
        return self.effective_mass / self.body.mass

    @property
    def stiffness(self) -> float:
        """k0 = (2 pi f0)^2 m0 [N/m]."""
        return (2 * math.pi * self.frequency) ** 2 * self.mass

    @property
    def damping(self) -> float:
        """c0 = 2 zeta0 (2 pi f0) m0 [N s/m]."""
        return 2 * self.damping_ratio * 2 * math.pi * self.frequency * self.mass


def module_model(frame: FrameModule, mesh_size: float | None = None, mass: str | None = None) -> ModuleModel:
    """Build and solve the finite-element model of a module.

    Parameters
    ----------
    frame
        The module.
    mesh_size
        Largest side of an element [m] (default: the file's).
    mass
        `total` or `effective`: what sits on the spring (default: the file's).

    Raises
    ------
    InputError
        When pyfe3d is missing, the mesh is too fine for the memory, a bottom corner has nothing to hold, or the structure is a mechanism.
    """
    size = frame.file.mesh.size if mesh_size is None else mesh_size
    _check_size(frame, size)
    mesh, corners = box_mesh(frame, size)
    if len(corners) < 4:
        place = frame.document.find(("frame",), key=True)
        raise InputError("a bottom corner is part of no panel and no member, so that nothing can be held there", place)
    matrices = assemble(mesh)
    body = rigid_body(mesh, matrices.M)
    if not body.mass > 0:
        raise InputError("the module weighs nothing; give its materials a density", frame.document.find(("materials",), key=True))
    held = (6 * corners[:, None] + np.arange(3)).ravel()
    try:
        modes = eigenmodes(matrices, held)
        found = modes.principal
    except InputError as error:
        raise InputError(error.message, error.position or frame.document.find(("mesh", "size"))) from error
    frequency, effective = float(modes.frequency[found]), float(modes.effective_mass[found])
    alpha, beta = rayleigh(*frame.file.damping)
    w0 = 2 * math.pi * frequency
    on_spring = body.mass if (mass or frame.file.mass) == "total" else effective
    return ModuleModel(
        frame,
        mesh,
        size,
        corners,
        body,
        modes,
        frequency,
        (alpha / w0 + beta * w0) / 2,
        effective,
        on_spring,
        body.mass - on_spring,
        tuple(_warnings(modes, body)),
    )


def cargo_text(model: ModuleModel) -> str:
    """Return the cargo file of a module, as `laden` reads it."""
    file, body = model.frame.file, model.body
    nodes, kind = len(model.mesh.nodes), "total" if model.fixed_mass == 0 else "effective"
    comments = [
        f"From the finite elements of {model.frame.path.name}: {nodes} nodes, mesh size {model.mesh_size:g} m.",
        f"Principal vertical mode {model.frequency:.4g} Hz, damping ratio {model.damping_ratio:.4g}; "
        f"it moves {model.effective_share:.1%} of {body.mass:.6g} kg.",
        f"Mass on the spring: {kind}.",
    ]
    words = {"name": file.name or "", "title": even_text(file.title), "source": even_text(file.source)}
    data: dict[str, Any] = {key: text for key, text in words.items() if text}
    data |= {"on": file.on, "behind": file.behind}
    data["module"] = {
        "mass": f"{model.mass!r} kg",
        **({"fixed_mass": f"{model.fixed_mass!r} kg"} if model.fixed_mass > 0 else {}),
        "stiffness": f"{model.stiffness!r} N/m",
        "damping": f"{model.damping!r} N s/m",
        "cog": {"behind_front": f"{float(body.cog[0])!r} m", "above_floor": f"{float(body.cog[2])!r} m"},
        "front": f"{file.front!r} m",
        "base": f"{file.base!r} m",
        "pitch_inertia": f"{body.pitch_inertia!r} kg m^2",
    }
    return yaml_document(data, comments)


def convergence(frame: FrameModule) -> list[ModuleModel]:
    """Return the model at twice, 1.4 times, once and 0.7 times the file's mesh size, as far as the memory goes."""
    sizes = [frame.file.mesh.size * 2 ** (step / 2) for step in (2, 1, 0, -1)]
    return [module_model(frame, size) for size in sizes if box_node_count(frame, size) <= node_limit()]


def node_limit() -> int:
    """Return the largest number of nodes that half of this machine's memory holds."""
    try:
        memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):
        memory = 4 * 2**30
    return min(MOST_NODES, memory // (2 * BYTES_PER_NODE))


def _check_size(frame: FrameModule, size: float) -> None:
    count, limit = box_node_count(frame, size), node_limit()
    if count > limit:
        wanted = size * math.sqrt(count / limit)
        raise InputError(
            f"a mesh size of {size:g} m makes about {count} nodes, and {limit} fit in the memory; choose about {wanted:.2g} m or more",
            frame.document.find(("mesh", "size")),
        )


def _warnings(modes: Eigenmodes, body: RigidBody) -> list[str]:
    found = []
    principal = modes.principal
    share = modes.effective_mass[principal] / body.mass
    if share < DOUBTFUL_SHARE:
        others = [i for i in np.argsort(modes.effective_mass)[::-1] if modes.genuine[i] and i != principal][:2]
        listed = " and ".join(f"{modes.frequency[i]:.3g} Hz ({modes.effective_mass[i] / body.mass:.0%})" for i in others)
        found.append(
            f"the principal vertical mode moves {share:.0%} of the mass, so that one mass on a spring is a rough model; next: {listed}"
            if listed
            else f"the principal vertical mode moves {share:.0%} of the mass"
        )
    if modes.hourglass[principal] > COARSE_HOURGLASS:
        found.append(
            f"{modes.hourglass[principal]:.0%} of the principal mode's strain energy is hourglass control: choose a smaller mesh size"
        )
    if not modes.complete:
        found.append(f"modes were sought up to {modes.frequency[-1]:.3g} Hz; a higher one may move more mass vertically")
    return found
