"""Random linkages of one to four loops that are solved stage by stage in closed form, many designs and poses at once.

A stage hangs two new bodies, `left` and `right`, on two bodies that are there: P joins the first to `left`, C `left` to
`right`, and Q the second to `right`. It has two poses, which meet where its margin is zero. All arrays of results are
(designs, poses); the designs are points and axes of the joints in the assembled pose (designs, joints, 3).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from jaxkin.joints.pairs import revolute, spherical
from jaxkin.mechanism.mechanism import Mechanism

Array = np.ndarray
Z = np.array([0.0, 0.0, 1.0])


class Solved(NamedTuple):
    margin: Array
    """Of the worst stage: 0 where two of its branches meet, negative where it cannot close; at most 1."""
    angles: dict[str, Array]
    """Displacements of hinges by joint, full turns aside."""


class Linkage(NamedTuple):
    name: str
    stages: tuple[tuple[str, str], ...]
    """The two bodies that each stage hangs on: "ground", "crank", "left 0", "right 0" and so on."""
    ball: bool
    """Whether P and C are balls."""
    draw: Callable[[np.random.Generator, int, Sequence[tuple[str, str]]], tuple[Array, Array]]
    """Points and axes of random designs."""
    solve: Callable[[Sequence[tuple[str, str]], Array, Array, Array], Solved]

    @property
    def joints(self) -> tuple[tuple[str, str, str], ...]:
        """Name and parts: the crank's pivot A, and three joints a stage."""
        found = [("A", "ground", "crank")]
        for k, (first, second) in enumerate(self.stages):
            ends = {"P": (first, f"left {k}"), "C": (f"left {k}", f"right {k}"), "Q": (second, f"right {k}")}
            found += [(f"{name}{k}", *parts) for name, parts in ends.items()]
        return tuple(found)

    def build(self, points: Array, axes: Array) -> Mechanism:
        """One design, points and axes (joints, 3)."""
        joints = []
        for (name, *parts), point, axis in zip(self.joints, points, axes, strict=True):
            if self.ball and name[0] in "PC":
                joints.append(spherical(name, *parts, point=point))
            else:
                joints.append(revolute(name, *parts, point=point, axis=axis))
        return Mechanism.build(fixed=["ground"], joints=joints)

    def misfit(self, points: Array, axes: Array, displacements: Sequence[Array]) -> Array:
        """How far the loops are from closed, by matrices: the largest entry by which two ways to a `right` differ."""
        at = dict(zip((name for name, *_ in self.joints), displacements, strict=True))
        where = {name: i for i, (name, *_) in enumerate(self.joints)}

        def moved(name: str) -> Array:
            q, i = np.asarray(at[name]), where[name]
            turned = turns(axes[:, None, i], q[..., 0])
            if q.shape[-1] == 3:
                turned = np.eye(3)
                for column in (2, 1, 0):
                    turned = turned @ turns(np.eye(3)[column], q[..., column])
            place = np.zeros((*q.shape[:2], 4, 4))
            place[..., :3, :3], place[..., 3, 3] = turned, 1.0
            point = points[:, None, i]
            place[..., :3, 3] = point - np.einsum("...ij,...j->...i", turned, point)
            return place

        poses, worst = {"ground": np.eye(4), "crank": moved("A")}, 0.0
        for k, (first, second) in enumerate(self.stages):
            poses[f"left {k}"] = poses[first] @ moved(f"P{k}")
            poses[f"right {k}"] = poses[f"left {k}"] @ moved(f"C{k}")
            off = poses[f"right {k}"] - poses[second] @ moved(f"Q{k}")
            worst = np.maximum(worst, np.max(np.abs(off), axis=(-1, -2)))
        return worst


def turns(axis: Array, angle: Array) -> Array:
    """Rotations (*, 3, 3) about unit axes (*, 3), by Rodrigues."""
    x, y, z = np.moveaxis(np.broadcast_to(axis, (*angle.shape, 3)), -1, 0)
    zero = np.zeros(angle.shape)
    cross = np.moveaxis(np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]]), (0, 1), (-2, -1))
    s, c = np.sin(angle)[..., None, None], np.cos(angle)[..., None, None]
    return np.eye(3) + s * cross + (1 - c) * cross @ cross


def solve_planar(stages: Sequence[tuple[str, str]], points: Array, axes: Array, inputs: Array) -> Solved:
    """Dyads: the pin C is where circles about P and Q meet. A body's displacement is z -> turn z + shift."""
    at = (points[..., 0] + 1j * points[..., 1])[..., None]
    turn = np.exp(1j * inputs)
    bodies = {"ground": (np.ones_like(turn), np.zeros_like(turn)), "crank": (turn, at[:, 0] * (1 - turn))}
    margin, angles = np.full(inputs.shape, 1.0), {}
    for k, (first, second) in enumerate(stages):
        p, c, q = (at[:, 1 + 3 * k + i] for i in range(3))
        (p_turn, p_shift), (q_turn, q_shift) = bodies[first], bodies[second]
        p_now, q_now = p_turn * p + p_shift, q_turn * q + q_shift
        one, other, apart = np.abs(c - p), np.abs(c - q), np.abs(q_now - p_now)
        side = np.sign(((c - p) * np.conj(q - p)).imag)
        cosine = (one**2 + other**2 - apart**2) / (2 * one * other)
        margin = np.minimum(margin, 1 - np.abs(cosine))
        along = (one**2 - other**2 + apart**2) / (2 * apart)
        across = side * np.sqrt(np.maximum(one**2 - along**2, 0.0))
        c_now = p_now + (q_now - p_now) / apart * (along + 1j * across)
        for name, pivot, pivot_now in (("left", p, p_now), ("right", q, q_now)):
            turned = (c_now - pivot_now) / (c - pivot)
            bodies[f"{name} {k}"] = (turned / np.abs(turned), pivot_now - turned / np.abs(turned) * pivot)
        left, right = bodies[f"left {k}"][0], bodies[f"right {k}"][0]
        angles |= {
            f"P{k}": np.angle(left / p_turn),
            f"C{k}": np.angle(right / left),
            f"Q{k}": np.angle(right / q_turn),
        }
    return Solved(margin, angles)


