"""Ends and necks: balls in open sockets, caps, pistons, nuts on shoulders, cotters, rings, channels.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import numpy as np
import pytest
import trimesh

from jaxkin.geometry.part import moved
from jaxkin.geometry.surfaces import Sphere
from reference.round_parts import SEEDS, TO_X, anywhere, assembly, block, moving, owners, part, pin, ring

PIVOT = pin(4.0, 0, 60, (60.0, 0.0))
LEVER = part("lever", ring(4.1, 9.0, 5, 15, (60.0, 0.0)), block((68, -3, 5), (100, 3, 15)))
"""Something that moves on the pivot of the base: where nothing can, inferences are left out until something does."""


def of(drawn, seed):
    mechanism = anywhere(drawn, seed).mechanism(fixed=["base"])
    return owners(mechanism), mechanism


def sphere(radius, side, low, high):
    """The zone of a sphere between two heights, over its radius."""
    triangles = trimesh.creation.icosphere(3, radius).triangles
    heights = triangles[:, :, 2] / radius
    kept = triangles[(heights.min(axis=1) > low) & (heights.max(axis=1) < high)]
    return [(Sphere(np.zeros(3), radius, side), kept if side > 0 else kept[:, ::-1])]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("ball", [8.0, 7.8])
def test_the_neck_of_a_ball_is_no_pin_in_the_opening_of_its_socket(seed, ball):
    base = part("base", sphere(8.0, -1, -0.7, 0.7), ring(6.0, 14.0, 5.6, 12), ring(8.5, 14.0, -5.6, 5.6))
    stud = part("stud", sphere(ball, 1, -0.99, 0.8), pin(5.0, 6.2, 30), block((-9, -2, 30), (9, 2, 40)))
    _, mechanism = of(assembly(base, stud), seed)
    assert [joint.kind for joint in moving(mechanism)] == ["spherical"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("bore", "floor", "told"), [(5.0, True, True), (5.2, True, False), (5.0, False, False)])
def test_a_knob_down_on_the_end_of_its_pin_turns_and_is_told(seed, bore, floor, told):
    """Exact contacts make it a hinge; that it may be pressed on is said with the words that would hold it there."""
    base = part("base", block((-60, -60, -10), (80, 60, 0)), pin(5.0, 0, 30), PIVOT)
    lid = [pin(12.0, 30, 36)] if floor else []
    knob = part("knob", ring(bore, 12.0, 10, 30), *lid, block((11, -4, 12), (40, 4, 20)))
    drawn = anywhere(assembly(base, knob, LEVER), seed)
    mechanism = drawn.mechanism(fixed=["base"])
    assert owners(mechanism)["knob"] != owners(mechanism)["base"]
    words = [note for note in mechanism.history if "rigid=[['base', 'knob']]" in note and "pressed on" in note]
    assert len(words) == told
    if told:
        held = drawn.mechanism(fixed=["base"], rigid=[["base", "knob"]])
        assert owners(held)["knob"] == owners(held)["base"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("low", "moves"), [(-20.0, True), (-60.0, False)])
def test_a_piston_in_the_midst_of_its_bore_is_no_fastener(seed, low, moves):
    """A plug that ends with the bore is."""
    base = part("base", ring(10.0, 16.0, -60, 60), block((15, -60, -10), (80, 60, 0)), PIVOT)
    body, _ = of(assembly(base, part("plug", pin(10.0, low, low + 40)), LEVER), seed)
    assert (body["plug"] != body["base"]) == moves


@pytest.mark.parametrize("seed", SEEDS)
def test_a_crank_between_a_shoulder_and_a_nut_goes_with_its_shaft(seed):
    base = part("base", ring(8.0, 16.0, -40, -2), block((-60, -60, -60), (60, 60, -50)))
    shaft = part("shaft", pin(8.0, -44, 0), pin(5.0, 0, 20))
    crank = part("crank", ring(5.0, 12.0, 0, 8), block((11, -4, 0), (60, 4, 8)))
    nut = part("nut", ring(5.0, 9.0, 8, 14)[:-1])  # without its outside, which is not round
    body, mechanism = of(assembly(base, shaft, crank, nut), seed)
    assert body["crank"] == body["shaft"] == body["nut"] != body["base"]
    assert any("against a shoulder of 'shaft'" in note for note in mechanism.notes)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_pin_with_a_cotter_is_held_by_the_fork_that_it_fits(seed):
    """The eye has play, and turns on it."""
    lugs = [ring(5.0, 10.0, low, low + 6) for low in (-16, 10)]
    webs = [block((-60, -10, low), (-9, 10, low + 6)) for low in (-16, 10)]
    base = part("base", *lugs, *webs, block((-80, -10, -16), (-60, 10, 16)))
    turned = moved(part("turned", ring(1.0, 1.1, -4.9, 4.9, (20.0, 0.0))), TO_X)
    bolt = part("bolt", pin(5.0, -16, 26), pin(8.0, -20, -16), [(f.surface, f.triangles) for f in turned.faces])
    turned = moved(part("turned", pin(1.0, -8, 8, (20.0, 0.0))), TO_X)
    cotter = part("cotter", [(f.surface, f.triangles) for f in turned.faces])
    eye = part("eye", ring(5.2, 10.0, -9, 9), block((9, -5, -5), (60, 5, 5)))
    body, mechanism = of(assembly(base, bolt, cotter, eye), seed)
    assert body["bolt"] == body["base"] == body["cotter"] != body["eye"]
    assert [joint.kind for joint in moving(mechanism)] == ["revolute"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("lips", "kinds"), [(True, ["prismatic"]), (False, [])])
def test_a_slider_in_a_channel_with_lips_slides(seed, lips, kinds):
    """Without lips nothing keeps it in the channel."""
    walls = [block((-80, min(s * 10.2, s * 16), 0), (80, max(s * 10.2, s * 16), 20)) for s in (1, -1)]
    tops = (
        [block((-80, min(s * 6.0, s * 10.2), 10.3), (80, max(s * 6.0, s * 10.2), 14)) for s in (1, -1)] if lips else []
    )
    base = part("base", block((-80, -16, -8), (80, 16, 0)), *walls, *tops)
    slider = part("slider", block((-30, -10, 0.2), (30, 10, 10)))
    _, mechanism = of(assembly(base, slider), seed)
    assert [joint.kind for joint in moving(mechanism)] == kinds
