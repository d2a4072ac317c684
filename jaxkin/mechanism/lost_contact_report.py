"""Lost contacts in words: which joint leaves its faces, at which input, how far, and what is left of it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Array

from jaxkin._runs import runs
from jaxkin.geometry.movements import is_length
from jaxkin.mechanism.lost_contacts import LostContact

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

MAX_REPORTED_JOINTS = 8
"""Joints that a report names at most: more are a sign of one cause."""
MAX_REPORTED_PER_JOINT = 3
"""Contacts, inputs and ranges of poses of one joint that a report names at most."""


def lost_contact_report(
    lost: Sequence[LostContact], mechanism: Mechanism, inputs: Mapping[str, np.ndarray | Array]
) -> list[str]:
    """Write lines on the joints that leave their faces; one line on contacts that are lost where their joints still
    hold."""
    loose: dict[str, list[LostContact]] = defaultdict(list)
    for each in lost:
        if each.loose.any():
            loose[each.joint].append(each)
    lines = []
    for name, contacts in list(loose.items())[:MAX_REPORTED_JOINTS]:
        lines += _of_joint(name, contacts, mechanism, inputs)
    if len(loose) > MAX_REPORTED_JOINTS:
        lines.append(
            f"lost contact: {len(loose) - MAX_REPORTED_JOINTS} more joints leave their faces: see motion.lost_contacts"
        )
    if spare := [each for each in lost if not each.loose.any()]:
        faces = _listed([_apart(each, mechanism.unit) for each in spare], ", ")
        lines.append(f"lost where other contacts of the same joint still make it what it is: {faces}")
    return lines


def _of_joint(
    name: str, contacts: Sequence[LostContact], mechanism: Mechanism, inputs: Mapping[str, np.ndarray | Array]
) -> list[str]:
    """Tell of a joint that leaves its faces: at which inputs, which faces, and what still holds the parts."""
    loose = np.any([each.loose for each in contacts], axis=0)
    farthest = max(contacts, key=lambda each: each.gap)
    unit, kind, left = mechanism.unit, mechanism.joints[name].kind, farthest.left
    return [
        f"lost contact: joint {name!r} leaves its faces at {loose.sum()} of {len(loose)} poses: "
        + _listed([_run(inputs, first, end - 1, unit) for first, end in runs(loose).tolist()], "; "),
        "  "
        + _listed([_apart(each, unit) for each in contacts], ", ")
        + (f"; what still touches makes it {left}, not {kind}" if left else "; nothing else holds it there"),
    ]


def _run(inputs: Mapping[str, np.ndarray | Array], first: int, last: int, unit: str) -> str:
    """Name consecutive poses, with the inputs at both ends, in degrees and in the unit of the mechanism."""
    said = []
    for name, values in inputs.items():
        is_angle = not is_length(name.rpartition(".")[2])
        scale, suffix = (180 / np.pi, " deg") if is_angle else (1.0, f" {unit}".rstrip())
        ends = dict.fromkeys(f"{scale * float(values[pose]):.4g}" for pose in (first, last))
        said.append(f"{name} = {' to '.join(ends)}{suffix}")
    poses = f"pose {first}" if first == last else f"poses {first} to {last}"
    return f"{poses} ({_listed(said, ', ')})"


def _apart(lost: LostContact, unit: str) -> str:
    """Name the faces of a contact, and how far they are apart at most."""
    contact = lost.contact
    faces = " and ".join(f"{part} {face}" for part, face in zip(contact.parts, contact.faces, strict=True))
    return f"({contact.state}) {faces} up to {lost.gap:.4g} {unit}".rstrip() + " apart"


def _listed(texts: Sequence[str], comma: str) -> str:
    more = f" and {len(texts) - MAX_REPORTED_PER_JOINT} more" if len(texts) > MAX_REPORTED_PER_JOINT else ""
    return comma.join(texts[:MAX_REPORTED_PER_JOINT]) + more
