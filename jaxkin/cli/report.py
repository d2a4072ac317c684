"""What the command line prints: contacts, mechanisms, structures, motions."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table
from rich.text import Text

from jaxkin._grouped import first_of_each, grouped, kind_of
from jaxkin._names import counted
from jaxkin.assembly.gears import gear_proposals
from jaxkin.assembly.inference.inference import INFERRED
from jaxkin.assembly.near_misses import not_accounted_for, of_moving
from jaxkin.contacts.reason import advises_tolerance
from jaxkin.geometry.movements import is_length

if TYPE_CHECKING:
    from jaxkin.assembly.assembly import Assembly
    from jaxkin.contacts.contact import Contacts
    from jaxkin.mechanism.mechanism import Mechanism
    from jaxkin.mechanism.motion import Motion

_GEARS = 5
"""Gears that are printed at most, unless all are asked for: planets and gear boxes of assemblies have many alike."""
_TAKE_GEARS = "take them by mechanism.with_couplings([each.coupling for each in jk.gear_proposals(mechanism)]):"
"""How gears are coupled: from Python, or by [couplings] of a study, which are the equations printed."""

_GIVE_TOLERANCES = (
    "such tolerances are given in a study without contacts = false, as in tolerance = { length = 0.001 }, or in "
    "Python, as in assembly.contacts(length=0.001); they hold for all faces"
)
"""How to follow the advice of near misses."""


def say(text: str = "") -> None:
    """Print text as it is: no markup, no colours, no wrapping."""
    Console().print(Text(text), soft_wrap=True)


def print_assembly(assembly: Assembly, contacts: Contacts | None, verbose: bool) -> None:
    """Print parts and their faces, contacts and refusals; what is said with a part is not said again."""
    if contacts is None:
        say(f"{assembly.describe(verbose)}\n")
        return
    said = {f"{part.name}: {note}" for part in assembly.parts for note in part.notes}
    notes = tuple(note for note in contacts.notes if note not in said)
    say(f"{assembly.describe(verbose)}\n\n{replace(contacts, near_misses=(), notes=notes).describe(verbose)}\n")


def print_near_misses(contacts: Contacts, mechanism: Mechanism | None, verbose: bool) -> None:
    """Print pairs of faces that are nearly in contact; by their number only those that a mechanism accounts for.

    See `not_accounted_for`; the mechanism tells only the others, too.
    """
    every = contacts.near_misses if mechanism is None else of_moving(contacts.near_misses, mechanism)
    if not every:
        return
    left = every if mechanism is None else not_accounted_for(every, mechanism)
    known = f", {len(every) - len(left)} of them of bodies and joints that are known otherwise"
    known = f"{known}{'' if verbose else ' (all: --verbose)'}" if len(left) < len(every) else ""
    say(f"\n{counted(len(every), 'near miss', 'no')}{known}")
    shown = [((miss.state, kind_of(miss.reason)), str(miss)) for miss in (every if verbose else left)]
    for line in grouped(shown, verbose):
        say(f"  {line}")
    if any(advises_tolerance(line) for _, line in shown):
        say(f"  {_GIVE_TOLERANCES}")


def print_mechanism(mechanism: Mechanism, contacts: Contacts, verbose: bool) -> None:
    """Print joints, loops, mobility and notes, but for the notes that were told with the contacts."""
    said = {*map(str, of_moving(contacts.near_misses, mechanism)), *contacts.notes}
    history, alignment = (
        tuple(note for note in notes if note not in said) for notes in (mechanism.history, mechanism.alignment)
    )
    say(replace(mechanism, history=history, alignment=alignment).describe(verbose))


def print_inferences(mechanism: Mechanism) -> None:
    """Print what was inferred beside exact contacts, counted by kind, with the first of each kind."""
    found = [note for note in mechanism.history if note.startswith(INFERRED)]
    if found:
        say(f"{len(found)} inferred beside exact contacts (all: jaxkin inspect --verbose):")
        for line in first_of_each((note.split(": ")[1], note) for note in found):
            say(f"  {line}")


def print_gears(mechanism: Mechanism, verbose: bool) -> None:
    """Print the gears that solids of a mechanism may be, with their teeth and ratios, which nothing couples yet: five
    at most, all with `verbose`."""
    found = gear_proposals(mechanism)
    if not found:
        return
    gears = "1 gear" if len(found) == 1 else f"{len(found)} gears"
    say(f"\n{gears} may mesh, of which nothing is coupled yet; {_TAKE_GEARS}")
    shown = found if verbose else found[:_GEARS]
    for each in shown:
        say(f"  {each}" + ("" if each.ratio is None else f"; ratio {each.ratio:.4g}"))
    if len(shown) < len(found):
        say(f"  and {len(found) - len(shown)} more (all: jaxkin inspect --verbose)")


def print_structure(mechanism: Mechanism) -> None:
    """Print the tree with the path of each loop, and a table: what closes each loop, and which loops share joints with
    it."""
    structure, mobility = mechanism.structure, mechanism.mobility()
    parts, joints, loops = len(structure.parts), len(structure.joints), len(structure.loops)
    rows = f"{parts} parts (all fixed ones are one)" if len(structure.fixed) > 1 else f"{parts} parts"
    say(f"{rows}, {joints} joints; independent loops: {joints} - {parts} + 1 = {loops}\n")
    say(f"{structure}\n")
    held = [{joint for joint, _ in loop.joints} for loop in structure.loops]
    rows = []
    for number, (loop, kind) in enumerate(zip(structure.loops, mobility.subgroups, strict=True)):
        others = [f"l{k + 1}" for k, joints in enumerate(held) if k != number and joints & held[number]]
        shares = ", ".join(others) or "none"
        rows.append((f"l{number + 1}", loop.path[0], str(len(loop.joints)), f"{kind.name} ({kind.dimension})", shares))
    if rows:
        print_table(("loop", "starts at", "joints", "moves in (equations)", "shares joints with"), rows, numbers=(2,))
        say()
    say(f"Mobility: {mobility}")


def print_table(headings: Iterable[str], rows: Iterable[Iterable[str]], numbers: Iterable[int] = ()) -> None:
    """Print rows under headings; columns named by index in `numbers` are aligned to the right."""
    table = Table(box=SIMPLE_HEAD, pad_edge=False, show_edge=False)
    for index, heading in enumerate(headings):
        table.add_column(heading, overflow="fold", justify="right" if index in set(numbers) else "left")
    for row in rows:
        table.add_row(*(Text(cell) for cell in row))
    Console(highlight=False).print(table)


def print_motion(motion: Motion) -> None:
    """Print what became of the poses, and the range that each joint coordinate runs through in those on the branch, if
    there are any."""
    say(str(motion))
    closed = np.asarray(motion.on_branch)
    if not closed.any():
        return
    say()
    rows = []
    for name, joint in motion.mechanism.joints.items():
        for column, coordinate in enumerate(joint.coordinates):
            values = np.asarray(motion.coordinates[name])[closed, column]
            scale, unit = (1.0, motion.mechanism.unit) if is_length(coordinate) else (180 / np.pi, "deg")
            ends = (f"{scale * end:z.3f}" for end in (values.min(), values.max()))
            rows.append((joint.full_names[column], *ends, unit))
    print_table(("coordinate", "least", "greatest", "unit"), rows, numbers=(1, 2))


def print_files(paths: Iterable[Path]) -> None:
    """Print the files written and their sizes."""
    print_table(("file", "kB"), [(str(path), f"{path.stat().st_size / 1000:.0f}") for path in paths], numbers=(1,))
