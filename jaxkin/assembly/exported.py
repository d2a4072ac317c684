"""What a file says of an assembly beside its solids: which parts are held, bodies, joints, mates, motors, couplings.

The exports of CAD systems, the files of robots and FreeCAD's documents say it; all become a mechanism in one way,
`jaxkin.assembly.from_export`.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace

from jaxkin.joints.combine import Chain
from jaxkin.joints.coupling import Coupling
from jaxkin.joints.joint import JointLimits
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.screws import freedoms


@dataclass(frozen=True, eq=False)
class Constraint:
    """A joint or a mate between two parts."""

    name: str
    parts: tuple[str, str]
    """Part 1 and part 2; displacements are those of part 2 relative to part 1."""
    text: str
    """What the file calls it, such as "Revolute 'hinge'"."""
    chain: Chain
    """The displacements that it allows; a weld allows none."""
    kind: JointKind
    """The kind of joint that it is by itself."""
    offset: float = 0.0
    """Distance between the two places that the export gives for its axis or centre, in the unit of the assembly."""
    tilt: float = 0.0
    """Angle between its two axes, radians."""
    limits: JointLimits = ()
    """Limits of its coordinates, counted from the assembled pose: see `jaxkin.joints.joint.JointLimits`."""
    pitch: float = 0.0
    """Advance per turn of a screw, in the unit of the assembly."""
    values: tuple[float, ...] = ()
    """What the file itself calls the displacements of its coordinates at the assembled pose, radians or lengths; empty
    where these are zero."""


@dataclass(frozen=True, eq=False)
class Exported:
    """What the export of a CAD system, or the file of a robot, says."""

    fixed: tuple[str, ...]
    """Parts that the file holds at rest."""
    rigid: tuple[tuple[str, ...], ...]
    """Groups of parts that do not move against each other."""
    constraints: tuple[Constraint, ...]
    notes: tuple[str, ...]
    """What is in the export and was not understood, a line each."""
    motors: tuple[str, ...] = ()
    """Names of the constraints that the file says are actuated, or "name.coordinate" of one of several."""
    couplings: tuple[Coupling, ...] = ()
    """Between coordinates of the constraints, by name; counted from where the file calls them zero."""
    accuracy: float = 0.0
    """Angle by which directions of the file deviate from what is meant, radians, and lengths over the size of the
    assembly, where that is more than nine digits have: by rounding, and by how mates are solved."""
    marks_rigid: bool = False
    """Whether the file says which sub-assemblies are rigid, so that the others are not."""
    system: str = "CAD system"
    """What the file is from, for messages: "CAD system", "robot file"."""

    @property
    def joint_values(self) -> dict[str, tuple[float, ...]]:
        """What the file calls the displacements of each joint at the assembled pose; displacements count from there."""
        return {each.name: each.values or (0.0,) * freedoms(each.chain.movements) for each in self.constraints}

    def renamed(self, names: Mapping[str, str]) -> Exported:
        """Make the export with other names for some parts."""

        def new(parts: tuple[str, ...]) -> tuple[str, ...]:
            return tuple(names.get(part, part) for part in parts)

        constraints = tuple(
            replace(each, parts=(names.get(each.parts[0], each.parts[0]), names.get(each.parts[1], each.parts[1])))
            for each in self.constraints
        )
        rigid = tuple(map(new, self.rigid))
        return replace(self, fixed=new(self.fixed), rigid=rigid, constraints=constraints)

    def without(self, parts: Collection[str]) -> Exported:
        """Make the export without some parts, and without what it says of them."""

        def left(group: tuple[str, ...]) -> tuple[str, ...]:
            return tuple(part for part in group if part not in parts)

        constraints = tuple(each for each in self.constraints if not {*each.parts} & {*parts})
        groups = tuple(group for group in map(left, self.rigid) if len(group) > 1)
        return replace(self, fixed=left(self.fixed), rigid=groups, constraints=constraints)
