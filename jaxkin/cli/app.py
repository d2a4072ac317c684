"""The commands: what each is called with, does and prints."""

from __future__ import annotations

import importlib.metadata
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from jaxkin.cli import run
from jaxkin.cli.arguments import (
    Drawing,
    Drive,
    Effects,
    ExactOnly,
    Exclude,
    Files,
    Fixed,
    Ignore,
    LoopsFile,
    Out,
    Page,
    PerContact,
    Picture,
    Rigid,
    Seconds,
    StudyFileOption,
    Unit,
    Verbose,
    Version,
    WorkPicture,
)
from jaxkin.cli.errors import one_line_errors
from jaxkin.cli.options import Options
from jaxkin.cli.progress import progress

if TYPE_CHECKING:
    from jaxkin.assembly.proposals import Proposal

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Kinematics of mechanisms: from solid models to joints, loops and motion.",
)


@app.callback(invoke_without_command=True)
def before_commands(version: Version = False) -> None:
    if version:
        typer.echo(f"jaxkin {importlib.metadata.version('jaxkin')}")
        raise typer.Exit


@app.command(epilog="Example:  jaxkin demo --out motion")
def demo(out: Out = Path("jaxkin-demo")) -> None:
    """Sweep the four-bar linkage that comes with jaxkin through a full turn, and write its motion."""
    from jaxkin.examples import EXAMPLES, path

    example = EXAMPLES["fourbar"]
    with one_line_errors():
        options = Options(fixed=list(example.fixed), drive=[f"{'-'.join(example.drive)}=0:360:361"])
        run.sweep([path("fourbar")], out, options)


@app.command(
    epilog="Examples:  jaxkin inspect fourbar.step --fixed ground --page report.html, "
    "jaxkin inspect crank.stl rod.stl frame.stl --unit mm"
)
def inspect(
    files: Files,
    fixed: Fixed = [],
    rigid: Rigid = [],
    ignore: Ignore = [],
    exclude: Exclude = [],
    exact_only: ExactOnly = False,
    no_combine: PerContact = False,
    unit: Unit = None,
    loops_file: LoopsFile = None,
    seconds: Seconds = None,
    png: Picture = None,
    page: Page = None,
    study_file: StudyFileOption = None,
    verbose: Verbose = False,
) -> None:
    """Print what is found in an assembly: faces, contacts, joints, loops, mobility, and what was refused and why.

    Of large assemblies counts come first, and of many parts, contacts and notes of one kind the first stands for all.
    Without --fixed it proposes what to fix and to drive, found by trying, and goes on with the best of it.
    """
    with one_line_errors():
        from jaxkin.cli import report, written

        if study_file:
            written.check_no_study(files)
        with progress(2) as step:
            options = Options(fixed, rigid, ignore, exclude, exact_only, no_combine, unit, loops_file, seconds)
            study = run.read(files, options, step)
            run.find_contacts(study, step)
            contacts = study.contacts
        if study.assembly:
            report.print_assembly(study.assembly, None if study.by_export else contacts, verbose)
        tried: tuple[Proposal, ...] = ()
        try:  # only now: what stands above helps to see why the mechanism is refused
            if study.assembly and not study.held:
                study, tried = run.proposed(study, study.assembly)
            report.print_mechanism(study.mechanism, contacts, verbose)
            if not tried:
                run.unlock(study)
            report.print_near_misses(contacts, study.mechanism, verbose)
            report.print_gears(study.mechanism, verbose)
        except ValueError as refusal:
            report.print_near_misses(contacts, None, verbose)
            if png and study.assembly:
                written.draw(study.assembly, contacts, None, png)
                report.say(f"\nWritten: {png}.")
            if page and study.assembly:
                written.write_refusal(study.assembly, contacts, page, refusal)
                report.say(f"\nWritten: {page}. Open it in a browser.")
            raise
        if png and study.assembly:
            written.draw(study.assembly, contacts, study.mechanism, png)
            report.say(f"\nWritten: {png}.")
        if page:
            written.write_page(study, tried, page)
            report.say(f"\nWritten: {page}. Open it in a browser.")
        if study_file:
            said = written.write_study(study, files, tried, study_file, loops_file)
            report.say(f"\nWritten: {study_file}. {said}")


@app.command(epilog="Example:  jaxkin loops fourbar.step --fixed ground --png loops.png")
def loops(
    files: Files,
    fixed: Fixed = [],
    rigid: Rigid = [],
    ignore: Ignore = [],
    exclude: Exclude = [],
    exact_only: ExactOnly = False,
    drive: Drive = [],
    no_combine: PerContact = False,
    unit: Unit = None,
    loops_file: LoopsFile = None,
    seconds: Seconds = None,
    png: Drawing = None,
) -> None:
    """Print the structure of an assembly: its closed loops, what hangs on them, the tree of both, and its mobility.

    With a drive also its plan: which loops it moves, and in which groups and order they can be solved.
    """
    with one_line_errors():
        from jaxkin.cli import report

        options = Options(fixed, rigid, ignore, exclude, exact_only, no_combine, unit, loops_file, seconds, drive)
        with progress(3) as step:
            study = run.find_joints(files, options, step)
        if png:
            study.mechanism.structure.plot(png)
        report.print_structure(study.mechanism)
        if study.ranges:
            report.say(f"\n{study.mechanism.plan(study.ranges)}")
        if png:
            report.say(f"\nWritten: {png}.")


@app.command(epilog="Example:  jaxkin accuracy fourbar.step --fixed ground --drive ground-crank=0:360:361")
def accuracy(
    files: Files,
    fixed: Fixed = [],
    rigid: Rigid = [],
    ignore: Ignore = [],
    exclude: Exclude = [],
    exact_only: ExactOnly = False,
    drive: Drive = [],
    no_combine: PerContact = False,
    unit: Unit = None,
    loops_file: LoopsFile = None,
    seconds: Seconds = None,
    png: WorkPicture = None,
) -> None:
    """Print what accuracy costs in time: the sweep at many tolerances, in both precisions and by several methods."""
    with one_line_errors():
        from jaxkin.cli import report
        from jaxkin.effects.accuracy import combinations, work_precision

        options = Options(fixed, rigid, ignore, exclude, exact_only, no_combine, unit, loops_file, seconds, drive)
        with progress(3 + len(combinations())) as step:
            study = run.find_joints(files, options, step)
            work = work_precision(study.mechanism, study.drive, step=step)
        if png:
            work.plot(png)
        report.say(str(work))
        if png:
            report.say(f"\nWritten: {png}.")


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
    exclude: Exclude = [],
    exact_only: ExactOnly = False,
    drive: Drive = [],
    no_combine: PerContact = False,
    unit: Unit = None,
    loops_file: LoopsFile = None,
    seconds: Seconds = None,
    effects: Effects = [],
) -> None:
    """Move an assembly through a range of displacements of some joints, and write its motion.

    Written are arrays (motion.npz), a table (motion.csv), an animation
    (motion.glb), a page for the browser (motion.html), a picture (motion.png) and
    a chart of the joints (coordinates.png). Of more than 200,000 poses only
    arrays are written, without those of the parts. Effects are computed only
    where they are asked for.
    """
    with one_line_errors():
        options = Options(
            fixed, rigid, ignore, exclude, exact_only, no_combine, unit, loops_file, seconds, drive, effects
        )
        run.sweep(files, out, options)
