"""Check that joints can be written to a file: known numbers, in a closed pose."""

from __future__ import annotations

from collections.abc import Iterable

from jaxkin._traced import traced
from jaxkin.joints.joint import Joint


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
