"""Toothed wheels as triangles, and mechanisms with such solids."""

from dataclasses import replace
from itertools import pairwise

import numpy as np

import jaxkin as jk
from jaxkin.geometry.part import Part

Z = np.array([0.0, 0.0, 1.0])


def outline(number, module, *, inner=False, phase=0.0, points=24):
    """Radii of trapezoidal teeth, as tall as standard ones: 1 module above and 1.25 below the pitch circle."""
    angle = np.linspace(0.0, 2 * np.pi, number * points, endpoint=False)
    wave = np.clip(4.0 * np.abs((angle * number / (2 * np.pi) + phase) % 1.0 - 0.5) - 1.0, -0.6, 0.6) / 0.6
    radii = module * (number / 2 - 0.125 + 1.125 * wave)
    return angle, radii + 0.25 * module if inner else radii


def wheel(name, number, module, *, at=(0, 0, 0), axis=Z, width=8.0, twist=0.0, apex=None, ring=0.0, phase=0.0):
    """A wheel between two heights; with `apex`, its height on the axis, a bevel wheel; with `ring`, a ring."""
    angle, radii = outline(number, module, inner=bool(ring), phase=phase)
    layers = []
    for height in np.linspace(-width / 2, width / 2, 5):
        turned = angle + twist * height
        scale = 1.0 if apex is None else (apex - height) / apex
        layers.append(np.stack([scale * radii * np.cos(turned), scale * radii * np.sin(turned), 0 * angle + height], 1))
    walls = [strip for low, high in pairwise(layers) for strip in walls_between(low, high)]
    for layer, height in ((layers[0], -width / 2), (layers[-1], width / 2)):
        rim = np.stack([ring * np.cos(angle), ring * np.sin(angle), 0 * angle + height], 1)
        walls += walls_between(layer, rim)
    if ring:
        low, high = (
            np.stack([ring * np.cos(angle), ring * np.sin(angle), 0 * angle + h], 1) for h in (-width / 2, width / 2)
        )
        walls += walls_between(low, high)
    return Part(name, (), placed(np.concatenate(walls), at, axis))


def walls_between(low, high):
    after_low, after_high = np.roll(low, -1, axis=0), np.roll(high, -1, axis=0)
    return [np.stack([low, after_low, high], axis=1), np.stack([after_low, after_high, high], axis=1)]


def placed(triangles, at, axis):
    z = np.asarray(axis, float) / np.linalg.norm(axis)
    x = np.cross([0.3, 0.5, 0.1], z)
    x /= np.linalg.norm(x)
    return triangles @ np.stack([x, np.cross(z, x), z]) + np.asarray(at, float)


def with_solids(joints, *solids, fixed=("ground",)):
    return replace(jk.Mechanism.build(fixed=list(fixed), joints=joints), solids=solids)


def ratio(coupling, leader, follower):
    """The turn of the follower over that of the leader."""
    factors = dict(zip(coupling.coordinates, np.asarray(coupling.coefficients)[:, 0], strict=True))
    return -factors[leader] / factors[follower]
