"""Bearings of several solids, and as one: the shaft turns in the housing, whatever is between them."""

import numpy as np
import pytest
import trimesh

import jaxkin as jk
from jaxkin.geometry.surfaces import Sphere
from jaxkin.joints.evidence import EvidenceKind
from reference.round_parts import SEEDS, anywhere, assembly, block, part, pin, ring

BORE, OUTSIDE, WIDTH = 5.0, 13.0, 8.0  # a 6000 bearing halved, but for its grooves
HOUSING = part("housing", ring(OUTSIDE, 25.0, -20.0, 20.0), block((-30, -30, -25), (30, 30, -20)))
SHAFT = part("shaft", pin(BORE, -15.0, 40.0), block((-3, -3, 40), (3, 20, 45)))


def ball(radius, at):
    mesh = trimesh.creation.icosphere(2, radius)
    mesh.apply_translation(at)
    return [(Sphere(np.array(at, float), radius, 1), mesh.triangles)]


def bearing(name, height, balls=0, rollers=0, cage=False, bore=BORE, outside=OUTSIDE, inner_width=WIDTH):
    """Two rings, balls or rollers, and a cage about an axis along z."""
    low, high = height - WIDTH / 2, height + WIDTH / 2
    middle = (bore + outside) / 2
    parts = [part(f"{name} outer", ring(outside - 2.4, outside, low, high))]
    parts += [part(f"{name} inner", ring(bore, bore + 2.4, low, low + inner_width))]
    for k in range(balls + rollers):
        angle = 2 * np.pi * k / (balls + rollers)
        at = middle * np.cos(angle), middle * np.sin(angle)
        piece = ball(2.3, (*at, height)) if k < balls else pin(1.55, low + 1, high - 1, at)
        parts.append(part(f"{name} {'ball' if k < balls else 'roller'} {k}", piece))
    if cage:
        parts.append(part(f"{name} cage", ring(middle - 0.3, middle + 0.3, low + 2, high - 2)))
    return parts


@pytest.mark.long
@pytest.mark.parametrize("what", [{"balls": 8}, {"balls": 8, "cage": True}, {"rollers": 6}, {}])
def test_a_shaft_in_two_bearings_has_one_hinge(what):
    drawn = assembly(HOUSING, SHAFT, *bearing("A", -10, **what), *bearing("B", 10, **what))
    mechanism = drawn.mechanism(fixed=["housing"])
    (joint,) = (each for each in mechanism.all_joints if each.freedoms)
    assert joint.kind == "revolute" and joint.evidence.kind == EvidenceKind.BEARING
    assert dict(joint.evidence.sizes)["balls or rollers"] == sum(what.get(key, 0) for key in ("balls", "rollers"))
    assert len(mechanism.bodies) == 2 and mechanism.mobility().freedoms == 1
    owner = {name: body for body, parts in mechanism.bodies.items() for name in parts}
    assert owner["A outer"] == owner["B outer"] == owner["housing"]
    assert owner["A inner"] == owner["B inner"] == owner["shaft"]
    assert any("'A inner' sits on the other one" in note for note in mechanism.notes)


def test_seats_with_clearance_hold_the_rings():
    drawn = assembly(HOUSING, SHAFT, *bearing("A", 0, balls=8, bore=5.05, outside=12.95))
    mechanism = drawn.mechanism(fixed=["housing"])
    assert len(mechanism.bodies) == 2 and mechanism.mobility().freedoms == 1


def test_rings_of_different_width_without_balls_are_no_bearing():
    drawn = assembly(HOUSING, SHAFT, *bearing("A", 0, inner_width=WIDTH / 2))
    kinds = {joint.evidence.kind for joint in drawn.mechanism(fixed=["housing"]).all_joints}
    assert EvidenceKind.BEARING not in kinds


