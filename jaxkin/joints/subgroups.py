"""The displacement subgroup that holds all joints of a loop: how many equations the loop needs (Herve 1978)."""

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
    """Its freedoms, and the equations by which a loop within it closes."""


def subgroup(screws: Screws, least: float = 1e-8) -> Subgroup:
    """The smallest subgroup that holds all displacements about these screws, lengths of the order of one.

    A screw of unit size is new if more than `least` of it lies outside of those before; what comes from files was
    aligned exactly before (`jaxkin.joints.regularise`).

    Its tangent at rest is the smallest space that holds the screws and their Lie brackets; what it holds once the
    joints of a loop have moved, it held before.
    """
    basis = _basis(screws, least)
    while True:
        larger = _basis(np.concatenate([basis, _brackets(basis)], axis=1), least)
        if larger.shape[1] == basis.shape[1]:
            return Subgroup(_name(basis, least), basis.shape[1])
        basis = larger


def _basis(screws: Screws, least: float) -> Basis:
    """An orthonormal basis of the space of the screws."""
    sizes = np.linalg.norm(screws, axis=0)
    directions, values, _ = np.linalg.svd(screws / np.where(sizes > least, sizes, np.inf), full_matrices=False)
    return directions[:, values > least]


def _brackets(screws: Basis) -> Float[np.ndarray, "6 pairs"]:
    """The Lie brackets of all pairs of screws (w; v)."""
    first, second = np.triu_indices(screws.shape[1], 1)
    (w1, v1), (w2, v2) = ((screws[:3, pick].T, screws[3:, pick].T) for pick in (first, second))
    return np.concatenate([np.cross(w1, w2), np.cross(w1, v2) + np.cross(v1, w2)], axis=1).T


def _name(basis: Basis, least: float) -> str:
    """The name of a subgroup by its dimension and its rotations, with a pitch or without."""
    dimension = basis.shape[1]
    directions, values, mixes = np.linalg.svd(basis[:3], full_matrices=True)
    turns = int((values > least).sum())
    if turns != 1:
        return {(0, 0): "no motion", (0, 1): "straight", (0, 2): "translation in a plane", (0, 3): "translation"}.get(
            (turns, dimension), "spherical" if dimension == 3 else "spatial"
        )
    # of all elements that turn, that without translation in the directions that the subgroup has anyway
    turn = basis @ mixes[0] / values[0]
    slides = (basis @ mixes[1:].T)[3:]
    pitch = abs((turn[3:] - slides @ (slides.T @ turn[3:])) @ directions[:, 0]) > least
    return {
        1: "screw" if pitch else "revolute",
        2: "cylindrical",
        3: "planar with a screw" if pitch else "planar",
        4: "Schoenflies",
    }[dimension]
