"""Machines whose makers leave screws and pins out of the drawing, or draw parts with points and play, to be printed."""

import numpy as np
import pytest
import trimesh

from jaxkin.geometry.surfaces import Cylinder, Plane
from jaxkin.joints.evidence import EvidenceKind
from reference.round_parts import SEEDS, across, anywhere, assembly, block, kind_of, moving, owners, part, pin, ring


def solid(mesh):
    """Faces of a mesh, each facet a plane."""
    faces = []
    for facet, normal in zip(mesh.facets, mesh.facets_normal, strict=True):
        triangles = mesh.triangles[facet]
        faces.append((Plane(triangles[0, 0], normal), triangles))
    return faces


def prism(outline, low, high):
    """A prism over a convex outline in x and z, from y = `low` to `high`."""
    corners = [(x, y, z) for x, z in outline for y in (low, high)]
    return solid(trimesh.convex.convex_hull(np.array(corners, float)))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("half", "told"), [(19.7, "faces stop its slide"), (15.0, "one middle")])
def test_a_point_between_two_plates_stops_a_slide_as_a_face_does(seed, half, told):
    """A plate that runs out into edges above and below, on an axle whose ends are in two plates."""
    plates = [ring(2.05, 30.0, -25.0, -20.0), ring(2.05, 30.0, 20.0, 25.0), block((30, -5, -25), (35, 5, 25))]
    leg = prism([(2.5, half), (2.5, -half), (60, 10), (60, -10)], -1.0, 1.0)
    drawn = assembly(part("base", *plates), part("leg", pin(2.0, -25, 25), leg))
    (joint,) = moving(anywhere(drawn, seed).mechanism(fixed=["base"]))
    assert joint.kind == "revolute" and told in joint.evidence.text


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("length", "kind"), [(12.0, "revolute"), (80.0, "cylindrical")])
def test_what_is_as_long_as_its_pin_has_no_stroke(seed, length, kind):
    """A wheel on the end of its axle, with nothing that keeps it there, turns; on a long rod it slides, too."""
    car = part("car", block((-20, -10, -60), (20, 10, -40)), pin(3.0, -40.0, length - 40.0))
    wheel = part("wheel", ring(3.3, 12.0, -38.0, -28.0), block((12, -2, -38), (18, 2, -28)))
    assert kind_of(anywhere(assembly(car, wheel), seed).mechanism(fixed=["car"]), "car", "wheel") == kind


def plate(name, low, high, holes, radius):
    """A plate with bushes round its holes, which lie on the plate below or above."""
    return part(name, *(ring(radius, radius + 4, low, high, at) for at in holes))


HOLES = [(0.0, 0.0), (40.0, 0.0)]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("length", "count"), [(4.0, 1), (14.0, 2)])
def test_short_dowels_place_a_part_and_long_pins_guide_it(seed, length, count):
    """Bosses with play in holes, faces that meet around them: a slide would lift the part off two radii later."""
    lid = [pin(3.0, -length, 2.0, at) for at in HOLES] + [ring(3.1, 9.0, 0.0, 2.0, at) for at in HOLES]
    drawn = assembly(plate("base", -15, 0, HOLES, 3.2), part("lid", *lid))
    mechanism = anywhere(drawn, seed).mechanism(fixed=["base"])
    assert len(mechanism.bodies) == count
    assert [str(joint.kind) for joint in moving(mechanism)] == ["prismatic"] * (count - 1)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("pegs", [True, False])
