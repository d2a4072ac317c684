"""Contacts that end, held to drawn rails, windows, half bores and slots whose ends are known."""

from itertools import pairwise

import jax
import numpy as np
import pytest
import trimesh

import jaxkin as jk
from jaxkin.assembly.assembly import Assembly
from jaxkin.examples import path
from reference.drawn_parts import box, loaded


def prism(rings, low, high):
    """A prism along z over the region between an outer ring of points and its holes, (x, y) each, anticlockwise."""
    from matplotlib.tri import Triangulation

    points = np.concatenate(rings)
    triangulation = Triangulation(*points.T)
    middles = points[triangulation.triangles].mean(axis=1)
    inside = contains(rings[0], middles) & ~np.any([contains(ring, middles) for ring in rings[1:]], axis=0)
    return extruded(rings, triangulation.triangles[inside], low, high)


def extruded(rings, flat, low, high):
    """A prism over triangles `flat` of the points of rings, the outer one anticlockwise."""
    points = np.concatenate(rings)
    n = len(points)
    corners = np.concatenate([np.column_stack([points, np.full(n, z)]) for z in (low, high)])
    faces = [*(flat + n), *flat[:, ::-1]]
    start = 0
    for number, ring in enumerate(rings):
        for k, j in pairwise([*range(start, start + len(ring)), start]):
            k, j = (k, j) if number == 0 else (j, k)
            faces += [[k, j, n + j], [k, n + j, n + k]]
        start += len(ring)
    return trimesh.Trimesh(corners, faces)


def contains(ring, points):
    """Which points lie in a convex ring."""
    edges = np.roll(ring, -1, axis=0) - ring
    off = points[:, None] - ring
    return np.all(edges[:, 0] * off[..., 1] - edges[:, 1] * off[..., 0] > 0, axis=1)


def rectangle(x0, x1, y0, y1):
    return np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], float)


def over_a_window(tmp_path):
    """A shoe, 10 long, on a table with a window from 40 to 70 that is wider than it; a fence keeps it straight."""
    table = prism([rectangle(0, 120, -20, 20), rectangle(40, 70, -8, 8)], -5, 0)
    fence = box([0, 5, 0], [120, 8, 10])
    shoe = box([10, -5, 0], [20, 5, 6])
    assembly = loaded(tmp_path, {"table": table, "fence": fence, "shoe": shoe})
    mechanism = assembly.mechanism(fixed=["table", "fence"])
    (name,) = mechanism.joints
    return mechanism, name


def test_a_shoe_over_a_window_has_lost_the_table_that_the_warning_takes_it_to_be_on(tmp_path):
    """Over the window from a displacement of 30 to 50: the hull of the table has no window, its triangles do."""
    mechanism, name = over_a_window(tmp_path)
    shift = np.arange(0.5, 90.0, 1.0)
    along = mechanism.joints[name].frames_1[0, 0, 2]
    motion = mechanism.sweep({name: along * shift})
    assert motion.lost_contacts == ()
    found = jk.contact_validity(motion)
    (floor,) = [k for k, each in enumerate(found.contacts) if "table" in each.parts]
    expected = (shift > 30) & (shift < 50)
    np.testing.assert_array_equal(found.lost[floor], expected)
    # distance to the nearer edge of the window: front edge 20 + shift to 40 .. 70, back edge 10 + shift
    apart = np.minimum(shift + 10 - 40, 70 - shift - 20)
    # whole numbers, which STL holds exactly: rounding of coordinates up to 100
    np.testing.assert_allclose(found.gaps[floor][expected], np.minimum(apart, 3.0)[expected], atol=1e-12)
    assert found.first == (30, floor)
    assert "first at pose 30" in str(found) and "table" in str(found)
    assert not found.holds and not found.lost[1 - floor].any()


