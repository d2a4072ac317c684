"""An inverse problem: its equations at the coordinates of many poses, and their solution from one start or another."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin.geometry.movements import is_length
from jaxkin.joints.coupling import Coupling
from jaxkin.linkage.closure_equations import closure_residual
from jaxkin.linkage.coordinates import coordinate
from jaxkin.linkage.joint_motion import part_transforms
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.inverse.aims import Aim, JointAim, PartAim
from jaxkin.mechanism.inverse.step import Bounds, Equations, step
from jaxkin.mechanism.targets import extent
from jaxkin.mobility.infeasible_drive import dead_point
from jaxkin.mobility.loop_freedoms import loop_freedoms

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

STAGES = 8
"""Steps in which targets are moved from the assembled pose to where they are asked for, so that its branch is kept."""
STAGE_ITERATIONS = 3
"""Iterations of each stage but the last one: Newton's method follows a target that moves by an eighth of its way."""
LARGEST = 0.5
"""Radians, or sizes of the mechanism, that a coordinate moves in one iteration at most."""
PENALTY = 100.0
"""Weight of squared closure residuals beside squared errors of targets, where steps are judged."""
REACHED = 1e-9
"""Weighted error, in radians and sizes of the mechanism, up to which a target counts as reached."""
CONVERGED = 1e-13
"""Largest step, in radians and sizes, after which nothing changes any more: rounding."""
RESTORATIONS = 3
"""Newton's steps by which the loops are closed after each step at most."""
CLOSED = 1e-12
"""Closure residual up to which a pose is closed: the default tolerance of `sweep`."""
ROUNDED = 1e-14
"""Error, in radians and sizes, that is rounding: a step that leaves no more is right, whatever it was before. Rounding
would refuse the last steps of inputs to where they rest, which change errors by less."""
BESIDE = 1e-2
"""Step off a dead point of a target, radians and sizes: Newton's method has slopes of a hundred there."""
DAMPING = 1e-3
"""Damping after the first step that is refused."""
GOOD = 0.5
"""Share of the foreseen decrease of squared errors below which a step is damped more the next time."""
FURTHER = 10.0
"""How much the squared errors may rise, over the fourth power of a step: along targets that are met the inputs move to
where they rest, and errors of the second order in that step are for the next one to mend."""


class Solution(NamedTuple):
    """Poses as they were found from one start."""

    x: Float[np.ndarray, "poses columns"]
    """Coordinates in radians and sizes."""
    error: Float[np.ndarray, " poses"]
    """Weighted error of the targets."""
    closure: Float[np.ndarray, " poses"]
    """Closure residual of all loops."""


