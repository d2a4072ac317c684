"""Files as they are named by users, and files that appear whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING
from warnings import catch_warnings, filterwarnings

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.figure import Figure

DPI = 150
"""Dots an inch of figures that are saved."""
_NO_LETTER = "Glyph .* missing from font"
"""What matplotlib warns of, once a letter, where the font lacks letters of names."""


def check_file(path: Path, kind: str) -> int:
    """Return the size in bytes of a file that is to be read; `kind` is what the file is, such as "STEP file".

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


def check_folder(target: Path) -> None:
    """Raise FileNotFoundError, with what to do, where the folder of a file that is to be written is not there."""
    if not target.parent.is_dir():
        raise FileNotFoundError(f"cannot write {target}: there is no folder {target.parent}; make it, or name another")


@contextmanager
def whole(target: Path) -> Iterator[Path]:
    """Yield a draft of a file, which takes the place of the file when it is written, and never if that fails.

    It lies in a folder beside the file, on the same disk, so that the move is a mere renaming. Raises FileNotFoundError
    where the folder of the file is not there, and OSError where nothing can be written in it, or not this file.
    """
    check_folder(target)
    try:
        beside = TemporaryDirectory(prefix=".", dir=target.parent)
    except OSError as error:
        raise OSError(f"cannot write {target}: {_why(error)}; name a folder that can be written in") from None
    with beside as folder:
        draft = Path(folder) / target.name
        yield draft
        try:
            os.replace(draft, target)
        except OSError as error:
            raise OSError(f"could not write {target}: {_why(error)}") from None


def make_folder(folder: Path) -> None:
    """Make a folder, with those that it lies in; OSError, with what to do, where it cannot be made."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):
        raise NotADirectoryError(
            f"cannot save into {str(folder)!r}: it is, or lies in, a file; name a directory"
        ) from None
    except OSError as error:
        why = f"it cannot be made, {_why(error)}"
        raise OSError(f"cannot save into {str(folder)!r}: {why}; name a folder that can be written in") from None


def _why(error: OSError) -> str:
    """Say what the system says of an error, without the names of files."""
    return (error.strerror or str(error)).lower()


def save_figure(figure: Figure, path: Path) -> Path:
    """Write a figure of matplotlib into a file that appears whole or not at all; returns the path of the file.

    The end of the name says the format; a name without one is written as PNG. A letter that the font does not have is
    drawn as a box. Raises FileNotFoundError as `whole` does.
    """
    with whole(path) as draft, catch_warnings():
        filterwarnings("ignore", _NO_LETTER)
        # the numbers along an axis follow from its size, and the layout makes room for those before it: without this
        # pass labels of axes of one scale may be cut off
        figure.draw_without_rendering()
        figure.savefig(draft, dpi=DPI, format=path.suffix.lstrip(".") or "png")
    return path


def text_width(text: str, size: float, weight: str = "normal") -> float:
    """Measure a line of text of letters of a size in points, in pixels of a picture; a letter that the font does not
    have counts as the box that is drawn for it."""
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import text_to_path

    with catch_warnings():
        filterwarnings("ignore", _NO_LETTER)
        width, _, _ = text_to_path.get_text_width_height_descent(text, FontProperties(size=size, weight=weight), False)
    return width * DPI / 72


def quoted(text: str) -> str:
    """Write a text in quotes, as a field of comma-separated values: a quote in it becomes two."""
    return '"' + text.replace('"', '""') + '"'


def save_table(heading: Sequence[str], first: Iterable[str], columns: Iterable[np.ndarray], path: Path) -> Path:
    """Write comma-separated values: a line of headings, then lines of a text and of a number of each column.

    Every number is the shortest decimal that reads back as the same number of its precision. Returns the path.
    """
    numbers = [[number.removesuffix(".0") for number in column.astype(str).tolist()] for column in columns]
    lines = [heading, *zip(first, *numbers, strict=True)]
    with whole(path) as draft:
        draft.write_text("".join(",".join(line) + "\n" for line in lines), encoding="utf-8")
    return path
