"""What is set on a pin though nothing drawn holds it there, and what third bodies or walls keep from sliding.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import pytest

from reference.round_parts import anywhere, assembly, block, moving, owners, part, pin, ring


def half(piece, side):
    """Those triangles of the faces of a ring that are on one side of the plane x = 0."""
    return [(surface, triangles[side * triangles.mean(axis=1)[:, 0] > 0]) for surface, triangles in piece]


def flag(low, high):
    """Something beside the axis: what is round only spins."""
    return block((11, -3, low), (40, 3, high))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("steps", [True, False])
def test_halves_with_the_steps_of_a_groove_grip_the_shaft_and_shells_of_one_radius_do_not(seed, steps):
    base = part("base", block((-60, -60, -100), (60, -50, 100)), ring(5.0, 12.0, -90, -60))
    shaft = part("shaft", pin(5.0, -92, 0), pin(4.0, 0, 3), pin(5.0, 3, 30), flag(25, 30))
    inside = [(4.0, 0, 3), (5.0, 3, 8)] if steps else [(5.0, 3, 8)]
    halves = [
        part(f"half {side}", *(half(ring(radius, 8.0, low, high), side) for radius, low, high in inside))
        for side in (-1, 1)
    ]
    cap = part("cap", ring(8.0, 14.0, inside[0][1], 8), block((13, -2, 3), (30, 2, 8)))
    mechanism = anywhere(assembly(base, shaft, *halves, cap), seed).mechanism(fixed=["base"])
    body = owners(mechanism)
    assert body["shaft"] != body["base"]
    assert (body["half -1"] == body["half 1"] == body["cap"] == body["shaft"]) == steps
    assert any("split ring" in note for note in mechanism.notes) == steps


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kept", [True, False])
def test_a_shaft_between_its_bearing_and_a_third_body_that_is_kept_there_does_not_slide(seed, kept):
    """A sun between the bearing of its shaft and the carrier; without a carrier it slides."""
    base = part(
        "base",
        block((-60, -60, -40), (60, -50, 90)),
        ring(3.0, 12.0, -30, -10),
        ring(6.0, 14.0, 30, 60),
    )
    sun = part("sun", pin(3.0, -60, 0), pin(8.0, -8, 12), block((-20, -2, -58), (-3, 2, -50)))
    shoulders = pin(9.0, 14, 29), pin(9.0, 61, 66)
    carrier = part("carrier", pin(6.0, 14, 80), *shoulders, block((5, -2, 70), (20, 2, 76)))
    drawn = assembly(base, sun, carrier) if kept else assembly(base, sun)
    mechanism = anywhere(drawn, seed).mechanism(fixed=["base"])
    kinds = {frozenset(joint.parts): joint.kind for joint in moving(mechanism)}
    assert kinds[frozenset(("base", "sun"))] == ("revolute" if kept else "cylindrical")


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("play", [0.0, 0.1])
def test_what_fits_a_held_column_exactly_is_set_on_it_where_something_else_has_play(seed, play):
    """A table with play and a head without; where nothing has play nothing is known."""
    base = part("base", block((-60, -60, -110), (60, 60, -100)), ring(20.0, 30.0, -100, -60))
    column = part("column", pin(20.0, -100, 200))
    table = part("table", ring(20.0 + play, 30.0, 0, 50), block((25, -5, 10), (90, 5, 20)))
    head = part("head", ring(20.0, 30.0, 120, 190), block((25, -5, 130), (90, 5, 140)))
    drawn = assembly(base, column, table, head)
    mechanism = anywhere(drawn, seed).mechanism(fixed=["base"], rigid=[["base", "column"]])
    body = owners(mechanism)
    assert body["table"] != body["base"]
    assert (body["head"] == body["base"]) == (play > 0)
    assert any("has a play" in note or "have a play" in note for note in mechanism.notes) == (play > 0)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("length", "held"), [(6.0, True), (30.0, False)])
def test_the_ear_of_a_bracket_that_a_face_keeps_from_turning_would_jam_on_its_pin(seed, length, held):
    """A plate on a step, with an ear on a pin: short ones are held there, long ones are guided and slide."""
    step = block((-40, -30, -60), (40, -10, 60))
    base, rod = part("base", step), part("rod", pin(5.0, -60, 60))
    other = part("bracket", ring(5.0, 9.0, 0, length), block((-15, -10, 0), (15, -8, length)))
    crank = part("crank", ring(5.1, 9.0, -40, -30), block((8, -3, -40), (40, 3, -30)))
    drawn = anywhere(assembly(base, rod, other, crank), seed)
    mechanism = drawn.mechanism(fixed=["base"], rigid=[["base", "rod"]])
    body = owners(mechanism)
    assert body["crank"] != body["base"]
    assert (body["bracket"] == body["base"]) == held
    assert any("would jam on a slide" in note for note in mechanism.notes if "face keeps" in note) == held


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("play", [0.05, 3.0])
def test_a_jaw_that_lies_on_its_ways_between_walls_slides_along_them(seed, play):
    base = part(
        "base",
        block((-100, -40, -10), (100, 40, 0)),
        block((-100, -40, 0), (100, -30, 8)),
        block((-100, 30, 0), (100, 40, 8)),
    )
    jaw = part("jaw", block((0, -30 + play, 0), (25, 30 - play, 40)), pin(5.0, 40, 70, at=(12, 0)))
    lever = part("lever", ring(5.0, 9.0, 45, 52, at=(12, 0)), block((20, -3, 45), (70, 3, 52)))
    mechanism = anywhere(assembly(base, jaw, lever), seed).mechanism(fixed=["base"])
    kinds = {frozenset(joint.parts): joint.kind for joint in moving(mechanism)}
    assert kinds.get(frozenset(("base", "jaw"))) == ("prismatic" if play < 1 else None)
    assert any("lies on" in note for note in mechanism.notes if "nothing else needs it" in note) == (play > 1)
