"""The files that a motion is saved as: a registry, so that higher floors add formats without being imported here."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from jaxkin.mechanism.motion import Motion

Writer = Callable[["Motion", Path], None]

_tables: dict[str, Writer] = {}
_others: dict[str, Writer] = {}


def register(filename: str, *, table: bool = False) -> Callable[[Writer], Writer]:
    """Decorator: the function `(motion, path) -> None` writes the file of this name.

    It must write exactly `path`, which ends in `filename` but lies in a temporary folder. Tables are written before all
    else: they are cheap, and are there even if a picture fails. A name that is taken already is refused (ValueError).
    """

    def add(writer: Writer) -> Writer:
        if filename in filenames():
            raise ValueError(f"{filename!r} has a writer already; register this one under another name")
        (_tables if table else _others)[filename] = writer
        return writer

    return add


def filenames() -> tuple[str, ...]:
    """Names of the files that `save` writes, in the order in which it writes them."""
    return (*_tables, *_others)


def save(
    motion: Motion, directory: str | os.PathLike[str], only: str | Collection[str] | None = None
) -> tuple[Path, ...]:
    """Write the motion's files into a directory, made if it is not there; `only` chooses some of `filenames()`.

    Returns the paths written. Each file appears whole or not at all. Raises ValueError for an unknown file name,
    NotADirectoryError where the directory is a file, and OSError, naming the file, where one cannot be written: those
    before it are there by then, those after it are not.
    """
    chosen = _choose(only)
    directory = Path(directory)
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):
        raise NotADirectoryError(
            f"cannot save into {str(directory)!r}: it is, or lies in, a file; name a directory"
        ) from None
    return tuple(_write(motion, directory, filename) for filename in chosen)


def _choose(only: str | Collection[str] | None) -> tuple[str, ...]:
    wanted = filenames() if only is None else {only} if isinstance(only, str) else set(only)
    if unknown := sorted(set(wanted) - set(filenames())):
        raise ValueError(f"no file {unknown[0]!r} can be written for a motion; choose from {', '.join(filenames())}")
    return tuple(filename for filename in filenames() if filename in wanted)


def _write(motion: Motion, directory: Path, filename: str) -> Path:
    target = directory / filename
    try:
        with whole(target) as draft:
            (_tables | _others)[filename](motion, draft)
    except Exception as error:  # writers are registered from outside: whatever fails in one, the user asked for a file
        raise OSError(f"could not write {str(target)!r}: {error}") from error
    return target


@contextmanager
def whole(target: Path) -> Iterator[Path]:
    """A draft of a file, which takes its place when it is written, and never does where that fails.

    It lies in a folder beside the file, on the same disk, so that the move is a mere renaming. Raises FileNotFoundError
    where the folder of the file is not there.
    """
    if not target.parent.is_dir():
        raise FileNotFoundError(f"cannot write {target}: there is no folder {target.parent}; make it, or name another")
    with TemporaryDirectory(prefix=".", dir=target.parent) as folder:
        draft = Path(folder) / target.name
        yield draft
        os.replace(draft, target)
