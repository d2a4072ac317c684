"""Closed forms of parallel robots: the inputs that a pose of the platform needs; as in `reference.planar` otherwise."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from reference.spatial import half_turns

Array = np.ndarray


class Hexapod(NamedTuple):
    base: Array
    """Centres of the balls of the base (6, 3), in the plane z = 0."""
    platform: Array
    """Centres of the balls of the platform (6, 3), in coordinates of the platform."""

    def legs(self, rotations: Array, positions: Array) -> Array:
        """Lengths of the legs (poses, 6) for rotations (poses, 3, 3) and positions (poses, 3) (Stewart, 1965)."""
        ends = self.platform @ np.swapaxes(rotations, -1, -2) + positions[..., None, :]
        return np.linalg.norm(ends - self.base, axis=-1)


def hexapod(base_radius=200.0, platform_radius=120.0, base_gap=0.25, platform_gap=0.35) -> Hexapod:
    """Balls in pairs at thirds of a turn, half a gap (radians) to either side; the platform's thirds stand between."""
    thirds = 2 * np.pi / 3 * np.arange(3)[:, None]
    base = (thirds + base_gap * np.array([-1, 1])).ravel()
    platform = (thirds + (np.pi / 3 - platform_gap) * np.array([-1, 1])).ravel()
    return Hexapod(_ring(base_radius, base), _ring(platform_radius, platform))


class Dietmaier(NamedTuple):
    """P. Dietmaier, The Stewart-Gough platform of general geometry can have 40 real postures (Advances in Robot
    Kinematics, 1998): the lengths of its legs, six decimals each, with which all 40 poses are real."""

    base: Array = np.array(
        [
            [0, 0, 0],
            [1.107915, 0, 0],
            [0.549094, 0.756063, 0],
            [0.735077, -0.223935, 0.525991],
            [0.514188, -0.526063, -0.368418],
            [0.590473, 0.094733, -0.205018],
        ]
    )
    platform: Array = np.array(
        [
            [0, 0, 0],
            [0.542805, 0, 0],
            [0.956919, -0.528915, 0],
            [0.665885, -0.353482, 1.402538],
            [0.478359, 1.158742, 0.107672],
            [-0.137087, -0.235121, 0.353913],
        ]
    )
    legs: Array = np.array([1.0, 0.645275, 1.086284, 1.503439, 1.281933, 0.771071])

    def misfit(self, rotations: Array, positions: Array) -> Array:
        """Lengths of the legs less those given (poses, 6)."""
        return Hexapod(self.base, self.platform).legs(rotations, positions) - self.legs

    def a_pose(self) -> Array:
        """The balls of the platform (6, 3) in one of the poses, found by Gauss-Newton steps from a random one."""
        rng = np.random.default_rng(0)
        for _ in range(100):
            found = least_squares(
                lambda x: self.misfit(Rotation.from_rotvec(x[:3]).as_matrix(), x[3:]),
                rng.normal(size=6),
                xtol=1e-15,
                ftol=1e-15,
                gtol=1e-15,
            )
            if np.abs(found.fun).max() < 1e-14:
                return self.platform @ Rotation.from_rotvec(found.x[:3]).as_matrix().T + found.x[3:]
        raise ValueError("no start led to a closed pose")


class Curve(NamedTuple):
    """A closed curve of a platform."""

    moved: Array
    """Displacement of the platform (poses, 4, 4)."""
    legs: Array
    """Displacements of the legs (poses, 6)."""


def curve(base: Array, home: Array, poses: int) -> Curve:
    """A platform that starts with its balls at `home` sways 20 mm and 0.2 rad about its middle, and comes back."""
    x, centre = np.linspace(0.0, 2 * np.pi, poses), home.mean(axis=0)
    moved = np.tile(np.eye(4), (poses, 1, 1))
    axes = np.stack([0.1 * np.sin(x), 0.1 - 0.1 * np.cos(x), 0.2 * np.sin(2 * x)], axis=1)
    shift = np.stack([20 * np.sin(x), 15 - 15 * np.cos(x), 10 * np.sin(x)], axis=1)
    moved[:, :3, :3] = Rotation.from_rotvec(axes).as_matrix()
    moved[:, :3, 3] = centre + shift - moved[:, :3, :3] @ centre
    tops = np.einsum("pij,kj->pki", moved[:, :3, :3], home) + moved[:, None, :3, 3]
    return Curve(moved, np.linalg.norm(tops - base, axis=2) - np.linalg.norm(home - base, axis=1))


def _ring(radius: float, angles: Array) -> Array:
    return np.stack([radius * np.cos(angles), radius * np.sin(angles), np.zeros(angles.shape)], axis=-1)


def delta(positions: Array, base_radius=200.0, platform_radius=45.0, arm=240.0, forearm=560.0) -> Array:
    """Angles of the three arms (poses, 3) of Clavel's Delta for platform centres (poses, 3) (Clavel, 1990).

    Arm k swings about the tangent of the base circle at k thirds of a turn; a positive angle lowers it towards -z.
    """
    x, y, z = np.moveaxis(np.asarray(positions), -1, 0)
    angles = []
    for turn in 2 * np.pi / 3 * np.arange(3):
        outward = np.cos(turn) * x + np.sin(turn) * y + platform_radius - base_radius
        across = -np.sin(turn) * x + np.cos(turn) * y
        reach = outward**2 + across**2 + z**2 + arm**2 - forearm**2
        angles.append(half_turns(2 * arm * outward, -2 * arm * z, reach, -1))
    return np.stack(angles, axis=-1)
