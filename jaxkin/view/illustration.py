"""A mechanism drawn as an illustration: plain colours, outlines, and soft shadows between its layers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, UInt8

from jaxkin.view.camera import View
from jaxkin.view.raster import Raster, normals, rasterise

SUPERSAMPLING = 3
"""Pixels drawn along one pixel of the picture, for smooth edges."""
PAPER, INK, FAINT_INK = (1.0, 1.0, 1.0), (0.13, 0.15, 0.18), (0.58, 0.60, 0.63)
HATCH = (5, 1)
"""Distance between the hatching lines of fixed parts and their width, in pixels along x."""
HATCHED = 0.93
"""Brightness of a hatching line."""
LIGHT = np.array([-0.35, -0.55, 0.76], np.float32)
"""Direction towards the light, in axes of pixels (y downwards): from the upper left."""
CONTRAST = 0.45
"""How strongly the brightness of a face follows the cosine between its normal and `LIGHT`."""
CREASE_COSINE = float(np.cos(np.deg2rad(38)))
"""An edge is drawn where faces turn by more: beyond what a tessellated round face turns between triangles."""
DEPTH_STEP = 2.0
"""Depth between neighbours, in pixels drawn and over the slope, that no plane has: a step."""
SHADOW, SHADOW_REACH = 0.26, 7.0  # darkest shadow; how far it reaches and how deep a layer lies to be in it, in pixels


@dataclass(frozen=True, eq=False)
class Canvas:
    """Where the picture lies in the view."""

    view: View
    corner: Float[np.ndarray, "3"]
    """Upper left corner of the picture, halfway through the depth, in coordinates of the view."""
    scale: float
    """Pixels over the unit of length."""
    height: int
    width: int

    def pixels(self, points: Float[np.ndarray, "*batch 3"]) -> Float[np.ndarray, "*batch 3"]:
        """Turn world coordinates into pixels: to the right, downwards, towards the viewer."""
        return (self.view.project(points) - self.corner) * [self.scale, -self.scale, self.scale]


@dataclass(frozen=True, eq=False)
class Layer:
    """Some of the parts, drawn at `SUPERSAMPLING` times the size of the picture."""

    present: Bool[np.ndarray, "height width"]
    depth: Float[np.ndarray, "height width"]
    """In pixels drawn, towards the viewer; -inf where nothing is present."""
    color: Float[np.ndarray, "height width 3"]
    outline: Bool[np.ndarray, "height width"]
    """Around each part; beyond its edge as well."""
    crease: Bool[np.ndarray, "height width"]
    """Along the edges within a part."""


def draw(canvas: Canvas, parts: Sequence[Float[np.ndarray, "_ 3 3"]], colors: Sequence[Sequence[float]]) -> Layer:
    """Draw parts given by their triangles in world coordinates; a face that faces the viewer keeps its colour."""
    points = canvas.pixels(np.concatenate([*parts, np.zeros((0, 3, 3))])) * SUPERSAMPLING
    raster = rasterise(points, canvas.height * SUPERSAMPLING, canvas.width * SUPERSAMPLING)
    # One row a triangle, and a last one for index -1, where there is none.
    owners = np.append(np.repeat(np.arange(len(parts)), [len(triangles) for triangles in parts]), -1)
    normal = np.vstack([normals(points), [0.0, 0.0, 1.0]]).astype(np.float32)
    light = 1 + CONTRAST * (normal @ LIGHT - LIGHT[2])
    color = np.clip(np.array([*colors, PAPER], np.float32)[owners] * light[:, None], 0, 1)
    outline, crease = _edges(raster, owners, normal)
    return Layer(raster.triangle >= 0, raster.depth, color.take(raster.triangle, axis=0), _grown(outline), crease)


def backdrop(fixed: Layer, ghost: Layer) -> Float[np.ndarray, "height width 3"]:
    """Draw what is behind moving parts at all poses: fixed parts hatched in grey, and the outlines of a ghost."""
    image = fixed.color.copy()
    rows, columns = np.arange(image.shape[0])[:, None], np.arange(image.shape[1])
    image[fixed.present & ((rows + columns) % (HATCH[0] * SUPERSAMPLING) < HATCH[1] * SUPERSAMPLING)] *= HATCHED
    _ink(image, fixed.crease, FAINT_INK, 0.8)
    _ink(image, fixed.outline, FAINT_INK, 1.0)
    _ink(image, ghost.outline, INK, 0.22)
    return image


def compose(
    behind_all: Float[np.ndarray, "height width 3"], fixed: Layer, moving: Layer
) -> UInt8[np.ndarray, "height width 3"]:
    """Draw moving parts over a `backdrop` of fixed ones.

    What a fixed part hides of a moving one shows through it, so that a housing does not hide the mechanism.
    """
    from PIL import Image

    image = behind_all.copy()
    front = moving.present & (moving.depth >= fixed.depth)
    behind = moving.present & ~front
    (at,), (under,) = (np.nonzero(each.ravel()) for each in (front, behind))
    pixels, colors = image.reshape(-1, 3), moving.color.reshape(-1, 3)
    pixels[at] = colors[at]
    pixels[under] = 0.7 * pixels[under] + 0.3 * colors[under]
    image *= 1 - _shadow(np.where(front, moving.depth, fixed.depth))[..., None]
    covered = _grown(_grown(behind)) & ~_grown(_grown(front))
    _ink(image, moving.crease & front, INK, 0.45)
    _ink(image, moving.outline & ~covered, INK, 0.9)
    _ink(image, moving.outline & covered, INK, 0.25)
    return np.asarray(Image.fromarray((255 * image + 0.5).astype(np.uint8)).reduce(SUPERSAMPLING))


def _edges(raster: Raster, owners: np.ndarray, normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Find pixels at the border of two parts, and where one part has a crease or a step; both sides of each."""
    outline, crease = np.zeros(raster.triangle.size, bool), np.zeros(raster.triangle.size, bool)
    places = np.arange(raster.triangle.size).reshape(raster.triangle.shape)
    face, depth = raster.triangle.ravel(), raster.depth.ravel()
    for one, other in ((places[1:], places[:-1]), (places[:, 1:], places[:, :-1])):
        change = face[one] != face[other]
        one, other = one[change], other[change]
        border = owners[face[one]] != owners[face[other]]
        outline[one] |= border
        outline[other] |= border
        one, other = one[~border], other[~border]
        first, second = normal[face[one]], normal[face[other]]
        level = np.minimum(first[:, 2], second[:, 2])
        inner = ((first * second).sum(axis=1) < CREASE_COSINE) | (
            np.abs(depth[one] - depth[other]) * level > DEPTH_STEP
        )
        crease[one] |= inner
        crease[other] |= inner
    return outline.reshape(places.shape), crease.reshape(places.shape)


