"""Tables that the command line prints."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table
from rich.text import Text

from jaxkin.geometry.motions import is_length

if TYPE_CHECKING:
    from jaxkin.contacts.contact import Contact
    from jaxkin.geometry.part import Part
    from jaxkin.motion.motion import Motion


def say(text: str = "") -> None:
    """Print text as it is: no markup, no colours, no wrapping."""
    Console().print(Text(text), soft_wrap=True)


def print_table(headings: Iterable[str], rows: Iterable[Iterable[str]], numbers: Iterable[int] = ()) -> None:
    """Print rows under headings; columns named by index in `numbers` are aligned to the right."""
    table = Table(box=SIMPLE_HEAD, pad_edge=False, show_edge=False)
    for index, heading in enumerate(headings):
        table.add_column(heading, overflow="fold", justify="right" if index in set(numbers) else "left")
    for row in rows:
        table.add_row(*(Text(cell) for cell in row))
    Console(highlight=False).print(table)


def print_parts(parts: Iterable[Part]) -> None:
    """How many faces of which kind each part has, and what of it could not be read."""
    rows = []
    for part in parts:
        kinds = Counter(face.surface.kind for face in part.faces)
        faces = ", ".join(f"{count} {kind}{'s' if count > 1 else ''}" for kind, count in sorted(kinds.items()))
        rows.append((part.name, faces or "none", "; ".join(part.notes) or "nothing"))
    print_table(("part", "faces", "not read"), rows)


def print_contacts(contacts: Iterable[Contact]) -> None:
    """Which faces touch, in which of the paper's states, and where."""
    print_table(
        ("parts", "state", "region", "faces"),
        [(" - ".join(c.parts), f"({c.state})", c.region, " - ".join(c.faces)) for c in contacts],
    )


def print_motion(motion: Motion) -> None:
    """What became of the poses, and the range that each joint coordinate runs through in the closed ones."""
    say(str(motion))
    say()
    closed = np.asarray(motion.closed)
    rows = []
    for name, joint in motion.mechanism.joints.items():
        for column, coordinate in enumerate(joint.coordinates):
            values = np.asarray(motion.coordinates[name])[closed, column]
            scale, unit = (1.0, motion.mechanism.unit) if is_length(coordinate) else (180 / np.pi, "deg")
            ends = (f"{scale * end:.3f}" for end in (values.min(), values.max())) if values.size else ("", "")
            rows.append((f"{name}.{coordinate}", *ends, unit))
    print_table(("coordinate", "least", "greatest", "unit"), rows, numbers=(1, 2))


def print_files(paths: Iterable[Path]) -> None:
    """The files written and their sizes."""
    print_table(("file", "kB"), [(str(path), f"{path.stat().st_size / 1000:.0f}") for path in paths], numbers=(1,))
