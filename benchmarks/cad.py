"""Joints found in assemblies that others drew, against those of their CAD systems: `python benchmarks/cad.py DIR`.

DIR holds assemblies as NAME.step or NAME.step.xz, and exports for Simscape Multibody as NAME.xml, these at any depth,
as repositories hold them. Where the CAD system's own joints are known, NAME.joints.json lies beside the file:
`instances` (name, grounded) and `joints` (type, and of both parts the name, a point and the axis, in metres), and
perhaps `freedoms`, the useful ones that were meant. Without known joints the part to fix comes from
`assembly.proposals`.

A labelled pair of parts is right where the bodies of the two parts have the same joint about the same axis, or are one
body if they are welded; right but for an idle slide or spin where the kinds differ by a coordinate that moves nothing
else; other where they have another joint; missed where no joint is between them.

*lines* are those of a study that moves the assembly: one for the fixed parts, where the file does not say what is held,
and one for the range of each drive. *closed* are the poses that close where each drive runs through a small range by
itself, 0.1 rad or a fiftieth of the size of the assembly to both sides.
"""

from __future__ import annotations

import json
import lzma
import os
import sys
from collections import Counter
from collections.abc import Collection, Mapping
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import jax
import numpy as np

import jaxkin as jk
from jaxkin.assembly.assembly import Assembly
from jaxkin.joints.evidence import EvidenceKind
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mobility.loop_freedoms import loop_freedoms
from jaxkin.topology.bodies import bodies

MAX_ANGLE, MAX_OFFSET = 1e-3, 1e-4
"""Radians and metres between axes that are the same: the exporter writes nine digits, solids differ by clearances."""
METRE = {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "in": 0.0254, "inch": 0.0254}
COORDINATES = {"Weld": set(), "Revolute": {"phi"}, "Prismatic": {"z"}, "Cylindrical": {"z", "phi"}}
VERDICTS = ("right", "idle", "other", "missed")
BY_CONTACTS = "by exact contacts"
"""How a verdict ends of a joint that is other than meant, and that exact contacts determine: nothing is inferred of
it."""


def true_mechanism(data: Mapping[str, Any]) -> Mechanism:
    """Build the mechanism of the exported joints, in metres."""
    joints = []
    for number, each in enumerate(data["joints"]):
        name, parts = f"{number} {each['name']}", (each["a"]["part"], each["b"]["part"])
        at = dict(point=each["a"]["point"], axis=each["a"]["axis"])
        if each["type"] == "Weld":
            joints.append(jk.fixed(name, *parts))
        else:
            joints.append(getattr(jk, each["type"].lower())(name, *parts, **at))
    jointed = {part for each in joints for part in each.parts}
    fixed = [name for name in grounded(data) if name in jointed]
    return jk.Mechanism.build(fixed=fixed, joints=[*joints, *rigid_groups(joints, fixed)], align=1e-3)


def rigid_groups(joints: list[jk.Joint], fixed: list[str]) -> list[jk.Joint]:
    """Weld the labelled parts of each outermost sub-assembly in which no labelled joint moves: exports lack these."""
    first: dict[str, str] = {}
    parts = dict.fromkeys(part for each in joints for part in each.parts)
    body = dict(bodies(list(parts), fixed, [each.parts for each in joints if each.kind == "fixed"]))
    moving = {tuple({part.split("/")[0] for part in each.parts}) for each in joints if each.kind != "fixed"}
    welds = []
    for part in (each for each in parts if "/" in each and (each.split("/")[0],) not in moving):
        host = first.setdefault(part.split("/")[0], part)
        if body[host] != body[part]:
            welds.append(jk.fixed(f"rigid {host}-{part}", host, part))
            joined = body[part]
            body = {name: body[host] if owner == joined else owner for name, owner in body.items()}
    return welds


def grounded(data: Mapping[str, Any]) -> list[str]:
    """Name the parts that the CAD system holds."""
    return [each["name"] for each in data["instances"] if each["grounded"]]


def bodies_of(mechanism: Mechanism) -> dict[str, str]:
    """Map each part to its body."""
    return {part: body for body, parts in mechanism.bodies.items() for part in parts}


def by_contacts(joint: jk.Joint) -> bool:
    """Tell whether exact contacts determine a joint."""
    return joint.evidence is not None and joint.evidence.kind == EvidenceKind.CONTACT


