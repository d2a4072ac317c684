"""Contacts that a user leaves out: faces that touch only in the modelled pose break assumption 4 of the paper."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from itertools import product

from jaxkin._arguments import several
from jaxkin._names import closest, counted, match_parts, may_be_pattern, nearest
from jaxkin.contacts.contact import Contact
from jaxkin.geometry.part import Part

Entry = tuple[tuple[str, str], ...]
"""The pairs that an entry of `ignore` stands for: one, unless a side is a pattern."""

Sides = tuple[tuple[str, str], tuple[str, str]]
"""What each of the two sides of a contact may be called: its part, and the part with the face."""


def without(contacts: Sequence[Contact], ignore: Sequence[Sequence[str]]) -> tuple[Contact, ...]:
    """Keep the contacts but for those between the two sides of an entry of `ignore`.

    A side is a part, "stop", for all of its contacts with the other side, or one of its faces as reports print it,
    "stop face 7".
    """
    return tuple(each for each in contacts if not any(_is_between(_sides(each), one, other) for one, other in ignore))


def check_ignored(
    contacts: Sequence[Contact],
    ignore: Sequence[Entry],
    beside: Collection[frozenset[str]] = (),
    what: str = "contact",
) -> None:
    """Refuse what leaves nothing out: ValueError for an entry none of whose pairs has a contact, or is one of the pairs
    of parts `beside`, between which something else is left out. `what` names both in the message."""
    sides = [_sides(contact) for contact in contacts]
    for entry in ignore:
        if not any(frozenset(pair) in beside or any(_is_between(each, *pair) for each in sides) for pair in entry):
            one, other = entry[0]
            like = f", nor between {counted(len(entry) - 1, 'other pair')} that they stand for" if entry[1:] else ""
            raise ValueError(
                f"there is no {what} between {one!r} and {other!r}{like} to ignore, and nothing is inferred there"
                f"{_instead(sides, beside, one, other)}"
            )


def ignored_in_full(ignore: Sequence[Sequence[str]], parts: Sequence[Part]) -> tuple[Entry, ...]:
    """List the pairs of names in full that each entry stands for, whose sides may be patterns with "*", "?" or "/".

    Raises ValueError for what is no list of pairs of names, and for a pattern that no part matches.
    """
    known = {part.name for part in parts}
    entries: list[Entry] = []
    for pair in several(ignore, "ignore", "pairs of parts or of their faces", '[["slider", "stop"]]'):
        if not isinstance(pair, tuple | list) or len(pair) != 2 or not all(isinstance(name, str) for name in pair):
            raise ValueError(
                'ignore must be a list of pairs of parts or of their faces, such as [["slider", "stop"]] or '
                f'[["slider face 3", "stop face 7"]], got {ignore!r}'
            )
        full = [match_parts(name, parts, "ignore") if _is_pattern(name, known) else (name,) for name in pair]
        entries.append(tuple((one, other) for one, other in product(*full) if one != other or len(full[0]) == 1))
    return tuple(entries)


def _is_pattern(name: str, known: Collection[str]) -> bool:
    """Tell whether a side is a pattern, and neither a part nor a face of one whose name has "*", "?" or "/" in it."""
    return may_be_pattern(name) and not any(name == part or name.startswith(f"{part} face ") for part in known)


def _sides(contact: Contact) -> Sides:
    (part1, part2), (face1, face2) = contact.parts, contact.faces
    return (part1, f"{part1} {face1}"), (part2, f"{part2} {face2}")


def _is_between(sides: Sides, one: str, other: str) -> bool:
    return any(one in first and other in second for first, second in (sides, sides[::-1]))


def _instead(sides: Sequence[Sides], beside: Collection[frozenset[str]], one: str, other: str) -> str:
    """Write the end of the message: what a misspelt side may be meant for, or what the first side does touch."""
    parts = dict.fromkeys([*(part for pair in sides for part, _ in pair), *sorted(frozenset().union(*beside))])
    known = dict.fromkeys([*(name for pair in sides for side in pair for name in side), *parts])
    if not known:
        return "; no two parts touch each other"
    for name in (one, other):
        if name not in known:
            return closest(name, known) or nearest(name, parts)
    touching = [second for pair in sides for first, second in (pair, pair[::-1]) if one in first]
    names = ", ".join(dict.fromkeys(repr(part) for part, _ in touching))
    return f"; {one!r} touches {names}" if names else ""
