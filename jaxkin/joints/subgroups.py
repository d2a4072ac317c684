"""The displacement subgroup that contains all joints of a loop: its dimension is the number of closure equations.

Herve 1978 lists the subgroups.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.joints.screws import Screws

Basis = Float[np.ndarray, "6 dimension"]
"""Orthonormal screws."""


class Subgroup(NamedTuple):
    """A subgroup of the displacements of space."""

    name: str
    dimension: int
    """Number of its freedoms, and of the closure equations of a loop within it."""


def subgroup(screws: Screws, least: float = 1e-8) -> Subgroup:
    """Find the smallest displacement subgroup that contains the motions about all given screws.

    Its tangent space is the Lie algebra that the screws generate: the smallest space that contains them and all their
    Lie brackets. It stays the same when the joints of a loop move. Lengths are of the order of one. A unit screw counts
    as new if its part outside of the space so far is larger than `least`; screws from files have been aligned exactly
    (`jaxkin.joints.regularise`).
    """
    basis = _basis(screws, least)
    while True:
        larger = _basis(np.concatenate([basis, _brackets(basis)], axis=1), least)
        if larger.shape[1] == basis.shape[1]:
            return Subgroup(_name(basis, least), basis.shape[1])
        basis = larger


def _basis(screws: Screws, least: float) -> Basis:
    """Find an orthonormal basis of the space of the screws."""
    sizes = np.linalg.norm(screws, axis=0)
    directions, values, _ = np.linalg.svd(screws / np.where(sizes > least, sizes, np.inf), full_matrices=False)
    return directions[:, values > least]


def _brackets(screws: Basis) -> Float[np.ndarray, "6 pairs"]:
    """Compute the Lie brackets of all pairs of screws (w; v)."""
    first, second = np.triu_indices(screws.shape[1], 1)
    (w1, v1), (w2, v2) = ((screws[:3, pick].T, screws[3:, pick].T) for pick in (first, second))
    return np.concatenate([np.cross(w1, w2), np.cross(w1, v2) + np.cross(v1, w2)], axis=1).T


def _name(basis: Basis, least: float) -> str:
    """Name a subgroup by its dimension, the number of its rotations, and whether they have a pitch."""
    dimension = basis.shape[1]
    directions, values, mixes = np.linalg.svd(basis[:3], full_matrices=True)
    turns = int((values > least).sum())
    if turns != 1:
        return {(0, 0): "no motion", (0, 1): "straight", (0, 2): "translation in a plane", (0, 3): "translation"}.get(
            (turns, dimension), "spherical" if dimension == 3 else "spatial"
        )
    # of all twists with a rotation, the one without translation in directions that the subgroup contains anyway
    turn = basis @ mixes[0] / values[0]
    slides = (basis @ mixes[1:].T)[3:]
    pitch = abs((turn[3:] - slides @ (slides.T @ turn[3:])) @ directions[:, 0]) > least
    return {
        1: "screw" if pitch else "revolute",
        2: "cylindrical",
        3: "planar with a screw" if pitch else "planar",
        4: "Schoenflies",
    }[dimension]
