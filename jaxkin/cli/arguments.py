"""The arguments and options that commands share, each with its help."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import typer
from typer.models import OptionInfo

Files = Annotated[
    list[Path],
    typer.Argument(
        metavar="FILE...",
        help="The assembled mechanism: a STEP file or a mesh (.stl, .obj, .ply, .3mf, .glb) of all parts, or several "
        "files of one part each, called as the files. Or what a CAD system exports for Simscape Multibody: an XML file "
        "with joints and mates, beside the files of its parts. Or a robot (URDF, MJCF, SDF), or an assembly of FreeCAD "
        "(.FCStd, .asmt). Or a study: a TOML file that names the geometry and says what is fixed, rigid, "
        "ignored and driven. Options add to what a study says; --drive replaces its drive.",
    ),
]
Unit = Annotated[
    str | None,
    typer.Option(
        "--unit", metavar="UNIT", help="Unit of lengths of STL, OBJ, PLY and ASMT files, which have none: mm, m, ..."
    ),
]
LoopsFile = Annotated[
    Path | None,
    typer.Option(
        "--loops",
        metavar="FILE",
        help="The YAML file that closes the loops of a robot in URDF, which is a tree, and names its motors.",
    ),
]
Seconds = Annotated[
    float | None,
    typer.Option(
        "--seconds",
        metavar="N",
        help="Processor seconds that reading each file may take; by default 20, and 5 for each megabyte of it.",
    ),
]
Fixed = Annotated[
    list[str],
    typer.Option(
        "--fixed",
        metavar="PART",
        help='A part that does not move, or "Base*" for all parts whose names match; may be given several times.',
    ),
]
Rigid = Annotated[
    list[str],
    typer.Option(
        "--rigid",
        metavar="PART,PART",
        help="Parts that do not move relative to each other; may be given several times.",
    ),
]
Ignore = Annotated[
    list[str],
    typer.Option(
        "--ignore",
        metavar="PART,PART",
        help="Contacts to leave out: all between two parts, or one, as in 'slider face 3 - stop face 7'; may be given "
        "several times.",
    ),
]
Exclude = Annotated[
    list[str],
    typer.Option("--exclude", metavar="PART", help="A part to leave out; may be given several times."),
]
ExactOnly = Annotated[
    bool,
    typer.Option(
        "--exact-only",
        help="Take contacts that fit exactly only, as in the paper; infer no pins with play, bolts, or parts that "
        "others hold.",
    ),
]
Drive = Annotated[
    list[str],
    typer.Option(
        "--drive",
        metavar="JOINT=RANGE",
        help="A joint, or joint.coordinate, and its displacements from the assembled pose, START:STOP:COUNT or a list "
        "with commas: degrees for angles, the unit of the file for lengths. May be given several times; all ranges "
        "need the same number of poses.",
    ),
]
Effects = Annotated[
    list[str],
    typer.Option(
        "--effects",
        metavar="NAME,NAME",
        help="What to compute beside the motion: rates (velocities and accelerations), clashes (parts that cut each "
        "other, and clearances), contacts (those that end), forces (of the drive and in joints; a study says the "
        "density). Each is printed, and written as a table and a picture.",
    ),
]
Out = Annotated[Path, typer.Option("--out", metavar="DIR", file_okay=False, help="Folder for the files written.")]
PerContact = Annotated[
    bool,
    typer.Option("--no-combine", help="Keep one joint per contact, as in the paper, not one per pair of parts."),
]


Version = Annotated[bool, typer.Option("--version", help="Print the version, and do nothing else.")]
Verbose = Annotated[
    bool, typer.Option("--verbose", help="List everything: every part, contact and note, however many there are.")
]


def _ending(suffix: str, what: str) -> Callable[[Path | None], Path | None]:
    """Make a check of the name of a file to write: a wrong one is refused before anything is computed."""

    def check(path: Path | None) -> Path | None:
        if path is not None and path.suffix.lower() != suffix:
            raise typer.BadParameter(f"{what}: name a file that ends in {suffix}, got {path}")
        if path is not None and not path.parent.is_dir():
            raise typer.BadParameter(f"there is no folder {path.parent} for {path.name}: make it, or name another")
        return path

    return check


StudyFileOption = Annotated[
    Path | None,
    typer.Option(
        "--study",
        metavar="FILE",
        dir_okay=False,
        callback=_ending(".toml", "a study is a TOML file"),
        help="Write all that was found as a study that jaxkin sweep runs: bodies, joints with what each is known from, "
        "a drive, and as lines to uncomment what else could be fixed, driven, turned off or left out.",
    ),
]


def _drawn(what: str) -> OptionInfo:
    check = _ending(".png", "the picture is a PNG")
    return typer.Option("--png", metavar="FILE", dir_okay=False, callback=check, help=f"Draw {what} into this file.")


Page = Annotated[
    Path | None,
    typer.Option(
        "--page",
        metavar="FILE",
        dir_okay=False,
        callback=_ending(".html", "the report is a page for the browser"),
        help="Write a report for the browser: the assembly in 3D, with each body, joint and assumption to click on. "
        "Also where nothing can move yet: then it says what is missing.",
    ),
]
Picture = Annotated[Path | None, _drawn("the assembly with the regions of its contacts and the axes of its joints")]
Drawing = Annotated[Path | None, _drawn("the graph of parts and joints with its loops, and their tree,")]
WorkPicture = Annotated[Path | None, _drawn("time against error")]
