"""What stands in the world of the exports of CAD systems."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

from jaxkin._names import listed
from jaxkin.io.export_constraints import PARALLEL_MATES, ConstrainedParts, Paths, joints_between, mates_between
from jaxkin.io.export_content import Export
from jaxkin.joints.combine import Chain, subgroup_joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.regularise import Noise

WORLD = ""
"""The assembly itself, as a part: no part has this name."""


def fixed_parts(export: Export, first: Paths, metres: float, size: float, notes: list[str]) -> tuple[str, ...]:
    """Find the parts that stand in the world: those that are fixed in it, or else those that joints and mates hold.

    Where the file has neither, and what is fixed in assemblies is all in one of these, that one is the frame, and a
    note says so. `size` is that of the assembly, in the unit of its solids.
    """
    fixed = [first[part.path] for part in export.parts if part.fixed_in == ()] or _held(export, first, metres, size)
    if fixed:
        return tuple(dict.fromkeys(fixed))  # instances with one identifier are one body
    inside = [part for part in export.parts if part.fixed_in is not None]
    if not inside:
        return ()
    frames = listed(sorted({part.names[0] for part in inside}))
    if len({part.path[0] for part in inside}) > 1:
        notes.append(f"nothing is fixed in the assembly itself, only in {frames}, which may move")
        return ()
    notes.append(f"nothing is fixed in the assembly itself; what is fixed in {frames} is taken to be")
    return tuple(dict.fromkeys(first[part.path] for part in inside))


def _held(export: Export, first: Paths, metres: float, size: float) -> list[str]:
    """List the parts that their joints and mates with the assembly itself leave no freedom."""
    where = ConstrainedParts(export, first, WORLD)
    joints = [each for each in export.joints if any(not side.path for side in each.sides)]
    mates = [each for each in export.mates if any(not side.path for side in each.sides)]
    chains: dict[str, list[Chain]] = defaultdict(list)
    for each in [*joints_between(joints, where, metres, []), *mates_between(mates, where, metres, size, [])]:
        (part,) = {*each.parts} - {WORLD}
        chains[part].append(each.chain)
    noise = Noise(PARALLEL_MATES, PARALLEL_MATES * size)
    return [part for part, several in chains.items() if _leave_nothing(several, noise)]


def _leave_nothing(chains: Sequence[Chain], noise: Noise) -> bool:
    together = subgroup_joint(chains, noise)
    return together is not None and together.kind is JointKind.FIXED
