"""Mechanisms of `reference` with masses, and their energies found from points alone."""

from dataclasses import replace

import numpy as np

import jaxkin as jk
from reference.mechanisms import planar_fourbar

GRAVITY = (1.0, -9.0, 0.5)

FOURBAR_MASSES = {
    "crank": jk.Mass(2.0, centre=(10.0, 8.0, 3.0), inertia=np.diag([1e-3, 1e-3, 2e-3])),
    "coupler": jk.Mass(1.5, centre=(60.0, 50.0, -5.0), inertia=np.diag([1e-3, 3e-3, 4e-3])),
    "rocker": jk.Mass(3.0, centre=(120.0, 30.0, 4.0), inertia=2e-3),
}

FOURBAR_SPRINGS = (
    jk.spring("ground", (0, 150, 10), "coupler", (70, 60, 20), stiffness=400.0, length=60.0, damping=15.0),
    jk.joint_spring("D", 3.0, rest=0.2, damping=0.4),
)


def fourbar(**lengths) -> jk.Mechanism:
    """The planar four-bar, lengths in mm."""
    return replace(planar_fourbar(**lengths), unit="mm")


def whole_turn(poses=64) -> np.ndarray:
    """Angles of a whole turn, the end left out."""
    return np.arange(poses) * 2 * np.pi / poses


def by_time(rows: np.ndarray, rate: float, order: int = 1) -> np.ndarray:
    """Derivative by time of what a whole turn at a constant rate repeats: each harmonic differentiated."""
    poses = len(rows)
    waves = np.fft.fftfreq(poses, 1 / poses)
    waves[poses // 2] = 0.0
    factors = (1j * waves * rate) ** order
    return np.fft.ifft(factors.reshape(-1, *[1] * (rows.ndim - 1)) * np.fft.fft(rows, axis=0), axis=0).real


def equivalent_points(mass: jk.Mass, metre=1e-3) -> tuple[np.ndarray, np.ndarray]:
    """Points (_, 3) and their masses that move as a part does: six on its principal axes, and the rest in the centre.

    A pair at +-r on each axis with the mass m0 together gives the second moments m0 r^2.
    """
    inertia = np.asarray(mass.inertia, float)
    inertia = inertia * np.eye(3) if inertia.ndim == 0 else inertia
    moments, axes = np.linalg.eigh(0.5 * np.trace(inertia) * np.eye(3) - inertia)
    share = mass.mass / 4
    radii = np.sqrt(np.maximum(moments, 0) / share) / metre
    centre = np.asarray(mass.centre, float)
    points = [centre + sign * r * axis for r, axis in zip(radii, axes.T, strict=True) for sign in (1, -1)]
    return np.array([*points, centre]), np.array([share / 2] * 6 + [share])


def energies(motion: jk.Motion, given, rate: float, gravity=GRAVITY) -> tuple[np.ndarray, np.ndarray]:
    """Kinetic and potential energy (joules) of all parts in each pose, from paths of points over a whole turn."""
    kinetic = potential = np.zeros(len(motion))
    for part, mass in given.items():
        for point, share in zip(*equivalent_points(mass), strict=True):
            path = 1e-3 * np.asarray(motion.points(part, point))
            kinetic = kinetic + 0.5 * share * np.sum(by_time(path, rate) ** 2, axis=1)
            potential = potential - share * path @ np.asarray(gravity)
    return kinetic, potential