def tee(width, bar, leg, depth):
    """A table like a T: a bar, `width` long over the heights of `bar`, with a leg below it, `depth` long."""
    (low, high), (left, right) = bar, leg
    ring = [(0, low), (left, low), (left, low - depth), (right, low - depth), (right, low), (width, low)]
    ring += [(width, high), (0, high)]
    flat = [(7, 0, 1), (7, 1, 6), (1, 4, 6), (4, 5, 6), (1, 2, 3), (1, 3, 4)]
    return extruded([np.array(ring, float)], np.array(flat), -5, 0)


def test_the_gap_at_the_end_of_a_table_with_a_leg_is_the_way_from_there(tmp_path):
    """The straight edges of its hull, from the bar to the leg, are no chords of a curved rim."""
    parts = {"table": tee(100, (-6, 9), (40, 70), 15), "fence": box([0, 5, 0], [100, 8, 10])}
    mechanism = loaded(tmp_path, {**parts, "shoe": box([10, -5, 0], [20, 5, 6])}).mechanism(fixed=["table", "fence"])
    (name,) = mechanism.joints
    shift = np.arange(85.5, 110.0, 1.0)
    motion = mechanism.sweep({name: mechanism.joints[name].frames_1[0, 0, 2] * shift})
    # its rear edge is at 10 + shift; whole numbers, which STL holds exactly: rounding of coordinates up to 130
    expected = np.maximum(10 + shift - 100, 0)
    found, lost = jk.contact_validity(motion), motion.lost_contacts
    assert len(found.contacts) == len(lost) == 2
    for gaps in (*found.gaps, *(each.gaps for each in lost)):
        np.testing.assert_allclose(gaps, expected, atol=1e-12)


def test_the_gap_in_a_recess_is_that_of_the_triangles(tmp_path):
    """A shoe beside the leg of the table, from within the hull of both to beyond it: what extents say is less."""
    parts = {"table": tee(110, (0, 20), (40, 70), 60), "fence": box([90, -100, 0], [95, 20, 10])}
    mechanism = loaded(tmp_path, {**parts, "shoe": box([80, 5, 0], [90, 15, 6])}).mechanism(fixed=["table", "fence"])
    (name,) = mechanism.joints
    shift = np.arange(0.5, 100.0, 1.0)
    motion = mechanism.sweep({name: -mechanism.joints[name].frames_1[0, 1, 2] * shift})
    found = jk.contact_validity(motion)
    (floor,) = [k for k, each in enumerate(found.contacts) if "table" in each.parts]
    # its upper edge is at 15 - shift, the bar ends at 0 and the leg, 10 beside it, at -60
    expected = np.minimum(np.maximum(shift - 15, 0), np.hypot(10, np.maximum(shift - 75, 0)))
    np.testing.assert_allclose(found.gaps[floor], expected, atol=1e-12)
    (warned,) = [each for each in motion.lost_contacts if "table" in each.contact.parts]
    assert np.all(warned.gaps <= expected + 1e-12) and warned.gaps.max() > 1.0  # a bound


def test_what_the_warning_tells_is_told_the_same(tmp_path):
    """Beyond the ends of the table both look at the same gap: one way to measure it."""
    mechanism, name = over_a_window(tmp_path)
    motion = mechanism.sweep({name: np.linspace(-150, 150, 61)})
    found = jk.contact_validity(motion)
    for lost in motion.lost_contacts:
        k = found.contacts.index(lost.contact)
        np.testing.assert_array_equal(found.gaps[k][lost.lost], lost.gaps[lost.lost])


