"""The report of `jaxkin inspect --page`: an assembly in 3D, its bodies, joints and assumptions to click on."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Float

from jaxkin._files import whole
from jaxkin._grouped import first_of_each, kind_of
from jaxkin._names import counted
from jaxkin.assembly.assembly import Assembly
from jaxkin.assembly.inference.inference import INFERRED
from jaxkin.contacts.contact import Contacts
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.part import Part, box_corners
from jaxkin.geometry.units import unit_name
from jaxkin.joints.evidence import EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.view.camera import View
from jaxkin.view.drawing import body_colors, body_label, drawn_solids
from jaxkin.view.glass import PITCH, oblique_view
from jaxkin.view.viewer import encoded, part_entries, rounded, write_page

BEYOND = (0.01, 0.1)
"""How far the axis of a joint stands out at either end: as far as both of its parts reach along it, but no less and no
more than this, over half the size of the assembly."""
AXIS = (0.86, 0.08, 0.24)
"""Axes of joints: a red that no body has."""
TRIED = "Tried to be fixed"
"""The heading of what could be fixed."""
WIDTH, THROUGH = 3, 0.75
"""Pixels of an axis, of which the edges of parts have one, and how much of it is seen where parts hide it."""


def inspection_page(
    found: Mechanism | Assembly,
    path: Path | str,
    *,
    source: str,
    missing: Sequence[str] = (),
    tried: Sequence[str] = (),
    contacts: Contacts | None = None,
) -> None:
    """Write a page with an assembly in 3D, where each body, joint and assumption can be clicked on and seen.

    `found` is the mechanism, or the assembly where there is none yet; `source` is what it was read from, and `missing`
    are paragraphs about what it needs to move. `tried` tells what could be fixed, a line a choice. Without a mechanism
    `contacts` are listed in place of joints. A link to a joint, part, body or note has its name or number after "#", as
    in `report.html#joint=crank-rod`.

    The page works from a file, without a network. It appears whole or not at all.
    """
    with whole(Path(path)) as draft:
        scene = _scene(found, source)
        notes = _notes(found, {part["name"]: number for number, part in enumerate(scene["parts"])}, tried, contacts)
        write_page(draft, "inspection", scene | {"missing": list(missing), "notes": notes})


def _scene(found: Mechanism | Assembly, source: str) -> dict:
    """Write what `inspection.js` reads, beside what the viewer does. Lengths are over `scale` about `centre`."""
    mechanism = found if isinstance(found, Mechanism) else None
    solids = found.parts if isinstance(found, Assembly) else drawn_solids(found)
    fixed = mechanism.fixed if mechanism else ()
    bodies = mechanism.bodies if mechanism else {part.name: (part.name,) for part in solids}
    corners = np.concatenate([part.box for part in solids])
    low, high = corners.min(axis=0), corners.max(axis=0)
    centre, scale = (low + high) / 2, float(np.linalg.norm(high - low) / 2) or 1.0
    colors = body_colors(bodies, fixed)
    entries = part_entries(solids, [*bodies.values()], colors, centre, scale)
    index = {part.name: number for number, part in enumerate(solids)}
    joints = sorted(mechanism.all_joints if mechanism else (), key=lambda joint: not joint.freedoms)
    boxes = {part.name: (part.box - centre) / scale for part in solids}
    axes = [(joint, _axis(joint, boxes, centre, scale)) for joint in joints if joint.freedoms]
    facts = [counted(len(solids), "part")]
    facts += [counted(len(bodies), "body"), f"joints that move: {len(axes)}"] if mechanism else []
    upright = _turntable(oblique_view(solids, fixed))
    return {
        "title": source,
        "subtitle": "  ·  ".join([*facts, f"lengths in {unit_name(found.unit) or 'no known unit'}"]),
        "labels": [""],
        "problems": [""],
        "lost": [""],
        "centre": centre.tolist(),
        "scale": scale,
        "axes": upright.tolist(),
        "corners": (box_corners(_bounds(solids, upright, centre) / scale) @ upright).tolist(),
        "yaw": 0.0,
        "pitch": PITCH,
        "bodies": [
            {
                "name": body_label(parts, solids),
                "fixed": parts[0] in fixed,
                "color": rounded(colors[name]),
                "poses": "",
                "parts": [index[part] for part in parts if part in index],
            }
            for name, parts in bodies.items()
        ],
        "parts": [entry | _told(part, found.unit) for entry, part in zip(entries, solids, strict=True)],
        "paths": [
            {"color": list(AXIS), "width": WIDTH, "through": THROUGH, "points": encoded(points)} for _, points in axes
        ],
        "marks": [],
        "joints": [_joint(joint, mechanism, index) for joint in joints if mechanism],
    }


def _bounds(
    solids: Sequence[Part], upright: Float[np.ndarray, "3 3"], centre: Float[np.ndarray, "3"]
) -> Float[np.ndarray, "2 3"]:
    """Find the box about a centre, along the rows of `upright`, that the parts fill: a box along the axes of the world
    is much larger where nothing in it lies along these."""
    places = np.concatenate([part.triangles.reshape(-1, 3) for part in solids]) - centre
    along = places @ upright.T
    return np.stack([along.min(axis=0), along.max(axis=0)])


def _turntable(oblique: View) -> Float[np.ndarray, "3 3"]:
    """Find the turntable that an oblique view looks down on, as it does on most flat faces; its rows are right, up, and
    level towards the viewer."""
    right, up, out = oblique.axes
    cos, sin = np.cos(PITCH), np.sin(PITCH)
    return np.stack([right, cos * up + sin * out, cos * out - sin * up])


def _axis(
    joint: Joint, boxes: dict[str, Float[np.ndarray, "2 3"]], centre: Float[np.ndarray, "3"], scale: float
) -> Float[np.ndarray, "3 3"]:
    """Find the place of a joint and the two ends of its axis, which reaches through both of its parts; a ball has
    none."""
    pose = np.asarray(joint.frames_1, float)[0]
    place, axis = (pose[:3, 3] - centre) / scale, pose[:3, 2]
    if MOVEMENTS[joint.movements[0]].ball:
        return np.stack([place, place, place])
    alongs = [(box_corners(boxes[part]) - place) @ axis for part in joint.parts]
    ends = sorted((max(along.min() for along in alongs), min(along.max() for along in alongs)))  # where both parts are
    beyond = np.clip(ends[1] - ends[0], *BEYOND)
    return place + np.outer([0.0, ends[0] - beyond, ends[1] + beyond], axis)


def _told(part: Part, unit: str) -> dict:
    """Tell what the report says of a part: where it is from, its size, and its faces that were not understood."""
    width, depth, height = (f"{side:.4g}" for side in np.ptp(part.box, axis=0))
    return {
        "original": part.original_name if part.original_name != part.name else "",
        "path": list(part.path),
        "size": f"{width} x {depth} x {height} {unit}".rstrip(),
        "notes": first_of_each((kind_of(note), note) for note in part.notes),
    }


def _joint(joint: Joint, mechanism: Mechanism, index: Mapping[str, int]) -> dict:
    """Write a joint with its parts, and all that it is known from."""
    evidence = joint.evidence
    known = evidence is None or evidence.kind in (EvidenceKind.CONTACT, EvidenceKind.USER, EvidenceKind.EXPORT)
    contacts = mechanism.contacts.get(joint.name, ())
    return {
        "name": joint.name,
        "kind": str(joint.kind),
        "coordinates": list(joint.full_names),
        "parts": [index[part] for part in joint.parts],
        "evidence": f"{evidence or ''}" + (f" (Doubtful: {evidence.doubt})" if evidence and evidence.doubt else ""),
        "sizes": [[name, f"{value:.4g}"] for name, value in (evidence.sizes if evidence else ())],
        "inferred": not known,
        "contacts": [str(contact) for contact in contacts],
    }


def _notes(
    found: Mechanism | Assembly, index: Mapping[str, int], tried: Sequence[str], contacts: Contacts | None
) -> list[dict]:
    """List assumptions and remarks by kind, each with the parts that it names, and the joint where it is of one."""
    if isinstance(found, Mechanism):
        texts, joints, solids = found.notes, found.all_joints, found.solids
    else:
        texts = () if contacts is None else (*map(str, (*contacts, *contacts.near_misses)), *contacts.notes)
        joints, solids = (), found.parts
    of_faces = {f"{part.name}: {note}" for part in solids for note in part.notes}
    named = {form: (name,) for name in index for form in (repr(name), f"{name} face ")}
    named |= {repr(joint.name): joint.parts for joint in joints}
    names = re.compile("|".join(re.escape(name) for name in sorted(named, key=len, reverse=True)))
    entries = []
    for text in dict.fromkeys((*(text for text in texts if text not in of_faces), *tried)):  # those are with their part
        group, said = (TRIED, text) if text in tried else _group(text)
        parts = dict.fromkeys(index[part] for name in names.findall(text) for part in named[name])
        joint = next((joint.name for joint in joints if joint.freedoms and repr(joint.name) in text), None)
        entries.append({"group": group, "text": said, "parts": list(parts), "joint": joint})
    return entries


def _group(text: str) -> tuple[str, str]:
    """Find the heading that a note stands under, and what it says there."""
    if text.startswith(f"{INFERRED} "):
        kind, _, said = text.removeprefix(f"{INFERRED} ").partition(": ")
        return f"Inferred from {kind}", said
    if text.startswith("nearly "):
        return "Nearly in contact", text
    return ("Contacts" if text.startswith("(") else "Noted"), text