def verdict(label: Mapping[str, Any], found: Mechanism, idle: set[str], truly_idle: set[str], scale: float) -> str:
    """Judge a labelled pair by the joint of its bodies."""
    body = bodies_of(found)
    a, b = body[label["a"]["part"]], body[label["b"]["part"]]
    wanted = COORDINATES[label["type"]]
    if a == b:
        return "right" if not wanted else "idle" if wanted <= truly_idle else "other"
    between = [each for each in found.all_joints if {body[part] for part in each.parts} == {a, b}]
    if not between:
        return "missed"
    other = f"other: {BY_CONTACTS}" if all(map(by_contacts, between)) else "other"
    if len(between) > 1 or between[0].kind not in ("revolute", "cylindrical", "prismatic"):
        return other
    joint, got = between[0], set(between[0].coordinates)
    more = {name for name in got - wanted if f"{joint.name}.{name}" in idle}
    if not wanted:
        return "idle" if more == got else other
    if not same_axis(label, joint, scale, "phi" in wanted | got):
        return other
    if got == wanted:
        return "right"
    return "idle" if got - wanted <= more and wanted - got <= truly_idle else other


def same_axis(label: Mapping[str, Any], joint: jk.Joint, scale: float, turns: bool) -> bool:
    """Whether a joint is about the labelled axis; for a slide only its direction counts."""
    frame = joint.frames_1[0]
    axis = np.array(label["a"]["axis"])
    offsets = [frame[:3, 3] * scale - label[side]["point"] for side in "ab"]
    apart = min(np.linalg.norm(offset - (offset @ axis) * axis) for offset in offsets)
    parallel = np.linalg.norm(np.cross(frame[:3, 2], axis)) < MAX_ANGLE
    return bool(parallel and (apart < MAX_OFFSET or not turns))


def useless(mechanism: Mechanism) -> set[str]:
    """Name the coordinates of loops that show idle motions, or that nothing can move."""
    names, moved = set(), set()
    for loop in loop_freedoms(mechanism.linkage):
        for column, (joint, k) in enumerate(loop.columns):
            each = mechanism.all_joints[joint]
            names.add(f"{each.name}.{each.coordinates[k]}")
            if np.abs(loop.motions[:, column]).max(initial=0.0) > loop.thresholds.rate:
                moved.add(f"{each.name}.{each.coordinates[k]}")
    return names - moved | set(mechanism.mobility().idle)


def judged(data: Mapping[str, Any], found: Mechanism, scale: float) -> list[str]:
    """Judge all labelled pairs, in the order of the file."""
    shown = useless(true_mechanism(data))
    idle = useless(found)
    result = []
    for number, label in enumerate(data["joints"]):
        name = f"{number} {label['name']}."
        result.append(
            verdict(label, found, idle, {each[len(name) :] for each in shown if each.startswith(name)}, scale)
        )
    return result


def read(path: Path) -> Assembly:
    """Read an assembly, packed or not."""
    if path.suffix == ".xml":
        return in_labelled_names(jk.load(path))
    if path.suffix != ".xz":
        return jk.load(path)
    with TemporaryDirectory() as folder:
        plain = Path(folder) / path.stem
        plain.write_bytes(lzma.decompress(path.read_bytes()))
        return jk.load(plain)


def in_labelled_names(assembly: Assembly) -> Assembly:
    """Name the parts of an export as labels do: by all sub-assemblies that they are in."""
    names = {part.name: "/".join((*part.path, part.original_name)) for part in assembly.parts}
    parts = tuple(replace(part, name=names[part.name]) for part in assembly.parts)
    return replace(assembly, parts=parts, exported=assembly.exported and assembly.exported.renamed(names))


def processor_seconds() -> float:
    """Seconds that this process and the readers that it started have worked: on a busy machine the clock tells less."""
    return sum(os.times()[:4])


def moved(mechanism: Mechanism, size: float) -> tuple[int, int]:
    """Count the poses that close, and all of them, where each drive runs through a small range by itself."""
    drives, closed, poses = mechanism.mobility().drivable, 0, 0
    for name in drives:
        reach = 0.1 if name.rsplit(".", 1)[1].startswith(("phi", "theta", "psi")) else size / 50
        path = np.linspace(-reach, reach, 21)
        motion = mechanism.sweep(dict.fromkeys(drives, 0 * path) | {name: path})
        closed, poses = closed + int(np.sum(motion.closed)), poses + motion.closed.size
    return closed, poses


