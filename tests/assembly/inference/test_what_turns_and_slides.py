"""Tapered bearings, rings with screw holes, shafts of motors, retaining rings, rams, undercut rails.

Each is drawn with a known truth; where it says a seed, at a place, a size and in an order at random.
"""

import numpy as np
import pytest

from jaxkin.geometry.part import moved
from jaxkin.geometry.surfaces import Cone, Plane
from jaxkin.joints.evidence import EvidenceKind
from reference.round_parts import (
    SECTIONS,
    SEEDS,
    TO_X,
    anywhere,
    assembly,
    block,
    kind_of,
    moving,
    owners,
    part,
    pin,
    ring,
)

PIVOT = pin(4.0, 0, 60, (60.0, 60.0))
LEVER = part("lever", ring(4.1, 9.0, 5, 15, (60.0, 60.0)), block((68, 57, 5), (100, 63, 15)))
"""Something that moves on the pivot of the base: where nothing can, inferences are left out until something does."""
HOUSING = part("base", ring(16.0, 25.0, -10.0, 10.0), block((-30, -30, -25), (30, 30, -10)))
SHAFT = part("shaft", pin(5.0, -8.0, 40.0), block((-3, -3, 40), (3, 20, 45)))


def of(drawn, seed):
    mechanism = anywhere(drawn, seed).mechanism(fixed=["base"])
    return owners(mechanism), mechanism


def raceway(first, last, low, high, side):
    """A conical face about z whose radius goes from `first` to `last`."""
    angles = np.linspace(0, 2 * np.pi, SECTIONS, endpoint=False)
    circle = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(SECTIONS)])
    below, above = first * circle + [0, 0, low], last * circle + [0, 0, high]
    after = [np.roll(points, -1, axis=0) for points in (below, above)]
    triangles = np.concatenate([np.stack([below, after[0], above], 1), np.stack([above, after[0], after[1]], 1)])
    half_angle = float(np.arctan((last - first) / (high - low)))
    apex = np.array([0.0, 0.0, low - first / np.tan(half_angle)])
    return [(Cone(apex, np.array([0.0, 0.0, 1.0]), half_angle, side), triangles if side > 0 else triangles[:, ::-1])]


@pytest.mark.parametrize("seed", SEEDS)
def test_a_tapered_roller_bearing_is_one_hinge(seed):
    """Its raceways are cones: neither ring has a cylinder there."""
    outer = part("outer", ring(12.0, 16.0, -5, 5)[:2], ring(12.0, 16.0, -5, 5)[3:], raceway(12.0, 13.5, -5, 5, -1))
    inner = part("inner", ring(5.0, 9.0, -5, 5)[:3], raceway(8.0, 9.0, -5, 5, 1))
    around = [10.7 * np.array([np.cos(angle), np.sin(angle)]) for angle in np.arange(6) * np.pi / 3]
    rollers = [part(f"roller {k}", pin(1.1, -4, 4, tuple(at))) for k, at in enumerate(around)]
    body, mechanism = of(assembly(HOUSING, SHAFT, outer, inner, *rollers), seed)
    (joint,) = moving(mechanism)
    assert joint.kind == "revolute" and joint.evidence and joint.evidence.kind is EvidenceKind.BEARING
    assert body["outer"] == body["base"] and body["inner"] == body["shaft"] == body["roller 3"]


@pytest.mark.parametrize("seed", SEEDS)
def test_rings_with_screw_holes_are_those_of_a_bearing_with_its_rollers(seed):
    """As crossed roller bearings have them."""
    spots = [13.0 * np.array([np.cos(angle), np.sin(angle)]) for angle in np.arange(4) * np.pi / 2]
    outer = part("outer", ring(10.6, 16.0, -4, 4), *(ring(1.0, 1.1, -4, 4, tuple(at))[2:3] for at in spots))
    inner = part("inner", ring(5.0, 7.4, -4, 4))
    around = [9.0 * np.array([np.cos(angle), np.sin(angle)]) for angle in np.arange(6) * np.pi / 3]
    rollers = [part(f"roller {k}", pin(1.4, -3, 3, tuple(at))) for k, at in enumerate(around)]
    body, mechanism = of(assembly(HOUSING, SHAFT, outer, inner, *rollers), seed)
    (joint,) = moving(mechanism)
    assert joint.kind == "revolute" and joint.evidence and joint.evidence.kind is EvidenceKind.BEARING
    assert body["outer"] == body["base"] != body["inner"] == body["shaft"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("flange", "turns"), [(True, True), (False, False)])