class Problem:
    """The columns are the coordinates of all joints in turn, in radians, and in lengths over the `size`."""

    def __init__(self, mechanism: Mechanism, aims: Sequence[Aim]) -> None:
        linkage = mechanism.linkage
        self.linkage, self.aims, self.size = linkage, aims, extent(mechanism)
        self.places = [(k, c) for k, joint in enumerate(linkage.joints) for c in range(joint.freedoms)]
        self.names = tuple(f"{linkage.joints[k].name}.{linkage.joints[k].coordinates[c]}" for k, c in self.places)
        self.units = np.array([self.size if is_length(name.rpartition(".")[2]) else 1.0 for name in self.names])
        ends = [linkage.joints[k].limits[c] if linkage.joints[k].limits else (-np.inf, np.inf) for k, c in self.places]
        self.limits = Bounds(*(np.array(ends, float).reshape(-1, 2) / self.units[:, None]).T)
        self.inputs = np.zeros(len(self.places), bool)
        self.rest = np.zeros(len(self.places))
        self.parts = tuple(dict.fromkeys(aim.part for aim in aims if isinstance(aim, PartAim)))
        first = aims[0]
        given = first.values if isinstance(first, JointAim) else first.turns if first.places is None else first.places
        self.poses = 0 if given is None else len(given)

    def column(self, name: str) -> int:
        """The column of a coordinate by name; ValueError where there is none."""
        return self.places.index(coordinate(self.linkage, name))

    def from_assembled(self, bounds: Bounds, iterations: int) -> Solution:
        """Solve from the assembled pose, along targets that move from there to where they are asked for."""
        x = np.clip(np.zeros((self.poses, len(self.units))) + self._beside(), bounds.low, bounds.high)
        for stage in range(1, STAGES):
            x = self._iterated(x, bounds, stage / STAGES, STAGE_ITERATIONS)
        return self._solution(self._iterated(x, bounds, 1.0, iterations))

    def _beside(self) -> Float[np.ndarray, " columns"]:
        """A step off the dead point, if the assembled pose is that of a target: there no step would lead to it."""
        found = np.zeros(len(self.units))
        if dead_point(self.linkage, [aim.place for aim in self.aims if isinstance(aim, JointAim)]):
            for group in loop_freedoms(self.linkage):
                for rates in group.at_rest[:1]:
                    found[[self.places.index(place) for place in group.columns]] = BESIDE * rates
        return found

    def from_random(self, bounds: Bounds, iterations: int, count: int, seed: int) -> Iterator[Solution]:
        """Solve from starts at random within the limits; half a turn, or a size, to each side where there are none."""
        rng = np.random.default_rng(seed)
        reach = np.where(self.units == 1.0, np.pi, 1.0)
        low, high = np.maximum(bounds.low, -reach), np.minimum(bounds.high, reach)
        for _ in range(count):
            x = rng.uniform(np.minimum(low, high), np.maximum(low, high), (self.poses, len(self.units)))
            yield self._solution(self._iterated(x, bounds, 1.0, iterations))

    def _iterated(self, x: np.ndarray, bounds: Bounds, share: float, iterations: int) -> np.ndarray:
        damping = np.zeros(len(x))
        now, merit = self._equations(x, share)
        for number in range(iterations):
            # errors that cannot vanish settle slowly, and only where nothing else moves on
            settled = np.sum(now.targets**2, axis=1) <= REACHED**2
            found = step(now, x, bounds, damping, self.inputs & (settled | (2 * number < iterations))[:, None])
            largest = np.abs(found.move).max(axis=1, initial=0.0)
            if largest.max(initial=0.0) <= CONVERGED:
                break
            tried = x + found.move * np.minimum(1.0, LARGEST / np.maximum(largest, CONVERGED))[:, None]
            tried, there, reached = self._restored(tried, bounds, share)
            met = reached <= ROUNDED**2
            taken = met | (reached <= merit + FURTHER * found.to_rest**4)
            errors = [np.sum(each.targets**2, axis=1) for each in (now, there)]
            as_foreseen = met | (errors[0] - errors[1] >= GOOD * (errors[0] - found.foreseen))
            x = np.where(taken[:, None], tried, x)
            now = Equations(*(_where(taken, new, old) for new, old in zip(there, now, strict=True)))
            merit = np.where(taken, reached, merit)
            damping = np.where(taken & as_foreseen, 0.3 * damping, np.maximum(4.0 * damping, DAMPING))
            damping = np.where(damping < DAMPING / 10, 0.0, damping)
        return x

    def _restored(self, x: np.ndarray, bounds: Bounds, share: float) -> tuple[np.ndarray, Equations, np.ndarray]:
        """Close the loops again after a step along their tangent; also returns equations and merit there."""
        now, merit = self._equations(x, share)
        for _ in range(RESTORATIONS):
            if np.linalg.norm(now.closure, axis=1).max(initial=0.0) <= CLOSED:
                break
            alone = now._replace(targets=now.targets[:, :0], targets_jacobian=now.targets_jacobian[:, :0])
            x = x + step(alone, x, bounds, np.zeros(len(x)), np.zeros((1, len(self.units)), bool)).move
            now, merit = self._equations(x, share)
        return x, now, merit

    def _equations(self, x: np.ndarray, share: float) -> tuple[Equations, np.ndarray]:
        """The equations at coordinates (poses, columns), and the merit that a step is to lessen.

        Targets are `share` of the way from the assembled pose to where they are asked for.
        """
        from scipy.spatial.transform import Rotation

        with jax.enable_x64(True):  # on the host numbers have double precision always, as those of numpy beside them
            found = _evaluated(self.linkage, self.parts, tuple(self.units), jnp.asarray(x))
        closure, jacobian, transforms, rates = (np.asarray(each) for each in found)
        errors, slopes = [], []
        for aim in self.aims:
            if isinstance(aim, JointAim):
                column = self.places.index(aim.place)
                slope = np.zeros((len(x), 1, x.shape[1]))
                slope[:, 0, column] = aim.weight
                errors.append(aim.weight * (share * aim.values / self.units[column] - x[:, column])[:, None])
                slopes.append(slope)
                continue
            number = self.parts.index(aim.part)
            there, change = transforms[:, number], rates[:, number]
            if aim.places is not None and aim.weights[0]:
                weight = aim.weights[0] / self.size
                goal = aim.at + share * (aim.places - aim.at)
                errors.append(weight * (goal - there[:, :3, :3] @ aim.at - there[:, :3, 3]))
                slopes.append(weight * (np.einsum("pijk,j->pik", change[:, :3, :3], aim.at) + change[:, :3, 3]))
            if aim.turns is not None and aim.weights[1]:
                goal = Rotation.from_matrix(aim.turns).as_rotvec() * share
                left = Rotation.from_rotvec(goal).as_matrix() @ np.swapaxes(there[:, :3, :3], 1, 2)
                spin = np.einsum("pijk,plj->pilk", change[:, :3, :3], there[:, :3, :3])
                errors.append(aim.weights[1] * Rotation.from_matrix(left).as_rotvec())
                slopes.append(aim.weights[1] * np.stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]], axis=1))
        targets = np.concatenate([np.zeros((len(x), 0)), *errors], axis=1)
        aimed = np.concatenate([np.zeros((len(x), 0, x.shape[1])), *slopes], axis=1)
        merit = np.sum(targets**2, axis=1) + PENALTY * np.sum(closure**2, axis=1)
        return Equations(closure, jacobian, targets, aimed, x - self.rest), merit

    def _solution(self, x: np.ndarray) -> Solution:
        now, _ = self._equations(x, 1.0)
        return Solution(x, np.linalg.norm(now.targets, axis=1), np.linalg.norm(now.closure, axis=1))


