"""What users give to objectives and constraints, held against what was expected.

Each function returns what was given, ready to use, or raises ValueError. `what` names the function and its argument,
such as "in_box: lower", and begins the message. Traced numbers are not looked at.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import jax.numpy as jnp
import numpy as np

from jaxkin._arguments import numbers, one_number, positive_number, several
from jaxkin._names import nearest
from jaxkin._traced import traced


def number(given: Any, what: str, least: float = -np.inf, most: float = np.inf, hint: str = "") -> Any:
    """Return a finite number from `least` to `most`; `hint` ends the message where it lies outside."""
    found = one_number(given, what)
    if traced(found):
        return found
    if not least <= found <= most:
        between = f"{least:.6g} or more" if most == np.inf else f"from {least:.6g} to {most:.6g}"
        raise ValueError(f"{what} must be {between}{hint}, got {given!r}")
    return float(found)


def positive(given: Any, what: str) -> Any:
    """Return a number above zero."""
    found = positive_number(given, what)
    return found if traced(found) else float(found)


def angle(given: Any, what: str, most: float) -> Any:
    """Return an angle from 0 to `most`, radians."""
    return number(given, what, 0.0, most, " radians (np.radians makes them of degrees)")


def row(given: Any, what: str, example: str) -> Any:
    """Return at least one finite number, in an array of one axis; `example` is what to write."""
    expected = f"finite numbers, one a pose, such as {example}"
    found = numbers(given, what, expected).ravel()
    if not found.size or not (traced(found) or np.all(np.isfinite(found))):
        raise ValueError(f"{what} must be {expected}, got {given!r}")
    return found


def rows(given: Any, what: str, width: int) -> Any:
    """Return finite numbers in an array (rows, width), of one row at least."""
    expected = f"finite numbers of shape (poses, {width})"
    found = numbers(given, what, expected)
    if found.ndim != 2 or found.shape[1] != width or not len(found):
        raise ValueError(f"{what} must be {expected}, got shape {found.shape}")
    if not (traced(found) or np.all(np.isfinite(found))):
        raise ValueError(f"{what} must be {expected}, got {int(np.sum(~np.isfinite(found)))} that are not finite")
    return found


def check_targets(count: int, poses: int, what: str, advice: str = "give one target a pose") -> None:
    """Raise ValueError where there is not one target for each pose."""
    if count != poses:
        raise ValueError(f"{what}: {count} targets but {poses} poses; {advice}")


def corner(given: Any, what: str, open_side: str) -> np.ndarray:
    """Return three numbers (x, y, z), of which some may be infinite: `open_side` is how to write these."""
    expected = f"three numbers (x, y, z), {open_side} where the box is open"
    found = numbers(given, what, expected)
    if found.shape != (3,) or np.any(np.isnan(found)):
        raise ValueError(f"{what} must be {expected}, got {given!r}")
    return found


def names(given: Any, what: str, expected: str, count: int | None = None) -> tuple[str, ...]:
    """Return a tuple of text, of `count` entries."""
    found = given if isinstance(given, Sequence) and not isinstance(given, str) else None
    if found is None or not all(isinstance(each, str) for each in found) or len(found) != (count or len(found)):
        raise ValueError(f"{what} must name {expected}, got {given!r}")
    return tuple(found)


def bar(given: Any, what: str) -> tuple[str, ...]:
    """Return the name of a length."""
    return names(given, what, "a part and two of its joints, as in ('coupler', 'B', 'C')")


def ends(given: Any, what: str) -> tuple[str, str]:
    """Return the names of the joints at the other ends of two links."""
    first, second = names(given, what, "the joint at the other end of either link, as in ('B', 'D')", 2)
    return first, second


def components(given: Any, what: str) -> tuple[int, ...]:
    """Return the numbers of some of the coordinates x, y, z, each once."""
    found = several(given, what, "numbers of coordinates", "(0, 1) for x and y")
    known = all(isinstance(k, int | np.integer) and 0 <= k < 3 for k in found)
    if not found or not known or len(set(found)) < len(found):
        raise ValueError(f"{what} must be some of 0, 1, 2 (x, y, z), each once, got {given!r}")
    return tuple(map(int, found))


def pose_numbers(given: Any, what: str) -> np.ndarray:
    """Return the numbers of poses, given as such or by a mask of all poses."""
    expected = "numbers of poses, such as [3, 4, 5], or True and False for each pose"
    found = numbers(given, what, expected)
    if found.ndim != 1 or np.any(found != np.round(found)):
        raise ValueError(f"{what} must be {expected}, got {given!r}")
    return np.flatnonzero(found) if np.asarray(given).dtype == bool else found.astype(int)


def extra(given: Mapping[str, Any], name: str, what: str, shapes: tuple[tuple[int, ...], ...]) -> Any:
    """Return the value of an extra variable, an array of one of the shapes."""
    if name not in given:
        example = f"name it in optimize(..., extras={{{name!r}: jk.design.Free(start, lower, upper)}})"
        raise ValueError(f"{what}: there is no extra variable {name!r}{nearest(name, given)}; {example}")
    found = jnp.asarray(given[name], float)
    if found.shape not in shapes:
        expected = " or ".join(map(str, shapes))
        raise ValueError(f"{what}: the extra variable {name!r} must have the shape {expected}, got {found.shape}")
    return found


def extra_point(given: Mapping[str, Any], name: str, what: str) -> Any:
    """Find the extra variable that is a point (3,), or one (2,) in the plane z = 0; ValueError as of `extra`."""
    found = extra(given, name, what, ((2,), (3,)))
    return jnp.append(found, 0.0) if found.shape == (2,) else found
