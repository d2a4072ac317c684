"""The paper's larger examples as solids: 18 bars with 20 pins in holes (Fig. 5), air cylinder and linkage (Fig. 7)."""

from __future__ import annotations

from colorsys import hls_to_rgb

import cadquery as cq
import numpy as np
from shapes import AMBER, CORAL, OCEAN, SLATE, assembly, bar, holes, pin

from jaxkin.examples import Example
from jaxkin.examples.paper import EIGHTEEN_BARS
from jaxkin.geometry.pose import frame


def eighteen_bars(example: Example) -> cq.Assembly:
    """Flat bars in layers with gaps, so that parts touch as pins in holes only. A pin belongs to the lower bar."""
    size = example.dimensions
    thick, gap, r_pin, r_end = size["thickness"], size["gap"], size["pin radius"], size["end radius"]
    ends: dict[str, list[str]] = {}
    for joint, parts in EIGHTEEN_BARS.items():
        for part in parts:
            ends.setdefault(part, []).append(joint)
    ends["p12"].append("end of p12")
    ends["p14"].append("end of p14")
    pairs = [(part, other) for pair in EIGHTEEN_BARS.values() for part, other in (pair, pair[::-1])]
    layer = {"p1": 0, "p9": 0}
    while new := {other: layer[part] + 1 for part, other in pairs if part in layer and other not in layer}:
        layer |= new

    parts = {}
    for part, joints in sorted(ends.items(), key=lambda entry: int(entry[0][1:])):
        points = [np.array([size[f"{joint} x"], size[f"{joint} y"], layer[part] * (thick + gap)]) for joint in joints]
        pose = frame(points[0], [0, 0, 1], points[1] - points[0])
        local = [(pose[:3, :3].T @ (point - points[0]))[:2] for point in points]
        solid = _hull(local, r_end, thick)
        for joint, (x, y) in zip(joints, local, strict=True):
            others = [layer[other] for other in EIGHTEEN_BARS.get(joint, ()) if other != part]
            if others and others[0] < layer[part]:
                solid = solid.cut(holes([(x, y)], r_pin, thick))
            elif others:
                solid = solid.union(pin(x, y, r_pin, thick, 2 * thick + gap, chamfer=0))
        hue = (0.13 + 0.618 * len(parts)) % 1  # golden ratio: neighbours in number look different
        red, green, blue = (round(255 * value) for value in hls_to_rgb(hue, 0.5, 0.6))
        color = SLATE if part == "p1" else "#8D9AA6" if part == "p9" else f"#{red:02X}{green:02X}{blue:02X}"
        parts[part] = (solid, color, pose)
    return assembly("eighteen bars", example.placement, parts)


def _hull(points: list[np.ndarray], radius: float, thickness: float) -> cq.Workplane:
    """A plate that is the hull of discs about two points, or about three that are not in line."""
    if len(points) == 2:
        return bar(float(np.linalg.norm(points[1] - points[0])), (radius, radius), thickness)
    outline = cq.Workplane().polyline([tuple(point) for point in points]).close()
    return outline.offset2D(radius, "arc").extrude(thickness)


