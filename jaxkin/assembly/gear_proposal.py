"""What gears solids may be: two parts with teeth, and the coupling of their joints."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from jaxkin.joints.coupling import Coupling

Meshing = Literal["external", "internal", "bevel", "rack"]


@dataclass(frozen=True)
class GearProposal:
    """Two toothed parts that may mesh."""

    parts: tuple[str, str]
    teeth: tuple[int, int]
    """Those of a full turn, also of a sector; of a rack, which comes second, those that it has."""
    meshing: Meshing
    module: float
    """Pitch diameter over number of teeth, in the unit of the mechanism; of bevel wheels about that at their middle."""
    coupling: Coupling
    """What couples the joints of the two parts if they mesh."""
    counted: tuple[int, int]
    """Teeth that the parts have: fewer than `teeth` on a sector."""

    def __str__(self) -> str:
        one, other = (
            f"{part!r} ({number} teeth)" if number == there else f"{part!r} ({there} of {number} teeth)"
            for part, number, there in zip(self.parts, self.teeth, self.counted, strict=True)
        )
        return f"{one} and {other} may mesh, {self.meshing}, module {self.module:.3g}: {self.coupling}"

    @property
    def ratio(self) -> float | None:
        """Teeth of the second wheel over those of the first; None for a rack."""
        return None if self.meshing == "rack" else self.teeth[1] / self.teeth[0]