def _grown(mask: Bool[np.ndarray, "height width"]) -> Bool[np.ndarray, "height width"]:
    """Grow the mask by the four neighbours of its pixels."""
    grown = mask.copy()
    for one, other in ((np.s_[1:], np.s_[:-1]), (np.s_[:, 1:], np.s_[:, :-1])):
        grown[one] |= mask[other]
        grown[other] |= mask[one]
    return grown


def _ink(image: Float[np.ndarray, "height width 3"], where: np.ndarray, ink: Sequence[float], strength: float) -> None:
    """Blend an ink into the picture, in place."""
    pixels, (at,) = image.reshape(-1, 3), np.nonzero(where.ravel())
    pixels[at] = (1 - strength) * pixels[at] + strength * np.asarray(ink, np.float32)


def _shadow(depth: Float[np.ndarray, "height width"]) -> Float[np.ndarray, "height width"]:
    """Compute how much darker a pixel is for lying deeper than its surroundings (the depth buffer through an unsharp
    mask)."""
    from scipy.ndimage import gaussian_filter

    coarse = depth[SUPERSAMPLING // 2 :: SUPERSAMPLING, SUPERSAMPLING // 2 :: SUPERSAMPLING] / SUPERSAMPLING
    solid = np.isfinite(coarse)
    weight = gaussian_filter(solid.astype(np.float32), SHADOW_REACH)
    around = gaussian_filter(np.where(solid, coarse, 0), SHADOW_REACH) / np.maximum(weight, 1e-6)
    deeper = np.where(solid, np.maximum(around - np.where(solid, coarse, 0), 0), 0)
    darker = (SHADOW * (1 - np.exp(-deeper / SHADOW_REACH))).astype(np.float32)
    return darker.repeat(SUPERSAMPLING, axis=0).repeat(SUPERSAMPLING, axis=1)
