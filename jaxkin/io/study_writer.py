"""A study written from a mechanism: bodies, joints with what each is known from, and a drive to choose."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from inspect import signature
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from jaxkin._arguments import check_mechanism
from jaxkin._files import whole
from jaxkin._grouped import grouped, kind_of
from jaxkin._names import counted
from jaxkin.assembly.dropped_inference import TOLD
from jaxkin.assembly.inference.inference import INFERRED
from jaxkin.assembly.wheels import wheels_last
from jaxkin.contacts.reason import advises_tolerance
from jaxkin.geometry.movements import MOVEMENTS, is_length
from jaxkin.geometry.pose import Transform, frame
from jaxkin.io.study_bodies import BodyChoices
from jaxkin.io.study_choices import NONE, Choices, find_choices
from jaxkin.io.study_couplings import coupling_keys
from jaxkin.io.study_curves import CURVE_ARGUMENTS, axes_of
from jaxkin.io.toml_text import comment, toml, toml_key
from jaxkin.io.writable import check_writable
from jaxkin.joints.evidence import BY_HAND, Evidence
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.pairs import JOINTS_BY_HAND
from jaxkin.mobility.open_loops import left_open

if TYPE_CHECKING:
    from jaxkin.assembly.proposals import Proposal
    from jaxkin.mechanism.mechanism import Mechanism

_BESIDE = (INFERRED, TOLD)
"""Prefixes of notes that are written beside their joint or body, and not at the top."""
_GIVE_TOLERANCES = (
    "such tolerances find contacts anew: delete contacts = false, rigid and [joints], and write, as an example, "
    "tolerance = { length = 0.001 } in their place"
)
"""How to follow the advice of near misses in a study that holds the joints that were found."""
_SAME = 1e-12
"""Largest difference of the entries of two poses that count as equal: rounding of a frame made anew from its axis."""
_AS_CONTACT = {JointKind.PLANAR: "a", JointKind.SPHERICAL: "o"}
"""Pairs whose coordinates depend on all axes of their frame -> the contact state that is written with whole frames."""


def write_study(
    mechanism: Mechanism,
    path: Path | str,
    *,
    geometry: str | Mapping[str, str] | None = None,
    loops: str | None = None,
    drive: Mapping[str, str] | None = None,
    assumptions: Sequence[str] = (),
    exclude: Sequence[str] = (),
    proposals: Sequence[Proposal] | None = None,
) -> None:
    """Write a TOML file that says all of a mechanism, so that `load_study` makes the same one without inference.

    - `geometry`: the file that the solids are from, or files by part, as named from the folder of the study; needed
      where the mechanism has solids.
    - `loops`: the YAML file of the loops of a robot in URDF, named from there too; needed where it was loaded with one.
    - `drive`: ranges by coordinate as studies have them, `{"A.phi": "0:360:361"}`; without it the coordinates that can
      drive are written as comments to choose from.
    - `assumptions`: lines to add as comments at the top.
    - `exclude`: parts of the file that the mechanism leaves out.
    - `proposals`: what else may be fixed, as of `Assembly.proposals`, or none of it, `()`. With them what is open is
      listed as lines to uncomment: other parts to fix, other coordinates to drive, joints to turn off, parts to leave
      out. Of each it has been tried that the loops follow its drive. For mechanisms with solids only.

    What each joint is known from stands above it. The file appears whole or not at all. Raises ValueError for traced
    numbers, for a mechanism whose lengths were changed, and where `geometry` is missing.
    """
    check_mechanism(mechanism, "written studies")
    if mechanism.solids and geometry is None:
        raise ValueError('the mechanism has solids: say where they are from, as in geometry="arm.step"')
    check_writable(mechanism.all_joints, "study")
    bodies = BodyChoices.of(mechanism)
    choices = NONE if proposals is None or not mechanism.solids else find_choices(mechanism, bodies, drive, proposals)
    lines = [
        *_head(mechanism, geometry, loops, assumptions),
        *_bodies(mechanism, bodies, exclude, choices),
        *_joints(mechanism, choices),
        *_couplings(mechanism),
        *_drive(mechanism, drive),
    ]
    with whole(Path(path)) as draft:
        draft.write_text("\n".join([*lines, ""]), "utf-8")


def _head(
    mechanism: Mechanism, geometry: str | Mapping[str, str] | None, loops: str | None, assumptions: Sequence[str]
) -> list[str]:
    moving = sum(joint.freedoms > 0 for joint in mechanism.all_joints)
    parts = f"{counted(len(mechanism.parts), 'part')}, {counted(len(mechanism.bodies), 'body')}"
    joints = "1 joint that moves" if moving == 1 else f"{moving} joints that move"
    lines = [f"# {parts}, {joints}; angles in degrees"]
    of_faces = {f"{part.name}: {note}" for part in mechanism.solids for note in part.notes}
    notes = [note for note in mechanism.notes if note not in of_faces and not note.startswith(_BESIDE)]
    for note in grouped((kind_of(note.rpartition(": ")[2]), note) for note in (*assumptions, *notes)):
        lines += comment(note)
    if mechanism.solids and any(advises_tolerance(note) for note in notes):
        lines += comment(_GIVE_TOLERANCES)
    lines += ["", f"geometry = {toml(geometry)}"] if mechanism.solids else []
    lines += [f"loops = {toml(loops)}"] if loops and mechanism.solids else []
    lines += ["contacts = false  # the joints below are all there are"] if mechanism.solids else []
    return lines + ["", f"unit = {toml(mechanism.unit)}"] if mechanism.unit else lines


def _bodies(mechanism: Mechanism, bodies: BodyChoices, exclude: Sequence[str], choices: Choices) -> list[str]:
    lines = ["", f"fixed = {toml(bodies.fixed)}"]
    if choices.instead:
        lines += [
            "# Alternatives to these fixed parts, or to the drive at the end of this file; choose one:",
            *choices.instead,
        ]
    if exclude or choices.exclude:
        lines += ["", "exclude = [  # parts to leave out", *(f"  {toml(part)}," for part in exclude)]
        lines += [*choices.exclude, "]"]
    if bodies.groups:
        lines += ["", "rigid = [  # what moves as one; without a line its parts come apart"]
        lines += [f"  {toml(group)},{_after(evidence)}" for group, evidence in bodies.groups] + ["]"]
    return [*lines, "", f"motors = {toml(mechanism.motors)}"] if mechanism.motors else lines


def _after(evidence: Evidence | None) -> str:
    """Write what something is known from, as the end of a line."""
    return f"  # {' '.join(str(evidence).split())}" if evidence and evidence != BY_HAND else ""


def _joints(mechanism: Mechanism, choices: Choices) -> list[str]:
    lines = []
    for joint in mechanism.all_joints:
        if joint.kind is JointKind.FIXED and mechanism.solids:
            continue  # a body of `rigid`
        lines += ["", f"[joints.{toml(joint.name)}]", *comment(str(joint.evidence or ""))]
        lines += [choices.off[joint.name]] if joint.name in choices.off else []
        kind, keys = _keys(joint)
        other = f"  # {choices.doubts[joint.name]}" if joint.name in choices.doubts else ""
        lines += [f"kind = {toml(kind)}{other}", f"parts = {toml(joint.parts)}"]
        lines += [f"{key} = {toml(value)}" for key, value in (keys | _limits(joint)).items()]
    return lines


def _limits(joint: Joint) -> dict[str, object]:
    """Write the limits of a joint by coordinate, degrees and lengths; nothing where it has none."""
    ends = {
        name: [end if is_length(name) else float(np.degrees(end)) for end in ends]
        for name, ends in zip(joint.coordinates, joint.limits, strict=bool(joint.limits))
        if np.isfinite(ends).any()
    }
    return {"limits": ends} if ends else {}


def _couplings(mechanism: Mechanism) -> list[str]:
    lines = []
    for coupling in mechanism.linkage.couplings:
        lines += ["", f"[couplings.{toml(coupling.name)}]"]
        lines += [f"{key} = {toml(value)}" for key, value in coupling_keys(coupling).items()]
    return lines


def _keys(joint: Joint) -> tuple[str, dict[str, object]]:
    """Find the kind of a joint as a study names it, and the arguments of the function of that kind."""
    pose = np.asarray(joint.frames_1, float)[0]
    usual = np.allclose(pose, frame(pose[:3, 3], pose[:3, 2]), atol=_SAME)
    if joint.kind in JOINTS_BY_HAND and (usual or joint.kind not in _AS_CONTACT):
        takes = signature(JOINTS_BY_HAND[joint.kind]).parameters
        said = {key: of(joint, pose) for key, of in WRITTEN_ARGUMENTS.items() if key in takes}
        return str(joint.kind), {key: value for key, value in said.items() if value is not None}
    if joint.kind in _AS_CONTACT:
        letter, region = _AS_CONTACT[joint.kind], None
    elif state := joint.contact_state:
        letter, region = state.letter, state.region
    else:
        raise ValueError(f"joint {joint.name!r} of kind {joint.kind} cannot be said in a study")
    keys: dict[str, object] = {"state": letter, "frames": np.asarray(joint.frames_1).tolist()}
    return "contact", keys | ({"region": "circle"} if region == "circle" else {})


def _direction(joint: Joint, pose: Transform) -> list[float] | None:
    """Find the direction of a straight slot, or of x of a profile or of several slides."""
    if joint.curves:
        return axes_of(joint)[:3, 0].tolist()
    if _slides_across(joint):
        return pose[:3, 0].tolist()
    return pose[:3, 2].tolist() if MOVEMENTS[joint.movements[0]].only_slides else None


def _slides_across(joint: Joint) -> bool:
    """Tell whether the first movement of a joint slides along several axes."""
    return MOVEMENTS[joint.movements[0]].turns_and_slides[1] > 1


def _axis2(joint: Joint, pose: Transform) -> list[float] | None:
    """Find the axis on part 2; that of a constant velocity joint is written as the direction between its shafts."""
    if _slides_across(joint):
        return _pin(joint)[:3, 2].tolist()
    return None if MOVEMENTS[joint.movements[0]].repeats else pose[:3, 0].tolist()


WRITTEN_ARGUMENTS: dict[str, Callable[[Joint, Transform], object]] = {
    "point": lambda joint, _: (axes_of(joint) if joint.curves else _pin(joint))[:3, 3].tolist(),
    "axis": lambda joint, _: (axes_of(joint) if joint.curves else _pin(joint))[:3, 2].tolist(),
    "normal": lambda _, pose: pose[:3, 2].tolist(),
    "axis1": lambda joint, pose: pose[:3, 2 if _slides_across(joint) else 1].tolist(),
    "axis2": _axis2,
    "pitch": lambda joint, _: float(joint.pitch),
    "direction": _direction,
    "centre": lambda joint, pose: None if MOVEMENTS[joint.movements[0]].only_slides else pose[:3, 3].tolist(),
    **CURVE_ARGUMENTS,
}
"""Keyword argument of the functions in `jaxkin.joints.pairs` -> what it was, from a joint and its first frame; None
where it was not given."""


def _pin(joint: Joint) -> Transform:
    """Take the last frame of a joint: that of the pin in a slot, and the only one of most joints."""
    return np.asarray(joint.frames_1, float)[-1]


def _drive(mechanism: Mechanism, drive: Mapping[str, str] | None) -> list[str]:
    if drive:
        return ["", "[drive]", *(f"{toml_key(name)} = {toml(values)}" for name, values in drive.items())]
    if (gap := left_open(mechanism.linkage, mechanism.unit)) is not None:
        return ["", *comment(f"nothing can drive: the loops cannot be closed: where they are the least open, {gap}")]
    drivable = wheels_last(mechanism)
    if not drivable:
        return ["", *comment(f"nothing can drive: {mechanism.mobility()}")]
    needed = "one range for each of these" if len(drivable) > 1 else "a range for this"
    choices = [f'# {toml_key(each)} = "0:10:11"' for each in drivable]
    return ["", f"# To drive it, give {needed}, START:STOP:COUNT:", "# [drive]", *choices]
