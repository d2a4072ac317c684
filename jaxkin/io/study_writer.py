"""A study written from a mechanism: bodies, joints with what each is known from, and a drive to choose."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from inspect import signature
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from jaxkin._files import whole
from jaxkin._grouped import grouped, kind_of
from jaxkin._traced import traced
from jaxkin.geometry.pose import Pose, frame
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.pairs import JOINTS_BY_HAND

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

_COMMENT = "# "
_SAME = 1e-12
"""Poses that differ by no more say the same: rounding of a frame that is made anew from its axis."""
_AS_CONTACT = {JointKind.PLANAR: "a", JointKind.SPHERICAL: "o"}
"""Contact states that say the same as pairs whose coordinates depend on all axes of their frame."""


def write_study(
    mechanism: Mechanism,
    path: Path | str,
    *,
    geometry: str | Mapping[str, str] | None = None,
    drive: Mapping[str, str] | None = None,
    assumptions: Sequence[str] = (),
) -> None:
    """Write a TOML file that says all of a mechanism, so that `load_study` makes the same one without inference.

    - `geometry`: the file that the solids are from, or files by part, as named from the folder of the study; needed
      where the mechanism has solids.
    - `drive`: ranges by coordinate as studies have them, `{"A.phi": "0:360:361"}`; without it the coordinates that can
      drive are written as comments to choose from.
    - `assumptions`: lines to add as comments at the top.

    What each joint is known from stands above it. The file appears whole or not at all. Raises ValueError for traced
    numbers, for a mechanism whose lengths were changed, and where `geometry` is missing.
    """
    if mechanism.solids and geometry is None:
        raise ValueError('the mechanism has solids: say where they are from, as in geometry="arm.step"')
    for joint in mechanism.all_joints:
        _check(joint)
    text = "\n".join([*_head(mechanism, geometry, assumptions), *_joints(mechanism), *_drive(mechanism, drive), ""])
    with whole(Path(path)) as draft:
        draft.write_text(text, "utf-8")


def _check(joint: Joint) -> None:
    if traced(joint):
        raise ValueError(f"joint {joint.name!r} has traced numbers: write the study outside of jit, vmap and grad")
    if not np.array_equal(joint.frames_1, joint.frames_2):
        raise ValueError(
            f"joint {joint.name!r} stands elsewhere on its second part than on its first, as after with_lengths: "
            "write mechanism.close().mechanism, whose given pose is closed"
        )


def _head(mechanism: Mechanism, geometry: str | Mapping[str, str] | None, assumptions: Sequence[str]) -> list[str]:
    bodies = mechanism.bodies
    moving = sum(joint.freedoms > 0 for joint in mechanism.all_joints)
    lines = [f"# {len(mechanism.parts)} parts, {len(bodies)} bodies, {moving} joints that move; angles in degrees"]
    notes = grouped((kind_of(note), note) for note in (*assumptions, *mechanism.notes))
    lines += [_COMMENT + line for note in notes for line in note.splitlines()]
    if mechanism.solids:
        lines += ["", f"geometry = {_text(geometry)}", "contacts = false  # the joints below are all there are"]
    elif mechanism.unit:
        lines += ["", f"unit = {_text(mechanism.unit)}"]
    lines += ["", f"fixed = {_names(mechanism.fixed)}"]
    if mechanism.solids:
        groups = [parts for name, parts in bodies.items() if len(parts) > 1 and name not in mechanism.fixed]
        lines += ["", "rigid = [", *(f"  {_names(parts)}," for parts in groups), "]"] if groups else []
    return lines


def _joints(mechanism: Mechanism) -> list[str]:
    lines = []
    for joint in mechanism.all_joints:
        if joint.kind is JointKind.FIXED and mechanism.solids:
            continue  # a body of `rigid`
        lines += ["", f"[joints.{_text(joint.name)}]"]
        lines += [_COMMENT + line for line in str(joint.evidence or "").splitlines()]
        kind, keys = _keys(joint)
        lines += [f"kind = {_text(kind)}", f"parts = {_names(joint.parts)}"]
        lines += [f"{key} = {_text(value)}" for key, value in keys.items()]
    return lines


def _keys(joint: Joint) -> tuple[str, dict[str, object]]:
    """The kind of a joint as a study names it, and its arguments."""
    pose = np.asarray(joint.frames_1, float)[0]
    usual = np.allclose(pose, frame(pose[:3, 3], pose[:3, 2]), atol=_SAME)
    if joint.kind in JOINTS_BY_HAND and (usual or joint.kind not in _AS_CONTACT):
        takes = signature(JOINTS_BY_HAND[joint.kind]).parameters
        return str(joint.kind), {key: said(joint, pose) for key, said in WRITTEN_ARGUMENTS.items() if key in takes}
    if joint.kind in _AS_CONTACT:
        letter, region = _AS_CONTACT[joint.kind], None
    elif state := joint.contact_state:
        letter, region = state.letter, state.region
    else:
        raise ValueError(f"joint {joint.name!r} of kind {joint.kind} cannot be said in a study")
    keys: dict[str, object] = {"state": letter, "frames": np.asarray(joint.frames_1).tolist()}
    return "contact", keys | ({"region": "circle"} if region == "circle" else {})


WRITTEN_ARGUMENTS: dict[str, Callable[[Joint, Pose], object]] = {
    "point": lambda _, pose: pose[:3, 3].tolist(),
    "axis": lambda _, pose: pose[:3, 2].tolist(),
    "normal": lambda _, pose: pose[:3, 2].tolist(),
    "axis1": lambda _, pose: pose[:3, 1].tolist(),
    "axis2": lambda _, pose: pose[:3, 0].tolist(),
    "pitch": lambda joint, _: float(joint.pitch),
}
"""Keyword argument of the functions in `jaxkin.joints.pairs` -> what it was, from a joint and its frame."""


def _drive(mechanism: Mechanism, drive: Mapping[str, str] | None) -> list[str]:
    if drive:
        return ["", "[drive]", *(f"{_key(name)} = {_text(values)}" for name, values in drive.items())]
    found = mechanism.mobility()
    if not found.drivable:
        return ["", f"# nothing can drive: {found}"]
    needed = "one range for each of these" if len(found.drivable) > 1 else "a range for this"
    choices = [f'# {_key(each)} = "0:10:11"' for each in found.drivable]
    return ["", f"# To drive it, give {needed}, START:STOP:COUNT:", "# [drive]", *choices]


def _key(name: str) -> str:
    return name if name.replace("-", "").replace("_", "").isalnum() and name.isascii() else _text(name)


def _names(names: Sequence[str]) -> str:
    return f"[{', '.join(map(_text, names))}]"


def _text(value: object) -> str:
    """A value as TOML: JSON's texts, lists and numbers are TOML's too, its tables are not."""
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{_text(key)} = {_text(each)}' for key, each in value.items())} }}"
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
