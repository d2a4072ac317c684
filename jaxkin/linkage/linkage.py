"""The linkage: joints, structure and loop classes, which is all that computing the motion of a mechanism needs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import jax

from jaxkin.joints.joint import Joint
from jaxkin.linkage.loop_class import LoopClass, loop_classes
from jaxkin.topology.structure import Structure


class SpinningPart(NamedTuple):
    """A part that only spins, such as a screw or a washer."""

    name: str
    freedoms: int
    """How many freedoms are the part's alone."""


@dataclass(frozen=True, eq=False)
class Linkage:
    """Bodies held together by joints, in their assembled pose.

    A pytree: its leaves are the frames and pitches of the joints, float arrays all; everything else is static, and
    stays what it is where JAX takes a linkage apart and puts it together with other numbers. So a new geometry of the
    same structure compiles nothing anew, and a gradient is a tree of the same structure.
    """

    joints: tuple[Joint, ...]
    """As they were given; in the order of the columns of the incidence matrix."""
    structure: Structure
    classes: tuple[LoopClass, ...]
    """What is special about the loops of each loop group of `structure`, as the numbers of the joints had it when the
    linkage was made: loops that leave their class later are not closed, which their poses' status says."""
    ideal: tuple[Joint, ...] = ()
    """The nearest joints whose loops close throughout their motion, where those of `joints`, which disagree by more
    than rounding, close at the assembled pose only; none where they do. Poses are found with these, and then brought to
    the least residual of the joints that were given. See `jaxkin.mobility.alignment`."""
    spinning: tuple[SpinningPart, ...] = ()
    """Parts that only spin, as their solids tell."""

    @staticmethod
    def of(joints: Sequence[Joint], structure: Structure) -> Linkage:
        """The linkage of some joints, its loop classes found from their numbers; general ones where JAX traces these,
        or where they are of many mechanisms."""
        classes = loop_classes(joints, structure) or (LoopClass(),) * len(structure.loop_groups)
        return Linkage(tuple(joints), structure, classes)

    def with_joints(self, joints: Sequence[Joint], ideal: Sequence[Joint] = ()) -> Linkage:
        """The linkage with other joints in the same structure; while JAX traces these the loop classes stay."""
        classes = loop_classes(ideal or joints, self.structure) or self.classes
        return replace(self, joints=tuple(joints), ideal=tuple(ideal), classes=classes)

    @property
    def solved_joints(self) -> tuple[Joint, ...]:
        """The joints whose loops are solved: those given, or `ideal` where these cannot move."""
        return self.ideal or self.joints

    @property
    def parts(self) -> tuple[str, ...]:
        """Names of all parts, the fixed ones too."""
        return self.structure.part_names

    @property
    def fixed(self) -> tuple[str, ...]:
        """Names of the parts that do not move."""
        return self.structure.fixed


jax.tree_util.register_dataclass(
    Linkage, data_fields=["joints", "ideal"], meta_fields=["structure", "classes", "spinning"]
)
