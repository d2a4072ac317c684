"""The linkage: joints, structure and loop classes, which is all that computing the motion of a mechanism needs."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import jax

from jaxkin.joints.coupling import Coupling
from jaxkin.joints.joint import Joint
from jaxkin.linkage.loop_class import LoopClass, loop_classes
from jaxkin.linkage.planes import normal_of_turns
from jaxkin.topology.structure import Structure


class SpinningPart(NamedTuple):
    """A part that only spins, such as a screw or a washer."""

    name: str
    freedoms: int
    """Number of freedoms in which only this part moves."""


@dataclass(frozen=True, eq=False)
class Linkage:
    """Bodies held together by joints, in their assembled pose.

    A linkage is a pytree: its leaves are the frames and pitches of the joints and the numbers of the couplings, all of
    them float arrays. All else is static, and is kept when JAX flattens a linkage and rebuilds it with other numbers.
    So a new geometry of the same structure compiles nothing anew, and a gradient is a tree of the same structure.
    """

    joints: tuple[Joint, ...]
    """The joints as they were given, in the order of the columns of the incidence matrix."""
    structure: Structure
    classes: tuple[LoopClass, ...]
    """The class of each loop group of `structure`, found from the numbers of the joints when the linkage was made.
    Loops that leave their class later do not close, and the statuses of their poses say so."""
    ideal: tuple[Joint, ...] = ()
    """The nearest joints whose loops close along a motion, if the loops of `joints` close in the assembled pose only
    because the joints disagree by more than rounding; else empty. Poses are found with the joints in `ideal`, and then
    brought to the least residual of those in `joints`. See `jaxkin.mobility.alignment`."""
    spinning: tuple[SpinningPart, ...] = ()
    """Parts that only spin, found from the shapes of their solids."""
    couplings: tuple[Coupling, ...] = ()
    """Relations between coordinates of the joints, in the order of `Structure.coupled`."""

    @staticmethod
    def of(joints: Sequence[Joint], structure: Structure, couplings: Sequence[Coupling] = ()) -> Linkage:
        """Make a linkage of joints, with its loop classes found from the numbers of these.

        The classes are general (six equations a loop) where JAX traces the joints, and where their arrays hold many
        mechanisms.
        """
        classes = loop_classes(joints, structure) or (LoopClass(),) * len(structure.loop_groups)
        return Linkage(tuple(joints), structure, classes, couplings=tuple(couplings))

    def with_joints(self, joints: Sequence[Joint], ideal: Sequence[Joint] = ()) -> Linkage:
        """Replace the joints in the same structure, and find loop classes anew; traced joints keep the classes."""
        classes = loop_classes(ideal or joints, self.structure) or self.classes
        return replace(self, joints=tuple(joints), ideal=tuple(ideal), classes=classes)

    @cached_property
    def in_space(self) -> Linkage:
        """The same linkage, its loops with a `LoopClass.decoupled_plane` solved in space.

        It is for numbers that JAX traces, and for poses that may leave that plane.
        """
        if all(each.decoupled_plane is None for each in self.classes):
            return self
        return replace(self, classes=tuple(each._replace(decoupled_plane=None) for each in self.classes))

    @cached_property
    def whole(self) -> Linkage:
        """The linkage `in_space`, none of its loops cut at a ball: for poses in which rods between balls have spun."""
        classes = (each._replace(spins=(), cut_at_balls=False) for each in self.in_space.classes)
        return replace(self, classes=tuple(classes))

    def normal(self, joints: Collection[int], *, decoupled: bool = False) -> Any:
        """Return the normal (3,) of the plane in which the loops of some joints move, in the assembled pose.

        None where no loop group holds them all, or where it has no plane. Planes that joints could leave count where
        they are `decoupled`. It is traced where the frames are.
        """
        for loop_group, found in zip(self.structure.loop_groups, self.classes, strict=True):
            columns = found.decoupled_plane if decoupled and found.plane is None else found.plane
            if columns is not None and set(joints) <= set(loop_group.joints):
                return normal_of_turns([self.solved_joints[number] for number in loop_group.joints], columns)
        return None

    @property
    def solved_joints(self) -> tuple[Joint, ...]:
        """The joints whose loops are solved: `ideal` if there are such, else `joints`."""
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
    Linkage, data_fields=["joints", "ideal", "couplings"], meta_fields=["structure", "classes", "spinning"]
)
