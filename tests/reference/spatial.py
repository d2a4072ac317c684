"""Closed forms of spatial linkages, in numpy float64 and independent of jaxkin; poses as in `reference.planar`."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

Array = np.ndarray


def half_turns(cosine, sine, constant, branch: int) -> Array:
    """The x (poses,) with `cosine cos x + sine sin x = constant`, on one of its two branches 1 and -1."""
    ratio = constant / np.hypot(cosine, sine)
    return np.arctan2(sine, cosine) + branch * np.arccos(np.where(np.abs(ratio) > 1, np.nan, ratio))


def about_x(angle: float) -> Array:
    """Rotation about x, 3x3."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def cardan(theta: Array, shafts=0.5) -> Array:
    """Angle of the driven shaft of one universal joint between shafts at an angle of `shafts` (poses,).

    theta is zero where the driving fork's arm is along the normal of the plane of the shafts, and so is the answer.
    """
    return np.arctan2(np.cos(shafts) * np.sin(theta), np.cos(theta))


class SphericalFourBar(NamedTuple):
    output: Array
    input_pin: Array
    output_pin: Array


def spherical_fourbar(theta: Array, ground=1.2, crank=0.5, coupler=1.1, rocker=0.9, branch=1) -> SphericalFourBar:
    """Angle of the output link, and the unit axes of the two moving pins (poses, 3); all arcs in radians.

    The input turns about z, the output about Rx(ground) z; both angles are zero where the link's arc lies in the
    plane x = 0, on the side of negative y (Chiang, Kinematics of Spherical Mechanisms, 1988, chapter 2).
    """
    input_pin = np.stack([np.sin(crank) * np.sin(theta), -np.sin(crank) * np.cos(theta)], axis=-1)
    input_pin = np.concatenate([input_pin, np.full((*theta.shape, 1), np.cos(crank))], axis=-1)
    tilt = about_x(ground)
    w = input_pin @ tilt
    output = half_turns(
        -np.sin(rocker) * w[..., 1], np.sin(rocker) * w[..., 0], np.cos(coupler) - np.cos(rocker) * w[..., 2], branch
    )
    local = np.stack(
        [np.sin(rocker) * np.sin(output), -np.sin(rocker) * np.cos(output), np.full(theta.shape, np.cos(rocker))], -1
    )
    return SphericalFourBar(output, input_pin, local @ tilt.T)


class Rssr(NamedTuple):
    output: Array
    crank_ball: Array
    rocker_ball: Array


def rssr(
    theta: Array, crank=30.0, rod=140.0, rocker=70.0, pivot=(100.0, 40.0, 60.0), axis=(0.2, 0.9, 0.3), branch=1
) -> Rssr:
    """Angle of the rocker, and the centres of the balls (poses, 3) (Hartenberg and Denavit, 1964, chapter 12).

    The crank turns about z at the origin from x, the rocker about `axis` at `pivot` from the direction axis x z. The
    rod may spin about its own axis: the mobility is 2.
    """
    axis = np.asarray(axis)
    normal = axis / np.linalg.norm(axis)
    zero = np.cross(normal, np.array([0.0, 0.0, 1.0]))
    zero = zero / np.linalg.norm(zero)
    quarter = np.cross(normal, zero)
    ball = crank * np.stack([np.cos(theta), np.sin(theta), np.zeros(theta.shape)], axis=-1)
    w = ball - np.asarray(pivot)
    output = half_turns(
        2 * rocker * w @ zero, 2 * rocker * w @ quarter, (w * w).sum(axis=-1) + rocker**2 - rod**2, branch
    )
    arm = np.cos(output)[..., None] * zero + np.sin(output)[..., None] * quarter
    return Rssr(output, ball, np.asarray(pivot) + rocker * arm)


def bennett_length(length=60.0, twist=0.7, other_twist=1.2) -> float:
    """Length of the other two links of a Bennett linkage (Bennett, 1903): lengths are as the sines of the twists."""
    return length * np.sin(other_twist) / np.sin(twist)


def bennett(theta: Array, twist=0.7, other_twist=1.2) -> Array:
    """The four joint angles (poses, 4) of a Bennett linkage, Denavit-Hartenberg, offsets zero, links in turn alike."""
    ratio = np.sin((other_twist + twist) / 2) / np.sin((other_twist - twist) / 2)
    phi = 2 * np.arctan2(ratio * np.cos(theta / 2), np.sin(theta / 2))
    return np.stack([theta, phi, -theta, -phi], axis=-1)


def sarrus(theta: Array, link=50.0) -> Array:
    """Height of the platform of a Sarrus linkage (1853), links equal and at theta above the base; it never turns."""
    return 2 * link * np.sin(theta)
