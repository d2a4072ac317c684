"""Check that a mechanism can be written: known numbers, in a closed pose, and names that are read as they are."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from jaxkin._traced import traced
from jaxkin.io.names import in_one_line
from jaxkin.joints.joint import Joint

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism


def check_writable(joints: Iterable[Joint], what: str) -> None:
    """Raise ValueError for traced numbers, and for joints that stand elsewhere on part 2 than on part 1.

    `what` is the kind of file, for messages: "study".
    """
    for joint in joints:
        if traced(joint):
            raise ValueError(f"joint {joint.name!r} has traced numbers: write the {what} outside of jit, vmap and grad")
        if not joint.coincides:
            raise ValueError(
                f"joint {joint.name!r} stands elsewhere on its second part than on its first, as after with_lengths: "
                "write mechanism.close().mechanism, whose given pose is closed"
            )


def check_robot(mechanism: Mechanism, what: str) -> None:
    """Raise ValueError for what `check_writable` refuses, and for names that no file of robots keeps.

    These have blanks at their ends or in a row, tabs, or letters that nobody can type.
    """
    check_writable(mechanism.all_joints, what)
    parts, joints, couplings = mechanism.parts, mechanism.all_joints, mechanism.linkage.couplings
    names = {"part": parts, "joint": [each.name for each in joints], "coupling": [each.name for each in couplings]}
    for kind, given in names.items():
        for name in given:
            if name != in_one_line(name):
                raise ValueError(
                    f"the {kind} {name!r} would be read back as {in_one_line(name)!r}: a {what} has names without "
                    "control characters, and without blanks at their ends or in a row; rename it, or use mechanism.save"
                )
