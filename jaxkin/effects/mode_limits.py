"""Assembly modes and the limits of joints: which full turn of an angle is meant, and which poses are within."""

from __future__ import annotations

from collections.abc import Container, Sequence
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Int

from jaxkin.effects.coupled_turns import turning
from jaxkin.effects.grid_steps import BATCH, NodeInputs
from jaxkin.geometry.trig import TURN
from jaxkin.linkage.coordinates import coordinate
from jaxkin.mechanism.drive_plan import DrivenLoopGroup
from jaxkin.mechanism.joint_limits import ROUNDING, Bound, bounds_of, rounding
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.solve.closure.closure import scaled_geometry
from jaxkin.solve.closure.joint_coordinates import ball_rotations, joint_coordinates
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State


def wrap_angles(mechanism: Mechanism, rows: Sequence[np.ndarray], driven: Container[str], first: int) -> None:
    """Bring the angles of modes from `first` on into (-pi, pi], where a full turn is no displacement.

    An angle that is within the limits of its joint some full turns away, and not there, is brought to the nearest of
    these: a mechanism that is assembled in the mode would be beyond its limits all along its motion otherwise.
    """
    tied = {name for coupling in mechanism.linkage.couplings for name in coupling.coordinates}
    for joint, row in zip(mechanism.all_joints, rows, strict=True):
        for k in turning(joint):
            if (name := joint.full_names[k]) in driven or name in tied:
                continue
            angles = row[first:, k]
            angles -= TURN * np.ceil(angles / TURN - 0.5)
            if joint.limits:
                low, high = joint.limits[k]
                least = np.ceil((low - ROUNDING - angles) / TURN)
                most = np.floor((high + ROUNDING - angles) / TURN)
                angles += TURN * np.where(least <= most, np.clip(0.0, least, most), 0.0)


class WithinLimits:
    """Tells which poses over a grid of inputs are within the limits of all joints."""

    def __init__(
        self, mechanism: Mechanism, loop_groups: Sequence[DrivenLoopGroup], inputs: NodeInputs, names: Sequence[str]
    ) -> None:
        """Take the loop groups that the inputs move, and the inputs of all nodes, in the order of their `names`."""
        joints = mechanism.all_joints
        bounds = {(each.joint, each.coordinate): each for each in bounds_of(joints)}
        slack = {length: rounding(joints, length) for length in {each.length for each in bounds.values()}}
        self._nodes = np.ones(inputs.shape[1], bool)
        """Whether the inputs of each node are within their own limits."""
        for name, row in zip(names, inputs, strict=True):
            if bound := bounds.get(coordinate(mechanism.linkage, name)):
                self._nodes &= _inside(bound, np.asarray(row, float), slack[bound.length])
        self._groups = [
            (
                group.system,
                group.joints,
                [(k, bounds[place]) for k, place in enumerate(group.columns) if place in bounds],
            )
            for group in loop_groups
        ]
        """Of each loop group also its columns that have limits, with these."""
        self._slack = slack
        self.any = bool(bounds)
        """Whether some joint has limits."""

    def of(self, nodes: Int[np.ndarray, " poses"], parts: Sequence[np.ndarray]) -> Bool[np.ndarray, " poses"]:
        """Tell which poses at these nodes are within limits; `parts` are the two arrays of each state in turn."""
        found = self._nodes[nodes]
        for (system, joints, columns), x, turns in zip(self._groups, parts[::2], parts[1::2], strict=True):
            for first in range(0, len(nodes) if columns else 0, BATCH):
                which = np.minimum(np.arange(first, first + BATCH), len(nodes) - 1)
                state = State(jnp.asarray(x[..., which]), jnp.asarray(turns[..., which]))
                rows = np.asarray(_coordinates(system, joints, state), float)
                for column, bound in columns:
                    found[which] &= _inside(bound, rows[column], self._slack[bound.length])
        return found


def _inside(bound: Bound, values: Float[np.ndarray, " poses"], slack: float) -> Bool[np.ndarray, " poses"]:
    return (values >= bound.low - slack) & (values <= bound.high + slack)


@partial(jax.jit, static_argnums=0)
def _coordinates(system: LoopSystem, joints: Joints, state: State) -> Float[Array, "columns poses"]:
    """Compute displacements of the columns of a loop group, radians and lengths of the mechanism."""
    geometry, lengths = scaled_geometry(system, joints)
    rotations = ball_rotations(system, geometry, state)
    return joint_coordinates(system, joints.frames_1, joints.frames_2, state.x * lengths, rotations)
