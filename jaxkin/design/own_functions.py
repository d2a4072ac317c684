"""Functions of users, told apart by what they compute, so that a search runs the program of an earlier one.

Two functions that were written in one place may differ in what they refer to, and one function may refer to something
that has changed since. So each is traced in every search, by itself, which takes a small part of the time to trace the
program that it becomes part of; functions whose operations and constants are the same are one function.

Also how such functions are called, and what they must return.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax.extend.core import Var

from jaxkin._traced import written_with_jax


@jax.tree_util.register_static
@dataclass(frozen=True)
class OwnFunction:
    """A function, equal to every other one that computes the same, with the same derivatives."""

    function: Callable[..., Any] = field(compare=False)
    name: str
    """For messages."""
    operations: Any
    """The text of its program."""

    def __call__(self, *given: Any) -> Any:
        return self.function(*given)


def own_function(function: Callable[..., Any], name: str, shapes: tuple[Any, ...], forward: bool) -> OwnFunction:
    """Trace a function of pytrees of floats and whole numbers, of which `shapes` has the shapes.

    Its derivatives are compared as they are asked for: `forward`, or backward of a function of one output. Raises
    ValueError for a function that asks for numbers which JAX traces.
    """
    leaves, tree = jax.tree.flatten(shapes)
    smooth = [jnp.issubdtype(leaf.dtype, jnp.inexact) for leaf in leaves]

    def of(numbers: list[Any], rest: list[Any]) -> Any:
        left = iter(numbers), iter(rest)
        found = function(*tree.unflatten([next(left[0] if each else left[1]) for each in smooth]))
        return jax.tree.map(lambda each: jnp.asarray(each, float), found)

    def with_derivative(numbers: list[Any], rest: list[Any]) -> Any:
        if forward:
            along = [jnp.ones_like(number) for number in numbers]
            return jax.jvp(lambda numbers: of(numbers, rest), (numbers,), (along,))
        value, back = jax.vjp(lambda numbers: of(numbers, rest), numbers)
        return value, back(jax.tree.map(jnp.ones_like, value))

    numbers, rest = (
        [leaf for leaf, is_smooth in zip(leaves, smooth, strict=True) if is_smooth is side] for side in (True, False)
    )
    with written_with_jax(name):
        text = jax.jit(with_derivative).lower(numbers, rest).as_text()
    # the text does not tell which function of Python is called
    return OwnFunction(function, name, object() if "callback" in text else text)


def called(function: Callable[..., Any], motion: Any, extras: dict[str, Any]) -> Any:
    """Call a loss or a constraint of a motion, with the extras where it takes them."""
    return function(motion, extras) if takes_extras(function) else function(motion)


def takes_extras(function: Callable[..., Any]) -> bool:
    """Tell whether a loss or a constraint wants the extra variables as a second argument.

    One that has a value already, as in `lambda motion, joint=joint: ...`, is the function's own.
    """
    try:
        signature = inspect.signature(function)
        signature.bind(None, None)
    except TypeError:
        return False
    except ValueError:  # no signature to be had: a callable of C
        return False
    # bound to two arguments: both are parameters, or are taken by *args
    second = [*signature.parameters.values()][:2][-1]
    return second.name == "extras" or second.default is inspect.Parameter.empty or second.default is None


def is_constant(function: Callable[..., Any], *given: Any) -> bool:
    """Tell whether a function computes nothing from what it is given."""
    operations = jax.make_jaxpr(function)(*given).jaxpr
    known = set(operations.invars)
    for each in operations.eqns:
        if any(isinstance(number, Var) and number in known for number in each.invars):
            known.update(each.outvars)
    return not any(isinstance(number, Var) and number in known for number in operations.outvars)


def check_loss(loss: Callable[..., Any], squares: bool, *given: Any) -> None:
    """Refuse a loss that returns no numbers with a derivative, or several where it has to be one."""
    expected = "residuals" if squares else "one number"
    advice = "an array of them" if squares else "jnp.sum(...) of what it measures"
    shape, kind = _returned(loss, "the loss", expected, advice, *given)
    if kind == "b":
        raise ValueError("the loss must return a number, got a truth value, which has no derivative")
    if kind == "i":
        raise ValueError(
            "the loss returns whole numbers, as of counting or rounding, which have no derivative; "
            "return what is rounded as it is, and in place of a count a smooth sum such as jnp.sum(jax.nn.sigmoid(x))"
        )
    if not squares and shape != ():
        raise ValueError(
            f"the loss must return one number, got an array of shape {shape}; return jnp.sum(...) of it, or say "
            "solver=jk.design.LevenbergMarquardt() if these are residuals whose squares are to be added up"
        )


def check_constraint(constraint: Callable[..., Any], name: str, *given: Any) -> None:
    """Refuse a constraint that returns no numbers: of truth values, which are 0 or 1, none is negative."""
    advice = "by how much it is met, a number or an array of them"
    _, kind = _returned(constraint, name, "numbers that are not negative where it holds", advice, *given)
    if kind == "b":
        raise ValueError(
            f"{name} returns truth values, of which none is negative, so that all would count as met; return by how "
            "much it is met, such as `angle - least` for `angle >= least`"
        )


def _returned(
    function: Callable[..., Any], name: str, expected: str, advice: str, *given: Any
) -> tuple[tuple[int, ...], str]:
    """Find the shape of the array that a function returns, and its kind; nothing is computed.

    Kinds are "f" of real numbers, "i" of whole ones, and "b" of truth values.
    Constants of Python count as real numbers. Raises ValueError where it returns no array of real numbers; `expected`
    says what it has to return, and `advice` what to write.
    """
    returned: list[Any] = []
    with written_with_jax(name):
        jax.eval_shape(lambda *numbers: returned.append(function(*numbers)), *given)
    (found,) = returned
    if isinstance(found, int | float) and not isinstance(found, bool):
        return (), "f"
    got = type(found).__name__
    if isinstance(found, bool):
        return (), "b"
    if isinstance(found, np.generic | np.ndarray | jax.Array):
        for kinds, kind in ((jnp.bool_, "b"), (jnp.integer, "i"), (jnp.floating, "f")):
            if jnp.issubdtype(found.dtype, kinds):
                return np.shape(found), kind
        got = f"numbers of type {found.dtype}"
    raise ValueError(f"{name} must return {expected}, got {got}; return {advice}")