@pytest.mark.parametrize(("radius", "rolls"), [(1.55, True), (1.0, False)])
def test_what_does_not_reach_both_rings_is_no_roller(radius, rolls):
    """Screws through a flange lie between its bore and a cap, too, with room on both sides."""
    outer, inner = bearing("A", 0, inner_width=WIDTH / 2)
    at = [(9.0 * np.cos(angle), 9.0 * np.sin(angle)) for angle in np.arange(4) * np.pi / 2]
    screws = [part(f"screw {k}", pin(radius, -3.0, -1.0, place)) for k, place in enumerate(at)]
    kinds = {
        each.evidence.kind
        for each in assembly(HOUSING, SHAFT, outer, inner, *screws).mechanism(fixed=["housing"]).all_joints
    }
    assert (EvidenceKind.BEARING in kinds) == rolls


def test_outer_rings_of_two_housings_have_no_hinge_about_their_raceways():
    housings = [part(f"housing {k}", ring(OUTSIDE, 25.0, low, low + 8)) for k, low in enumerate((-14.0, 6.0))]
    drawn = assembly(*housings, SHAFT, *bearing("A", -10), *bearing("B", 10))
    mechanism = drawn.mechanism(fixed=["housing 0"])
    assert {joint.evidence.kind for joint in mechanism.all_joints if joint.freedoms} == {EvidenceKind.BEARING}


def test_a_bearing_that_is_one_solid_belongs_to_the_housing_and_keeps_the_shaft():
    drawn = assembly(HOUSING, SHAFT, part("A", ring(BORE, OUTSIDE, -14, -6)), part("B", ring(BORE, OUTSIDE, 6, 14)))
    mechanism = drawn.mechanism(fixed=["housing"])
    assert {*mechanism.bodies["housing"]} == {"housing", "A", "B"}
    (joint,) = (each for each in mechanism.all_joints if each.freedoms)
    assert joint.kind == "revolute" and joint.evidence.kind == EvidenceKind.BEARING


def test_a_joint_by_hand_comes_before_a_bearing():
    by_hand = jk.cylindrical("motor", "housing", "shaft", point=(0, 0, 0), axis=(0, 0, 1))
    drawn = assembly(HOUSING, SHAFT, *bearing("A", 0, balls=8))
    mechanism = drawn.mechanism(fixed=["housing"], joints=[by_hand])
    assert [joint.name for joint in mechanism.all_joints if joint.freedoms] == ["motor"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("where", "rolls"), [(-40.0, False), (42.0, True)])
def test_what_is_elsewhere_on_a_hollow_axle_are_no_rollers_of_a_disc(seed, where, rolls):
    """Three pieces that reach from the axle to the radius of the hole of a disc: beside the disc they are rollers."""
    axle = part("base", ring(4.0, 8.0, -60, 60))
    disc = part("disc", ring(9.0, 50.0, 40, 44))
    turns = np.radians([0, 120, 240])
    pieces = [
        part(f"piece {k}", pin(0.5, where - 1, where + 1, (8.5 * np.cos(t), 8.5 * np.sin(t))))
        for k, t in enumerate(turns)
    ]
    mechanism = anywhere(assembly(axle, disc, *pieces), seed).mechanism(fixed=["base"])
    assert any("a bearing with 3 balls or rollers" in note for note in mechanism.history) == rolls


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("outside", "still"), [(6.8, True), (6.5, False)])
def test_a_seal_that_fits_the_housing_does_not_turn_with_the_inner_ring_that_it_lies_on(outside, still, seed):
    """One with room around it is a spacer, clamped on the shaft with the ring."""
    housing = part(
        "housing", ring(OUTSIDE, 25.0, -4, 20), ring(6.8, 25.0, -10, -4), block((-30, -30, -12), (-8, 30, 20))
    )
    seal = part("seal", ring(BORE, outside, -10, -4))
    drawn = anywhere(assembly(housing, SHAFT, seal, *bearing("A", 0)), seed)
    body = {name: one for one, parts in drawn.mechanism(fixed=["housing"]).bodies.items() for name in parts}
    assert body["housing"] != body["shaft"]
    assert body["seal"] == (body["housing"] if still else body["shaft"])
