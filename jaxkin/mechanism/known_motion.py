"""Differentiate the displacements of a motion whose poses are known: the closure is solved at them to first order.

A sweep that is differentiated finds its poses anew. Here the poses are those of the motion, and only the derivative of
the closure (`jaxkin.solve.range.implicit_derivative`) is computed: for velocities one linear system a pose, of planar
loops by the twists of the pose (`jaxkin.solve.closed_form.planar_derivative`). Nested derivatives are those of a sweep,
too, and so are derivatives with respect to lengths.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float, Int

from jaxkin._traced import traced
from jaxkin.linkage.first_order import Columns
from jaxkin.linkage.joint_motion import JointDisplacements
from jaxkin.mechanism.drive_plan import plan_drive
from jaxkin.solve.closed_form.assembled_axes import AssembledAxes
from jaxkin.solve.closed_form.known_poses_in_plane import known_displacements_in_plane
from jaxkin.solve.range.known_poses import known_displacements
from jaxkin.solve.status import Status, is_closed_on_branch
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem

if TYPE_CHECKING:
    from jaxkin.mechanism.motion import Motion

Inputs = dict[str, Float[Array | np.ndarray, " poses"]]
"""By "joint.coordinate" the displacements of the driven coordinates, or their derivatives of one order by time."""
JointRates = tuple[Float[Array, "poses _"], ...]
"""For each joint of `Linkage.joints` the derivatives of its displacements of one order by time."""
Follow = Callable[[Inputs], JointDisplacements]
"""The displacements of all joints as a function of the inputs: see `follow`."""


class KnownLoopGroup(NamedTuple):
    """A loop group that the drive moves (static)."""

    system: LoopSystem
    columns: Columns
    inputs: tuple[str, ...]
    """Its inputs, in the order of `system.driven`."""
    regular: bool
    """Whether no pose is singular, so that planar loops have the derivatives of their formulas; False of others."""
    refined: bool
    """Whether the poses are those of least residual of given joints that disagree: the loops of the ideal joints are
    closed from there, before they are differentiated."""


class KnownDrive(NamedTuple):
    """What follows from the drive of a motion, without numbers (static)."""

    freedoms: tuple[int, ...]
    """Number of coordinates of every joint."""
    driven: tuple[tuple[str, int, int], ...]
    """Name, joint and coordinate of every input."""
    loop_groups: tuple[KnownLoopGroup, ...]
    unit: str
    """Of all lengths."""


class KnownMotion(NamedTuple):
    """The numbers of a motion that its derivatives follow from."""

    numbers: tuple[Joints | AssembledAxes, ...]
    """Of every loop group of the `KnownDrive`: the axes of planar loops whose numbers are known, else the joints."""
    displacements: JointDisplacements
    status: Int[Array, " poses"]


def some_poses(motion: Motion, chosen: Int[np.ndarray, " chosen"]) -> Motion:
    """Make the motion of some poses of another one, by their numbers (host code)."""
    inputs, displacements, status, residual = jax.tree.map(
        lambda values: np.asarray(values)[chosen],
        (dict(motion.inputs), motion.displacements, motion.status, motion.residual),
    )
    return replace(motion, inputs=inputs, displacements=displacements, status=status, residual=residual)


def known_motion(motion: Motion) -> tuple[KnownDrive, KnownMotion]:
    """Collect what the derivatives of a motion follow from."""
    linkage = motion.mechanism.linkage
    plan = plan_drive(linkage if motion.swept else linkage.whole, tuple(motion.inputs))
    names = list(plan.driven)
    formulas = plan.formula_sweep
    regular = formulas is not None and not traced(motion.inputs) and formulas.passes(motion.inputs)
    own = plan.loop_groups if len(motion) else ()
    axes = [None if each.given else each.planar_axes for each in own]
    loop_groups = tuple(
        KnownLoopGroup(
            system=each.system,
            columns=each.columns,
            inputs=tuple(names[i] for i in each.inputs),
            regular=regular and planar is not None,  # all others have one program, in any range
            refined=each.given is not None,
        )
        for each, planar in zip(own, axes, strict=True)
    )
    driven = tuple((name, *place) for name, place in plan.driven.items())
    numbers = tuple(each.joints if planar is None else planar for each, planar in zip(own, axes, strict=True))
    drive = KnownDrive(plan.freedoms, driven, loop_groups, motion.mechanism.unit)
    return drive, KnownMotion(numbers, motion.displacements, motion.status)


def follow(drive: KnownDrive, known: KnownMotion) -> Follow:
    """Return the displacements of all joints as a function of the inputs, to be differentiated at those of the motion.

    The function returns the displacements that are known; its derivatives are zero at poses that did not close.
    """
    # least-residual poses are closed by the ideal joints, whose derivatives they have
    differentiated = is_closed_on_branch(known.status) | (known.status == Status.MISFIT.value)
    status = jnp.where(differentiated, Status.CLOSED.value, known.status)
    finite = known.status != Status.NONFINITE.value
    at = tuple(jnp.where(finite[:, None], lax.stop_gradient(rows), 0.0) for rows in known.displacements)

    def displacements(inputs: Inputs) -> JointDisplacements:
        columns = {}
        for name, joint, k in drive.driven:
            given = inputs[name]
            columns[joint, k] = at[joint][:, k] + jnp.where(finite, given - lax.stop_gradient(given), 0.0)
        for loop_group, numbers in zip(drive.loop_groups, known.numbers, strict=True):
            rows = jnp.stack([at[joint][:, k] for joint, k in loop_group.columns])
            given = [jnp.where(finite, inputs[name], 0.0) for name in loop_group.inputs]
            given = jnp.stack(given) if given else jnp.zeros((0, len(finite)), rows.dtype)
            if isinstance(numbers, AssembledAxes):
                found = known_displacements_in_plane(
                    loop_group.system, numbers, given, rows, status, regular=loop_group.regular
                )
            else:
                found = known_displacements(loop_group.system, numbers, given, rows, status, loop_group.refined)
            columns |= dict(zip(loop_group.columns, found, strict=True))
        return tuple(
            jnp.stack([columns.get((joint, k), rows[:, k]) for k in range(rows.shape[1])], axis=1)
            if rows.shape[1]
            else rows
            for joint, rows in enumerate(at)
        )

    return displacements


def derivatives(function: Callable, given: tuple) -> tuple:
    """Differentiate f(x(t)) with respect to time: `given` are x, x', x'', ..., each a pytree; returns f', f'', ...

    There are as many derivatives of f as of x. With D_n(x, x', ..., x^(n)) = (f, f', ..., f^(n)), the last entry of D_n
    is the derivative of the last entry of D_(n-1) along (x', ..., x^(n)).
    """

    def up_to(order: int) -> Callable:
        if order == 0:
            return lambda value: (function(value),)

        def found(*given):
            lower, changes = jax.jvp(up_to(order - 1), given[:-1], given[1:])
            return *lower, changes[-1]

        return found

    return up_to(len(given) - 1)(*given)[1:]
