"""Lost contacts in words: which joint leaves its faces, at which input, how far, and what is left of it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from jaxtyping import Array

from jaxkin.contacts.contact import Contact
from jaxkin.geometry.motions import is_length
from jaxkin.motion.lost_contacts import LostContact
from jaxkin.motion.mechanism import Mechanism

LISTED = 8
"""Joints that a report names at most: more are a sign of one cause."""
FACES = 3
"""Contacts of a joint that a report names at most."""


def lost_contact_report(
    lost: Sequence[LostContact], mechanism: Mechanism, inputs: Mapping[str, np.ndarray | Array]
) -> list[str]:
    """Lines on the joints that leave their faces; one line on contacts that are lost where their joints still hold."""
    loose: dict[str, list[LostContact]] = defaultdict(list)
    for each in lost:
        if each.loose.any():
            loose[each.joint].append(each)
    lines = []
    for name, contacts in list(loose.items())[:LISTED]:
        lines += _of_joint(name, contacts, mechanism, inputs)
    if len(loose) > LISTED:
        lines.append(f"lost contact: {len(loose) - LISTED} more joints leave their faces: see motion.lost_contacts")
    if spare := [each for each in lost if not each.loose.any()]:
        faces = _listed(f"{_faces(each.contact)}, up to {_length(each.gap, mechanism.unit)} apart" for each in spare)
        lines.append(f"left where other contacts of the same joint still hold it: {faces}")
    return lines


def _of_joint(
    name: str, contacts: Sequence[LostContact], mechanism: Mechanism, inputs: Mapping[str, np.ndarray | Array]
) -> list[str]:
    """What becomes of a joint that leaves its faces."""
    loose = np.any([each.loose for each in contacts], axis=0)
    first, unit = int(np.argmax(loose)), mechanism.unit
    kind = mechanism.joints[name].kind
    gaps = np.max([np.where(loose, each.gaps, 0.0) for each in contacts], axis=0)
    worst = int(np.argmax(gaps))
    left = next(each.left for each in contacts if each.loose[first])
    holds = f"what still touches makes it {left}, not {kind}" if left else "nothing else makes it the joint that it is"
    return [
        f"lost contact: joint {name!r} leaves its faces at {loose.sum()} of {len(loose)} poses, first at pose "
        f"{first} ({_at(inputs, first, unit)}), farthest at pose {worst} ({_at(inputs, worst, unit)}):",
        f"  {_listed(f'{_faces(each.contact)} {_length(each.gap, unit)} apart' for each in contacts)}; {holds}",
    ]


def _at(inputs: Mapping[str, np.ndarray | Array], pose: int, unit: str) -> str:
    """The inputs at a pose, in degrees and in the unit of the mechanism; of many the first ones."""
    return _listed(
        f"{name} = {_length(float(values[pose]), unit)}"
        if is_length(name.rpartition(".")[2])
        else f"{name} = {np.rad2deg(float(values[pose])):.4g} deg"
        for name, values in inputs.items()
    )


def _faces(contact: Contact) -> str:
    sides = (f"{part} {face}" for part, face in zip(contact.parts, contact.faces, strict=True))
    return f"({contact.state}) {' and '.join(sides)}"


def _length(value: float, unit: str) -> str:
    return f"{value:.4g} {unit}".rstrip()


def _listed(texts: Iterable[str]) -> str:
    texts = list(texts)
    more = f" and {len(texts) - FACES} more" if len(texts) > FACES else ""
    return ", ".join(texts[:FACES]) + more
