"""The commands and their options."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from jaxkin.cli.errors import one_line_errors
from jaxkin.cli.options import Options

if TYPE_CHECKING:
    from jaxkin.io.study import Study

LONG = 200_000
"""From more poses on a range is written as arrays only, chunk by chunk: pictures and tables of so many say nothing, and
the displacements of all parts may not fit into memory."""

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Kinematics of mechanisms: from solid models to joints, loops and motion.",
)

Files = Annotated[
    list[Path],
    typer.Argument(
        metavar="FILE...",
        help="The assembled mechanism: a STEP file or a mesh (.stl, .obj, .ply, .3mf, .glb) of all parts, or several "
        "files of one part each, called as the files. Or a study: a TOML file that names the geometry and says what is "
        "fixed, rigid, ignored and driven. Options add to what a study says; --drive replaces its drive.",
    ),
]
Unit = Annotated[
    str | None,
    typer.Option("--unit", metavar="UNIT", help="Of lengths, for STL, OBJ and PLY, which have none: mm, m, in, ..."),
]
Fixed = Annotated[
    list[str], typer.Option("--fixed", metavar="PART", help="A part that does not move; may be given several times.")
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
Out = Annotated[Path, typer.Option("--out", metavar="DIR", file_okay=False, help="Folder for the files written.")]
PerContact = Annotated[
    bool,
    typer.Option("--no-combine", help="Keep one joint per contact, as in the paper, not one per pair of parts."),
]

Picture = Annotated[
    Path | None,
    typer.Option(
        "--png",
        metavar="FILE",
        dir_okay=False,
        help="Draw the assembly with the regions of its contacts and the axes of its joints into this file.",
    ),
]
Drawing = Annotated[
    Path | None,
    typer.Option(
        "--png",
        metavar="FILE",
        dir_okay=False,
        help="Draw the graph of parts and joints with its loops, and their tree, into this file.",
    ),
]


WorkPicture = Annotated[
    Path | None,
    typer.Option("--png", metavar="FILE", dir_okay=False, help="Draw time against error into this file."),
]


@app.command(epilog="Example:  jaxkin demo --out motion")
def demo(out: Out = Path("jaxkin-demo")) -> None:
    """Sweep the four-bar linkage that comes with jaxkin through a full turn, and write its motion."""
    from jaxkin.examples import EXAMPLES, path

    example = EXAMPLES["fourbar"]
    with one_line_errors():
        options = Options(fixed=list(example.fixed), drive=[f"{'-'.join(example.drive)}=0:360:361"])
        _sweep([path("fourbar")], out, options)


@app.command(
    epilog="Examples:  jaxkin inspect fourbar.step --fixed ground --png found.png, "
    "jaxkin inspect crank.stl rod.stl frame.stl --unit mm"
)
def inspect(
    files: Files,
    fixed: Fixed = [],
    rigid: Rigid = [],
    ignore: Ignore = [],
    no_combine: PerContact = False,
    unit: Unit = None,
    png: Picture = None,
) -> None:
    """Print what is found in an assembly: faces, contacts, joints, loops, mobility, and what was refused and why."""
    with one_line_errors():
        from jaxkin.cli import report

        with _progress(2) as step:
            step(f"reading {_named(files)}")
            study = Options(fixed, rigid, ignore, no_combine=no_combine, unit=unit).on(files)
            step("finding contacts")
            contacts = study.contacts
        if study.assembly:
            report.print_contacts(study.assembly, contacts)
        # only now: what stands above helps to see why the mechanism is refused
        if png and study.assembly:
            from jaxkin.view.inspection import draw_inspection

            draw_inspection(study.assembly, png, contacts=contacts, mechanism=study.mechanism if study.fixed else None)
        report.print_mechanism(_checked(study).mechanism, contacts)


@app.command(epilog="Example:  jaxkin loops fourbar.step --fixed ground --png loops.png")
def loops(
    files: Files,
    fixed: Fixed = [],
    rigid: Rigid = [],
    ignore: Ignore = [],
    drive: Drive = [],
    no_combine: PerContact = False,
    unit: Unit = None,
    png: Drawing = None,
) -> None:
    """Print the structure of an assembly: its closed loops, what hangs on them, the tree of both, and its mobility.

    With a drive also its plan: which loops it moves, and in which groups and order they can be solved.
    """
    with one_line_errors():
        from jaxkin.cli import report

        with _progress(2) as step:
            study = _found(files, Options(fixed, rigid, ignore, drive, no_combine, unit), step)
        if png:
            from jaxkin.view.structure import draw_structure

            draw_structure(study.mechanism.structure, png)
        report.print_structure(study.mechanism)
        if study.ranges:
            report.say(f"\n{study.mechanism.plan(study.ranges)}")


@app.command(epilog="Example:  jaxkin accuracy fourbar.step --fixed ground --drive ground-crank=0:360:361")
def accuracy(
    files: Files,
    fixed: Fixed = [],
    rigid: Rigid = [],
    ignore: Ignore = [],
    drive: Drive = [],
    no_combine: PerContact = False,
    unit: Unit = None,
    png: WorkPicture = None,
) -> None:
    """Print what accuracy costs in time: the sweep at many tolerances, in both precisions and by several methods."""
    with one_line_errors():
        from jaxkin.cli import report
        from jaxkin.effects.accuracy import combinations, work_precision

        with _progress(2 + len(combinations())) as step:
            study = _found(files, Options(fixed, rigid, ignore, drive, no_combine, unit), step)
            work = work_precision(study.mechanism, study.drive, step=step)
        if png:
            work.plot(png)
        report.say(str(work))


@app.command(
    epilog="Examples:  jaxkin sweep fourbar.step --fixed ground --drive ground-crank=0:360:361 --out motion, "
    "jaxkin sweep study.toml --out motion"
)
def sweep(
    files: Files,
    out: Out,
    fixed: Fixed = [],
    rigid: Rigid = [],
    ignore: Ignore = [],
    drive: Drive = [],
    no_combine: PerContact = False,
    unit: Unit = None,
) -> None:
    """Move an assembly through a range of displacements of some joints, and write its motion.

    Written are arrays (motion.npz), a table (motion.csv), an animation (motion.glb), a page for the browser
    (motion.html) and a picture (motion.png). Of more than 200,000 poses only arrays are written, without those of the
    parts.
    """
    with one_line_errors():
        _sweep(files, out, Options(fixed, rigid, ignore, drive, no_combine, unit))


def _sweep(files: Sequence[Path], out: Path, options: Options) -> None:
    start = time.perf_counter()
    import jax

    from jaxkin.cli import report
    from jaxkin.motion.writers import filenames

    with _progress(2) as step:
        study = _found(files, options, step)
    if len(next(iter(study.drive.values()))) > LONG:
        said, paths = _streamed(study, out)
    else:
        with _progress(1 + len(filenames())) as step:
            step("solving")
            motion = jax.block_until_ready(study.sweep())
            said, paths = motion, []
            for filename in filenames():
                step(f"writing {filename}")
                paths += motion.save(out, only=filename)
    report.say(f"{_named(files)}: {study.mechanism.mobility()}")
    if isinstance(said, str):
        report.say(said)
        more = f"More than {LONG} poses: arrays only."
    else:
        report.print_motion(said)
        more = f"Open {out / 'motion.html'} in a browser."
    report.say()
    report.print_files(paths)
    report.say(f"\nWritten in {time.perf_counter() - start:.1f} s. {more}")


def _streamed(study: Study, out: Path) -> tuple[str, list[Path]]:
    """The motion written chunk by chunk, as arrays only; what became of the poses, and the file."""
    from jaxkin.io.long_motion import write_stream

    out.mkdir(parents=True, exist_ok=True)
    stream = study.mechanism.stream(study.drive)
    with _progress(1 + len(stream)) as step:
        step("writing motion.npz")
        said = write_stream(stream, out / "motion.npz", lambda: step("writing motion.npz"))
    return said, [out / "motion.npz"]


def _named(files: Sequence[Path]) -> str:
    return files[0].name + (f" and {len(files) - 1} more" if len(files) > 1 else "")


def _found(files: Sequence[Path], options: Options, step: Callable[[str], None]) -> Study:
    """The study that files and options make, its mechanism found: two steps of the progress."""
    step(f"reading {_named(files)}")
    study = options.on(files)
    step("finding contacts and joints")
    _ = _checked(study).mechanism  # found once, here, where its step is shown
    return study


def _checked(study: Study) -> Study:
    """The study, if a part is fixed."""
    if study.assembly and not study.fixed:
        names = ", ".join(study.assembly.names)
        raise ValueError(f"no part is fixed: give --fixed PART, once or more; the parts are {names}")
    return study


@contextmanager
def _progress(steps: int) -> Iterator[Callable[[str], None]]:
    """A bar on the terminal, gone when done; call what it yields at the beginning of each step."""
    from rich.console import Console
    from rich.progress import Progress

    console = Console(stderr=True)
    if not console.is_terminal:
        yield lambda text: None
        return
    with Progress(console=console, transient=True) as progress:
        task = progress.add_task("", total=steps, completed=-1)
        yield lambda text: progress.update(task, description=text, advance=1)
