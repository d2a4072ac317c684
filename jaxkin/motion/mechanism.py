"""The mechanism: joints and structure. The one representation that everything else works on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import jax

from jaxkin.contacts.contact import Contact
from jaxkin.geometry.part import Part
from jaxkin.joints.joint import Joint
from jaxkin.topology.structure import Structure, structure

if TYPE_CHECKING:
    from jaxkin.motion.mobility import Mobility
    from jaxkin.motion.motion import Motion


@dataclass(frozen=True, eq=False)
class Mechanism:
    """Parts held together by joints, in their assembled pose.

    A pytree: its leaves are the frames and pitches of the joints, float arrays all; names and structure are static. A
    new geometry of the same structure compiles nothing anew. Solids, notes and contacts are for pictures and tables
    only: they are left behind where JAX takes a mechanism apart (`jit`, `grad`, `vmap`).
    """

    all_joints: tuple[Joint, ...]
    structure: Structure
    unit: str = ""
    """Unit of all lengths, such as "mm"; empty where it was not said."""
    solids: tuple[Part, ...] = field(default=())
    notes: tuple[str, ...] = field(default=())
    """What was found, combined or refused on the way from solids to joints, in words."""
    contacts: Mapping[str, tuple[Contact, ...]] = field(default_factory=dict)
    """The contacts that a joint stands for, by its name; none for joints by hand."""

    @staticmethod
    def build(*, fixed: Sequence[str], joints: Sequence[Joint], unit: str = "") -> Mechanism:
        """A mechanism from joints written by hand, in world coordinates of its assembled pose.

        Raises ValueError where names repeat, a fixed part is in no joint, or a part hangs on nothing.
        """
        parts = list(dict.fromkeys(part for joint in joints for part in joint.parts))
        described = [(joint.name, *joint.parts) for joint in joints]
        return Mechanism(tuple(joints), structure(parts, described, fixed), unit)

    @property
    def parts(self) -> tuple[str, ...]:
        """Names of all parts, the fixed ones too."""
        return self.structure.part_names

    @property
    def fixed(self) -> tuple[str, ...]:
        """Names of the parts that do not move."""
        return self.structure.fixed

    @cached_property
    def joints(self) -> Mapping[str, Joint]:
        """Joints by name."""
        return {joint.name: joint for joint in self.all_joints}

    def joints_between(self, part1: str, part2: str) -> tuple[str, ...]:
        """Names of the joints between two parts, in whichever order."""
        return tuple(joint.name for joint in self.all_joints if set(joint.parts) == {part1, part2})

    def sweep(self, drive: Mapping[str, object]) -> Motion:
        """The motion for given displacements of some joints: see `jaxkin.motion.sweep.sweep`."""
        from jaxkin.motion.sweep import sweep

        return sweep(self, drive)

    def mobility(self) -> Mobility:
        """Freedoms, idle freedoms and redundant constraints at the assembled pose."""
        from jaxkin.motion.mobility import mobility

        return mobility(self)

    def __str__(self) -> str:
        from jaxkin.motion.describe import describe_mechanism

        return describe_mechanism(self)


# by hand, since `drop_fields` of `register_dataclass` works from jax 0.10 on only
jax.tree_util.register_pytree_node(
    Mechanism,
    lambda mechanism: ((mechanism.all_joints,), (mechanism.structure, mechanism.unit)),
    lambda static, leaves: Mechanism(*leaves, *static),
)
