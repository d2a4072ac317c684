"""Closed poses in extended precision: what the errors of the solver are measured against.

The loops of the mechanism's own numbers, as exact as those are written, are evaluated by mpmath in fifty digits; chord
steps with the Jacobian in float64 gain some ten digits each.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.curves import Spline, curve_point
from jaxkin.geometry.elementary_motions import ElementaryMotion, amount, displaced_columns
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.patches import FollowedPoint, FollowedSpline, bicubic, patch_point
from jaxkin.joints.joint import Joint
from jaxkin.linkage.closed_loops import closed_loops
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.topology.structure import LoopGroup

DIGITS = 50
"""Decimal digits: the error of the reference is then nothing beside that of float64, also at singular poses."""
CHORD_STEPS = 12
"""Chord steps at most: each gains some ten digits, fewer near singular poses."""
LAST_STEP = 1e-22
"""Step, radians or lengths, below which the pose has converged: far below the rounding of float64."""
RANK = 1e-9
"""Singular value over the largest one that counts as zero: an idle freedom. A hundred times below the rank threshold of
the solver (`linkage.first_order.RANK_TOLERANCE`), which is that of J J^T: the exact pose is to be found nearer to
singular poses than the solver gets, and J itself is known to 1e-14."""


class Extended:
    """The loops of a loop group in fifty digits. Raises ImportError where mpmath is not installed."""

    def __init__(self, mechanism: Mechanism, loop_group: LoopGroup, free: Sequence[int]) -> None:
        try:
            from mpmath.ctx_mp import MPContext
        except ImportError:
            raise ImportError(
                "errors are measured in extended precision, which needs mpmath: pip install 'jaxkin[accuracy]'"
            ) from None
        self.mp: Any = MPContext()
        self.mp.dps = DIGITS
        self.loop_group, self.free = loop_group, list(free)
        self.joints = {index: mechanism.all_joints[index] for index in loop_group.joints}
        self.loops = closed_loops(mechanism.linkage, loop_group)

    def closed(self, q: Float[np.ndarray, " columns"]) -> tuple[Float[np.ndarray, " columns"], bool]:
        """Find the exact pose near `q` with the same driven coordinates; returns it rounded, and whether it converged.

        `q` is in radians and lengths of the mechanism; where freedoms are idle, the nearest such pose is found. Frames
        are rounded numbers: redundant equations close to their rounding only, and what is found is the pose of least
        residual.
        """
        exact = [self.mp.mpf(float(value)) for value in q]
        for _ in range(CHORD_STEPS):
            misfit = self._misfit(exact)
            size = max((abs(value) for value in misfit), default=self.mp.mpf(0))
            rounded = np.array([float(value) for value in exact])
            if size == 0:
                return rounded, True
            step = size * self.mp.matrix(self._step(rounded, np.array([float(value / size) for value in misfit])))
            exact = [value - d for value, d in zip(exact, step, strict=True)]
            if max(abs(d) for d in step) < LAST_STEP:
                return np.array([float(value) for value in exact]), True
        return np.array([float(value) for value in exact]), False

    def idle(self, q: Float[np.ndarray, " columns"]) -> Float[np.ndarray, "columns columns"]:
        """Compute the projector onto the idle freedoms of a pose, which have no exact value."""
        jacobian = self._jacobian(q)
        _, values, directions = np.linalg.svd(jacobian)
        kept = directions[: int((values > RANK * values[0]).sum())]
        return np.eye(len(q)) - kept.T @ kept

    def _step(self, q: Float[np.ndarray, " columns"], misfit: np.ndarray) -> Float[np.ndarray, " columns"]:
        return np.linalg.pinv(self._jacobian(q), rcond=RANK) @ misfit

    def _jacobian(self, q: Float[np.ndarray, " columns"]) -> Float[np.ndarray, "equations columns"]:
        """Compute the Jacobian of `_misfit` in float64, by radians and lengths of the mechanism.

        Columns that are not free are zero.
        """
        every = self.loops.jacobian(q / self.loops.units)
        jacobian = np.zeros_like(every)
        jacobian[:, self.free] = every[:, self.free]
        return jacobian / self.loops.units

    def _misfit(self, q: list) -> list:
        """Compute the rotation and translation, the latter over the characteristic length, by which the loops do not
        close.

        What the couplings are off by comes last.
        """
        steps = {index: self._displacement(joint, q[self.loops.slices[index]]) for index, joint in self.joints.items()}
        found, places = [], {}
        centre = self.mp.matrix([float(value) for value in self.loops.centre])
        for loop in self.loop_group.loops:
            ends = self.loops.ends
            start = pose = places.setdefault(ends[loop[0][0]][0 if loop[0][1] > 0 else 1], self.mp.eye(4))
            for joint, sign in loop:
                pose = pose * (steps[joint] if sign > 0 else self._inverse(steps[joint]))
                places.setdefault(ends[joint][1 if sign > 0 else 0], pose)
            left = pose * self._inverse(start)
            found += [(left[2, 1] - left[1, 2]) / 2, (left[0, 2] - left[2, 0]) / 2, (left[1, 0] - left[0, 1]) / 2]
            moved = left[:3, :3] * centre + left[:3, 3] - centre
            found += [value / self.mp.mpf(self.loops.length) for value in moved]
        for columns, coefficients, offset in self.loops.couplings:
            scaled = [q[column] / self.mp.mpf(float(self.loops.units[column])) for column in columns]
            terms = (
                self.mp.mpf(float(factor)) * value**power
                for value, factors in zip(scaled, coefficients, strict=True)
                for power, factor in enumerate(factors, start=1)
            )
            found.append(sum(terms, -self.mp.mpf(offset)))
        return found

    def _displacement(self, joint: Joint, q: list) -> Any:
        """Compute the displacement J of part 2 relative to part 1: the product of `frames_1 T frames_2^-1` (Table
        2)."""
        pose, first = self.mp.eye(4), 0
        for frame, name in enumerate(joint.movements):
            movement = MOVEMENTS[name]
            pose = pose * self._matrix(joint.frames_1[frame])
            spline = joint.splines[frame]
            point = None if spline is None else self._point(spline, q[first : first + len(movement.coordinates)])
            for element in movement.elements:
                pose = self._displaced(pose, element, q[first + element.coordinate], float(joint.pitch), point)
            pose = pose * self._inverse(self._matrix(joint.frames_2[frame]))
            first += len(movement.coordinates)
        return pose

    def _displaced(
        self, pose: Any, element: ElementaryMotion, value: Any, pitch: float, point: FollowedPoint | None
    ) -> Any:
        """Multiply a pose F (4, 4) by an elementary motion E from the right, F E, in place, and return it.

        `value` is the coordinate of E, `pitch` the advance of a screw per turn, `point` that of the curve or surface
        which E follows.
        """
        turns = self.mp.mpf(pitch) * 2 * np.pi / (2 * self.mp.pi)  # `amount` divides by 2 pi of float64
        how_far = amount(element, value, turns, point, lambda angle: (self.mp.cos(angle), self.mp.sin(angle)))
        for number, column in enumerate(displaced_columns([pose[:, k] for k in range(4)], element.axis, *how_far)):
            pose[:, number] = column
        return pose

    def _point(self, spline: FollowedSpline, q: list) -> FollowedPoint:
        """Evaluate a curve or a surface, whose coefficients are taken as exact."""
        if isinstance(spline, Spline):
            piece, behind = self._piece(spline.knots, spline.start, spline.closed, q[0])
            coefficients = [[self.mp.mpf(float(c)) for c in power] for power in spline.table[:, piece]]
            return curve_point(coefficients, behind, self.mp.sqrt)
        (i, s), (j, t) = (self._piece(*each) for each in zip(spline.knots, spline.start, spline.closed, q, strict=True))
        powers = np.array([self.mp.mpf(float(c)) for c in np.ravel(spline.table[:, :, i, j])], object).reshape(4, 4, 3)
        height = None if spline.height is None else self.mp.mpf(float(spline.height))
        return patch_point(bicubic(powers, s, t), height, self.mp.sqrt)

    def _piece(self, knots: Any, start: Any, closed: bool, q: Any) -> tuple[int, Any]:
        """Find the piece of a spline at a coordinate, and how far that is behind the beginning of the piece."""
        s = self.mp.mpf(float(start)) + q
        if closed:
            s -= self.mp.mpf(float(knots[-1])) * self.mp.floor(s / self.mp.mpf(float(knots[-1])))
        piece = int(np.clip(np.searchsorted(knots, float(s), side="right") - 1, 0, len(knots) - 2))
        return piece, s - self.mp.mpf(float(knots[piece]))

    def _matrix(self, pose) -> Any:
        return self.mp.matrix(np.asarray(pose, float).tolist())

    def _inverse(self, pose) -> Any:
        """Compute the inverse of a pose, exactly: the pose is rigid to rounding only, so its transpose would not do."""
        return pose**-1
