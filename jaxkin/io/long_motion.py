"""A motion of any length as arrays on disk: written chunk by chunk, never whole in memory."""

from __future__ import annotations

import zipfile
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

import numpy as np

from jaxkin._files import whole
from jaxkin.io.tables import poses_of, words_of
from jaxkin.mechanism.joint_limits import Breach, breaches
from jaxkin.mechanism.joint_limits import joined as limits_joined
from jaxkin.mechanism.lost_contacts import LostContact, joined
from jaxkin.mechanism.motion import Tally, largest_residuals, tell
from jaxkin.solve.status import Status

if TYPE_CHECKING:
    from jaxkin.mechanism.stream import Stream


def write_stream(stream: Stream, path: Path, step: Callable[[], None] = lambda: None) -> str:
    """Write the arrays of `write_arrays` but for those of the parts, and say what became of the poses.

    `step` is called when a chunk is written. The file appears whole or not at all; while it is made, its folder holds
    its arrays twice.
    """
    counts, largest = np.zeros(len(Status), int), np.zeros(len(Status))
    lost: list[tuple[tuple[LostContact, ...], int]] = []
    beyond: list[tuple[tuple[Breach, ...], int]] = []
    with whole(path) as draft:
        columns: dict[str, Path] = {}
        with ExitStack() as stack:
            files: dict[str, BinaryIO] = {}
            for motion in stream:
                for name, rows in poses_of(motion).items():
                    if name not in files:
                        columns[name] = draft.with_name(f"{len(files)}.npy")
                        files[name] = stack.enter_context(columns[name].open("wb"))
                        shape = (stream.poses, *rows.shape[1:])
                        header = {
                            "descr": np.lib.format.dtype_to_descr(rows.dtype),
                            "fortran_order": False,
                            "shape": shape,
                        }
                        np.lib.format.write_array_header_2_0(files[name], header)
                    files[name].write(rows.tobytes())
                counts += np.bincount(np.asarray(motion.status), minlength=len(Status))
                largest = np.maximum(largest, largest_residuals(motion))
                lost.append((motion.lost_contacts, len(motion)))
                beyond.append((breaches(motion), len(motion)))
                step()
        with zipfile.ZipFile(draft, "w") as archive:
            for name, file in columns.items():
                archive.write(file, f"{name}.npy")
                file.unlink()
            for name, words in words_of(stream.mechanism).items():
                with archive.open(f"{name}.npy", "w") as file:
                    np.lib.format.write_array(file, words)
    return tell(Tally(counts, largest, joined(lost), limits_joined(beyond)), stream.mechanism, stream.inputs)
