"""Bodies: parts that are declared rigidly connected form one, and so do all fixed parts (Section 4.1)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from jaxkin._names import nearest


def bodies(parts: Sequence[str], fixed: Sequence[str], rigid: Sequence[Sequence[str]] = ()) -> Mapping[str, str]:
    """Map each part to the first part, in the order of `parts`, of the body that it belongs to.

    `rigid` holds groups of parts that do not move relative to each other; groups that share a part form one body.
    Raises ValueError for a group that is no list of two or more known parts.
    """
    body = {part: part for part in parts}
    order = {part: place for place, part in enumerate(parts)}
    for group in (fixed, *checked_groups(parts, rigid)):
        joined = {body[part] for part in group}
        first = min(joined, key=order.__getitem__)
        body = {part: first if owner in joined else owner for part, owner in body.items()}
    return body


def checked_groups(parts: Sequence[str], rigid: Sequence[Sequence[str]]) -> Sequence[Sequence[str]]:
    """Return the groups if each is a list of two or more known parts; raise ValueError otherwise."""
    if isinstance(rigid, str) or any(isinstance(group, str) for group in rigid):
        raise ValueError(f'rigid must be a list of groups of parts, such as [["bolt", "plate"]], got {rigid!r}')
    for group in rigid:
        if len(set(group)) < 2:
            raise ValueError(f"rigid connects two parts or more, got the group {list(group)!r}")
        for part in group:
            if part not in parts:
                raise ValueError(f"rigid names the unknown part {part!r}{nearest(part, parts)}")
    return rigid
