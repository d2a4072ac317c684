"""Studs of balls and rod ends on their rods: what turns about the middle of a ball needs no turn about its stud."""

import numpy as np
import pytest
import trimesh

from jaxkin.geometry.surfaces import Sphere
from reference.round_parts import SEEDS, anywhere, assembly, block, moving, owners, part, pin, ring

PIVOT = pin(4.0, 0, 60, (60.0, 0.0))
BASE = part("base", ring(5.0, 12.0, 0, 10), block((12, -4, 0), (60, 4, 10)), PIVOT)
LEVER = part("lever", ring(4.1, 9.0, 20, 30, (60.0, 0.0)), block((68, -3, 20), (100, 3, 30)))
"""Something that moves on the pivot of the base: where nothing can, inferences are left out until something does."""


def of(seed, *parts):
    mechanism = anywhere(assembly(*parts), seed).mechanism(fixed=["base"])
    return owners(mechanism), mechanism


def ball(radius, side, centre, most=0.9):
    """The faces of a ball, or of a socket, about the axis z, without what is beyond some of its radii."""
    triangles = trimesh.creation.icosphere(3, radius).triangles
    kept = triangles[np.abs(triangles[:, :, 2] / radius).max(axis=1) < most] + [0.0, 0.0, centre]
    return [(Sphere(np.array([0.0, 0.0, centre]), radius, side), kept if side > 0 else kept[:, ::-1])]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("shank", [5.15, 4.9])
def test_the_stud_of_a_ball_is_held_where_its_collar_lies(seed, shank):
    """With interference or with play: it turns about the middle of its ball already."""
    stud = part("stud", pin(shank, 1, 10), pin(7.0, 10, 12.5), pin(4.0, 12.5, 19), ball(8.0, 1, 25.0))
    rod = part("rod", ball(8.1, -1, 25.0), block((12, -4, 20), (60, 4, 30)))
    body, mechanism = of(seed, BASE, stud, rod)
    assert body["stud"] == body["base"] != body["rod"]
    assert [joint.kind for joint in moving(mechanism)] == ["spherical"]
    assert any("about which that turns in 'rod' already" in note for note in mechanism.notes)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_shaft_with_a_ball_on_its_end_turns_where_it_has_a_crank(seed):
    """Something else hangs on its turn: a third part on a pin of the crank."""
    crank = block((-4, -40, -20), (4, 4, -10)), pin(3.0, -40, -20, (0.0, -36.0))
    stud = part("stud", pin(4.9, -10, 10), pin(7.0, 10, 12.5), pin(4.0, 12.5, 19), ball(8.0, 1, 25.0), *crank)
    rod = part("rod", ball(8.1, -1, 25.0), block((12, -4, 20), (60, 4, 30)))
    link = part("link", ring(3.1, 7.0, -30, -22, (0.0, -36.0)), block((7, -38, -30), (60, -34, -22)))
    body, _ = of(seed, BASE, stud, rod, link)
    assert body["stud"] != body["base"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("aside", "held"), [(0.0, True), (4.0, False)])
def test_a_rod_end_is_held_on_its_rod_where_that_points_at_the_ball(seed, aside, held):
    """A socket whose pin passes beside the middle of the ball swings that about the pin."""
    stud = part("stud", ball(8.0, 1, 0.0), pin(4.0, -30, -6.5), block((-20, -20, -40), (20, 20, -30)))
    base = part("base", block((-60, -60, -60), (80, 60, -40)), pin(4.0, -40, 60, (60.0, 0.0)))
    at = (aside, 0.0)
    end = part("end", ball(8.1, -1, 0.0), block((-12, -12, 9), (12, 12, 20)), ring(5.0, 9.0, 20, 40, at))
    rod = part("rod", pin(4.8, 20.5, 40, at), pin(12.0, 40, 60, at), block((-30, -3, 45), (-12, 3, 55)))
    drawn = anywhere(assembly(base, stud, end, rod, LEVER), seed)
    mechanism = drawn.mechanism(fixed=["base"], rigid=[["base", "stud"]])
    body = owners(mechanism)
    assert (body["end"] == body["rod"]) == held
    assert "spherical" in [joint.kind for joint in moving(mechanism)]


