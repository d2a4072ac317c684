from dataclasses import replace

import numpy as np
import pytest
import trimesh

import jaxkin as jk
from jaxkin.geometry.part import Part
from jaxkin.view.scene import make_scene
from jaxkin.view.traces import given_marks
from reference.planar import fourbar
from view.bars import TURN


def test_the_paths_of_a_four_bar_are_those_of_its_moving_pins(four_bar):
    """Not of the pins in the ground, and no corner of the coupler: on a bar that is next to a pin."""
    scene = make_scene(four_bar)
    at = fourbar(1.0 + TURN)
    assert len(scene.traces) == 2
    for trace, pin in zip(scene.traces, (at.crank_pin, at.rocker_pin), strict=True):
        assert np.allclose(trace.path[:, :2], pin, atol=1e-9)
    assert {trace.part for trace in scene.traces} <= {"crank", "coupler", "rocker"}


def test_a_coupler_point_is_added_where_the_coupler_reaches_far(four_bar, plates):
    apex = np.array([60.0, 150.0, 10.0])
    at = fourbar(np.array([1.0]))
    corners = [[*at.crank_pin[0], 10], [*at.rocker_pin[0], 10], apex, [60.0, 150.0, 6.0]]
    coupler = Part("coupler", (), trimesh.convex.convex_hull(np.array(corners)).triangles.view(np.ndarray))
    mechanism = replace(four_bar.mechanism, solids=(*plates[:2], coupler, plates[3]))
    scene = make_scene(replace(four_bar, mechanism=mechanism))
    (trace,) = scene.traces[2:]
    assert trace.part == "coupler"
    expected = np.asarray(four_bar.points("coupler", apex))
    assert np.allclose(trace.path[:, :2], expected[:, :2], atol=1e-9)  # either of the two corners one behind the other


def test_every_part_that_slides_or_turns_by_itself_has_a_path(press):
    traces = {trace.part: trace.path for trace in make_scene(press).traces}
    assert set(traces) == {"wheel", "ram"}
    assert np.allclose(traces["ram"] - traces["ram"][0], np.outer(10 * np.sin(TURN), [0, 1, 0]), atol=1e-9)
    assert np.allclose(np.linalg.norm(traces["wheel"][:, :2], axis=1), np.hypot(8, 1))  # its farthest corner


def test_the_choice_does_not_depend_on_the_unit(sticks, small):
    one, other = make_scene(sticks).traces, make_scene(small).traces
    assert [trace.part for trace in one] == [trace.part for trace in other]
    for first, second in zip(one, other, strict=True):
        assert np.allclose(first.path, 1e6 * second.path, atol=1e-7)


def test_a_path_stops_where_the_mechanism_cannot_be_closed(partly):
    closed = np.asarray(partly.closed)
    assert 0 < closed.sum() < len(closed)
    for trace in make_scene(partly).traces:
        assert np.array_equal(np.isfinite(trace.path).all(axis=1), closed)


def test_points_of_the_user_replace_the_choice(four_bar):
    scene = make_scene(four_bar, {"coupler": [(20.0, 60.0, 0.0), (10.0, 10.0, 1.0)], "rocker": (90.0, 20.0, 0.0)})
    assert [trace.part for trace in scene.traces] == ["coupler", "coupler", "rocker"]
    assert np.allclose(scene.traces[1].path, four_bar.points("coupler", np.array([10.0, 10.0, 1.0])), atol=1e-12)
    assert make_scene(four_bar, {}).traces == ()


def test_points_on_no_part_or_of_no_place_are_refused():
    with pytest.raises(ValueError, match=r"'cupler'.*did you mean 'coupler'"):
        given_marks({"cupler": (0, 0, 0)}, ["crank", "coupler"])
    for wrong in ((1.0, 2.0), (1.0, 2.0, np.nan), [[[1.0, 2.0, 3.0]]], "tip"):
        with pytest.raises(ValueError, match=r"points\['crank'\] must be one finite \(x, y, z\)"):
            given_marks({"crank": wrong}, ["crank"])


def test_poses_are_drawn_in_order_of_a_single_input_whatever_order_they_came_in(four_bar):
    shuffled = np.random.default_rng(1).permutation(len(TURN))
    scene = make_scene(four_bar.mechanism.sweep({"A": TURN[shuffled]}))
    assert np.array_equal(shuffled[scene.order], np.arange(len(TURN)))


def test_several_inputs_are_drawn_as_they_came(press):
    assert np.array_equal(make_scene(press).order, np.arange(len(TURN)))


def test_a_whole_turn_returns_and_half_a_turn_does_not(four_bar):
    assert make_scene(four_bar).cyclic
    assert not make_scene(four_bar.mechanism.sweep({"A": TURN / 2})).cyclic


def test_everything_drawn_lies_within_the_bounds(four_bar):
    scene = make_scene(four_bar)
    low, high = scene.bounds
    for part in scene.parts:
        corners = scene.view.project(scene.moved(part, part.triangles, scene.closed))
        assert (corners >= low - 1e-9).all() and (corners <= high + 1e-9).all()


def test_where_two_parts_are_fixed_together_has_no_path():
    """Here that is the origin, far from the parts."""
    hinge = jk.revolute("A", "ground", "arm", point=(5, 0, 0), axis=(0, 0, 1))
    joints = [hinge, jk.fixed("F", "arm", "hand"), jk.revolute("B", "hand", "tip", point=(7, 0, 0), axis=(0, 0, 1))]
    mechanism = jk.Mechanism.build(fixed=["ground"], joints=joints)
    angles = np.linspace(0, 1, 5)
    scene = make_scene(mechanism.sweep({"A": angles, "B": angles}))
    assert scene.traces and all(np.linalg.norm(trace.path[0, :2]) > 4 for trace in scene.traces)