def solve_spatial(stages: Sequence[tuple[str, str]], points: Array, axes: Array, inputs: Array) -> Solved:
    """The point C on a body that turns about Q keeps its distance from P: `cosine cos x + sine sin x = constant`.

    P is a point of a body that turns about a fixed axis, and Q turns on the ground, as in `reference.spatial.rssr`; in
    a spherical linkage all axes meet in the origin, and P and C are points of their axes.
    """
    bodies = {"crank": (points[:, None, 0], axes[:, None, 0], inputs)}
    margin, angles = np.full(inputs.shape, 1.0), {}
    for k, (first, _) in enumerate(stages):
        p, c, q = (points[:, None, 1 + 3 * k + i] for i in range(3))
        axis = axes[:, None, 3 + 3 * k]
        pivot, about, turned = bodies[first]
        p_now = pivot + np.einsum("npij,npj->npi", turns(about, turned), np.broadcast_to(p - pivot, (*turned.shape, 3)))
        w, arm, dot = p_now - q, c - q, lambda a, b: np.sum(a * b, axis=-1)
        level = dot(arm, axis)[..., None] * axis
        flat, quarter = arm - level, np.cross(axis, arm)
        square = dot(c - p, c - p)
        cosine, sine = 2 * dot(w, flat), 2 * dot(w, quarter)
        constant = dot(w, w) + dot(arm, arm) - square - 2 * dot(w, level)
        ratio = constant / np.hypot(cosine, sine)
        margin = np.minimum(margin, 1 - np.abs(ratio))
        # as assembled x is zero: that tells the branch
        start = p - q
        branch = -np.sign(dot(start, quarter))
        turned = np.arctan2(sine, cosine) + branch * np.arccos(np.clip(ratio, -1.0, 1.0))
        angles[f"Q{k}"] = turned
        bodies[f"right {k}"] = (q, axis, turned)
    return Solved(margin, angles)


def directions(rng: np.random.Generator, *shape: int) -> Array:
    found = rng.normal(size=(*shape, 3))
    return found / np.linalg.norm(found, axis=-1, keepdims=True)


def draw_planar(rng: np.random.Generator, designs: int, stages: Sequence[tuple[str, str]]) -> tuple[Array, Array]:
    """Pins anywhere in a square, cranks shorter than most bars."""
    points = rng.uniform(-1.0, 1.0, (designs, 1 + 3 * len(stages), 3))
    points[..., 2] = 0.0
    for k, (first, _) in enumerate(stages):
        if first == "crank":
            points[:, 1 + 3 * k] = points[:, 0] + 0.35 * (points[:, 1 + 3 * k] - points[:, 0])
    return points, np.broadcast_to(Z, points.shape)


def draw_rssr(rng: np.random.Generator, designs: int, stages: Sequence[tuple[str, str]]) -> tuple[Array, Array]:
    """Balls and axes anywhere; balls that drive are near the axes that they turn about."""
    points = rng.uniform(-1.0, 1.0, (designs, 1 + 3 * len(stages), 3))
    for k in range(len(stages)):
        pivot = points[:, 3 * k]  # that of A, or of the stage before
        points[:, 1 + 3 * k] = pivot + 0.35 * (points[:, 1 + 3 * k] - pivot)
    return points, directions(rng, *points.shape[:2])


def draw_spherical(rng: np.random.Generator, designs: int, stages: Sequence[tuple[str, str]]) -> tuple[Array, Array]:
    """Axes through the origin in any direction, driving arcs shorter than most."""
    axes = directions(rng, designs, 1 + 3 * len(stages))
    for k in range(len(stages)):
        near = axes[:, 3 * k] + 0.5 * axes[:, 1 + 3 * k]
        axes[:, 1 + 3 * k] = near / np.linalg.norm(near, axis=-1, keepdims=True)
    points = axes.copy()
    points[:, 0::3] = 0.0  # hinges on the ground: the closed form turns about their points
    return points, axes


def _planar(name: str, *stages: tuple[str, str]) -> Linkage:
    return Linkage(name, stages, False, draw_planar, solve_planar)


def _in_series(name: str, loops: int, ball: bool) -> Linkage:
    stages = tuple((f"right {k - 1}" if k else "crank", "ground") for k in range(loops))
    return Linkage(name, stages, ball, draw_rssr if ball else draw_spherical, solve_spatial)


FIRST = ("crank", "ground")
LINKAGES: tuple[Linkage, ...] = (
    _planar("four-bar", FIRST),
    _planar("Watt six-bar", FIRST, ("right 0", "ground")),
    _planar("Stephenson six-bar", FIRST, ("left 0", "ground")),
    _planar("leg of three dyads", FIRST, FIRST, ("right 0", "right 1")),
    _planar("four dyads", FIRST, ("left 0", "ground"), ("right 1", "crank"), ("right 2", "left 1")),
    _in_series("RSSR", 1, True),
    _in_series("two RSSR", 2, True),
    _in_series("three RSSR", 3, True),
    _in_series("spherical four-bar", 1, False),
    _in_series("two spherical four-bars", 2, False),
    _in_series("four spherical four-bars", 4, False),
)
