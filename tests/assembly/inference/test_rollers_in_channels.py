"""Rollers on stubs between the flanges of channels are no fasteners, and what they carry slides.

Each is drawn with a known truth, at a place, a size and in an order at random.
"""

import numpy as np
import pytest

from jaxkin.assembly.inference.bores import bores
from jaxkin.assembly.inference.slotted_pins import slotted_pins
from jaxkin.geometry.part import moved
from reference.round_parts import SEEDS, anywhere, assembly, block, kind_of, owners, part, pin, ring

LEVER = part("lever", ring(4.1, 9.0, -95, -85, (60, 0)), block((68, -3, -95), (100, 3, -85)))
PLACES = ((0.0, 40.0), (0.0, -40.0))
"""Of two stubs on a carriage."""


def channel(half, length, *more):
    """A channel with flanges about y, or the two pockets of a plate about the stubs, and a pivot for a lever."""
    at = [(-200, 200)] if length > 200 else [(y - length / 2, y + length / 2) for _, y in PLACES]
    flanges = [
        block((min(ends), low, 8), (max(ends), high, 30))
        for low, high in at
        for ends in ((half, half + 5), (-half, -half - 5))
    ]
    web = block((-half - 5, -200, 30), (half + 5, 200, 34))
    post = [block((-5, 180, 34), (80, 200, 40)), pin(4.0, -100, 40, (60, 0)), block((55, -5, 34), (80, 190, 40))]
    return part("channel", *flanges, web, *post, *more)


def carriage(*more):
    """A block with two stubs, each with a collar that a roller lies on."""
    stubs = [piece for at in PLACES for piece in (pin(11.0, 0, 10, at), pin(7.0, 10, 25, at))]
    return part("carriage", block((-20, -60, -50), (20, 60, 0)), *stubs, *more)


ROLLERS = [part(f"roller {k}", ring(7.0, 14.5, 10, 24, at)) for k, at in enumerate(PLACES)]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("half", "length", "rolls"), [(15.0, 400.0, True), (17.0, 400.0, False), (15.0, 40.0, False)])
def test_rings_on_stubs_between_flanges_roll_along_them(half, length, rolls, seed):
    """With much play, or in pockets as long as they are, they are nuts on their studs."""
    drawn = anywhere(assembly(channel(half, length), carriage(), *ROLLERS, LEVER), seed)
    mechanism = drawn.mechanism(fixed=["channel"])
    body = owners(mechanism)
    assert (body["roller 0"] != body["carriage"]) == (body["roller 1"] != body["carriage"]) == rolls
    if rolls:
        assert kind_of(mechanism, "channel", "carriage") == "prismatic"
        assert kind_of(mechanism, "carriage", "roller 0") == "revolute"


@pytest.mark.parametrize("seed", SEEDS)
def test_rings_on_stubs_point_at_no_wall_behind_them(seed):
    """Nuts on the studs of a carriage end near a plate without holes: they screw nothing to that."""
    wall = part("wall", block((-60, -200, 26), (60, 200, 34)), pin(4.0, -100, 26, (60, 0)))
    mechanism = anywhere(assembly(wall, carriage(), *ROLLERS, LEVER), seed).mechanism(fixed=["wall"])
    assert not any("point at" in note for note in mechanism.history)
    assert owners(mechanism)["roller 0"] == owners(mechanism)["carriage"]


@pytest.mark.parametrize(("away", "beside"), [(-10.0, True), (20.0, False)])
def test_a_pin_is_beside_none_of_two_channels_whose_flanges_are_one_face(away, beside):
    """Files have the flanges of two channels in one plane as one face, with nothing between them."""
    faces: dict[tuple, list] = {}
    for x in (10, -15):
        for low, high in ((away, 60), (-60, -away)):
            for surface, triangles in block((x, -50, low), (x + 5, 50, high)):
                key = (*np.round(surface.normal, 9), round(float(surface.point @ surface.normal), 9))
                faces.setdefault(key, [surface]).append(triangles)
    channels = part("channels", [(surface, np.concatenate(some)) for surface, *some in faces.values()])
    roller = part("roller", pin(9.8, -10, 10))
    own = {each.name: bores(each) for each in (channels, roller)}
    assert len(slotted_pins([channels, roller], own, lambda _: [channels])) == beside


def mast():
    """An inner mast with rollers that fit the channels of an outer one, and a pad between both on either side."""
    sides, at = (-1, 1), PLACES

    def up(side, low, high):
        return min(side * low, side * high), max(side * low, side * high)

    outer, inner = [], [block((-20, -60, -24), (20, 60, 24))]
    parts = []
    for side in sides:
        low, high = up(side, 30, 44)
        outer += [block((x, -200, low), (x + 5, 200, high)) for x in (15, -20)]
        low, high = up(side, 44, 48)
        outer += [block((-20, -200, low), (20, 200, high))]
        inner += [pin(7.0, *up(side, 24, 43), at=each) for each in at]
        parts += [part(f"roller {side} {k}", ring(7.0, 15.0, *up(side, 31, 43), at=each)) for k, each in enumerate(at)]
        low, high = up(side, 24, 30)
        parts.append(part(f"pad {side}", block((13, -5, low), (19, 5, high))))
    outer += [block((-20, -210, -48), (20, -200, 48)), along_y(ring(3.0, 6.0, -200, -100))]
    outer.append(pin(4.0, 48, 100, (0, 150)))
    rod = along_y(pin(3.0, -150, -60), pin(2.0, -60, -40), pin(9.0, -90, -84))
    parts.append(part("lever", ring(4.1, 9.0, 80, 90, (0, 150)), block((8, 147, 80), (40, 153, 90))))
    inner.append(along_y(ring(2.0, 4.0, -60, -40))[2:3])
    return assembly(part("outer", *outer), part("inner", *inner), part("rod", rod), *parts)


def along_y(*pieces):
    """Pieces about the axis y in place of z."""
    pose = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
    return [(face.surface, face.triangles) for face in moved(part("turned", *pieces), pose).faces]


@pytest.mark.parametrize("seed", SEEDS)
def test_pads_between_masts_on_rollers_hold_them_not_together(seed):
    """A pad may be on either; the rod that is set into the inner mast slides with that."""
    mechanism = anywhere(mast(), seed).mechanism(fixed=["outer"])
    body = owners(mechanism)
    assert body["rod"] == body["inner"] != body["outer"]
    assert {body["pad 1"], body["pad -1"]} <= {body["inner"], body["outer"]}
    assert kind_of(mechanism, "inner", "outer") == "prismatic"