@pytest.mark.parametrize("seed", SEEDS)
def test_the_bolt_of_a_rod_end_does_not_slide_where_its_nut_is_not_drawn(seed):
    bolted = part("ball", ball(8.0, 1, 25.0, 0.6), ring(3.0, 6.2, 20, 30)[:-1])
    eye = ring(7.2, 12.0, 21.5, 28.5)
    rod = part("rod", ball(8.1, -1, 25.0, 0.43), eye[:2] + eye[3:], block((11, -3, 22), (60, 3, 28)))
    bolt = part("bolt", pin(2.9, -10, 30), pin(5.0, 30, 33))
    base = part("base", ring(3.1, 12.0, 0, 10), block((12, -4, 0), (60, 4, 10)), PIVOT)
    body, mechanism = of(seed, base, bolted, rod, bolt)
    assert body["ball"] == body["bolt"] == body["base"] != body["rod"]
    assert [joint.kind for joint in moving(mechanism)] == ["spherical"]


def dimple(radius, side, centre, out):
    """The faces of a ball or of a socket that are on one side of a plane across the axis y, a little beyond its
    middle: what stands out of a leaf, or what is sunk into it."""
    triangles = trimesh.creation.icosphere(3, radius).triangles
    kept = triangles[(triangles[:, :, 1] * out).min(axis=1) > -0.15 * radius] + np.array([0.0, centre, 0.0])
    return [(Sphere(np.array([0.0, centre, 0.0]), radius, side), kept if side > 0 else kept[:, ::-1])]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("room", "kind"), [(1.7, "revolute"), (2.1, None)])
def test_balls_in_dimples_on_one_line_are_a_hinge(seed, room, kind):
    """Two balls of a leaf stand loosely in two dimples of the one beside it, as hinges are printed in one piece."""
    inner = part("inner", block((2, -4, -3), (8, 4, 3)), dimple(1.5, 1, 4.0, 1), dimple(1.5, 1, -4.0, -1))
    outer = [dimple(room, -1, 4.0, 1), dimple(room, -1, -4.0, -1), block((2, 6, -3), (8, 20, 3))]
    drawn = assembly(BASE, LEVER, inner, part("outer", *outer, block((2, -20, -3), (8, -6, 3))))
    mechanism = anywhere(drawn, seed).mechanism(fixed=["base"], rigid=[["base", "outer"]])
    body = owners(mechanism)
    between = [joint for joint in moving(mechanism) if "inner" in joint.parts]
    assert [joint.kind for joint in between] == ([kind] if kind else [])
    assert kind or body["inner"] == body["base"]
    if between:
        told = next(note for note in mechanism.notes if "1 more are on its line" in note)
        assert "the ball of radius" in told


@pytest.mark.parametrize("seed", SEEDS)
def test_a_loose_ball_rolls_in_what_turns(seed):
    """The half of a wheel turns on its axle, which points at the middle of the ball that rolls in it."""
    arm, axle = block((11, -3, 22), (40, 3, 30)), [pin(8.0, 0, 14.8), pin(5.0, 14.8, 22.2), pin(8.0, 22.2, 23)]
    half = part("half", ring(5.2, 12.0, 15, 22), ring(8.5, 12.0, 22, 24), ball(3.5, -1, 30.0), arm)
    base = part("base", block((-40, -40, -10), (60, 40, 0)), *axle, PIVOT)
    loose = part("loose", ball(3.0, 1, 30.0, 1.1))
    body, mechanism = of(seed, base, LEVER, half, loose)
    assert body["half"] not in (body["base"], body["loose"])
    kinds = {frozenset(joint.parts): joint.kind for joint in moving(mechanism)}
    assert kinds[frozenset(("half", "loose"))] == "spherical"
    assert "loose" in mechanism.mobility().spinning
    best = anywhere(assembly(base, LEVER, half, loose), seed).proposals()[0]
    assert not any("loose" in name for name in (*best.fixed, *best.drive))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("length", "slides"), [(12.0, False), (90.0, True)])
def test_a_stud_that_fits_its_hole_exactly_does_not_slide_there_and_a_strut_does(seed, length, slides):
    """No collar says so: the ball on its axis does, which a strut has as well, on the end of a long rod."""
    stud = part("stud", pin(5.0, 12 - length, 12), pin(4.0, 12, 19), ball(8.0, 1, 25.0))
    rod = part("rod", ball(8.0, -1, 25.0), block((12, -4, 20), (60, 4, 30)))
    _, mechanism = of(seed, BASE, stud, rod, LEVER)
    kinds = {joint.kind for joint in moving(mechanism) if {*joint.parts} == {"base", "stud"}}
    assert ("cylindrical" in kinds) == slides
