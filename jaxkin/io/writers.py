"""The files that a motion is saved as."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from jaxkin._arguments import several
from jaxkin._files import make_folder, whole
from jaxkin._traced import traced
from jaxkin.io.gltf import write_animation
from jaxkin.io.tables import write_arrays, write_table
from jaxkin.view.coordinates_plot import draw_coordinates
from jaxkin.view.page import page
from jaxkin.view.storyboard import storyboard

if TYPE_CHECKING:
    from jaxkin.mechanism.motion import Motion

Writer = Callable[["Motion", Path], None]
"""Writes exactly the path that it is given, which ends in the name of the file but lies in a temporary folder."""

WRITERS: dict[str, Writer] = {
    "motion.npz": write_arrays,
    "motion.csv": write_table,
    "motion.glb": write_animation,
    "motion.html": page,
    "motion.png": storyboard,
    "coordinates.png": draw_coordinates,
}
"""By the name of the file, in the order in which they are written: tables before all else, since they are cheap and
are there even if a picture fails."""

OTHER_ENDS = (".svg", ".pdf", ".jpg", ".jpeg", ".gif", ".mp4", ".npy", ".json", ".txt", ".tsv", ".xlsx", ".mat", ".pkl")
"""Ends of files that nothing here writes, and of which no folder has its name."""


def save(
    motion: Motion,
    directory: str | os.PathLike[str],
    only: str | Collection[str] | None = None,
    writers: Mapping[str, Writer] = WRITERS,
) -> tuple[Path, ...]:
    """Write the motion's files into a directory, made if it is not there; `only` chooses some of them by name.

    A path that ends as one of the files does, as in "rocker.csv", and that is no directory, is that one file.

    Returns the paths written. Each file appears whole or not at all. Raises ValueError for an unknown file name, for a
    path that ends as a file of another kind does, as in "rocker.svg", and for traced numbers, NotADirectoryError where
    the directory is a file, and OSError, naming the file, where one cannot be written: those before it are there by
    then, those after it are not.
    """
    if traced(motion):
        raise ValueError("the numbers of the motion are traced by JAX: call save outside of jit, vmap and grad")
    directory = Path(directory)
    if only is None and not directory.is_dir():
        single = [name for name in writers if directory.suffix and Path(name).suffix == directory.suffix.lower()]
        if single:
            return (_write(motion, directory, writers[single[0]]),)
        if directory.suffix.lower() in OTHER_ENDS:
            ends = ", ".join(dict.fromkeys(Path(name).suffix for name in writers))
            raise ValueError(
                f"a motion is saved as a file that ends in {ends}, or as all of them in a folder, as in save('out'); "
                f"got {directory.name!r}"
            )
    chosen = _choose(only, writers)
    make_folder(directory)
    return tuple(_write(motion, directory / filename, writers[filename]) for filename in chosen)


def _choose(only: str | Collection[str] | None, writers: Mapping[str, Writer]) -> list[str]:
    wanted = set(writers) if only is None else {only} if isinstance(only, str) else set(several(only, "only", "files"))
    if unknown := sorted(wanted - set(writers)):
        raise ValueError(f"no file {unknown[0]!r} can be written for a motion; choose from {', '.join(writers)}")
    return [filename for filename in writers if filename in wanted]


def _write(motion: Motion, target: Path, writer: Writer) -> Path:
    with whole(target) as draft:
        try:
            writer(motion, draft)
        except Exception as error:  # whatever fails in a writer, the user asked for a file
            raise OSError(f"could not write {str(target)!r}: {error}") from error
    return target
