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


def disc_profile(count: int, radius=25.0, eccentricity=8.0, angle=0.0) -> Array:
    """Points (count, 2) of a disc whose centre is off the shaft, at an angle."""
    turn = 2 * np.pi * np.arange(count) / count
    centre = eccentricity * np.array([np.cos(angle), np.sin(angle)])
    return centre + radius * np.stack([np.cos(turn), np.sin(turn)], axis=-1)


def cam_roller_arm(theta, xp=np, radius=25.0, eccentricity=8.0, roller=6.0, pivot=40.0, arm=35.0):
    """Angle of an arm, pivoted at (pivot, 0), to a roller on top of an eccentric disc: the rocker of a four-bar."""
    x, y = eccentricity * xp.cos(theta) - pivot, eccentricity * xp.sin(theta)
    far = xp.sqrt(x * x + y * y)
    corner = (far**2 + arm**2 - (radius + roller) ** 2) / (2 * far * arm)
    return xp.arctan2(y, -x) * -1.0 + np.pi - xp.arccos(corner)


def cam_flat_arm(theta, xp=np, radius=25.0, eccentricity=8.0, pivot=40.0):
    """Angle of a flat face through its pivot at (pivot, 0) that lies on an eccentric disc from above."""
    x, y = eccentricity * xp.cos(theta) - pivot, eccentricity * xp.sin(theta)
    return np.pi - xp.arctan2(y, -x) - xp.arcsin(radius / xp.sqrt(x * x + y * y))


def flat_cam_of(lift, rate, angle: Array, base: float) -> Array:
    """Profile (poses, 2) of a cam that lifts a flat face across its stroke by `lift(angle)`; `rate` is its derivative.

    The face is at the height base + lift above the shaft, and touches beside the stroke by the rate.
    """
    height, beside = base + lift(angle), rate(angle)
    return _turned_back(beside, height, angle)


def roller_cam_of(lift, rate, angle: Array, base: float, roller: float) -> Array:
    """Profile (poses, 2) of a cam that lifts a roller, whose centre is on the stroke, by `lift(angle)`.

    The centre of the roller is at the height base + roller + lift; the profile is a roller's radius away from the
    curve of the centre, along the normal of that.
    """
    height, rise = base + roller + lift(angle), rate(angle)
    length = np.hypot(rise, height)
    return _turned_back(roller * rise / length, height - roller * height / length, angle)


def _turned_back(x: Array, y: Array, angle: Array) -> Array:
    """Points fixed in the world, in axes of a cam that has turned by the angle: clockwise the profile."""
    cos, sin = np.cos(angle), np.sin(angle)
    return np.stack([cos * x + sin * y, cos * y - sin * x], axis=-1)
