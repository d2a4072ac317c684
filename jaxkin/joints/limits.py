"""Limits of the coordinates of joints by hand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from jaxkin._names import nearest
from jaxkin.joints.joint import Joint

GivenLimits = Sequence[float | int] | Mapping[str, Sequence[float | int]]
"""The lowest and highest displacement of the only coordinate, (low, high), or those of several by their names."""


def with_limits(joint: Joint, given: GivenLimits | None) -> Joint:
    """Give limits to the coordinates of a joint, counted from the assembled pose, radians or lengths; inf for none.

    Raises ValueError for unknown coordinates, for the angles of a ball, which are one turn, and for limits that are not
    two numbers in rising order. Two equal ones lock the coordinate.
    """
    if given is None:
        return joint
    names = joint.coordinates
    if not isinstance(given, Mapping):
        if len(names) != 1:
            form = "{" + ", ".join(f"{name!r}: (low, high)" for name in names[:1]) + "}"
            raise ValueError(
                f"joint {joint.name!r} has the coordinates {', '.join(names) or '(none)'}: write limits={form}, "
                f"got {given!r}"
            )
        given = {names[0]: given}
    found = [(-np.inf, np.inf)] * len(names)
    together = {name for group in joint.driven_together if len(group) > 1 for name in (names[k] for k in group)}
    for name, ends in given.items():
        if name not in names:
            raise ValueError(f"limits of joint {joint.name!r}: there is no coordinate {name!r}{nearest(name, names)}")
        if name in together:
            raise ValueError(
                f"limits of joint {joint.name!r}: {name!r} is one of the angles of a ball, which have no limits each"
            )
        found[names.index(name)] = low_and_high(ends, f"joint {joint.name!r}: the limits of {name!r}")
    return replace(joint, limits=tuple(found))


def with_limits_within(joint: Joint, ends: Mapping[str, tuple[float, float]], given: GivenLimits | None) -> Joint:
    """Give limits to a joint as `with_limits`, and `ends`, by coordinate, where none are given."""
    if given is not None and not isinstance(given, Mapping):
        return with_limits(joint, given)
    both = dict(ends) | dict(given or {})
    return with_limits(joint, both) if both else joint


def low_and_high(ends: Sequence[float | int], what: str) -> tuple[float, float]:
    """Return a lower and an upper limit, or equal ones; ValueError, which begins with `what`, for others."""
    try:
        low, high = (float(end) for end in ends)
    except (TypeError, ValueError):
        low = high = np.nan
    if not (low <= high and low < np.inf and high > -np.inf):
        raise ValueError(f"{what} must be two numbers, the lower one first, such as (-0.5, 0.5), got {ends!r}")
    return low, high
