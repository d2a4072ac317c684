"""Closed forms of mechanisms with higher pairs; poses as in `reference.planar`."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

Array = np.ndarray


def cam_flat_follower(theta: Array, radius=15.0, eccentricity=5.0) -> Array:
    """Height above the shaft (poses,) of a flat follower on an eccentric disc: contact (b), Fig. 6 of the paper.

    The disc's centre lies at the angle theta from the follower's face, which is perpendicular to its stroke.
    """
    return radius + eccentricity * np.sin(theta)


def cam_roller_follower(theta: Array, radius=25.0, eccentricity=8.0, roller=6.0, offset=3.0) -> Array:
    """Height (poses,) of a roller on an eccentric disc: contact (f). Its centre runs on x = offset, a slider-crank."""
    return eccentricity * np.sin(theta) + np.sqrt((radius + roller) ** 2 - (eccentricity * np.cos(theta) - offset) ** 2)


class Swash(NamedTuple):
    height: Array
    normal: Array


def swash_plate(theta: Array, distance=40.0, tilt=0.35, ball=6.0) -> Swash:
    """Height (poses,) of a ball resting on a tilted plate that turns about z, and the plate's normal: contact (d).

    The plate, tilted about x at theta = 0, passes through the origin; the ball's centre runs along z at (distance, 0).
    """
    upright = np.full(theta.shape, np.cos(tilt))
    normal = np.stack([np.sin(tilt) * np.sin(theta), -np.sin(tilt) * np.cos(theta), upright], axis=-1)
    return Swash((ball - normal[..., 0] * distance) / normal[..., 2], normal)