def test_a_pin_amid_screw_holes_with_a_hub_clamped_on_it_is_the_shaft_of_a_motor(seed, flange, turns):
    """Without the holes it is a stud, which stands in the material as it is drawn."""
    corners = [(15.0 * i, 15.0 * j) for i in (-1, 1) for j in (-1, 1)]
    holes = [ring(1.5, 1.6, -6, 0, at) for at in corners] if flange else []
    motor = part("base", block((-21, -21, -40), (21, 21, 0)), *holes, block((21, 21, -40), (80, 80, 0)), PIVOT)
    shaft = part("shaft", pin(2.5, -2, 24))
    across = moved(part("hole", ring(1.25, 1.3, 2.5, 8.0)), TO_X)
    across = moved(across, np.array([[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 14], [0, 0, 0, 1]]))
    hub = part("hub", ring(2.5, 8.0, 10, 18), [(face.surface, face.triangles) for face in across.faces])
    tight = moved(part("tight", pin(1.25, 2.5, 7.0)), TO_X)
    tight = moved(tight, np.array([[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 14], [0, 0, 0, 1]]))
    screw = part("screw", [(face.surface, face.triangles) for face in tight.faces])
    body, mechanism = of(assembly(motor, shaft, hub, screw, LEVER), seed)
    assert body["hub"] == body["shaft"]
    assert (body["shaft"] != body["base"]) == turns
    assert sum(joint.kind == "revolute" for joint in moving(mechanism)) == turns


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("end", "kept"), [(11.1, True), (16.0, False)])
def test_a_ring_that_springs_into_a_groove_goes_with_the_shaft(seed, end, kept):
    """In a groove that is five times as wide as the ring it is something else."""
    base = part("base", ring(5.0, 12.0, -20, 0), block((12, -60, -20), (80, 80, -10)), PIVOT)
    shaft = part("shaft", pin(5.0, -40, 10), pin(4.7, 10, end), pin(5.0, end, 40), block((-3, -30, 40), (3, 30, 44)))
    lug = [*ring(0.6, 0.7, 10.05, 11.05, (8.0, 0.0))[2:3], *block((6.5, -1.5, 10.05), (9.5, 1.5, 11.05))]
    clip = part("clip", ring(4.5, 7.0, 10.05, 11.05), lug)
    body, _ = of(assembly(base, shaft, clip, LEVER), seed)
    assert (body["clip"] == body["shaft"]) == kept
    assert body["shaft"] != body["base"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("gap", "slides"), [(0.05, True), (6.0, False)])
def test_a_ram_that_lies_between_walls_slides_behind_its_cover(seed, gap, slides):
    """It only touches the back of its guide. Without walls near to it, it just lies there."""
    sides = []
    for s in (1, -1):
        low, high = sorted((s * (10 + gap), s * 25.0))
        sides.append(block((0, low, -40), (20.1, high, 40)))
    base = part("base", block((-20, -25, -40), (0, 80, 40)), *sides, block((20, 25, -40), (80, 80, 0)), PIVOT)
    ram = part("ram", block((0, -10, -70), (20, 10, 70)))
    _, mechanism = of(assembly(base, ram, LEVER), seed)
    kinds = [joint.kind for joint in moving(mechanism) if "ram" in joint.parts]
    assert kinds == (["prismatic"] if slides else [])


def prism(corners, low, high):
    """A convex bar along x, by its corners (y, z) in turn."""
    ends = [np.array([(x, *corner) for corner in corners], float) for x in (low, high)]
    fans = [np.array([(end[0], end[k], end[k + 1]) for k in range(1, len(end) - 1)]) for end in ends]
    faces = [(Plane(ends[0][0], np.array([-1.0, 0, 0])), fans[0][:, ::-1]), (Plane(ends[1][0], np.eye(3)[0]), fans[1])]
    for k in range(len(corners)):
        a, b = ends[0][k], ends[0][(k + 1) % len(corners)]
        c, d = ends[1][k], ends[1][(k + 1) % len(corners)]
        normal = np.cross(b - a, np.eye(3)[0])
        faces.append((Plane(a, normal / np.linalg.norm(normal)), np.array([(a, c, b), (b, c, d)])))
    return faces


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("reach", "slides"), [(10.2, True), (40.0, False)])
def test_a_carriage_on_an_undercut_rail_slides(seed, reach, slides):
    """With its jaws far from the slanting faces it is not kept on the rail."""
    rail = part("base", prism([(-10, 0), (10, 0), (16, 6), (-16, 6)], -100, 100))
    jaws = [
        prism([(-reach - 20, 0), (-reach, 0), (-reach - 6, 6), (-reach - 20, 6)], -25, 25),
        prism([(reach, 0), (reach + 20, 0), (reach + 20, 6), (reach + 6, 6)], -25, 25),
    ]
    top = block((-25, -reach - 20, 6.1), (25, reach + 20, 12))
    _, mechanism = of(assembly(rail, part("carriage", *jaws, top)), seed)
    assert [joint.kind for joint in moving(mechanism)] == (["prismatic"] if slides else [])


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("fit", [4.0, 4.1])
@pytest.mark.parametrize(("screws", "turns"), [(4, True), (2, False)])
def test_a_shaft_between_two_circles_of_screws_turns_where_nothing_else_stops_it(seed, fit, screws, turns):
    """The stator of a motor and the flange on its shaft: a rod that slides needs no circle of screws."""
    angles = [2 * np.pi * k / screws + 0.4 for k in range(screws)]
    around = [[(away * np.cos(angle), away * np.sin(angle)) for angle in angles] for away in (16.0, 10.0)]
    foot = block((-40, -30, -20), (40, -20, 28)), block((-4, -20, 0), (4, -7, 28))
    can = part("can", ring(fit, 8.0, 0, 28), *foot, *(ring(1.25, 2.5, 20, 28, at) for at in around[0]))
    tapped = [ring(1.25, 2.2, 32, 36, at) for at in around[1]]
    shaft = part("shaft", pin(4.0, 2, 34), pin(7.5, 32, 36), *tapped, block((13, -4, 32), (60, 4, 36)))
    mechanism = anywhere(assembly(can, shaft), seed).mechanism(fixed=["can"])
    assert kind_of(mechanism, "can", "shaft") == ("revolute" if turns else "cylindrical")
