"""Checks of the names and connections that a structure is made from: ValueErrors that say what is wrong."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from jaxkin._arguments import several
from jaxkin._names import nearest
from jaxkin.topology.graph import Graph

MAX_MERGED = 3
"""Fixed parts that the name of their row names one by one: the paper's examples have two, and of the eighty fixed parts
of an assembly that was drawn with its bolts nobody reads the names in every loop."""


def check_letters(parts: str, joints: Sequence[tuple[str, str, str]], fixed: Sequence[str]) -> None:
    """Refuse a text in place of the names of parts where joints and fixed parts name more than letters: ValueError."""
    named = [*fixed, *(part for _, *ends in joints for part in ends)]
    if any(len(str(part)) > 1 for part in named):
        several(parts, "parts", "part names")


def check_names(parts: Sequence[str], joints: Sequence[tuple[str, str, str]], fixed: Sequence[str]) -> None:
    """Refuse names that are no texts, repeat or are unknown, a joint of a part with itself, and no fixed part:
    ValueError."""
    if not parts:
        raise ValueError("there are no parts; name at least one, and fix it")
    named = {"part": parts, "joint": [name for name, _, _ in joints], "fixed part": fixed}
    for what, names in named.items():
        if wrong := [name for name in names if not isinstance(name, str)]:
            raise ValueError(f"the name of a {what} must be a text, got {wrong[0]!r}; write {str(wrong[0])!r}")
        _refuse_repeats(what, names)
    known = set(parts)
    for name, part1, part2 in joints:
        for part in (part1, part2):
            if part not in known:
                raise ValueError(f"joint {name!r} names the unknown part {part!r}{nearest(part, parts)}")
        if part1 == part2:
            raise ValueError(f"joint {name!r} joins part {part1!r} to itself; name two different parts")
    if not fixed:
        raise ValueError(f"no part is fixed; name at least one part that does not move, such as fixed=[{parts[0]!r}]")
    for part in fixed:
        if part not in known:
            raise ValueError(f"there is no part {part!r} to fix{nearest(part, parts)}")
    merged = merged_name(parts, fixed)
    if merged in known and merged not in fixed:
        raise ValueError(f"part {merged!r} has the name that the fixed parts get together; rename it")


def check_chords(joints: Sequence[str], chords: Sequence[str] | None) -> None:
    """Refuse chords that repeat or are no joints: ValueError."""
    if isinstance(chords, str):
        raise ValueError(f"chords must be a list of joint names, got the text {chords!r}; write chords=[{chords!r}]")
    _refuse_repeats("chord", chords or ())
    for chord in chords or ():
        if chord not in joints:
            raise ValueError(f"there is no joint {chord!r} to be a chord{nearest(chord, joints)}")


def check_connected(graph: Graph, rows: Sequence[str], root: int) -> None:
    """Refuse a graph in which no chain of joints connects some parts to the row of the fixed ones: ValueError."""
    reached, stack = {root}, [root]
    while stack:
        for _, other in graph.around[stack.pop()]:
            if other not in reached:
                reached.add(other)
                stack.append(other)
    loose = [row for row in range(graph.rows) if row not in reached]
    if alone := [repr(rows[row]) for row in loose if not graph.around[row]]:
        raise ValueError(f"no joint holds {', '.join(alone)}; join every part to another, or leave it out")
    if loose:
        names = ", ".join(repr(rows[row]) for row in loose)
        raise ValueError(
            f"no chain of joints ties {names} to the fixed part {rows[root]!r}; add a joint, or fix one of them"
        )


def merged_name(parts: Iterable[str], fixed: Sequence[str]) -> str:
    """Name the row that stands for all fixed parts, in the order of the parts: "p1&p9".

    Of many the one is named that was fixed first: "base&87 more". What follows from it may be screws.
    """
    held = set(fixed)
    names = [part for part in parts if part in held]
    return "&".join(names) if len(names) <= MAX_MERGED else f"{fixed[0]}&{len(names) - 1} more"


def _refuse_repeats(what: str, names: Iterable[str]) -> None:
    if repeated := [name for name, count in Counter(names).items() if count > 1]:
        raise ValueError(f"{what} {repeated[0]!r} is named twice; every {what} needs a name of its own")
