"""What commands do between their options and what they print: the study asked for, its sweep, its files."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import typer

from jaxkin._files import make_folder
from jaxkin.cli.errors import about_input
from jaxkin.cli.options import Options
from jaxkin.cli.progress import CommandSteps, progress

if TYPE_CHECKING:
    from jaxkin.assembly.assembly import Assembly
    from jaxkin.assembly.proposals import Proposal
    from jaxkin.io.study import Study

LONG = 200_000
"""From more poses on a range is written as arrays only, chunk by chunk: pictures and tables of so many say nothing, and
the displacements of all parts may not fit into memory."""

MANY_PARTS = 600
"""Parts of an assembly from which on a command says that it takes its time: more than a minute."""


class _Written(NamedTuple):
    """What a sweep wrote, and what is printed of it."""

    paths: list[Path]
    tell: Callable[[], None]
    """Prints what became of the poses, and the effects."""
    more: str
    """How to go on, in one line."""
    failed: Mapping[str, str] = {}
    """The effects that could not be computed, each with the reason."""


def sweep(files: Sequence[Path], out: Path, options: Options) -> None:
    """Write the motion that files and options ask for into a folder, and print what became of it.

    An effect that cannot be computed keeps neither the motion nor other effects from being written. Raises ValueError
    for it at the end.
    """
    start = time.perf_counter()
    from jaxkin.cli import report

    with progress(3) as step:
        study = find_joints(files, options, step)
    long = len(next(iter(study.drive.values()))) > LONG
    if long and study.effects:
        raise ValueError(
            f"effects are computed of {LONG} poses at most: drive fewer, or leave out {', '.join(study.effects)}"
        )
    written = _streamed(study, out) if long else _swept(study, out)
    report.say(f"{named(files)}: {study.mechanism.mobility()}")
    report.print_inferences(study.mechanism)
    written.tell()
    report.say()
    report.print_files(written.paths)
    report.say(f"\nWritten in {time.perf_counter() - start:.1f} s. {written.more}")
    if written.failed:
        reasons = "".join(f"\n  {reason}" for reason in written.failed.values())
        raise ValueError(f"not computed: {', '.join(written.failed)}; all else is written{reasons}")


def _swept(study: Study, out: Path) -> _Written:
    """Write the motion in all its files, then its effects: none that fails keeps the motion from being written."""
    import jax

    from jaxkin.cli import report
    from jaxkin.io.named_effects import Result, compute, missing
    from jaxkin.io.writers import WRITERS

    results: dict[str, Result] = {}
    failed: dict[str, str] = {}
    with progress(1 + len(WRITERS) + len(study.effects)) as step:
        step("solving")
        motion, paths = jax.block_until_ready(study.sweep()), []
        for filename in WRITERS:
            step(f"writing {filename}")
            paths += motion.save(out, only=filename)
        for name in study.effects:
            step(f"computing {name}")
            try:
                results |= compute(motion, {name: study.effects[name]}, step.within)
            except ValueError as error:
                if not about_input(error):
                    raise
                failed[name] = str(error)
        for name, result in results.items():
            paths += [result.save(out / f"{name}.csv"), result.plot(out / f"{name}.png")]

    def tell() -> None:
        report.print_motion(motion)
        for result in results.values():
            report.say(f"\n{result}")
        left = missing(motion, study.effects)
        report.say(f"\n{left}" if left else "")

    return _Written(paths, tell, f"Open {out / 'motion.html'} in a browser.", failed)


def _streamed(study: Study, out: Path) -> _Written:
    """Write the motion chunk by chunk, as arrays only."""
    from jaxkin.cli import report
    from jaxkin.io.long_motion import write_stream

    make_folder(out)
    stream = study.mechanism.stream(study.drive)
    with progress(1 + len(stream)) as step:
        step("writing motion.npz")
        said = write_stream(stream, out / "motion.npz", lambda: step("writing motion.npz"))
    return _Written([out / "motion.npz"], partial(report.say, said), f"More than {LONG} poses: arrays only.")


def named(files: Sequence[Path]) -> str:
    """Name the first file by name, and how many more."""
    return files[0].name + (f" and {len(files) - 1} more" if len(files) > 1 else "")


def read(files: Sequence[Path], options: Options, step: CommandSteps) -> Study:
    """Make the study that files and options make: a step of the progress."""
    step(f"reading {named(files)}")
    study = options.on(files, step.within)
    if study.assembly and (parts := len(study.assembly.parts)) > MANY_PARTS:
        typer.echo(
            f"jaxkin: {study.assembly.source} has {parts} parts; 400 take half a minute, 1200 two minutes: to be "
            "quicker give what is fixed, --fixed PART, or export a part of the assembly",
            err=True,
        )
    return study


def find_contacts(study: Study, step: CommandSteps) -> None:
    """Find the contacts of a study once, here, where that is shown: a step of the progress."""
    step("finding contacts")
    if study.assembly and study.detect and not study.by_export:
        study.assembly.contacts(**study.tolerance, progress=step.within)


def find_joints(files: Sequence[Path], options: Options, step: CommandSteps) -> Study:
    """Make the study that files and options make, and find its contacts and joints: three steps of the progress."""
    study = read(files, options, step)
    check_fixed(study)
    find_contacts(study, step)
    step("finding joints")
    _ = study.mechanism
    return study


def proposed(study: Study, assembly: Assembly) -> tuple[Study, tuple[Proposal, ...]]:
    """Find the study with the parts fixed that do best of those that are tried; all proposals, which are printed
    too."""
    from jaxkin.assembly.proposals import grouped
    from jaxkin.cli import report

    with progress(1) as step:
        step("trying what to fix and to drive")
        found = assembly.without(study.exclude).proposals(progress=step.within)
    report.say("No part is fixed. What was tried, the best first:")
    for line in grouped(found):
        report.say(f"  {line}")
    report.say()
    return replace(study, fixed=found[0].fixed, ignore=[*study.ignore, *found[0].ignore]), found


def unlock(study: Study) -> None:
    """Print what takes back an inference of a study in which nothing can move, so that something can."""
    from jaxkin.assembly.proposals import grouped, unlocked
    from jaxkin.cli import report

    if not (study.assembly and study.infer and study.detect and study.combine) or study.by_export:
        return
    found = unlocked(study.mechanism, lambda pair: replace(study, ignore=[*study.ignore, pair]).mechanism, study.fixed)
    if found:
        report.say("\nInferences were taken back in turn:")
        for line in grouped(found):
            report.say(f"  {line}")


def check_fixed(study: Study) -> None:
    """Refuse a study in which no part is fixed: ValueError."""
    if study.assembly and not study.held:
        names = ", ".join(study.assembly.names)
        raise ValueError(f"no part is fixed: give --fixed PART, once or more; the parts are {names}")
