"""Parts as if of glass: pale, with hidden edges, seen from the corner that hides least of any, and areas in them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np
from jaxtyping import Bool, Float, UInt8

from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Vector, frame
from jaxkin.view.camera import View, choose_view, thumbnail
from jaxkin.view.illustration import PAPER, SUPERSAMPLING, Canvas, draw
from jaxkin.view.sheet import Color

WIDTH = 1300
"""Pixels of the longer side of the drawing."""
GLASS_MARGIN = 0.06
"""Around the parts, over the larger side: axes reach beyond them."""
PALE = 0.62
"""Share of white in the parts, so that what is in them is seen."""
THROUGH = 12
"""Parts at most whose hidden edges are drawn too."""

CORNER = np.array([0.62, 0.35, 0.7])
"""Where an oblique view is from: above the plane of most flat faces, beside and before it."""
PITCH = float(np.arcsin(CORNER[0] / np.linalg.norm(CORNER)))
"""How far it looks down on that plane, radians."""
ASIDE = 0.05
"""Distance of the middles of moving and fixed parts, over the size of all, from which on they are on one side of them:
parts within a frame are not."""


def pale(color: Color) -> Color:
    """Find the colour that parts of a colour get."""
    red, green, blue = (PALE + (1 - PALE) * channel for channel in color)
    return red, green, blue


def canvas_of(parts: Sequence[Part], fixed: Sequence[str], longer: int = WIDTH) -> Canvas:
    """Find what the drawing shows of the parts, from where, and how large: the pixels of its longer side."""
    view = oblique_view(parts, fixed)
    points = view.project(np.concatenate([part.triangles.reshape(-1, 3) for part in parts]))
    low, high = points.min(axis=0), points.max(axis=0)
    margin = GLASS_MARGIN * (high - low)[:2].max()
    extent, centre = (high - low)[:2] + 2 * margin, (low + high) / 2
    scale = longer / extent.max()
    width, height = (int(np.ceil(side * scale)) for side in extent)
    corner = np.append(centre[:2] + np.array([-width, height]) / (2 * scale), centre[2])
    return Canvas(view, corner, scale, height, width)


def see_through(
    canvas: Canvas,
    parts: Sequence[Part],
    colors: Sequence[Color],
    areas: Sequence[Float[np.ndarray, "_ 3 3"]],
    color: Color,
) -> UInt8[np.ndarray, "height width 3"]:
    """Draw the parts in pale colours, and over them areas in one colour: strong where they are in front, else
    through."""
    from PIL import Image

    solid = draw(canvas, [part.triangles for part in parts], colors)
    image = solid.color  # blended in place: a picture has tens of millions of pixels drawn
    image *= 1 - PALE
    image += PALE
    image[~solid.present] = 1.0
    image[solid.crease] *= 0.8
    image[solid.outline] *= 0.45
    for part in parts if len(parts) <= THROUGH else ():
        image[_hidden_edges(canvas, part, solid.depth)] *= 0.8
    if areas:
        layer = draw(canvas, areas, [color] * len(areas))
        front = layer.depth >= solid.depth - 1e-3 * canvas.width * SUPERSAMPLING
        for where, strength in ((layer.present & front, 0.8), (layer.present & ~front, 0.42)):
            image[where] = (1 - strength) * image[where] + strength * layer.color[where]
        rim = layer.outline & ~layer.present
        image[rim] = 0.4 * image[rim] + 0.6 * np.array(color, np.float32)
    np.clip(image, 0, 1, out=image)
    image *= 255
    image += 0.5
    return np.asarray(Image.fromarray(image.astype(np.uint8)).reduce(SUPERSAMPLING))


def _hidden_edges(
    canvas: Canvas, part: Part, depth: Float[np.ndarray, "height width"]
) -> Bool[np.ndarray, "height width"]:
    """Find the pixels of the edges of a part that are behind what is drawn at some depth."""
    alone = draw(canvas, [part.triangles], [PAPER])
    return (alone.outline | alone.crease) & (alone.depth < depth - 1.0)


def oblique_view(parts: Sequence[Part], fixed: Sequence[str]) -> View:
    """Choose a view obliquely on the plane of most flat faces, from the corner that hides least of any part: from the
    side of the plane on which the moving parts are, where they are on one side of the fixed ones."""
    still = {part.name: np.eye(4)[None] for part in parts}
    right, up, out = choose_view(parts, fixed, still).axes
    side = _side_of_moving(parts, fixed, out)
    views = []
    for above, beside, before in product((side,) if side else (1, -1), (1, -1), (-1, 1)):
        towards = CORNER @ np.stack([above * out, beside * right, before * up])
        views.append(View(frame(np.zeros(3), towards, np.cross(above * out, towards))[:3, :3].T, False))
    merits = [_seen(parts, view) for view in views]
    best = int(np.argmax(merits))
    return views[best] if merits[best] > merits[0] + 0.1 * len(parts) else views[0]


def _side_of_moving(parts: Sequence[Part], fixed: Sequence[str], out: Vector) -> int:
    """Tell on which side of the fixed parts the others are, 1 along `out` or -1; 0 where they are beside each other."""
    middles = np.array([part.box.mean(axis=0) @ out for part in parts])
    held = np.array([part.name in fixed for part in parts])
    if held.all() or not held.any():
        return 0
    size = np.linalg.norm(np.ptp(np.concatenate([part.box for part in parts]), axis=0))
    rise = middles[~held].mean() - middles[held].mean()
    return int(np.sign(rise)) if abs(rise) > ASIDE * size else 0


def _seen(parts: Sequence[Part], view: View) -> float:
    """Measure the sum over the parts of the logarithm of what a small picture shows of each."""
    owners = np.repeat(np.arange(len(parts)), [len(part.triangles) for part in parts])
    front = thumbnail(view, np.concatenate([part.triangles for part in parts]))
    return float(np.log1p(np.bincount(owners[front], minlength=len(parts))).sum())
