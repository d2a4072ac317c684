"""What is open in a study: other parts to fix, other coordinates to drive, joints to turn off, parts to leave out."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import islice
from typing import TYPE_CHECKING

import numpy as np

from jaxkin._grouped import products
from jaxkin._names import counted, match_parts
from jaxkin.assembly.assembly import Assembly
from jaxkin.geometry.part import Part
from jaxkin.io.study_bodies import BodyChoices
from jaxkin.io.study_drives import can_drive, small_ranges, useful_coordinates
from jaxkin.io.toml_text import toml
from jaxkin.joints.evidence import Doubt, EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.pairs import JOINTS_BY_HAND, fixed
from jaxkin.mobility.doubts import doubts
from jaxkin.mobility.open_loops import left_open

if TYPE_CHECKING:
    from jaxkin.assembly.proposals import Proposal
    from jaxkin.mechanism.mechanism import Mechanism

_DRIVES = 12
"""Other drives that are listed at most: each is one more line of the same mechanism."""
_SAID = (EvidenceKind.USER, EvidenceKind.EXPORT)
"""Joints that somebody said; all others were found in solids, exact contacts too, and may be wrong: faces that touch in
the modelled pose need not guide each other."""


@dataclass(frozen=True)
class Choices:
    """Lines that may be uncommented, each for itself."""

    instead: tuple[str, ...] = ()
    exclude: tuple[str, ...] = ()
    off: Mapping[str, str] = field(default_factory=dict)
    """By joint."""
    doubts: Mapping[str, str] = field(default_factory=dict)
    """By joint: what to write in place of its kind, why, and what that gives."""


NONE = Choices()


def find_choices(
    mechanism: Mechanism, bodies: BodyChoices, drive: Mapping[str, str] | None, proposals: Sequence[Proposal]
) -> Choices:
    """Try what the study of a mechanism leaves open, on the joints that it holds; what could not be swept is left out.

    `drive` is the drive of the study, `proposals` are other parts to fix.
    """
    tried = _Tried(mechanism, bodies)
    driven = tuple(drive or ())
    instead = [*_other_fixed(tried, proposals), *islice(_other_drives(mechanism, driven), _DRIVES)]
    off = {joint.name: _off(tried, joint, driven) for joint in tried.joints if _is_found(joint)}
    other = {joint.name: _doubt(tried, joint, doubt, driven) for joint, doubt in doubts(mechanism.linkage)}
    return Choices(tuple(instead), tuple(_needless(mechanism, bodies)), off, other)


class _Tried:
    """The mechanisms of a study with other fixed parts, or without one of its joints."""

    def __init__(self, mechanism: Mechanism, bodies: BodyChoices) -> None:
        self.joints = [joint for joint in mechanism.all_joints if joint.freedoms]
        self.fixed = bodies.fixed
        self._assembly = Assembly(mechanism.solids, mechanism.unit, "the study")
        self._rigid = [parts for parts, _ in bodies.groups]

    def with_fixed(self, fixed: Sequence[str]) -> Mechanism:
        return self._assembly.of_joints(fixed=fixed, rigid=self._rigid, joints=self.joints)

    def without(self, joint: Joint, *instead: Joint) -> Mechanism:
        others = [*(each for each in self.joints if each is not joint), *instead]
        return self._assembly.of_joints(fixed=self.fixed, rigid=self._rigid, joints=others)


def _other_fixed(tried: _Tried, proposals: Sequence[Proposal]) -> list[str]:
    lines = []
    for each in proposals:
        if set(each.fixed) == set(tried.fixed) or each.ignore:  # the joints of a study are written out
            continue
        mechanism = tried.with_fixed(each.fixed)
        driven = mechanism.mobility().drivable if left_open(mechanism.linkage) is None else ()
        if driven and can_drive(mechanism, driven):
            choice = {"fixed": each.fixed, "drive": small_ranges(mechanism, driven)}
            lines.append(f"# instead = {toml(choice)}  # {_told(mechanism)}")
    return lines


def _other_drives(mechanism: Mechanism, driven: Sequence[str]) -> Iterator[str]:
    """Find coordinates that can take the place of one of those that drive."""
    for name in useful_coordinates(mechanism) if driven else ():
        places = [tuple(name if each == one else each for each in driven) for one in driven if name not in driven]
        if found := next((place for place in places if can_drive(mechanism, place)), None):
            yield f"# instead = {toml({'drive': small_ranges(mechanism, found)})}"


def _off(tried: _Tried, joint: Joint, driven: Sequence[str]) -> str:
    """Write the line that turns a joint off, or why there is none."""
    if any(name.rpartition(".")[0] == joint.name for name in driven):
        return "# (It is driven: choose another drive before you turn it off.)"
    mechanism = tried.without(joint)
    if driven and not can_drive(mechanism, driven):
        return "# (Without it what is driven could not move.)"
    return f"# off = true  # without it: {_told(mechanism)}"


def _doubt(tried: _Tried, joint: Joint, doubt: Doubt, driven: Sequence[str]) -> str:
    """Write the other reading of a joint as the end of the line of its kind, with what it gives."""
    if one_body := doubt.kind is JointKind.FIXED:
        other = fixed(joint.name, *joint.parts)
    else:
        pose = np.asarray(joint.frames_1, float)[0]
        other = JOINTS_BY_HAND[doubt.kind](joint.name, *joint.parts, point=pose[:3, 3], axis=pose[:3, 2])
    mechanism = tried.without(joint, other)
    sweeps = "" if not driven or can_drive(mechanism, driven) else ", which need another drive"
    instead = f"{toml(joint.parts)} in rigid" if one_body else f'"{doubt.kind}"'
    return f"or {instead}, since {doubt.why}: it has {_told(mechanism)} then{sweeps}"


def _needless(mechanism: Mechanism, bodies: BodyChoices) -> list[str]:
    """Find parts that only one group holds, and that no joint needs, by their products: screws, and what touches
    nothing."""
    held = Counter(part for parts, _ in bodies.groups for part in parts)
    jointed = {part for joint in mechanism.all_joints if joint.freedoms for part in joint.parts}
    evidence = {part: each for parts, each in reversed(bodies.groups) for part in parts}
    product = products(mechanism.parts)
    found: dict[tuple[str, str], list[Part]] = {}
    for part in mechanism.solids:
        if held[part.name] == 1 and part.name not in jointed and part.name not in bodies.fixed:
            known = evidence[part.name]
            found.setdefault((product[part.name], str(known.kind) if known else "rigid"), []).append(part)
    return [_exclude(name, kind, parts, mechanism.solids) for (name, kind), parts in found.items()]


def _exclude(name: str, kind: str, parts: Sequence[Part], solids: Sequence[Part]) -> str:
    """Write one line for the parts of one product: their pattern where it stands for them alone, otherwise their
    names."""
    names = [part.name for part in parts]
    pattern = f"{name}*"
    across = max(part.extent for part in parts)
    shown = toml(pattern) if len(names) > 1 and _means(pattern, solids, names) else ", ".join(map(toml, names))
    return f"  # {shown},  # {len(names)} {'part' if len(names) == 1 else 'parts'}, {across:.3g} across: {kind}"


def _means(pattern: str, solids: Sequence[Part], names: Sequence[str]) -> bool:
    try:
        return set(match_parts(pattern, solids)) == set(names)
    except ValueError:
        return False


def _is_found(joint: Joint) -> bool:
    return joint.evidence is not None and joint.evidence.kind not in _SAID


def _told(mechanism: Mechanism) -> str:
    """Tell what a choice makes of the mechanism."""
    if left_open(mechanism.linkage) is not None:
        return "loops that cannot be closed"
    found = mechanism.mobility()
    count = "one freedom" if found.useful == 1 else f"{found.useful} freedoms"
    return f"{count} of use in {counted(len(mechanism.bodies), 'body')}"