def test_pegs_that_are_not_round_place_a_wheel_on_its_hub(seed, pegs):
    """Square pegs with play in square holes round a short boss; without them the wheel turns on it."""
    sides = [((x, y), (x / 12, y / 12)) for x, y in ((12, 0), (0, 12), (-12, 0), (0, -12))]
    hub = [ring(5.0, 20.0, -15, 0), pin(5.0, -15, 4), block((-4, -40, -20), (4, 40, -15))]
    wheel = [ring(5.4, 9.0, 0, 5), ring(15.2, 24.0, 0, 5)]
    for (x, y), _ in sides if pegs else []:
        hub.append(block((x - 2, y - 2, 0), (x + 2, y + 2, 4)))
        for a, b in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            u, v = x + 2.7 * a, y + 2.7 * b
            wheel.append(
                block(
                    (u - 0.5 - 1.7 * abs(b), v - 0.5 - 1.7 * abs(a), 0),
                    (u + 0.5 + 1.7 * abs(b), v + 0.5 + 1.7 * abs(a), 5),
                )
            )
    stand = part("stand", ring(20.1, 26.0, -14, -4), block((26, -5, -14), (60, 5, -4)))
    body = owners(anywhere(assembly(stand, part("hub", *hub), part("wheel", *wheel)), seed).mechanism(fixed=["stand"]))
    assert (body["wheel"] == body["hub"]) == pegs and body["hub"] != body["stand"]


def nut(low, high, radius=4.0, at=(0.0, 0.0)):
    """A hexagonal nut with its hole."""
    angles = np.radians(60 * np.arange(6))
    outline = 7.0 * np.column_stack([np.cos(angles), np.sin(angles)]) + at
    hexagon = trimesh.convex.convex_hull(np.array([(*corner, z) for corner in outline for z in (low, high)]))
    sides = [each for each in solid(hexagon) if abs(each[0].normal[2]) < 0.5]
    return [*sides, *ring(radius, radius + 0.5, low, high, at)[:3]]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("relief", [False, True])
def test_a_nut_on_no_screw_belongs_to_the_hole_that_it_is_on(seed, relief):
    """In a recess that is a little wider, and with the ends of its thread as slivers of a wider hole, as CAD systems
    draw them; a round spacer on the same holes is left to turn."""
    base = part("base", ring(4.0, 20.0, 0.0, 10.0))
    threaded = [nut(10.05, 16.0, 3.4), ring(4.0, 4.4, 10.05, 10.07)[:3]] if relief else [nut(10.05, 16.0)]
    drawn = assembly(base, part("nut", *threaded), part("wheel", ring(4.0, 15.0, -6.0, 0.0)))
    mechanism = anywhere(drawn, seed).mechanism(fixed=["base"])
    body = owners(mechanism)
    assert body["nut"] == body["base"] != body["wheel"]
    assert kind_of(mechanism, "base", "wheel") == "revolute"
    assert any("its screw is not drawn" in note for note in mechanism.notes)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("holes", [HOLES[:1], HOLES])
def test_on_one_screw_that_is_not_drawn_a_lever_turns_and_two_hold_it(seed, holes):
    """A hole that the screw goes through over one that it is screwed into."""
    arm = block((-60, -4, 0), (-7, 4, 4))
    lever = part("lever", arm, *(ring(1.7, 8.0, 0.0, 4.0, at) for at in holes))
    drawn = assembly(part("base", *(ring(1.25, 9.0, -10.0, 0.0, at) for at in holes)), lever)
    mechanism = anywhere(drawn, seed).mechanism(fixed=["base"])
    if len(holes) == 1:
        (joint,) = moving(mechanism)
        assert joint.kind == "revolute" and joint.evidence.kind == EvidenceKind.VIRTUAL_PIN
    else:
        assert len(mechanism.bodies) == 1


@pytest.mark.parametrize("seed", SEEDS)
def test_a_short_wheel_with_play_that_lies_on_nothing_turns_on_its_pin(seed):
    """A planet, printed in its carrier: no nut, which would lie on something, and has no play."""
    carrier = part("carrier", pin(4.6, 0.0, 20.0), ring(4.6, 30.0, -5.0, 0.0), ring(4.6, 30.0, 20.0, 25.0))
    planet = part("planet", ring(5.0, 11.0, 4.0, 16.0))
    mechanism = anywhere(assembly(carrier, planet), seed).mechanism(fixed=["carrier"])
    assert kind_of(mechanism, "carrier", "planet") == "revolute"


