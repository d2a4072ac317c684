"""Close the loops of a loop group on the host, by damped Newton steps in numpy and float64 (Eq. 10)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import jax
import numpy as np
from jaxtyping import Float

from jaxkin.geometry.characteristic_length import centroid_and_length
from jaxkin.geometry.movements import is_length
from jaxkin.geometry.patches import FollowedSpline
from jaxkin.geometry.pose import Transform, inverse
from jaxkin.joints.coupling import Coupling
from jaxkin.joints.joint import Joint
from jaxkin.joints.screws import Screws, chain, moved
from jaxkin.linkage.first_order import DOUBLE, SINGLE
from jaxkin.topology.structure import LoopGroup, Structure

_ITERATIONS = 200
"""Largest number of steps: two dozen close loops that are wide open, and the others are for loops that cannot close."""
_LONGEST_STEP = 0.5
"""Longest step, radians or characteristic lengths: farther away a linear model of a rotation is no longer good."""
_STAGNANT = 1e-9
"""Relative decrease of the merit in one step below which the merit has reached its minimum, if the step is damped no
more than the first one."""
_ROUNDING = 1e-14
"""Residual, some 45 roundings of float64, below which a step gains nothing: the host computes in float64, also where
the mechanism has `SINGLE` numbers."""
_DAMPING_FLOOR = 1e-14
"""Least damping of a step, relative to the mean square of the rows of J: the square of `RANK_TOLERANCE`, so that the
host takes the same singular values for zero as the solver (`solve.linear.least_norm.damping_floor`)."""
_LEAST_TRUST = 1e12
"""Ratio of the damping to the square of the residual above which the residual counts as stationary: even the short
steps of so much damping do not reduce it."""

LoopCoordinates = Float[np.ndarray, " columns"]
"""Displacements of all coordinates of the loops from the assembled pose: radians and characteristic lengths."""
ClosureResidual = Float[np.ndarray, " equations"]
"""What the loops and couplings leave open, as `Travel.residual` has it."""


ClosureJacobian = Float[np.ndarray, "equations columns"]
"""Derivatives of the residual, as `Travel.jacobian` has them."""


class ScaledChain(NamedTuple):
    """The movements of a joint with their numbers, lengths over the characteristic length, about the centroid."""

    movements: tuple[str, ...]
    frames_1: Float[np.ndarray, "frames 4 4"]
    frames_2: Float[np.ndarray, "frames 4 4"]
    pitch: float
    splines: tuple[FollowedSpline | None, ...]
    """The curves of the movements; empty where no movement has one."""

    def displaced(self, q: Float[np.ndarray, " _"]) -> tuple[Transform, Screws]:
        """Compute the displacement of part 2 relative to part 1, and the screws of the coordinates: see `chain`."""
        return chain(self.movements, self.frames_1, q, self.pitch, self.frames_2, self.splines)

    def alone(self, number: int) -> ScaledChain:
        """Return one of the movements, with the frame on part 1 on both sides."""
        one = slice(number, number + 1)
        return ScaledChain(self.movements[one], self.frames_1[one], self.frames_1[one], self.pitch, self.splines[one])


class Travel(NamedTuple):
    """The quantities found by travelling around the loops, in world coordinates about the centroid, lengths scaled."""

    residual: ClosureResidual
    """Six rows a loop, the displacement that is left open as a twist: `vee(R - R^T)/2` of its rotation, then its
    translation; after those of all loops the `coupling_residual`."""
    jacobian: ClosureJacobian
    """For each column six rows a loop, the twist of the loop's end at a unit rate of the coordinate: the derivative of
    the residual where the loop is closed. After those of all loops the `coupling_jacobian`."""
    screws: Screws
    """Unit twists (6, columns) of the coordinates of all joints, angular velocity first."""
    starts: tuple[Transform, ...]
    """Displacement of the part at which each loop starts."""
    left_open: Float[np.ndarray, "loops 4 4"]
    """For each loop the displacement that is left when it has been travelled: the identity if the loop is closed."""
    places: Mapping[str, Transform]
    """Displacement of each row of parts from the assembled pose; parts that joints of other loop groups place rest."""
    coupling_residual: Float[np.ndarray, " couplings"]
    """Left-hand side of each coupling less its offset, over its largest coefficient."""
    coupling_jacobian: Float[np.ndarray, "couplings columns"]
    """Derivatives of `coupling_residual` with respect to the coordinates."""

    @property
    def residual_norm(self) -> float:
        """The residual norm: square root of Eq. 12, over all twelve equations of all loops, and all couplings."""
        return float(np.hypot(np.linalg.norm(self.left_open - np.eye(4)), np.linalg.norm(self.coupling_residual)))

    @property
    def merit(self) -> float:
        """Half the sum of squares of Eq. 12, rotation entries weighted by 1/2.

        The gradient of the merit is `jacobian.T @ residual`. Half the square of `residual` is no substitute, since
        `residual` also vanishes where a rotation is left open by half a turn.
        """
        squares = (self.left_open - np.eye(4)) ** 2
        of_couplings = (self.coupling_residual**2).sum()
        return float(0.25 * squares[:, :3, :3].sum() + 0.5 * (squares[:, :3, 3].sum() + of_couplings))


class ClosedLoops:
    """The loops and couplings of a loop group as numbers, in scaled coordinates.

    The origin is the centroid of the joint frames on part 1, and lengths are divided by the root-mean-square distance
    of these from it, the characteristic length.
    """

    def __init__(
        self,
        every: Sequence[Joint],
        structure: Structure,
        loop_group: LoopGroup,
        couplings: Sequence[Coupling] = (),
    ) -> None:
        """Take the loops of `loop_group`; `every` are all joints and `couplings` all couplings of the linkage.

        `jaxkin.linkage.closed_loops` takes those of a linkage.
        """
        joints = {index: every[index] for index in loop_group.joints}
        self.loop_group = loop_group
        self.columns = tuple((index, k) for index, joint in joints.items() for k in range(joint.freedoms))
        single = any(np.asarray(leaf).dtype == np.float32 for leaf in jax.tree.leaves(list(joints.values())))
        self.thresholds = SINGLE if single else DOUBLE
        row_of = structure.row_of
        self.ends = {index: (row_of[joint.parts[0]], row_of[joint.parts[1]]) for index, joint in joints.items()}
        looped = {joint for loop in loop_group.loops for joint, _ in loop}
        self.hanging = {
            row_of[part]: (row_of[parent], joint, sign)
            for part, parent, joint, sign in (structure.tree if looped < joints.keys() else ())
            if joint in joints and joint not in looped
        }
        """Row of parts that hangs by a coupled joint in no loop -> the row that it hangs on, the joint, and +1 if that
        row is part 1 of the joint, else -1."""
        origins = np.concatenate([np.asarray(joint.frames_1, float)[:, :3, 3] for joint in joints.values()])
        centre, length = centroid_and_length(origins, np)
        self.centre, self.length = centre, float(length)

        def scaled(frames) -> np.ndarray:
            frames = np.array(frames, float)
            frames[:, :3, 3] = (frames[:, :3, 3] - centre) / length
            return frames

        self.chains = {
            index: ScaledChain(
                joint.movements,
                scaled(joint.frames_1),
                scaled(joint.frames_2),
                float(joint.pitch) / length,
                tuple(curve and curve.over(length).spline() for curve in joint.curves),
            )
            for index, joint in joints.items()
        }
        first = np.cumsum([0, *(joint.freedoms for joint in joints.values())])
        names = [name for joint in joints.values() for name in joint.coordinates]
        self.lengths = [is_length(name) for name in names]
        """For each column whether it is a length."""
        self.units = np.where(self.lengths, length, 1.0)
        """For each column the factor from the scaled coordinate to that of the mechanism: 1 for angles."""
        self.couplings = [
            self._scaled(couplings[number], [every[j].full_names[k] for j, k in self.columns])
            for number in loop_group.couplings
        ]
        self.coincide = all(joint.coincides for joint in joints.values()) and not any(
            offset for *_, offset in self.couplings
        )
        """Whether each joint has the same frame on both of its parts, and no coupling an offset. Then the assembled
        pose is closed by construction, also if frames that are orthonormal to a few digits only leave a residual."""
        self.slices = {index: slice(*first[i : i + 2]) for i, index in enumerate(joints)}

    def _scaled(self, coupling: Coupling, names: Sequence[str]) -> tuple[list[int], np.ndarray, float]:
        """Find the columns of a coupling; scale its coefficients and offset, over the largest coefficient."""
        columns = [names.index(name) for name in coupling.coordinates]
        given = np.asarray(coupling.coefficients, float)
        scaled = given * self.units[columns, None] ** np.arange(1, given.shape[1] + 1)
        largest = np.abs(scaled).max()
        return columns, scaled / largest, float(coupling.offset) / largest

    def jacobian(self, q: LoopCoordinates) -> ClosureJacobian:
        """Compute the closure Jacobian at scaled coordinates `q`: see `Travel.jacobian`."""
        return self.travel(q).jacobian

    def closed(self, q: LoopCoordinates, held: Sequence[int] = ()) -> tuple[LoopCoordinates, Travel]:
        """Close the loops from scaled coordinates `q` by damped Newton steps of least norm (Levenberg-Marquardt).

        A step that does not reduce the merit is refused and damped more, so that loops may begin wide open. Loops that
        cannot close are brought to their least residual. The columns `held` keep their values. Returns the coordinates
        and the quantities of the loops there.
        """
        found, trust, free = self.travel(q), 1.0, np.ones(len(q))
        free[list(held)] = 0.0
        for _ in range(_ITERATIONS):
            if found.residual_norm < _ROUNDING or trust > _LEAST_TRUST:
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
            elif found.residual_norm < self.thresholds.residual:
                break  # rounding
            else:
                trust *= 8.0
        return q, found

    def travel(self, q: LoopCoordinates) -> Travel:
        """Travel around all loops at scaled coordinates `q`, each from the part at which it starts."""
        steps = {index: each.displaced(q[self.slices[index]]) for index, each in self.chains.items()}
        places: dict[str, Transform] = {}
        starts: list[Transform] = []
        left_open: list[Transform] = []
        residual = np.zeros((len(self.loop_group.loops), 6))
        jacobian = np.zeros((len(self.loop_group.loops), 6, len(q)))
        screws = np.zeros((6, len(q)))

        def place(row: str) -> Transform:
            """Place a row of parts that the loops before have not placed: at rest, unless it hangs by a joint."""
            if row not in places:
                places[row] = np.eye(4)
                if row in self.hanging:
                    parent, joint, sign = self.hanging[row]
                    step, own = steps[joint]
                    above = place(parent)
                    places[row] = above @ (step if sign > 0 else inverse(step))
                    screws[:, self.slices[joint]] = moved(above if sign > 0 else places[row], own)
            return places[row]

        for row, (misfit, twists) in enumerate(zip(residual, jacobian, strict=True)):
            loop = self.loop_group.loops[row]
            # a loop starts at a part that the loops before it hold (Section 4.2)
            start = pose = place(self.ends[loop[0][0]][0 if loop[0][1] > 0 else 1])
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
            left_open.append(left)
            misfit[:] = closure_twist(left)
        for row in self.hanging:
            place(row)
        coupling_residual, coupling_jacobian = self._evaluate_couplings(q)
        return Travel(
            np.append(residual.ravel(), coupling_residual),
            np.concatenate([jacobian.reshape(6 * len(residual), len(q)), coupling_jacobian]),
            screws,
            tuple(starts),
            np.array(left_open).reshape(-1, 4, 4),
            places,
            coupling_residual,
            coupling_jacobian,
        )

    def _evaluate_couplings(self, q: LoopCoordinates) -> tuple[ClosureResidual, Float[np.ndarray, "couplings columns"]]:
        """Evaluate `Travel.coupling_residual` at scaled coordinates `q`, and its derivatives with respect to these."""
        residual, jacobian = np.zeros(len(self.couplings)), np.zeros((len(self.couplings), len(q)))
        for row, (columns, coefficients, offset) in enumerate(self.couplings):
            for at, column, factors in zip(q[columns], columns, coefficients, strict=True):
                polynomial = np.polynomial.Polynomial([0.0, *factors])
                residual[row] += polynomial(at)
                jacobian[row, column] = polynomial.deriv()(at)
            residual[row] -= offset
        return residual, jacobian


def closure_twist(displacement: Transform) -> tuple[float, ...]:
    """Compute `vee(R - R^T)/2` of the rotation R of a displacement, then its translation: the residual of Eq. 10."""
    turn, shift = displacement[:3, :3] - displacement[:3, :3].T, displacement[:3, 3]
    return turn[2, 1] / 2, turn[0, 2] / 2, turn[1, 0] / 2, *shift


def least_norm(jacobian: ClosureJacobian, right: ClosureResidual, damping: float) -> LoopCoordinates:
    """Solve J x = r with least norm; `damping` is relative to the mean square of the rows of J."""
    gram = jacobian @ jacobian.T
    floor = damping * max(float(np.trace(gram)) / max(len(gram), 1), 1e-300)
    return jacobian.T @ np.linalg.solve(gram + floor * np.eye(len(gram)), right)
