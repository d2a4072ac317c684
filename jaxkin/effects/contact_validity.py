"""Check along a motion whether the faces of each contact still touch: the paper's assumption 4.

`motion.lost_contacts` is the cheap warning, from the extents of faces. This check takes its gaps where they tell, and
looks at the triangles of the faces where they do not: at holes, notches, half bores, and in the states that the warning
does not follow.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from jaxkin._arguments import check_known, check_motion
from jaxkin._grouped import MAX_LINES
from jaxkin._guesses import Result
from jaxkin._names import counted
from jaxkin.assembly.kept_contacts import kept_contacts
from jaxkin.contacts.contact import Contact
from jaxkin.contacts.separation import FaceDisplacements, Gaps
from jaxkin.contacts.whole_face import is_whole, share_region
from jaxkin.effects.pose_axis import drive_axis, pose_names
from jaxkin.effects.pose_plot import draw_lines, save_rows
from jaxkin.geometry.part import Face
from jaxkin.geometry.pose import Transform, apply
from jaxkin.geometry.triangle_distance import set_distance
from jaxkin.joints.joint import Joint
from jaxkin.joints.screws import displacements
from jaxkin.mechanism.lost_contacts import FaceSetting, gaps_of, moved_second
from jaxkin.mechanism.motion import Motion


@dataclass(frozen=True, eq=False, repr=False)
class ContactValidity(Result):
    """How far the faces of each contact are apart at each pose. Prints, draws and saves itself."""

    motion: Motion
    """The motion that was looked at."""
    joints: tuple[str, ...]
    """The joint that each contact stands for."""
    contacts: tuple[Contact, ...]
    """The contacts that were checked."""
    gaps: Float[np.ndarray, "contacts poses"]
    """How far the faces are apart, in the unit of the mechanism: 0 where they touch, NaN at poses that are not closed
    (`motion.closed`).
    """
    unit: str
    """Unit of the gaps."""
    unchecked: tuple[str, ...]
    """Joints with freedoms that have no contacts to check: inferred, or by hand between what does not touch."""

    @property
    def lost(self) -> Bool[np.ndarray, "contacts poses"]:
        """Which contacts are lost at which poses; False where the gap is NaN."""
        return self.gaps > 0

    @property
    def holds(self) -> bool:
        """Whether all contacts that were checked last, at all closed poses."""
        return not self.lost.any()

    @property
    def first(self) -> tuple[int, int] | None:
        """The first pose at which a contact is lost, and the index of the contact, that of the widest gap; or None."""
        if self.holds:
            return None
        pose = int(np.argmax(self.lost.any(axis=0)))
        return pose, int(np.argmax(np.nan_to_num(self.gaps[:, pose])))

    def __str__(self) -> str:
        closed = int(np.sum(~np.isnan(self.gaps).any(axis=0))) if len(self.gaps) else 0
        lost, at = np.flatnonzero(self.lost.any(axis=1)).tolist(), pose_names(self.motion)
        lines = [f"{len(self.contacts)} contacts at {closed} closed poses of {self.gaps.shape[1]}: {len(lost)} lost"]
        if self.first is not None:
            pose, number = self.first
            lines.append(f"  first at {at(pose)}: {self._named(number)}, {self._length(self.gaps[number, pose])} apart")
        for number in lost[:MAX_LINES]:
            gaps = np.nan_to_num(self.gaps[number])
            lines.append(
                f"  {self._named(number)}: lost at {counted(np.sum(gaps > 0), 'pose')} from {at(np.argmax(gaps > 0))} "
                f"on, widest {self._length(gaps.max())} at {at(np.argmax(gaps))}"
            )
        if len(lost) > MAX_LINES:
            lines.append(f"  and {len(lost) - MAX_LINES} more: see .gaps")
        if self.unchecked:
            lines.append(f"  without contacts to check: {', '.join(self.unchecked)}")
        return "\n".join(lines)

    def plot(self, path: str | Path, times: Any = None) -> Path:
        """Draw the gaps of the contacts that are lost, over the drive or `times`, into a picture file; returns its
        path."""
        lost = np.flatnonzero(self.lost.any(axis=1)).tolist()
        title = "contacts that are lost" if lost else "no contact is lost"
        label = f"gap between the faces ({self.unit})" if self.unit else "gap between the faces"
        names, rows = [self._named(number) for number in lost], self.gaps[lost]
        if not lost and len(self.gaps):
            names, rows = ["all contacts"], self.gaps.max(axis=0, keepdims=True)
        return draw_lines(names, rows, label, title, Path(path), axis=drive_axis(self.motion, times))

    def save(self, path: str | Path) -> Path:
        """Write the gaps as comma-separated values, a row a pose and a column a contact; returns the path."""
        names = [f"{self._named(number)} [{self.unit or 'length'}]" for number in range(len(self.contacts))]
        return save_rows(names, self.gaps, Path(path))

    def _named(self, number: int) -> str:
        contact = self.contacts[number]
        faces = " - ".join(f"{part} {face}" for part, face in zip(contact.parts, contact.faces, strict=True))
        return f"{self.joints[number]} ({contact.state}) {faces}"

    def _length(self, value: float) -> str:
        return f"{value:.4g} {self.unit}".rstrip()


def contact_validity(motion: Motion) -> ContactValidity:
    """Check at each closed pose of a motion whether the faces of each contact still touch within their extents.

    A contact holds where the region in which its surfaces touch lies on both faces, or on faces of the same bodies that
    continue them. The gap of a lost one is the distance along the surface from the extents of the faces, or, of faces
    with holes or notches, that of their triangles where it is larger. All sixteen contact states are
    checked. Faces end where their triangles do, so that a curved rim is exact to the height of a chord.

    Contacts are those that the joints of a mechanism were read from, or, of joints by hand between solids, as studies
    write them, those that these joints keep, which are looked for then (`kept_contacts`). Raises ValueError where there
    are no solids, or no contacts of them, and inside `jit`, `vmap` and `grad`.
    """
    check_motion(motion, "contacts")
    check_known("contacts that end", "jk.contact_validity", motion)
    mechanism = motion.mechanism
    if not mechanism.solids:
        raise ValueError(
            "contact_validity needs the contacts that joints were read from, or solids to find some, and this "
            "mechanism has none: those of solids, jk.load(files).mechanism(fixed=...), have them"
        )
    known = mechanism.contacts or kept_contacts(mechanism)
    if not known:
        raise ValueError(
            "contact_validity needs contacts, and no two bodies that a joint joins are in contact so that the joint "
            "keeps it"
        )
    setting = FaceSetting(mechanism)
    (closed,) = np.nonzero(np.asarray(motion.closed))
    joints, contacts, rows, unchecked = [], [], [], []
    for joint, values in zip(mechanism.all_joints, motion.displacements, strict=True):
        checked = known.get(joint.name, ()) if joint.freedoms else ()
        if joint.freedoms and not checked:
            unchecked.append(joint.name)
        moved = displacements(joint, np.asarray(values, float)[closed])
        for contact in checked:
            row = np.full(len(motion), np.nan)
            row[closed] = _gaps(joint, contact, moved, setting)
            joints.append(joint.name)
            contacts.append(contact)
            rows.append(row)
    gaps = np.stack(rows) if rows else np.zeros((0, len(motion)))
    return ContactValidity(motion, tuple(joints), tuple(contacts), gaps, mechanism.unit, tuple(unchecked))


def _gaps(joint: Joint, contact: Contact, moved: FaceDisplacements, setting: FaceSetting) -> Gaps:
    """Measure the gaps of one contact over the displacements of part 2 of its joint."""
    cheap = gaps_of(joint, contact, moved, setting)
    gaps = np.where(cheap > setting.length, cheap, 0.0)
    relative = moved_second(joint, contact, moved, setting)
    faces = setting.continued(contact)
    if relative is None or (np.all(np.isfinite(cheap)) and all(map(is_whole, faces[0]))):
        return gaps  # the faces cannot part, or their extents say all
    for pose in range(len(gaps)):
        displacement = np.vstack([relative[:, :, pose], [0.0, 0.0, 0.0, 1.0]])
        # where extents are apart the faces are, by as much at least
        if gaps[pose] > 0 or not any(
            share_region(contact.contact_state, *pair, displacement, setting.length) for pair in faces
        ):
            gaps[pose] = max(gaps[pose], _apart(faces, displacement, setting.length))
    return gaps


def _apart(faces: Sequence[tuple[Face, Face]], displacement: Transform, length: float) -> float:
    """Measure the least distance of the triangles of pairs of faces; at least what counts as not touching."""
    return max(length, min(set_distance(one.triangles, apply(displacement, two.triangles)) for one, two in faces))
