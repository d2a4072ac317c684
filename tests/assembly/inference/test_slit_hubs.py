"""Collars on hexagons, with a slit from the bore to the rim, whose screw is not drawn."""

import numpy as np
import pytest

from jaxkin.geometry.surfaces import Cylinder, Plane
from reference.round_parts import SEEDS, anywhere, assembly, owners, part, pin, ring

FLAT, RIM, HALF, ENDS = 5.0, 12.0, 1.0, (10.0, 20.0)
"""Distance of the flats and of the rim from the axis z, half of the width of a slit, and where the collar is."""


def wall(normal, distance, low, high, ends):
    """A plane face along z with a normal, between two places beside it."""
    normal = np.array([*normal, 0.0])
    along, middle = np.array([-normal[1], normal[0], 0.0]), distance * normal
    corners = ((low, ends[0]), (high, ends[0]), (high, ends[1]), (low, ends[1]))
    a, b, c, d = (middle + across * along + [0, 0, z] for across, z in corners)
    return Plane(a, normal), np.array([[a, b, c], [a, c, d]])


def hexagon(side, ends, gap=None):
    """Six walls about z, facing outwards or, with a side of -1, inwards; a gap parts the first."""
    edge, faces = FLAT / np.sqrt(3), []
    for k, angle in enumerate(np.arange(6) * np.pi / 3):
        spans = [(-edge, edge)] if k or gap is None else [(-edge, -gap), (gap, edge)]
        normal = side * np.array([np.cos(angle), np.sin(angle)])
        faces += [wall(normal, side * FLAT, *span, ends) for span in spans]
    return faces


def collar(bottom):
    """A collar with a slit from the rim down to the distance `bottom` from the axis; none with None."""
    if bottom is None:
        return [*ring(RIM - 1, RIM, *ENDS), *hexagon(-1, ENDS)]
    start = np.arcsin(HALF / RIM)
    angles = np.linspace(start, 2 * np.pi - start, 73)
    low, high = (np.stack([RIM * np.cos(angles), RIM * np.sin(angles), np.full(73, z)], axis=1) for z in ENDS)
    quads = np.stack([low[:-1], low[1:], high[1:], low[:-1], high[1:], high[:-1]], axis=1).reshape(-1, 3, 3)
    rim = Cylinder(np.zeros(3), np.array([0.0, 0.0, 1.0]), RIM, 1), quads
    out = float(np.sqrt(RIM**2 - HALF**2))
    sides = [wall((0, -1), -HALF, bottom, out, ENDS), wall((0, 1), -HALF, -out, -bottom, ENDS)]
    return [rim, *sides, *hexagon(-1, ENDS, HALF if bottom == FLAT else None)]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("bottom", "held"), [(FLAT, True), (9.0, False), (None, False)])
def test_a_collar_on_a_hexagon_is_clamped_by_a_slit_through_its_wall(bottom, held, seed):
    """A groove in the rim clamps nothing, and without a slit a hub slides on the shaft."""
    shaft = part("shaft", pin(3.0, -20, 0), hexagon(1, (0.0, 60.0)))
    drawn = assembly(part("base", ring(3.0, 9.0, -20, 0)), shaft, part("collar", collar(bottom)))
    mechanism = anywhere(drawn, seed).mechanism(fixed=["base"])
    body = owners(mechanism)
    assert (body["collar"] == body["shaft"]) is held
    assert any("its slit" in note for note in mechanism.history) is held