@pytest.mark.parametrize("seed", SEEDS)
def test_a_block_that_fits_its_rod_between_the_ends_that_hold_it_slides(seed):
    """Ends are drawn with play, for the printer; the linear bearing is not."""
    ends = [
        part(f"end {k}", across(ring(4.25, 12.0, x, x + 20.0)), block((x, -20, -30), (x + 20, 20, -12)))
        for k, x in enumerate((-150.0, 130.0))
    ]
    rod = part("rod", across(pin(4.0, -150, 150)))
    slide = part("block", across(ring(4.0, 12.0, -15, 15)), block((-20, -15, 12), (20, 15, 30)))
    mechanism = anywhere(assembly(*ends, rod, slide), seed).mechanism(fixed=["end 0", "end 1"])
    assert owners(mechanism)["rod"] != owners(mechanism)["block"]
    assert kind_of(mechanism, "rod", "block") == "cylindrical"


def test_drawn_solids_are_what_tests_say():
    """Facets of a prism look outwards, and a nut has six sides."""
    middle = np.array([30.0, 0.0, 0.0])
    for surface, triangles in prism([(2.5, 20), (2.5, -20), (60, 10), (60, -10)], -1, 1):
        assert (triangles.mean(axis=(0, 1)) - middle) @ surface.normal > 0
    sides = [surface for surface, _ in nut(0, 6) if isinstance(surface, Plane) and abs(surface.normal[2]) < 0.5]
    assert len(sides) == 6 and sum(isinstance(surface, Cylinder) for surface, _ in nut(0, 6)) == 1


def foot_on_a_wall(hole=1.7, other=1.7, link=False, more=()):
    """A foot on a wall, with a screw of radius 1.5 in one of two holes or more, and a lever on a pin in its lugs;
    perhaps with a link on a pin beside the screw, which stands in the wall, too."""
    wall = part("wall", block((-30, -60, -20), (100, 60, 0)), *([pin(3, 0, 6, (80.0, 40.0))] if link else []))
    places = [(hole, HOLES[0]), (other, HOLES[1]), *((other, at) for at in more)]
    lugs = [ring(2.05, 5, x, x + 2, (-15.0, 20.0)) for x in (16, 24)]
    foot = [ring(radius, 6, 0, 2, at) for radius, at in places] + [block((6, -6, 0), (34, 6, 2))]
    foot += [across(lug) for lug in lugs] + ([pin(3, 0, 6, (20.0, 40.0))] if link else [])
    screw = part("screw", pin(1.5, -10, 2), pin(3, 2, 4))
    pivot = part("pivot", across(pin(2, 14, 28, (-15.0, 20.0))))
    lever = part("lever", across(ring(2.05, 5, 18.2, 23.8, (-15.0, 20.0))), block((18.2, 25, 10), (23.8, 50, 20)))
    bars = [ring(3.05, 5, 2, 6, at) for at in ((80.0, 40.0), (20.0, 40.0))] + [block((25, 38, 2), (75, 42, 6))]
    return assembly(wall, part("foot", *foot), screw, pivot, lever, *([part("link", *bars)] if link else []))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("more", [(), ((20.0, -20.0),)])
def test_a_foot_with_a_screw_in_one_hole_and_none_in_another_is_screwed_on(more, seed):
    mechanism = anywhere(foot_on_a_wall(more=more), seed).mechanism(fixed=["wall"])
    body = owners(mechanism)
    assert body["wall"] == body["screw"] == body["foot"] != body["lever"]
    assert any(f"{1 + len(more)} empty hole" in note for note in mechanism.notes)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("hole", "other", "link"), [(1.53, 1.53, False), (1.7, 2.5, False), (1.7, 1.7, True)])
def test_a_foot_on_one_screw_turns_where_its_holes_are_no_pattern_or_a_link_moves_it(hole, other, link, seed):
    """With the play of a hinge, with a hole of another size, and with a pin along the screw."""
    mechanism = anywhere(foot_on_a_wall(hole, other, link), seed).mechanism(fixed=["wall"])
    body = owners(mechanism)
    assert body["wall"] == body["screw"] != body["foot"]
