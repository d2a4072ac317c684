"""Colours of glTF, which are of linear light there, and as on the screen (sRGB) in parts."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

Color = tuple[float, float, float]
"""Red, green, blue, 0 to 1, as on the screen."""


def from_gltf(factor: Sequence[float]) -> Color:
    """Return the colour on the screen of a `baseColorFactor`, to four digits."""
    linear = np.array(factor[:3], float)
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    red, green, blue = np.clip(srgb, 0, 1).round(4).tolist()
    return red, green, blue


def to_gltf(color: Color) -> list[float]:
    """Return the `baseColorFactor` of a colour on the screen, opaque."""
    screen = np.array(color)
    return [*np.where(screen <= 0.04045, screen / 12.92, ((screen + 0.055) / 1.055) ** 2.4).tolist(), 1.0]
