"""Bodies: parts that are declared rigidly connected form one, and so do all fixed parts (Section 4.1)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from jaxkin._names import nearest
from jaxkin.topology.components import connected


def bodies(parts: Sequence[str], fixed: Sequence[str], rigid: Sequence[Sequence[str]] = ()) -> Mapping[str, str]:
    """Map each part to the first part, in the order of `parts`, of the body that it belongs to.

    `rigid` holds groups of parts that do not move relative to each other; groups that share a part form one body.
    Raises ValueError for a group that is no list of two or more known parts.
    """
    order = {part: place for place, part in enumerate(parts)}
    groups = [tuple(group) for group in (fixed, *checked_groups(parts, rigid))]
    joined = connected(parts, [(group[0], part) for group in groups for part in group])
    first = {part: min(group, key=order.__getitem__) for group in joined for part in group}
    return {part: first[part] for part in parts}


def checked_groups(parts: Sequence[str], rigid: Sequence[Sequence[str]]) -> Sequence[Sequence[str]]:
    """Return the groups if each is a list of two or more known parts; raise ValueError otherwise."""
    if isinstance(rigid, str) or any(isinstance(group, str) for group in rigid):
        raise ValueError(f'rigid must be a list of groups of parts, such as [["bolt", "plate"]], got {rigid!r}')
    known = set(parts)
    for group in rigid:
        if len(set(group)) < 2:
            raise ValueError(f"rigid connects two parts or more, got the group {list(group)!r}")
        for part in group:
            if part not in known:
                raise ValueError(f"rigid names the unknown part {part!r}{nearest(part, parts)}")
    return rigid


def members(body_of: Mapping[str, str]) -> dict[str, tuple[str, ...]]:
    """List the parts of each body, from the body of each part."""
    found: dict[str, tuple[str, ...]] = {}
    for part, body in body_of.items():
        found[body] = (*found.get(body, ()), part)
    return found


def body_of_parts(found: Mapping[str, Sequence[str]]) -> dict[str, str]:
    """Map each part to its body, from the parts of each body: the inverse of `members`."""
    return {part: body for body, parts in found.items() for part in parts}