def apart(data: Mapping[str, Any], found: Mechanism, scale: float, size: float) -> float:
    """Measure how far labelled points are from where the known joints move them, in metres: NaN where no pose tells."""
    true = true_mechanism(data)
    body, drives, distances = bodies_of(found), [], []
    for drive in true.mobility().drivable:
        name, coordinate = drive.rsplit(".", 1)
        joint = true.joints[name]
        one, other = (body[part] for part in joint.parts)
        same = next((each for each in found.all_joints if {body[part] for part in each.parts} == {one, other}), None)
        if same is None or coordinate not in same.coordinates:
            return float("nan")
        sign = np.sign(joint.frames_1[0][:3, 2] @ same.frames_1[0][:3, 2]) * (1 if body[same.parts[0]] == one else -1)
        turns = coordinate == "phi"
        reach = 0.5 if turns else size * scale / 10
        drives.append(
            (drive, f"{same.name}.{coordinate}", np.linspace(-reach, reach, 41), sign / (1 if turns else scale))
        )
    for driven, _, path, _ in drives:
        truly = true.sweep({drive: path if drive == driven else 0 * path for drive, *_ in drives})
        motion = found.sweep({name: (path if drive == driven else 0 * path) * k for drive, name, _, k in drives})
        closed = np.asarray(truly.closed & motion.closed)
        for each in (label[side] for label in data["joints"] for side in "ab"):
            point = np.array(each["point"])
            places = [
                poses[:, :3, :3] @ (point / unit) * unit + poses[:, :3, 3] * unit
                for poses, unit in ((truly.transforms[each["part"]], 1.0), (motion.transforms[each["part"]], scale))
            ]
            distances.extend(np.linalg.norm(places[0] - places[1], axis=-1)[closed])
    return max(distances, default=float("nan"))


def row(path: Path, verbose: bool) -> str:
    """One line of the table."""
    start = processor_seconds()
    name, assembly = path.name.split(".")[0], read(path)
    labels = path.with_name(f"{name}.joints.json")
    data = json.loads(labels.read_text()) if labels.exists() else None
    said = assembly.exported is not None  # then nothing is left to say
    fixed = () if said else grounded(data) if data else assembly.proposals()[0].fixed
    mechanism = assembly.mechanism(fixed=fixed)
    mobility = mechanism.mobility()
    seconds = processor_seconds() - start
    counts = Counter()
    if data:
        verdicts = judged(data, mechanism, METRE[assembly.unit])
        counts = Counter(each.split(":")[0] for each in verdicts)
        if verbose:
            pairs = [(v, each) for v, each in zip(verdicts, data["joints"], strict=True) if v not in ("right", "idle")]
            for v, each in pairs:
                print(f"  {v}: {each['type']} {each['a']['part']} - {each['b']['part']}")
    corners = np.array([part.box for part in assembly.parts])
    size = float(np.linalg.norm(np.ptp(corners, axis=(0, 1))))
    closed, poses = moved(mechanism, size)
    cells = [
        f"{name}{' (export)' if said else ''}",
        len(assembly.parts),
        len(mechanism.bodies),
        *((counts[v] for v in VERDICTS) if data else "----"),
        f"{mobility.useful} of {data['freedoms']}" if data and "freedoms" in data else mobility.useful,
        mobility.freedoms,
        (not said) + len(mobility.drivable),
        f"{closed} of {poses}",
        f"{1e3 * apart(data, mechanism, METRE[assembly.unit], size):.1e}" if data else "-",
        f"{seconds:.1f}",
    ]
    return "| " + " | ".join(map(str, cells)) + " |"


def assemblies(folder: Path, names: Collection[str]) -> list[Path]:
    """List the assemblies in a folder, or those of some names; says what is wrong where there are none."""
    if not folder.is_dir():
        sys.exit(f"{folder} is no folder")
    found = sorted([*folder.glob("*.step"), *folder.glob("*.step.xz"), *folder.rglob("*.xml")])
    known = [path.name.split(".")[0] for path in found]
    if not found:
        sys.exit(f"{folder} holds no .step, .step.xz or .xml; exports are looked for in its folders, too")
    if unknown := [name for name in names if name not in known]:
        sys.exit(f"{folder} holds no {', '.join(unknown)}; it holds {', '.join(known)}")
    return [path for path, name in zip(found, known, strict=True) if not names or name in names]


def main(folder: str, names: Collection[str]) -> None:
    """Print the table of all assemblies in a folder, or of those named."""
    jax.config.update("jax_enable_x64", True)
    paths = assemblies(Path(folder), names)
    head = ["file", "parts", "bodies", *VERDICTS, "useful freedoms", "freedoms"]
    head += ["lines", "closed", "apart [mm]", "processor seconds"]
    print("| " + " | ".join(head) + " |\n|" + "---|" * len(head))
    for path in paths:
        print(row(path, verbose=bool(names)), flush=True)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2:])
