"""The loops and motors of a robot whose URDF is a tree, in a YAML file beside it.

The keys are those of Gepetto's example-parallel-robots: `closed_loop` pairs frames of two links, each named by its
link or by the joint above it, which `type` holds together in place and orientation ("6d") or in place only ("3d");
`name_mot` names the actuated joints, and `joint_name` with `joint_type` gives joints another type than the URDF has,
SPHERICAL, CARDAN or FIXED.
"""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import NamedTuple

from jaxkin.io.yaml_subset import Value, read_yaml
from jaxkin.joints.kinds import JointKind

SPHERICAL = "SPHERICAL"
"""Entry of `joint_type` of a ball."""

RETYPED = {SPHERICAL.lower(): JointKind.SPHERICAL, "cardan": JointKind.UNIVERSAL, "fixed": JointKind.FIXED}
"""Entries of `joint_type` in small letters -> kind."""

LOOPS = {"6d": JointKind.FIXED, "3d": JointKind.SPHERICAL}
"""Entries of `type` in small letters -> kind."""

YAML_KEYS = ("closed_loop", "type", "name_mot", "joint_name", "joint_type")
"""Keys of a file of loops."""

YAML_SUFFIXES = (".yaml", ".yml")
"""Suffixes of files of loops."""


LoopPair = tuple[str, str, JointKind]
"""Two frames, by their links or joints, and the kind of the joint that holds them together."""


class Loops(NamedTuple):
    """What the file of loops says."""

    name: str
    pairs: tuple[LoopPair, ...] = ()
    motors: tuple[str, ...] = ()
    kinds: tuple[tuple[str, JointKind], ...] = ()
    notes: tuple[str, ...] = ()


def read_loops(path: Path) -> Loops:
    """Read a file of loops; ValueError where it is no such file."""
    said = read_yaml(path, YAML_KEYS)
    name = path.name
    notes = [f"{name}: the key {key!r} is not understood; left out" for key in said if key not in YAML_KEYS]
    pairs = said.get("closed_loop") or []
    if not isinstance(pairs, list) or not all(isinstance(each, list) and len(each) == 2 for each in pairs):
        raise ValueError(f"{name}: expected closed_loop: [['frame_a', 'frame_b'], ...], got {pairs!r}")
    if twice := next((pair for number, pair in enumerate(pairs) if pair in pairs[:number]), None):
        raise ValueError(f"{name}: closed_loop has {twice!r} twice: leave one out")
    if not pairs and not any(said.get(key) for key in YAML_KEYS):
        raise ValueError(
            f"{name}: it closes no loop and names no motor: expected closed_loop: [['frame_a', 'frame_b'], ...]"
        )
    if pairs and not said.get("type"):
        notes.append(
            f"{name}: no type is given, so that each loop is closed as by a weld (6d): write type: ['3d', ...], one a "
            "loop, for loops that close at a point"
        )
    kinds = _texts(said, "type", name) or ["6d"] * len(pairs)
    retyped, types = _texts(said, "joint_name", name), _texts(said, "joint_type", name)
    for (key, entries), (other, count) in zip(
        {"type": kinds, "joint_type": types}.items(),
        {"closed_loop": len(pairs), "joint_name": len(retyped)}.items(),
        strict=True,
    ):
        if len(entries) != count:
            raise ValueError(f"{name}: {key} has {len(entries)} entries and {other} has {count}: expected as many")
    return Loops(
        name,
        tuple((str(a), str(b), _one_of(kind, LOOPS, name, "type")) for (a, b), kind in zip(pairs, kinds, strict=True)),
        tuple(_texts(said, "name_mot", name)),
        tuple((a, _one_of(kind, RETYPED, name, "joint_type")) for a, kind in zip(retyped, types, strict=True)),
        tuple(notes),
    )


def unread_beside(urdf: Path) -> tuple[str, ...]:
    """Say of each file of loops beside a URDF, with the same stem, that it is not read, and what reads it.

    A YAML file without a key of `YAML_KEYS`, such as one of a controller, or that cannot be read, is none.
    """
    found = [each for suffix in YAML_SUFFIXES if (each := urdf.with_suffix(suffix)).is_file() and has_loops(each)]
    return tuple(
        f"{each.name}: this file of loops is beside {urdf.name}, and is not read: give --loops "
        f"{shlex.quote(str(each))}, in Python jk.load(..., loops={str(each)!r}), or in a study the key loops beside "
        "geometry"
        for each in found
    )


def has_loops(path: Path) -> bool:
    """Tell whether a file is one of loops: YAML that can be read, with one of `YAML_KEYS`."""
    try:
        return any(read_yaml(path, YAML_KEYS).get(key) for key in YAML_KEYS)
    except (ValueError, OSError):
        return False


def _texts(said: dict[str, Value], key: str, name: str) -> list[str]:
    found = said.get(key) or []
    found = [found] if isinstance(found, str) else found
    if not isinstance(found, list) or not all(isinstance(each, str) for each in found):
        raise ValueError(f"{name}: expected {key}: ['a', 'b'], got {found!r}")
    return [each for each in found if isinstance(each, str)]


def _one_of(text: str, known: dict[str, JointKind], name: str, key: str) -> JointKind:
    if text.lower() not in known:
        raise ValueError(f"{name}: {key}: expected one of {', '.join(known)}, got {text!r}")
    return known[text.lower()]
