"""Planar robots with closed forms: a five-bar driven at both arms, and a platform on three legs (3-RPR)."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import label

import jaxkin as jk
from reference import planar
from reference.mechanisms import Z, flat

BASE = np.array([[0.0, 0.0], [15.91, 0.0], [0.0, 10.0]])
PLATFORM = planar.meet(np.zeros(2), 20.84, np.array([17.04, 0.0]), 16.54, 1)
PLATFORM = np.array([[0.0, 0.0], [17.04, 0.0], PLATFORM])
LEGS = np.array([14.98, 15.38, 12.0])
"""A 3-RPR robot with six poses (Innocenti and Parenti-Castelli, 1992)."""


def corners(pose) -> np.ndarray:
    x, y, angle = pose
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return PLATFORM @ turn.T + [x, y]


def three_rpr(pose) -> jk.Mechanism:
    joints = []
    for i, (base, corner) in enumerate(zip(BASE, corners(pose), strict=True)):
        joints += [
            jk.revolute(f"base {i}", "ground", f"tube {i}", point=flat(base), axis=Z),
            jk.prismatic(f"leg {i}", f"tube {i}", f"rod {i}", axis=flat(corner - base), point=flat(base)),
            jk.revolute(f"top {i}", f"rod {i}", "platform", point=flat(corner), axis=Z),
        ]
    return jk.Mechanism.build(fixed=["ground"], joints=joints)


WIDTH, ARM, START = 80.0, np.hypot(30.0, 60.0), np.arctan2(60.0, -30.0)
FINE = 24
"""Intervals between two nodes at which the closed form is looked at."""


def elbows(left, right):
    """Ends of the two arms (poses, 2) for displacements of their drives; the right one is the mirror image."""
    return planar.polar(ARM, START + left), np.array([WIDTH, 0.0]) + planar.polar(ARM, np.pi - START + right)


def tip(left, right, rod):
    """Where the rods meet, above the line of the elbows; nan where they do not."""
    one, other = elbows(np.asarray(left, float), np.asarray(right, float))
    with np.errstate(invalid="ignore"):
        return planar.meet(one, rod, other, rod, 1)


def five_bar(rod: float) -> jk.Mechanism:
    left, right = (place[0] for place in elbows(np.zeros(1), np.zeros(1)))
    top = tip(np.zeros(1), np.zeros(1), rod)
    joints = [
        jk.revolute("A", "ground", "left", point=(0, 0, 0), axis=Z),
        jk.revolute("B", "left", "left rod", point=flat(left), axis=Z),
        jk.revolute("C", "left rod", "right rod", point=flat(top), axis=Z),
        jk.revolute("D", "right", "right rod", point=flat(right), axis=Z),
        jk.revolute("E", "ground", "right", point=(WIDTH, 0, 0), axis=Z),
    ]
    return jk.Mechanism.build(fixed=["ground"], joints=joints)


def connected(grid, rod, inside=True) -> np.ndarray:
    """Nodes that are connected with the assembled pose along the lines of the grid, through poses that exist.

    And through those nodes only that are `inside`.
    """
    fine = np.linspace(grid[0], grid[-1], FINE * (len(grid) - 1) + 1)
    there = np.isfinite(tip(*(each.ravel() for each in np.meshgrid(fine, fine, indexing="ij")), rod)[:, 0])
    there = there.reshape(len(fine), len(fine))
    lines = np.zeros_like(there)
    lines[::FINE] = lines[:, ::FINE] = True
    there[::FINE, ::FINE] &= inside
    islands = label(there & lines)[0]
    home = int(np.argmin(np.abs(fine)))
    return islands[::FINE, ::FINE] == islands[home, home]
