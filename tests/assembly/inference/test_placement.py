"""What solids imply does not depend on how the assembly is turned, and not on rounding where lengths are equal."""

import numpy as np
import pytest

from jaxkin.assembly.inference.bores import bores
from jaxkin.assembly.inference.screwed import crossings
from jaxkin.assembly.inference.slots import walls_beside
from jaxkin.assembly.inference.ties import first_largest
from jaxkin.assembly.inference.walls import facing, is_on_polygon
from jaxkin.geometry.part import moved
from jaxkin.geometry.pose import unit
from reference.round_parts import assembly, block, moving, part, pin, ring

TURNS = range(4)


def turned(seed):
    """A pose: the first turns nothing, the second by 45 degrees, others by angles at random."""
    rng, pose = np.random.default_rng(seed), np.eye(4)
    if seed == 1:
        pose[:2, :2] = np.array([[1, -1], [1, 1]]) / np.sqrt(2)
    elif seed:
        turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        pose[:3, :3], pose[:3, 3] = turn * np.sign(np.linalg.det(turn)), 100 * rng.normal(size=3)
    return pose


@pytest.mark.parametrize("seed", TURNS)
def test_faces_look_at_each_other_only_where_they_are_in_front_of_each_other(seed):
    block_between = part("slider", block((-5, -5, 0), (5, 5, 10)))
    beside = part("beside", block((-8, 5.2, 0), (-6, 20, 10)), block((6, -20, 0), (8, -5.2, 10)))
    in_front = part("in front", block((-8, -5, 0), (-6, 20, 10)), block((6, -20, 0), (8, 5, 10)))
    at_edges = part("at edges", block((-8, 5, 0), (-6, 20, 10)), block((6, -20, 0), (8, -5, 10)))
    pose = turned(seed)
    slider = moved(block_between, pose)
    across = pose[:3, 0]

    def gaps(other):
        return sorted(gap for normal, gap, _ in facing(slider, [moved(other, pose)]) if abs(normal @ across) > 0.5)

    # boxes of faces that lie askew to the axes of the world reach beyond the faces, and edges that meet share nothing
    assert gaps(beside) == [] and gaps(at_edges) == []
    np.testing.assert_allclose(gaps(in_front), [1.0, 1.0], atol=1e-12)


@pytest.mark.parametrize("seed", TURNS)
def test_walls_that_end_at_the_axis_of_a_screw_are_beside_it(seed):
    """As those of a slot in a sheet, in which half of a screw is; not walls that end before the axis, nor those that
    begin where the screw ends."""
    pose = turned(seed)
    (screw,) = bores(moved(part("screw", pin(1.5, 0, 10)), pose))
    ends = part("ends", block((-9, 0, 0), (-3, 9, 10)), block((3, 0, 0), (9, 9, 10)))
    goes_by = part("goes by", block((-9, -9, 0), (-3, 9, 10)), block((3, -9, 0), (9, 9, 10)))
    ends_before = part("ends before", block((-9, 0.1, 0), (-3, 9, 10)), block((3, 0.1, 0), (9, 9, 10)))
    begins_after = part("begins after", block((-9, -9, 10), (-3, 9, 20)), block((3, -9, 10), (9, 9, 20)))
    found = [
        len(walls_beside(screw, moved(each, pose), (1.05, 4.0))) for each in (ends, goes_by, ends_before, begins_after)
    ]
    assert found == [1, 1, 0, 0]


@pytest.mark.parametrize("seed", TURNS)
def test_a_line_through_edges_of_a_solid_goes_through_it_once_on_either_side(seed):
    """The line goes through the diagonals of two sides of a box, or along a third one, which it does not cross."""
    pose = turned(seed)
    solid = moved(part("box", block((-1, -2, 3), (1, 2, 5))), pose)
    for x in (0.0, 1.0, -1.0):  # in the middle, and along two sides
        point = pose[:3, :3] @ np.array([x, 0.0, 0.0]) + pose[:3, 3]
        found = np.unique(np.round(crossings(point, pose[:3, 2], solid.triangles), 9))
        assert found.tolist() == [3.0, 5.0]


@pytest.mark.parametrize("seed", TURNS)
def test_two_sides_are_no_polygon_however_they_are_turned(seed):
    """Normals on both sides of a place where decimals are cut are one direction."""
    turn = np.eye(4)
    x = unit(np.array([0.125, 0.99, 0.0]) if seed == 0 else turned(seed)[:3, 0])
    turn[:3, 0], turn[:3, 1] = x, unit(np.cross([0.0, 0.0, 1.0], x))
    turn[:3, 2] = np.cross(x, turn[:3, 1])
    shaft = part("shaft", block((-5, -4, 0), (5, 4, 20)), block((-5, -4, 20), (5, 4, 40)))
    hub = part("hub", block((-9, 4.1, 0), (9, 9, 40)), block((-9, -9, 0), (9, -4.1, 40)))
    both = [moved(each, turn) for each in (hub, shaft)]
    assert not is_on_polygon(*both, np.zeros(3), turn[:3, 2], 1.0)


@pytest.mark.parametrize("seed", TURNS)
def test_of_two_plates_that_reach_as_far_the_same_one_holds_the_bolt(seed):
    """Two links of one thickness on a bolt with play: which of them the bolt goes with is of no importance, but is not
    a matter of rounding."""
    links = [
        part("frame", ring(3.1, 8, 0, 5), block((8, -5, 0), (40, 5, 5))),
        part("one", ring(3.1, 8, 5.1, 10.1), block((-40, -5, 5.1), (-8, 5, 10.1))),
        part("other", ring(3.1, 8, 10.2, 15.2), block((-5, 8, 10.2), (5, 40, 15.2))),
        part("bolt", pin(3, -3, 18), pin(6, -6, -0.1), pin(6, 15.3, 20)),
    ]
    pose = turned(seed)
    mechanism = assembly(*(moved(each, pose) for each in links)).mechanism(fixed=["frame"])
    joints = sorted(tuple(sorted(joint.parts)) for joint in moving(mechanism))
    plain = assembly(*links).mechanism(fixed=["frame"])
    assert joints == sorted(tuple(sorted(joint.parts)) for joint in moving(plain))


def test_the_first_of_those_that_are_as_large_is_taken():
    sizes = {"a": 1.0, "b": 2.0 - 1e-12, "c": 2.0, "d": 1.5}
    assert first_largest(sizes, sizes.__getitem__, 1e-9) == "b"
    assert first_largest(sizes, sizes.__getitem__, 0.0) == "c"
