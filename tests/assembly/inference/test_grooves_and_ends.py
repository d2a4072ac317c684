"""What published scripts leave out and leave open: grooves open by half, screws in the ends of shafts, guide rods."""

from itertools import pairwise

import numpy as np
import pytest

from jaxkin.geometry.surfaces import Plane
from reference.round_parts import SEEDS, anywhere, assembly, block, kind_of, moving, owners, part, pin, ring


def of(seed, *parts, fixed="base"):
    mechanism = anywhere(assembly(*parts), seed).mechanism(fixed=[fixed])
    return owners(mechanism), mechanism


def groove(radius, low, high, way=-1.0):
    """The round face of a groove about the axis z that is open by half, towards y or against it."""
    wall = ring(radius, 2 * radius, low, high)[2]
    surface, triangles = wall
    assert surface.side < 0
    return [(surface, triangles[way * triangles[:, :, 1].mean(axis=1) < 0])]


CAR = [block((-30, 5, -25), (30, 30, 25)), groove(5.0, -25, 25), groove(18.0, 22, 38), groove(18.0, -38, -22)]
"""The floor of a car: a groove for an axle, and two arches for its wheels."""


def wheel(low, high):
    """A wheel with a hole for the screw that is to hold it."""
    return ring(2.0, 15.0, low, high)


@pytest.mark.parametrize("seed", SEEDS)
def test_an_axle_in_a_groove_turns_with_the_wheels_that_are_screwed_on_its_ends(seed):
    """Arches that are open by half and wider than the wheels by a fifth guide none; no screw is drawn."""
    axle = part("axle", pin(5.0, -25, 25), *(ring(1.5, 4.9, *ends)[2:3] for ends in ((-25, -15), (15, 25))))
    wheels = [part("left", wheel(-35, -25)), part("right", wheel(25, 35))]
    body, mechanism = of(seed, part("base", *CAR), axle, *wheels)
    assert body["left"] == body["axle"] == body["right"] != body["base"]
    assert [joint.kind for joint in moving(mechanism)] == ["revolute"]
    assert any("'left' lies on the end of 'axle'" in note for note in mechanism.notes)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_washer_on_the_end_of_a_pin_is_screwed_to_it(seed):
    """It lies on what turns on the pin as well, and keeps it there; the screw in the pin is not drawn."""
    base = part("base", block((-90, -30, -30), (-30, 30, -20)), pin(5.0, -20, 2, (-60.0, 0.0)))
    bar, pivot = block((-52, -4, -8), (6, 4, 0)), [pin(4.0, 0, 18), ring(1.5, 3.9, 4, 18)[2:3]]
    link = part("link", ring(5.1, 9.0, -19.9, 0, (-60.0, 0.0)), bar, *pivot)
    arm = part("arm", ring(4.4, 8.0, 10, 18), block((7, -3, 10), (60, 3, 18)))
    body, mechanism = of(seed, base, arm, link, part("washer", ring(1.9, 7.0, 18, 20)))
    assert body["washer"] == body["link"] != body["arm"]
    assert any("'washer' lies on the end of 'link'" in note for note in mechanism.notes)


@pytest.mark.parametrize("seed", SEEDS)
def test_half_round_webs_of_two_forks_are_no_hinge(seed):
    """They are of one radius, on one axis, and a pin would fall out of both."""
    low = part("base", block((-10, 5, -4), (10, 60, 4)), groove(5.0, -4, 4))
    high = part("high", block((-10, 5, 10), (10, 60, 18)), groove(5.0, 10, 18))
    _, mechanism = of(seed, low, high)
    assert not moving(mechanism)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("gap", "slides"), [(6.0, True), (0.0, False)])
