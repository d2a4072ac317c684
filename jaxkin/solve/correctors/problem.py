"""What a corrector is given: the loops to close, and how."""

from __future__ import annotations

from dataclasses import dataclass

from jaxkin.solve.closure.closure import Geometry
from jaxkin.solve.options import SolverOptions
from jaxkin.solve.system.loop_system import LoopSystem


@dataclass(frozen=True, eq=False)
class ClosureProblem:
    """Close the loops of a system: its equations, their constants, and the options of the user.

    All correctors take it, so that a new option needs no other argument on its way to the corrector that reads it.
    """

    system: LoopSystem
    geometry: Geometry
    options: SolverOptions
