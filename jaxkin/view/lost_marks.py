"""Where pictures mark the joints that leave their faces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from jaxkin.mechanism.lost_contacts import LostContact
from jaxkin.view.camera import PartTransforms, move

WARNING = (0.80, 0.07, 0.12)
"""Red of a lost contact: in no colour of the parts (`jaxkin.view.drawing.PALETTE`)."""


@dataclass(frozen=True, eq=False)
class LostMark:
    """One joint that leaves its faces."""

    joint: str
    ends: Float[np.ndarray, "2 poses 3"]
    """World coordinates of the middle of the contact on either part; NaN where the joint has its faces."""

    @property
    def shown(self) -> Bool[np.ndarray, " poses"]:
        """Poses at which it is marked."""
        return np.isfinite(self.ends[0, :, 0])


def lost_marks(lost: Sequence[LostContact], displacements: PartTransforms) -> tuple[LostMark, ...]:
    """Make a mark for each joint that leaves its faces, at the contact whose faces part the farthest."""
    joints = dict.fromkeys(each.joint for each in lost if each.loose.any())
    marks = []
    for joint in joints:
        mine = [each for each in lost if each.joint == joint]
        contact = max(mine, key=lambda each: each.gap).contact
        loose = np.any([each.loose for each in mine], axis=0)
        ends = [np.where(loose[:, None], move(displacements, part, contact.centre), np.nan) for part in contact.parts]
        marks.append(LostMark(joint, np.stack(ends)))
    return tuple(marks)


def told(marks: Sequence[LostMark], pose: int) -> str:
    """Name the joints that have left their faces at a pose, in words; empty if there is none."""
    names = [mark.joint for mark in marks if mark.shown[pose]]
    more = f" and {len(names) - 2} more" if len(names) > 2 else ""
    return f"lost contact: {', '.join(names[:2])}{more}" if names else ""
