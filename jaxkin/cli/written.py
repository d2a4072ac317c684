"""What `jaxkin inspect` writes beside what it prints: the report for the browser, and the study."""

from __future__ import annotations

import os
import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from jaxkin._names import listed
from jaxkin.cli.progress import progress

if TYPE_CHECKING:
    from jaxkin.assembly.assembly import Assembly
    from jaxkin.assembly.proposals import Proposal
    from jaxkin.contacts.contact import Contacts
    from jaxkin.io.study import Study
    from jaxkin.mechanism.mechanism import Mechanism


def draw(assembly: Assembly, contacts: Contacts, mechanism: Mechanism | None, png: Path) -> None:
    """Draw an assembly with its contacts, and with the axes of its joints where it makes a mechanism."""
    from jaxkin.view.inspection import draw_inspection

    with progress(1) as step:
        step(f"drawing {png.name}")
        draw_inspection(assembly, png, contacts=contacts, mechanism=mechanism)


def write_page(study: Study, tried: Sequence[Proposal], page: Path) -> None:
    """Write the report on a mechanism, with what it needs to move and what else was tried to be fixed."""
    from jaxkin.assembly.wheels import wheels_last
    from jaxkin.mechanism.describe import describe_mobility
    from jaxkin.view.inspection_page import inspection_page

    with progress(1) as step:
        step(f"writing {page.name}")
        mechanism = study.mechanism
        missing = ["\n".join(describe_mobility(mechanism))]
        if not study.ranges and (drivable := wheels_last(mechanism)):
            ranges = "a range for this" if len(drivable) == 1 else "one range for each of these"
            missing.append(f"To move it, give {ranges}: {listed(drivable)}")
        if tried:
            missing.append(f"No part was named to be fixed. The best of {len(tried)} choices: {tried[0]}")
        source = study.assembly.source if study.assembly else study.source
        inspection_page(mechanism, page, source=source, missing=missing, tried=[*map(str, tried)])


def write_refusal(assembly: Assembly, contacts: Contacts, page: Path, refusal: ValueError) -> None:
    """Write the report on an assembly that makes no mechanism yet, with the reason."""
    from jaxkin.view.inspection_page import inspection_page

    missing = [f"There is no mechanism yet. {refusal}"]
    inspection_page(assembly, page, source=assembly.source, missing=missing, contacts=contacts)


def check_no_study(files: Sequence[Path]) -> None:
    """Raise ValueError where a study is given, of which another one would be written."""
    if files[0].suffix.lower() == ".toml":
        raise ValueError(f"{files[0].name} is a study already: give the geometry that it names")


def write_study(
    study: Study, files: Sequence[Path], tried: Sequence[Proposal], target: Path, loops: Path | None = None
) -> str:
    """Write what was found as a study that names its geometry and the file of its loops from where it stands; say what
    can be done with it."""
    from jaxkin.io.study_drives import small_drive
    from jaxkin.io.study_writer import write_study

    from_there = [_from(target, file) for file in files]
    parts = dict(zip((file.stem for file in files), from_there, strict=True))
    mechanism = study.mechanism
    names = study.assembly.names if study.assembly else ()
    with progress(1) as step:
        step("trying what is open in the study")
        drive = small_drive(mechanism) if mechanism.solids else None
        write_study(
            mechanism,
            target,
            geometry=parts if len(files) > 1 else from_there[0],
            loops=None if loops is None else _from(target, loops),
            drive=drive,
            exclude=[name for name in names if name not in mechanism.parts],
            proposals=tried,
        )
    if not drive:
        return "Nothing drives in it yet: see its last lines."
    return f"Choose among its lines, then: jaxkin sweep {shlex.quote(str(target))} --out motion"


def _from(target: Path, file: Path) -> str:
    """Name a file as it is found from the folder of another one."""
    return os.path.relpath(file, target.parent).replace(os.sep, "/")