def air_cylinder(example: Example) -> cq.Assembly:
    """Links before and behind platform and base, the cylinder between them, its rod's eye in a fork of the platform."""
    size = example.dimensions
    link, base, r_pin = size["link"], size["base"], size["pin radius"]
    q = link * np.array([np.cos(size["angle"]), np.sin(size["angle"]), 0.0])
    eye, trunnion = q + [base / 2, 0, 0], np.array([size["trunnion"], 0.0, 0.0])
    along = (eye - trunnion) / np.linalg.norm(eye - trunnion)
    stretch = float(np.linalg.norm(eye - trunnion))

    bottom = _block((-10, 160), (-30, -20), (-20, 20))
    for x in (0, base):
        bottom = bottom.union(_block((x - 6, x + 6), (-20, 6), (-5, 5))).union(pin(x, 0, r_pin, -18, 18, chamfer=0))
    seat = _block((size["trunnion"] - 8, size["trunnion"] + 8), (-20, 8), (-20, -8))
    bottom = bottom.union(seat).union(pin(size["trunnion"], 0, size["trunnion radius"], -8, 12, chamfer=0))

    platform = _block((-6, base + 6), (8, 16), (-5, 5))
    for x in (0, base):
        platform = platform.union(_block((x - 5.5, x + 5.5), (0, 8), (-5, 5)))
        platform = platform.union(pin(x, 0, 5.5, -5, 5, chamfer=0)).union(pin(x, 0, r_pin, -18, 18, chamfer=0))
    for z in (-8, 5):
        platform = platform.union(_block((base / 2 - 6, base / 2 + 6), (-6, 16), (z, z + 3)))
    platform = platform.union(pin(base / 2, 0, r_pin, -8, 8, chamfer=0))

    side = bar(link, (6.0, 6.0), 4).cut(holes([(0, 0), (link, 0)], r_pin, 4))
    parts = {
        "p1": (platform, AMBER, frame(q, [0, 0, 1], [1, 0, 0])),
        "p2": (_rod(size), "#7A8794", frame(eye, -along, [0, 0, 1])),
        "p3": (_tube(size["bore radius"], size["rod radius"], 6), "#6B4C9A", frame(trunnion + 53 * along, along)),
        "p4": (bottom, SLATE, np.eye(4)),
    }
    for number, (x, z) in enumerate(((0, 10), (base, 10), (0, -14), (base, -14))):
        color = (OCEAN, "#3FA7D6", "#1B4F72", "#5DADE2")[number]
        parts[f"p{5 + number}"] = (side, color, frame([x, 0, z], [0, 0, 1], q))
    parts["p9"] = (_eye(size), "#2E8B57", frame(eye, -along, [0, 0, 1]))
    parts["p10"] = (_cylinder(size), CORAL, frame(trunnion, along, [0, 0, 1]))
    if not 72 + 14 < stretch < 72 + 49:
        raise ValueError(f"the piston, 72 mm behind the eye, is outside of the bore: the pivots are {stretch} mm apart")
    return assembly("air cylinder and parallel linkage", example.placement, parts)


def _rod(size: dict[str, float]) -> cq.Workplane:
    """Along z from the eye: a tip in the eye's socket, a shoulder on it, the rod, the piston."""
    tip = pin(0, 0, size["tip radius"], 9, 14, chamfer=0)
    return tip.union(pin(0, 0, size["rod radius"], 14, 70, chamfer=0)).union(
        pin(0, 0, size["bore radius"], 68, 72, chamfer=0)
    )


def _eye(size: dict[str, float]) -> cq.Workplane:
    """About the origin, its hole along x; a shank along z with a socket for the tip of the rod."""
    ring = cq.Workplane("YZ", origin=(-4.5, 0, 0)).circle(6).extrude(9).union(pin(0, 0, 4, 3, 14, chamfer=0))
    hole = cq.Workplane("YZ", origin=(-4.5, 0, 0)).circle(size["pin radius"]).extrude(9)
    return ring.cut(hole).cut(pin(0, 0, size["tip radius"], 8, 14, chamfer=0))


def _cylinder(size: dict[str, float]) -> cq.Workplane:
    """Along z from the trunnion, whose hole is along x; the bore is open in front."""
    tail = cq.Workplane().box(16, 16, 18).union(pin(0, 0, size["bore radius"] + 2, 9, 60, chamfer=0))
    hole = cq.Workplane("YZ", origin=(-8, 0, 0)).circle(size["trunnion radius"]).extrude(16)
    return tail.cut(hole).cut(pin(0, 0, size["bore radius"], 13, 60, chamfer=0))


def _tube(outer: float, inner: float, length: float) -> cq.Workplane:
    return pin(0, 0, outer, 0, length, chamfer=0).cut(pin(0, 0, inner, 0, length, chamfer=0))


def _block(x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> cq.Workplane:
    (x0, x1), (y0, y1), (z0, z1) = x, y, z
    return cq.Workplane().box(x1 - x0, y1 - y0, z1 - z0, centered=False).translate((x0, y0, z0))