def test_a_carriage_with_empty_bushes_slides_on_rods_that_are_not_drawn(seed, gap, slides):
    """Where it lies on the mount, screws through both would hold it there, as those in threaded inserts do."""
    places = [(-12.0, 0.0), (12.0, 0.0)]
    mount = [ring(4.0, 6.0, 24 + gap, 44 + gap, at) for at in places]
    base = part("base", *mount, block((-30, 8, 24 + gap), (30, 20, 44 + gap)))
    carriage = part("carriage", *(ring(7.5, 9.0, 0, 24, at) for at in places), block((-30, 8, 0), (30, 20, 24)))
    bushes = [part(f"bush {k}", ring(4.0, 7.5, 0, 24, at)) for k, at in enumerate(places)]
    body, mechanism = of(seed, base, carriage, *bushes)
    assert not slides or body["bush 0"] == body["bush 1"] == body["carriage"]
    assert ([joint.kind for joint in moving(mechanism)] == ["prismatic"]) == slides


def hexagon(flat, low, high, inwards=False):
    """Six sides about the axis z, those of a nut or of a pocket for one."""
    angles = np.pi / 6 + np.arange(7) * np.pi / 3
    corners = flat / np.cos(np.pi / 6) * np.column_stack([np.cos(angles), np.sin(angles)])
    faces = []
    for one, other in pairwise(corners):
        a, b, c, d = ([*one, low], [*other, low], [*other, high], [*one, high])
        normal = np.array([*(one + other) / 2, 0.0]) / flat
        triangles = np.array([[a, b, c], [a, c, d]])
        faces.append(
            (Plane(triangles[0, 0], -normal), triangles[:, ::-1])
            if inwards
            else (Plane(triangles[0, 0], normal), triangles)
        )
    return faces


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("pocket", "held"), [(6.5, True), (7.3, False)])
def test_a_rod_in_a_nut_in_a_pocket_is_held_there(seed, pocket, held):
    """The rod fits the foot exactly, and would slide and turn in it; a round recess holds no nut."""
    base = part(
        "base", block((-60, -20, -4), (-20, 20, 8)), pin(4.0, 8, 18, (-40.0, 0.0)), pin(7.0, 18, 20, (-40.0, 0.0))
    )
    foot = part("foot", ring(4.0, 18.0, 8, 12), ring(10.0, 18.0, 0, 8), hexagon(pocket, 0, 8, inwards=True))
    nut = part("nut", ring(4.0, 6.2, 1, 7)[:3], hexagon(6.2, 1, 7))
    top = part("top", ring(4.0, 9.0, 74, 90), pin(9.0, 90, 94), block((8, -4, 80), (40, 4, 86)))
    rod = part("rod", pin(4.0, 0, 90))
    lever = part("lever", ring(4.0, 9.0, 8.1, 17.9, (-40.0, 0.0)), block((-36, -3, 30), (-20, 3, 36)))
    drawn = anywhere(assembly(base, foot, nut, rod, top, lever), seed)
    body = owners(drawn.mechanism(fixed=["base"], rigid=[["base", "foot"]]))
    assert (body["rod"] == body["nut"] == body["foot"]) == held


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("inside", "outside", "turns"), [(0.1, 0.1, True), (0.0, 0.1, False), (0.1, 0.0, False)])
def test_a_ring_turns_that_has_play_round_a_part_and_inside_of_the_same_one(inside, outside, turns, seed):
    """As the scroll of a chuck does. What fits on one side exactly is pressed on there."""
    walls = [pin(60.0, -10, 0), pin(20.0, 0, 12), pin(24.0, 12, 14), ring(52.0, 60.0, 0, 14)]
    base = part("base", *walls, pin(4.0, -10, 20, (80, 0)), block((50, -10, -20), (90, 10, -10)))
    lever = part("lever", ring(4.1, 8.0, 0, 10, (80, 0)), block((87, -3, 0), (130, 3, 10)))
    scroll = part("scroll", ring(20.0 + inside, 52.0 - outside, 0.1, 11.9))
    mechanism = anywhere(assembly(base, scroll, lever), seed).mechanism(fixed=["base"])
    body = owners(mechanism)
    assert (body["scroll"] != body["base"]) is turns
    assert not turns or kind_of(mechanism, "base", "scroll") == "revolute"
