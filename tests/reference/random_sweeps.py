"""Sweeps of random linkages held against their closed forms: what is reachable, on which branch, and how far off."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields

import jax
import jax.numpy as jnp
import numpy as np

from jaxkin.geometry.pose import frame
from jaxkin.solve.execution.compiler import jit_options
from jaxkin.solve.options import SolverOptions
from jaxkin.solve.status import Status, default_tolerance
from reference.hard_case import TURN, off_turns
from reference.random_linkages import Array, Linkage

POSES, GRID = 16, 721
APART = 1e-6
"""Angles that differ by more are on different branches: poses nearer to a limit than 1e-9 rad, where branches are
closer than 6e-5, are left undecided."""
UNDECIDED = 1e-9


@dataclass
class Count:
    """Poses, by what they are and should be."""

    poses: int = 0
    reachable: int = 0
    closed: int = 0
    """Of the reachable ones."""
    undecided: int = 0
    jumped: int = 0
    stalled: int = 0
    """Of all."""
    residual: int = 0
    """CLOSED with a residual above the tolerance, by the sweep or by the matrices of NumPy."""
    branch: int = 0
    """CLOSED, and not the pose of the closed form."""
    behind: int = 0
    """CLOSED, where it cannot be reached."""
    error: float = 0.0
    """Largest angle by which a pose that is CLOSED rightly is off, times the margin of its worst stage."""

    def __iadd__(self, other: Count) -> Count:
        for field in fields(self):
            both = getattr(self, field.name), getattr(other, field.name)
            setattr(self, field.name, max(both) if field.name == "error" else sum(both))
        return self

    @staticmethod
    def head() -> str:
        return "".join(f"{field.name:>11}" for field in fields(Count))

    def __str__(self) -> str:
        return "".join(f"{v:>11.0e}" if isinstance(v, float) else f"{v:>11}" for v in vars(self).values())


def sweeps(linkage: Linkage, options: SolverOptions | None = None) -> Callable:
    """The sweeps of many designs in one compiled program: (designs, joints, 4, 4) frames and (designs, poses) inputs to
    displacements, status and residual.

    One after another: under `vmap` all wait for the one with most limits, which takes seven times as long here.
    """
    points, axes = linkage.draw(np.random.default_rng(0), 1, linkage.stages)
    template = linkage.build(points[0], axes[0])
    assert template.linkage.classes  # found while the frames are numbers

    def one(given: tuple[jax.Array, jax.Array]):
        frames, inputs = given
        names = [name for name, *_ in linkage.joints]
        motion = template.with_frames(dict(zip(names, frames, strict=True))).sweep({"A": inputs}, options=options)
        return motion.displacements, motion.status, motion.residual

    return jax.jit(lambda frames, inputs: jax.lax.map(one, (frames, inputs)), **jit_options())


def frames_of(linkage: Linkage, points: Array, axes: Array) -> Array:
    """Joint frames (designs, joints, 4, 4)."""
    balls = [linkage.ball and name[0] in "PC" for name, *_ in linkage.joints]
    return np.stack(
        [
            np.stack([frame(p, np.array([0.0, 0.0, 1.0]) if b else a) for p, a, b in zip(ps, axs, balls, strict=True)])
            for ps, axs in zip(points, axes, strict=True)
        ]
    )


def checked(linkage: Linkage, program: Callable, rng: np.random.Generator, designs: int) -> Count:
    """Random designs, each over a range of up to a turn that holds its assembled pose."""
    points, axes = linkage.draw(rng, designs, linkage.stages)
    width = TURN * rng.uniform(0.1, 1.0, (designs, 1))
    inputs = width * (np.linspace(0.0, 1.0, POSES) - rng.uniform(0.0, 1.0, (designs, 1)))
    inputs = rng.permuted(inputs, axis=1)
    displacements, status, residual = jax.tree.map(
        np.asarray, program(jnp.asarray(frames_of(linkage, points, axes)), jnp.asarray(inputs))
    )

    solved = linkage.solve(linkage.stages, points, axes, inputs)
    low, high = limits(linkage, points, axes)
    room = np.maximum.reduce([np.minimum(inputs + k * TURN - low, high - inputs - k * TURN) for k in (-1, 0, 1)])
    undecided = np.abs(room) < UNDECIDED
    reachable = (room > 0) & ~undecided
    closed = status == Status.CLOSED
    where = {name: i for i, (name, *_) in enumerate(linkage.joints)}
    off = np.max(
        [off_turns(displacements[where[name]][..., 0] - angle) for name, angle in solved.angles.items()], axis=0
    )
    largest = default_tolerance(np.float64)
    open_ = closed & ((residual > largest) | (linkage.misfit(points, axes, displacements) > 10 * largest))
    right = closed & reachable & (off <= APART)
    return Count(
        poses=inputs.size,
        reachable=int(reachable.sum()),
        closed=int((reachable & closed).sum()),
        undecided=int(undecided.sum()),
        jumped=int((status == Status.JUMPED).sum()),
        stalled=int((status == Status.STALLED).sum()),
        residual=int(open_.sum()),
        branch=int((closed & reachable & (off > APART)).sum()),
        behind=int((closed & ~reachable & ~undecided).sum()),
        error=float(np.max(np.where(right, off * solved.margin, 0.0))),
    )


def limits(linkage: Linkage, points: Array, axes: Array) -> tuple[Array, Array]:
    """How far each crank turns (designs, 1) before two branches meet; infinite if not within a turn."""

    def margin(inputs: Array) -> Array:
        return linkage.solve(linkage.stages, points, axes, inputs).margin

    ends = []
    for sign in (-1, 1):
        grid = np.linspace(0.0, sign * TURN, GRID)
        at = margin(np.broadcast_to(grid, (len(points), GRID)))
        inner = at[:, 1:-1]
        # a gap may lie between two poses of the grid: the least margins are looked at closely
        dips = np.where((inner <= at[:, :-2]) & (inner <= at[:, 2:]) & (inner > 0), inner, np.inf)
        few = np.argsort(dips, axis=1)[:, :4] + 1
        low, high = grid[few - 1], grid[few + 1]
        for _ in range(40):  # thirds
            one, other = low + (high - low) / 3, high - (high - low) / 3
            left = margin(one) < margin(other)
            low, high = np.where(left, low, one), np.where(left, other, high)
        bottom = (low + high) / 2
        crossed = np.where(at <= 0, np.abs(grid), np.inf)
        hidden = np.where(margin(bottom) <= 0, np.abs(bottom), np.inf)
        first = np.minimum(crossed.min(axis=1), hidden.min(axis=1))[:, None]
        outside = np.where(np.isfinite(first), first, 0.0)
        inside = np.maximum(outside - TURN / (GRID - 1), 0.0)
        for _ in range(60):
            middle = (inside + outside) / 2
            free = margin(sign * middle) > 0
            inside, outside = np.where(free, middle, inside), np.where(free, outside, middle)
        ends.append(sign * np.where(np.isfinite(first), inside, np.inf))
    return ends[0], ends[1]
