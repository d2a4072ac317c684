"""What published scripts leave out and leave open: grooves open by half, screws in the ends of shafts, guide rods."""

import pytest

from reference.round_parts import SEEDS, anywhere, assembly, block, moving, owners, part, pin, ring


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
