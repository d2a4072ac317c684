"""The loops of a linkage as numbers of the host."""

from __future__ import annotations

from jaxkin.linkage.host_closure import ClosedLoops
from jaxkin.linkage.linkage import Linkage
from jaxkin.topology.structure import LoopGroup


def closed_loops(linkage: Linkage, loop_group: LoopGroup) -> ClosedLoops:
    """Take the loops of a loop group of a linkage, of the joints that are solved, and its couplings."""
    return ClosedLoops(linkage.solved_joints, linkage.structure, loop_group, linkage.couplings)
