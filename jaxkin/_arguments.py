"""What users pass to functions, held against what was expected: a ValueError says what arrived and what to write."""

from __future__ import annotations

from collections.abc import Mapping
from decimal import Decimal
from numbers import Real
from typing import Any

import jax.numpy as jnp
import numpy as np
from jax import dtypes

from jaxkin._traced import traced


def check_mechanism(given: Any, what: str) -> None:
    """Raise ValueError for what is no mechanism; `what` is found of it, and begins the message.

    A mechanism is known by its linkage, as a motion by its displacements: their classes are on higher floors than some
    of the functions that are given them.
    """
    if not hasattr(given, "linkage"):
        example = "jk.load(file).mechanism(fixed=[...])"
        raise ValueError(f"{what} are those of a mechanism, {example}, got {type(given).__name__}")


def check_motion(given: Any, what: str) -> None:
    """Raise ValueError for what is no motion, or a batch of them; `what` is found of it, and begins the message."""
    if not hasattr(given, "displacements"):
        raise ValueError(f"{what} are those of a motion, mechanism.sweep(drive), got {type(given).__name__}")
    check_one(what, "one motion", np.shape(given.status)[:-1])


def check_one(what: str, given: str, batch: tuple[int, ...]) -> None:
    """Raise ValueError where what was `given` has the axes of a `batch` in front of its own; `what` is found of it, and
    begins the message."""
    if batch:
        raise ValueError(
            f"{what} are those of {given}, and this is a batch of {' x '.join(map(str, batch))}, as jax.vmap makes: "
            "call the function inside of jax.vmap, too, or take one out, jax.tree.map(lambda rows: rows[0], batch)"
        )


def check_known(what: str, call: str, *given: Any, inside: str = "") -> None:
    """Raise ValueError where JAX traces numbers of what was given: `what`, which begins the message, is found by `call`
    on the host. `inside` names what may be traced in its place."""
    if traced(given):
        instead = f", or {inside}" if inside else ""
        raise ValueError(f"{what} are found on the host: call {call} outside of jit, vmap and grad{instead}")


def by_name(given: Any, what: str, example: str) -> Mapping[Any, Any]:
    """Return what was given if it is a mapping, else raise ValueError with an example."""
    if not isinstance(given, Mapping):
        raise ValueError(f"{what} are given by name, as in {example}, got {given!r}")
    return given


def several(given: Any, what: str, entries: str, example: str = "") -> tuple[Any, ...]:
    """Return the entries of the list that the argument `what` is; ValueError for text and for what has no entries.

    `entries` says what they should be; an `example` says it of those that are no names.
    """
    expected = f"{what} must be a list of {entries}{f', such as {example}' if example else ''}"
    if isinstance(given, str):
        advice = "" if example else f"; write {what}=[{given!r}]"
        raise ValueError(f"{expected}, got the text {given!r}{advice}")
    try:
        return tuple(given)
    except TypeError:
        raise ValueError(f"{expected}, got {given!r}") from None


def text(given: Any, what: str) -> str:
    """Return what was given if it is text, else raise ValueError."""
    if not isinstance(given, str):
        raise ValueError(f"{what} must be text, got {given!r}")
    return given


def yes_or_no(given: Any, what: str) -> bool:
    """Return what was given if it is True or False, else raise ValueError."""
    if not isinstance(given, bool | np.bool_):
        raise ValueError(f"{what} must be True or False, got {given!r}")
    return bool(given)


def numbers(given: Any, what: str, expected: str = "numbers") -> Any:
    """Return an array of what was given, of JAX where it is traced, else of numpy, in the precision of JAX.

    Raises ValueError for what is no number, as `exact_numbers`.
    """
    return exact_numbers(given, what, expected).astype(dtypes.canonicalize_dtype(float), copy=False)


def exact_numbers(given: Any, what: str, expected: str = "numbers") -> Any:
    """Return an array of what was given, of JAX where it is traced, else of numpy in float64; ValueError for others.

    None, text, times and complex numbers are none, although numpy makes numbers of them. Decimals and fractions are.
    What a masked array hides is NaN.
    """
    if traced(given):
        known = jnp.asarray(given)
        if jnp.iscomplexobj(known):
            raise ValueError(f"{what} must be {expected}, got complex numbers that JAX traces")
        return known.astype(float)
    try:
        found = np.asarray(given)
        if found.dtype.kind == "O":
            real = all(isinstance(each, Real | Decimal) for each in found.flat)
        else:
            real = found.dtype.kind in "biuf" or jnp.issubdtype(found.dtype, jnp.floating)
        if not real:
            raise TypeError
        found = found.astype(np.float64, copy=False)
    except (TypeError, ValueError, OverflowError):  # the last one of integers beyond 1e308
        raise ValueError(f"{what} must be {expected}, got {given!r}") from None
    return np.where(np.ma.getmaskarray(given), np.nan, found) if np.ma.isMaskedArray(given) else found


def one_number(given: Any, what: str, expected: str = "one finite number") -> Any:
    """Return one finite number as an array without axes, else raise ValueError; a traced one is not looked at."""
    found = numbers(given, what, expected)
    if isinstance(given, bool | np.bool_) or found.shape != () or not (traced(found) or np.isfinite(found)):
        raise ValueError(f"{what} must be {expected}, got {given!r}")
    return found


def positive_number(given: Any, what: str, expected: str = "one positive number") -> Any:
    """Return one finite number above zero as an array without axes, else raise ValueError; a traced one is not looked
    at."""
    found = one_number(given, what, expected)
    if not (traced(found) or found > 0):
        raise ValueError(f"{what} must be {expected}, got {given!r}")
    return found


def whole_number(given: Any, what: str, least: int = 0) -> int:
    """Return a whole number from `least` on, else raise ValueError."""
    if isinstance(given, bool) or not isinstance(given, int | np.integer) or given < least:
        raise ValueError(f"{what} must be a whole number, {least} or more, got {given!r}")
    return int(given)