def _where(taken: np.ndarray, new: np.ndarray, old: np.ndarray) -> np.ndarray:
    return np.where(taken.reshape(-1, *[1] * (new.ndim - 1)), new, old)


@partial(jax.jit, static_argnums=(1, 2))
def _evaluated(
    linkage: Linkage, parts: tuple[str, ...], units: tuple[float, ...], x: Float[Array, "poses columns"]
) -> tuple[Array, Array, Array, Array]:
    """Closure equations (poses, equations), their Jacobian, transforms of parts (poses, parts, 4, 4), their rates."""
    places = [(k, c) for k, joint in enumerate(linkage.joints) for c in range(joint.freedoms)]
    numbers = [linkage.parts.index(part) for part in parts]

    def equations(scaled: Float[Array, " columns"]) -> tuple[Array, Array]:
        q = scaled * jnp.array(units)
        rows = [closure_residual(linkage.structure, linkage.solved_joints, q)]
        rows += [_coupling(linkage, coupling, places, units, scaled)[None] for coupling in linkage.couplings]
        split = np.cumsum([joint.freedoms for joint in linkage.joints])[:-1]
        transforms = part_transforms(linkage, tuple(each[None] for each in jnp.split(q, split)))
        there = jnp.stack([transforms[number][0] for number in numbers]) if numbers else jnp.zeros((0, 4, 4))
        return jnp.concatenate(rows), there

    def all_of(scaled: Float[Array, " columns"]) -> tuple[Array, Array, Array, Array]:
        (closure, there), (jacobian, rates) = equations(scaled), jax.jacfwd(equations)(scaled)
        return closure, jacobian, there, rates

    return jax.vmap(all_of)(x)


def _coupling(
    linkage: Linkage,
    coupling: Coupling,
    places: Sequence[tuple[int, int]],
    units: Sequence[float],
    scaled: Float[Array, " columns"],
) -> Float[Array, ""]:
    """Evaluate what a coupling is off by, over its largest coefficient."""
    columns = np.array([places.index(coordinate(linkage, name)) for name in coupling.coordinates])
    powers = np.arange(1, coupling.coefficients.shape[-1] + 1)
    factors = jnp.asarray(coupling.coefficients) * np.array(units)[columns, None] ** powers
    largest = jnp.max(jnp.abs(factors))
    return (jnp.sum(factors * scaled[columns, None] ** powers) - coupling.offset) / largest
