"""Tie coordinates of a linkage by couplings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from jaxkin._arguments import several
from jaxkin.joints.coupling import Coupling, check_couplings, shifted_coupling
from jaxkin.joints.joint import Joint
from jaxkin.linkage.linkage import Linkage

OFFSET_ROUNDING = 1e-9
"""Offset of a coupling, over its largest coefficient and displacement, that counts as rounding: joint positions in
files have ten digits at most, and loops that were closed before are closed to 1e-12."""


def coupled(linkage: Linkage, couplings: Sequence[Coupling]) -> Linkage:
    """Tie coordinates of a linkage by further couplings; ValueError as in `check_couplings`.

    A part at a joint that is tied, such as a round gear wheel, no longer counts as one that only spins: it cannot move
    by itself.
    """
    more = several(couplings, "couplings", "couplings", "[jk.gear(...)]")
    every = check_couplings([*linkage.couplings, *more], linkage.joints)
    ties = tuple(tuple(name.rpartition(".")[0] for name in each.coordinates) for each in every)
    found = replace(linkage.structure, coupled=ties)
    made = Linkage.of(linkage.solved_joints, found, every)
    tied = {part for joint in linkage.joints if any(joint.name in tie for tie in ties) for part in joint.parts}
    spinning = tuple(each for each in linkage.spinning if each.name not in tied)
    return replace(linkage, structure=found, couplings=every, classes=made.classes, spinning=spinning)


def counted_from(
    couplings: Sequence[Coupling], joints: Sequence[Joint], values: Mapping[str, Sequence[float] | np.ndarray]
) -> tuple[Coupling, ...]:
    """Count couplings from displacements `values` of the joints, by name, where the assembled pose is to be.

    An offset that rounding leaves is set to zero, so that the new assembled pose counts as obeying the coupling.
    Raises ValueError as `check_couplings`.
    """
    by_name = {joint.name: joint for joint in joints}
    found = []
    for coupling in check_couplings(couplings, joints):
        places = [name.rpartition(".")[::2] for name in coupling.coordinates]
        at = np.array([values[name][by_name[name].coordinates.index(own)] for name, own in places], float)
        shifted = shifted_coupling(coupling, at)
        rounding = OFFSET_ROUNDING * np.abs(shifted.coefficients).max() * max(1.0, np.abs(at).max(initial=0.0))
        found.append(replace(shifted, offset=np.zeros(())) if abs(shifted.offset) <= rounding else shifted)
    return tuple(found)
