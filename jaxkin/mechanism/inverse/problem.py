"""An inverse problem: the columns of its coordinates, and its equations at those of many poses."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import AbstractContextManager
from functools import partial
from typing import TYPE_CHECKING

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from jaxkin.geometry.movements import MOVEMENTS, is_length
from jaxkin.geometry.trig import TURN
from jaxkin.joints.coupling import Coupling
from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.closure_equations import closure_residual
from jaxkin.linkage.coordinates import coordinate
from jaxkin.linkage.joint_motion import part_transforms
from jaxkin.linkage.linkage import Linkage
from jaxkin.linkage.start_ranges import start_ranges
from jaxkin.mechanism.inverse.aims import Aim, JointAim, PartAim, poses_of
from jaxkin.mechanism.inverse.bounded import Bounds
from jaxkin.mechanism.inverse.step import StepEquations
from jaxkin.mechanism.targets import extent

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

PENALTY = 100.0
"""Weight of squared closure residuals beside squared errors of targets, where steps are judged."""


class InverseProblem:
    """The loops and the aims of an inverse problem, as functions of the coordinates of all joints.

    Columns are these coordinates, of one joint after the other, in radians, and in lengths over the `size`.
    """

    def __init__(self, mechanism: Mechanism, aims: Sequence[Aim]) -> None:
        linkage = mechanism.linkage
        self.linkage, self.aims, self.size = linkage, aims, float(extent(mechanism))
        with _doubled():
            self.numbers = jax.tree.map(jnp.asarray, linkage)
            """The linkage on the device: what is put there anew in each call takes longer than the call."""
        self.places = [(k, c) for k, joint in enumerate(linkage.joints) for c in range(joint.freedoms)]
        self.names = tuple(name for joint in linkage.joints for name in joint.full_names)
        self.lengths = np.array([is_length(name.rpartition(".")[2]) for name in self.names], bool)
        self.units = np.where(self.lengths, self.size, 1.0)
        self.turns = np.array(_turns(linkage, aims), bool)
        """Which columns repeat after a whole turn: those of hinges and balls that no coupling and no target names."""
        ends = [linkage.joints[k].limits[c] if linkage.joints[k].limits else (-np.inf, np.inf) for k, c in self.places]
        self.limits = Bounds(*(np.array(ends, float).reshape(-1, 2) / self.units[:, None]).T)
        self.reach = _reach(linkage, self.places, self.lengths, self.size)
        """How far each column is moved at random starts, radians and sizes: see `_reach`."""
        self.unlimited = Bounds(*np.full((2, len(self.places)), [[-np.inf], [np.inf]]))
        self.inputs = np.zeros(len(self.places), bool)
        self.rest = np.zeros(len(self.places))
        self.parts = tuple(dict.fromkeys(aim.part for aim in aims if isinstance(aim, PartAim)))
        self.poses = poses_of(aims[0])

    def column(self, name: str) -> int:
        """Look up the column of a coordinate by name; ValueError where there is none."""
        return self.places.index(coordinate(self.linkage, name))

    def turned_back(
        self, x: Float[np.ndarray, "*poses columns"], bounds: Bounds
    ) -> Float[np.ndarray, "*poses columns"]:
        """Turn hinges by whole turns to where they are nearest to zero, within their limits if a whole turn is."""
        least, most = np.ceil((bounds.low - x) / TURN), np.floor((bounds.high - x) / TURN)
        there = self.turns & (least <= most)
        return x + TURN * np.clip(-np.round(x / TURN), np.where(there, least, 0.0), np.where(there, most, 0.0))

    def equations(
        self, x: Float[np.ndarray, "poses columns"], share: float
    ) -> tuple[StepEquations, Float[np.ndarray, " poses"]]:
        """Evaluate the equations at coordinates (poses, columns), and the merit that a step is to lessen.

        Targets are `share` of the way from the assembled pose to where they are asked for.
        """
        from scipy.spatial.transform import Rotation

        with _doubled():
            found = _evaluated(self.numbers, self.parts, tuple(self.units), jnp.asarray(x))
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
        return StepEquations(closure, jacobian, targets, aimed, x - self.rest), merit


def _doubled() -> AbstractContextManager[None]:
    """Compute in double precision, as numpy does beside: poses are led to targets on the host."""
    return jax.enable_x64(True)


def _reach(
    linkage: Linkage, places: Sequence[JointCoordinate], lengths: Bool[np.ndarray, " columns"], size: float
) -> Float[np.ndarray, " columns"]:
    """Say how far each column is moved at random starts, radians and sizes of the mechanism: see `start_ranges`."""
    pitched = [any(MOVEMENTS[name].has_pitch for name in joint.movements) for joint in linkage.joints]
    pitch = np.array([float(linkage.joints[k].pitch) / size if pitched[k] else 0.0 for k, _ in places])
    units, couplings = np.where(lengths, size, 1.0), []
    for coupling in linkage.couplings:
        factors = np.asarray(coupling.coefficients, float)
        columns = [places.index(coordinate(linkage, name)) for name in coupling.coordinates]
        if len(columns) == 2 and factors[:, 0].all() and not factors[:, 1:].any():
            couplings.append((columns, factors[:, 0] * units[columns]))
    return start_ranges(lengths, pitch, 1.0, couplings, np.full(len(places), True))


def _turns(linkage: Linkage, aims: Sequence[Aim]) -> list[bool]:
    """Tell of each column whether it is the same pose a whole turn farther, and meets the targets as well there."""
    tied = {coordinate(linkage, name) for coupling in linkage.couplings for name in coupling.coordinates}
    tied |= {aim.place for aim in aims if isinstance(aim, JointAim)}
    found: list[bool] = []
    for number, joint in enumerate(linkage.joints):
        movements = [MOVEMENTS[name] for name in joint.movements]
        other = [
            [element.coordinate for element in movement.elements if element.kind != "rotate" or element.law]
            for movement in movements
        ]
        rotates = [
            k not in slides for m, slides in zip(movements, other, strict=True) for k in range(len(m.coordinates))
        ]
        found += [turns and (number, place) not in tied for place, turns in enumerate(rotates)]
    return found


@partial(jax.jit, static_argnums=(1, 2))
def _evaluated(
    linkage: Linkage, parts: tuple[str, ...], units: tuple[float, ...], x: Float[Array, "poses columns"]
) -> tuple[Array, Array, Array, Array]:
    """Evaluate closure equations (poses, equations), their Jacobian, transforms of parts (poses, parts, 4, 4), and the
    derivatives of these."""
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
    places: Sequence[JointCoordinate],
    units: Sequence[float],
    scaled: Float[Array, " columns"],
) -> Float[Array, ""]:
    """Evaluate what a coupling is off by, over its largest coefficient."""
    columns = np.array([places.index(coordinate(linkage, name)) for name in coupling.coordinates])
    powers = np.arange(1, coupling.coefficients.shape[-1] + 1)
    factors = jnp.asarray(coupling.coefficients) * np.array(units)[columns, None] ** powers
    largest = jnp.max(jnp.abs(factors))
    return (jnp.sum(factors * scaled[columns, None] ** powers) - coupling.offset) / largest