@pytest.mark.long
def test_a_pin_reaches_the_end_of_its_slot(tmp_path):
    """Straight flanks from x = -20 to 20: the pin's axis leaves them there."""
    turn = np.linspace(-np.pi / 2, np.pi / 2, 25)
    end = np.column_stack([20 + 4 * np.cos(turn), 4 * np.sin(turn)])
    slot = np.concatenate([end, -end])
    plate = prism([rectangle(-40, 40, -15, 15), slot], 0, 6)
    pin = trimesh.creation.cylinder(4, segment=[[0, 0, -6], [0, 0, 12]], sections=48)
    head = box([-9, -9, 6], [9, 9, 9])
    mechanism = loaded(tmp_path, {"plate": plate, "pin": pin, "head": head}).mechanism(
        fixed=["plate"], rigid=[["pin", "head"]]
    )
    along = mechanism.joints["plate-head"].frames_1[0, :3, :3].T @ [1.0, 0, 0]
    (axis,) = np.flatnonzero(np.abs(along) > 0.999)
    shift = np.arange(-30.25, 31, 0.5)
    drive = {f"plate-head.{'xy'[axis]}": along[axis] * shift, "plate-head.phi": 0 * shift}
    found = jk.contact_validity(mechanism.sweep(drive))
    flanks = [k for k, each in enumerate(found.contacts) if each.state == "b"]
    assert len(flanks) == 2
    for k in flanks:
        np.testing.assert_array_equal(found.lost[k], np.abs(shift) > 20)
        np.testing.assert_allclose(found.gaps[k], np.maximum(np.abs(shift) - 20, 0), atol=2e-3)


@pytest.mark.long
def test_an_assembly_that_stays_on_its_faces_holds_prints_draws_and_saves(tmp_path):
    mechanism = jk.load(path("cam")).mechanism(fixed=["frame"])
    motion = mechanism.sweep({mechanism.joints_between("cam", "frame")[0]: np.linspace(0, 2 * np.pi, 9)})
    found = jk.contact_validity(motion)
    assert found.holds and found.first is None and "5 contacts at 9 closed poses of 9: 0 lost" in str(found)
    assert found.plot(tmp_path / "gaps.png").stat().st_size > 1000
    rows = found.save(tmp_path / "gaps.csv").read_text().splitlines()
    assert len(rows) == 10 and "(b)" in rows[0]


def test_poses_that_are_not_closed_are_nan(tmp_path):
    from dataclasses import replace

    mechanism, name = over_a_window(tmp_path)
    motion = mechanism.sweep({name: np.array([0.0, 40.0, 40.0])})
    cut = replace(motion, status=jax.numpy.array([0, 0, 1]) + motion.status[0])
    found = jk.contact_validity(cut)
    assert np.isnan(found.gaps[:, 2]).all() and not np.isnan(found.gaps[:, :2]).any()
    assert "at 2 closed poses of 3" in str(found)


def test_a_mechanism_by_hand_has_nothing_to_check_and_says_what_to_do():
    slide = jk.prismatic("slide", "base", "slider", axis=(1, 0, 0))
    motion = jk.Mechanism.build(fixed=["base"], joints=[slide]).sweep({"slide": np.array([0.0, 1.0])})
    with pytest.raises(ValueError, match=r"has none: those of solids, jk\.load"):
        jk.contact_validity(motion)


def test_joints_that_were_written_down_are_checked_by_the_contacts_that_they_keep(tmp_path):
    """As a study has them: the slide keeps the faces of the shoe on the table and on the fence, and loses the same. A
    hinge across the faces of the table keeps none of them."""
    found, name = over_a_window(tmp_path)
    shift = found.joints[name].frames_1[0, 0, 2] * np.arange(0.5, 90.0, 10.0)
    slide = jk.prismatic("slide", "table", "shoe", axis=found.joints[name].frames_1[0, :3, 2])
    assembly = Assembly(found.solids, "mm", "shoe")
    words = {"fixed": ["table"], "rigid": [["table", "fence"]]}
    checked = jk.contact_validity(assembly.of_joints(joints=[slide], **words).sweep({"slide": shift}))
    expected = jk.contact_validity(found.sweep({name: shift}))
    assert {each.faces for each in checked.contacts} == {each.faces for each in expected.contacts}
    assert checked.joints == ("slide",) * len(expected.joints) and not expected.holds
    np.testing.assert_allclose(np.sort(checked.gaps, 0), np.sort(expected.gaps, 0), atol=1e-9)
    across = jk.revolute("slide", "table", "shoe", point=(15, 0, 0), axis=(1, 0, 0))
    with pytest.raises(ValueError, match="needs contacts"):
        jk.contact_validity(assembly.of_joints(joints=[across], **words).sweep({"slide": np.zeros(2)}))
