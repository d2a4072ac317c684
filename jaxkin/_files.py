"""Files as they are named by users."""

from __future__ import annotations

from pathlib import Path


def check_file(path: Path, kind: str) -> int:
    """The size in bytes of a file of a kind ("STEP file").

    Raises FileNotFoundError where nothing is there, and ValueError for what is no file: a folder, or a pipe or device,
    from which reading may never end.
    """
    if path.is_dir():
        raise ValueError(f"{path} is a folder: give the {kind} itself")
    if not path.exists():
        raise FileNotFoundError(f"{path} does not exist: give the path of a {kind}")
    if not path.is_file():
        raise ValueError(f"{path} is a pipe or a device: give the {kind} itself")
    return path.stat().st_size
