"""The independent coordinates of a vehicle: what each is called, and what it means."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    import sympy as sp


@dataclass(frozen=True)
class Coordinate:
    """An independent coordinate: `heave.BODY` [m], `pitch.BODY` [rad], `bending.BODY` [m] or `hop.AXLE` [m]."""

    motion: Literal["heave", "pitch", "bending", "hop"]
    owner: str

    @property
    def name(self) -> str:
        """Its name in tables and files."""
        return f"{self.motion}.{self.owner}"

    @property
    def symbol(self) -> sp.Symbol:
        """Its symbol in equations."""
        import sympy as sp

        return sp.Symbol(f"{self.letter}_{self.owner}", real=True)

    @property
    def letter(self) -> str:
        """What its symbol begins with: `z` of a rise, `theta` of a pitch, `eta` of a bending, so that no two of one body are alike."""
        return {"heave": "z", "pitch": "theta", "bending": "eta", "hop": "z"}[self.motion]

    @property
    def unit(self) -> str:
        """Its SI unit."""
        return "rad" if self.motion == "pitch" else "m"

    @property
    def meaning(self) -> str:
        """What it is, in words."""
        return {
            "heave": f"rise of the COG of {self.owner}",
            "pitch": f"pitch of {self.owner}, nose-down positive",
            "bending": f"rise of the ends of {self.owner} in its bending mode",
            "hop": f"rise of the unsprung mass of {self.owner}",
        }[self.motion]
