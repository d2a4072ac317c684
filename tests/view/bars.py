"""Simple solids for the tests of the pictures."""

import numpy as np
import trimesh

from jaxkin.geometry.part import Part

TURN = np.linspace(0.0, 2 * np.pi, 61)
COLORS = {"crank": (0.8, 0.2, 0.2), "coupler": (0.2, 0.2, 0.8), "rocker": (0.2, 0.6, 0.2)}


def box(name, low, high, color=None):
    """A box between two corners."""
    return Part(name, (), trimesh.creation.box(bounds=[low, high]).triangles.view(np.ndarray), color)


def bar(name, start, end, z, color=None):
    """A bar 8 wide and 4 thick between two points of the plane; its lower side at height z."""
    start, end = np.append(start, z), np.append(end, z)
    length = np.linalg.norm(end - start)
    pose = np.eye(4)
    pose[:3, 0] = (end - start) / length
    pose[:3, 1] = np.cross([0, 0, 1.0], pose[:3, 0])
    pose[:3, 3] = (start + end) / 2 + [0, 0, 2.0]
    solid = trimesh.creation.box((length + 8, 8, 4), transform=pose)
    return Part(name, (), solid.triangles.view(np.ndarray), color)
