"""The loops of a structure element on the host: closed by Newton steps in numpy, whatever the device does (Eq. 10)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import jax
import numpy as np
from jaxtyping import Float

from jaxkin.geometry.movements import is_length
from jaxkin.geometry.pose import Pose, inverse
from jaxkin.joints.joint import Joint
from jaxkin.joints.screws import Screws, chain, moved
from jaxkin.linkage.first_order import DOUBLE, SINGLE
from jaxkin.topology.structure import LoopGroup, Structure

_ITERATIONS = 200
"""Steps at most: two dozen close loops that are half open, more are for those that cannot close."""
_LONGEST_STEP = 0.5
"""Radians, or characteristic lengths: what a linear model of a rotation is good for."""
_STAGNANT = 1e-9
"""Relative decrease of the merit in a step without more damping than at first, below which it is the least."""
_ROUNDING = 1e-14
"""Residual, some 45 roundings of float64, below which a step gains nothing: the host computes in float64, also where
the mechanism has `SINGLE` numbers."""
_DAMPING_FLOOR = 1e-14
"""Least damping of a step, relative to the mean square of the rows of J: the square of `RANK_TOLERANCE`, so that the
host takes the same singular values for zero as the solver (`correctors.levenberg_marquardt.damping_floor`)."""
_LEAST_TRUST = 1e12
"""Damping, over the square of the residual, at which no step lessens the residual: it is the least."""

Row = Float[np.ndarray, " columns"]
Rows = Float[np.ndarray, " equations"]


class Travel(NamedTuple):
    """What is met on the way around the loops, in world coordinates."""

    residual: Rows
    """Misfits of the loops as twists, six rows each."""
    jacobian: Float[np.ndarray, "equations columns"]
    """Their derivatives."""
    screws: Screws
    """Of the coordinates of all joints."""
    starts: tuple[Pose, ...]
    """Displacement of the part at which each loop starts."""
    left_open: Float[np.ndarray, "loops 4 4"]
    """Displacement of the part at which each loop starts that is left when it has been travelled: none if closed."""
    places: Mapping[str, Pose]
    """Displacement of each row of parts from its assembled pose; that at which the first loop starts is at rest."""

    @property
    def gap(self) -> float:
        """Square root of Eq. 12: over all twelve equations of all loops."""
        return float(np.linalg.norm(self.left_open - np.eye(4)))

    @property
    def merit(self) -> float:
        """Half the sum of squares of Eq. 12, rotation entries weighted by 1/2.

        `residual` times the Jacobian is its gradient. `residual` alone vanishes at half a turn too.
        """
        squares = (self.left_open - np.eye(4)) ** 2
        return float(0.25 * squares[:, :3, :3].sum() + 0.5 * squares[:, :3, 3].sum())


class ClosedLoops:
    """The loops of a structure element as numbers: frames from their centroid, over their root-mean-square distance."""

    def __init__(self, every: Sequence[Joint], structure: Structure, loop_group: LoopGroup) -> None:
        """`every` are the joints whose loops are solved, all of the linkage; `loop_group` says which loops."""
        joints = {index: every[index] for index in loop_group.joints}
        self.loop_group = loop_group
        self.columns = tuple((index, k) for index, joint in joints.items() for k in range(joint.freedoms))
        single = any(np.asarray(leaf).dtype == np.float32 for leaf in jax.tree.leaves(list(joints.values())))
        self.thresholds = SINGLE if single else DOUBLE
        row_of = structure.row_of
        self.ends = {index: (row_of[joint.parts[0]], row_of[joint.parts[1]]) for index, joint in joints.items()}
        origins = np.concatenate([np.asarray(joint.frames_1, float)[:, :3, 3] for joint in joints.values()])
        centre = self.centre = origins.mean(axis=0)
        length = self.length = float(np.sqrt(((origins - centre) ** 2).sum(axis=1).mean())) or 1.0

        def scaled(frames) -> np.ndarray:
            frames = np.array(frames, float)
            frames[:, :3, 3] = (frames[:, :3, 3] - centre) / length
            return frames

        self.chains = {
            index: (joint.movements, scaled(joint.frames_1), scaled(joint.frames_2), float(joint.pitch) / length)
            for index, joint in joints.items()
        }
        first = np.cumsum([0, *(joint.freedoms for joint in joints.values())])
        names = [name for joint in joints.values() for name in joint.coordinates]
        self.units = np.array([length if is_length(name) else 1.0 for name in names])
        """Of each column: what its scaled coordinate is multiplied by."""
        self.coincide = all(np.array_equal(joint.frames_1, joint.frames_2) for joint in joints.values())
        """Whether all joints have one frame on both of their parts: then the assembled pose is closed as it is given,
        though frames that are rigid to some digits only leave a residual of their own."""
        self.slices = {index: slice(*first[i : i + 2]) for i, index in enumerate(joints)}

    def jacobian(self, q: Row) -> Float[np.ndarray, "equations columns"]:
        """Derivative of the misfits of the loops, six rows each in world coordinates about the centroid."""
        return self.travel(q)[1]

    def closed(self, q: Row, held: Sequence[int] = ()) -> tuple[Row, Travel]:
        """The closed coordinates that damped Newton steps of least norm lead to, and what is met there.

        Steps that do not lessen the merit are refused and damped more (Levenberg-Marquardt), so that loops may begin
        wide open; where they cannot close, those of least residual are found. Columns that are `held` stay.
        """
        found, trust, free = self.travel(q), 1.0, np.ones(len(q))
        free[list(held)] = 0.0
        for _ in range(_ITERATIONS):
            if found.gap < _ROUNDING or trust > _LEAST_TRUST:
                break
            damping = max(_DAMPING_FLOOR, trust * 1e-2 * min(1.0, 2 * found.merit))
            step = least_norm(found.jacobian * free, found.residual, damping)
            step *= min(1.0, _LONGEST_STEP / max(float(np.linalg.norm(step)), _LONGEST_STEP))
            trial = self.travel(q - step)
            if trial.merit < found.merit:
                least = trust <= 1.0 and trial.merit > (1.0 - _STAGNANT) * found.merit
                q, found, trust = q - step, trial, max(0.3 * trust, 1e-2)
                if least:
                    break
            elif found.gap < self.thresholds.residual:
                break  # rounding
            else:
                trust *= 8.0
        return q, found

    def travel(self, q: Row) -> Travel:
        """Travel all loops, from the part at which each starts, with these coordinates."""
        steps = {
            index: chain(movements, before, q[self.slices[index]], pitch, after)
            for index, (movements, before, after, pitch) in self.chains.items()
        }
        places: dict[str, Pose] = {}
        starts: list[Pose] = []
        left_open: list[Pose] = []
        residual = np.zeros((len(self.loop_group.loops), 6))
        jacobian = np.zeros((len(self.loop_group.loops), 6, len(q)))
        screws = np.zeros((6, len(q)))
        for row, (misfit, twists) in enumerate(zip(residual, jacobian, strict=True)):
            loop = self.loop_group.loops[row]
            # a loop starts at a part that the loops before it hold (Section 4.2)
            start = pose = places.setdefault(self.ends[loop[0][0]][0 if loop[0][1] > 0 else 1], np.eye(4))
            starts.append(start)
            for joint, sign in loop:
                step, own = steps[joint]
                if sign > 0:
                    turned, pose = moved(pose, own), pose @ step
                else:
                    pose = pose @ inverse(step)
                    turned = moved(pose, own)
                screws[:, self.slices[joint]] = turned
                twists[:, self.slices[joint]] = sign * turned
                places.setdefault(self.ends[joint][1 if sign > 0 else 0], pose)
            left = pose @ inverse(start)
            skew = left[:3, :3] - left[:3, :3].T
            left_open.append(left)
            misfit[:] = skew[2, 1] / 2, skew[0, 2] / 2, skew[1, 0] / 2, *left[:3, 3]
        jacobian = jacobian.reshape(6 * len(residual), len(q))
        return Travel(residual.ravel(), jacobian, screws, tuple(starts), np.array(left_open), places)


def least_norm(jacobian: Float[np.ndarray, "equations columns"], right: Rows, damping: float) -> Row:
    """The x of least norm with J x = r, damping over the mean square of the rows of J."""
    gram = jacobian @ jacobian.T
    floor = damping * max(float(np.trace(gram)) / max(len(gram), 1), 1e-300)
    return jacobian.T @ np.linalg.solve(gram + floor * np.eye(len(gram)), right)
