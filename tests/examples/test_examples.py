"""The shipped assemblies against the table of the dimensions that they were drawn with."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from jaxkin.examples import EXAMPLES, path
from jaxkin.geometry.pose import apply
from jaxkin.geometry.surfaces import Cylinder, Plane
from jaxkin.io.step import read_step

# The reader passes placements through float32: 6e-8 of coordinates of up to 200 mm, and of parts 150 mm long.
NOISE = 2e-5


@pytest.mark.long
@pytest.mark.parametrize("name", EXAMPLES)
def test_files_are_small_and_hold_the_parts_of_the_table(name):
    example = EXAMPLES[name]
    assert path(name).name == example.file
    assert path(name).stat().st_size < 400_000
    parts, unit = read(name)
    assert unit == example.unit
    assert {*example.fixed, *example.drive} <= {part.name for part in parts}
    assert len({part.color for part in parts} - {None}) == len(parts)
    assert all(part.notes == () for part in parts)


def test_an_unknown_name_is_answered_with_the_known_ones():
    with pytest.raises(KeyError, match="fourbar, slider_crank, cam"):
        path("five-bar")


@pytest.mark.long
@pytest.mark.parametrize("name", EXAMPLES)
def test_nothing_is_parallel_to_a_world_axis(name):
    turn = EXAMPLES[name].placement[:3, :3]
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-15)
    for part in read(name)[0]:
        for face in part.faces:
            direction = face.surface.normal if isinstance(face.surface, Plane) else face.surface.axis
            assert np.abs(direction).max() < np.cos(0.05)


@pytest.mark.parametrize(
    ("name", "link", "radii"),
    [
        ("fourbar", "ground", ("ground pin radius", "ground pin radius")),
        ("fourbar", "crank", ("ground pin radius", "pin radius")),
        ("fourbar", "coupler", ("pin radius", "pin radius")),
        ("fourbar", "rocker", ("ground pin radius", "pin radius")),
        ("slider_crank", "crank", ("ground pin radius", "pin radius")),
        ("slider_crank", "rod", ("pin radius", "pin radius")),
    ],
)
def test_pins_and_holes_of_a_link_are_its_length_apart(name, link, radii):
    size = EXAMPLES[name].dimensions
    bores = [bore for bore in cylinders(name, link) if bore.radius == pytest.approx(size[radii[0]], rel=1e-9)]
    bores += [bore for bore in cylinders(name, link) if bore.radius == pytest.approx(size[radii[1]], rel=1e-9)]
    between = bores[-1].point - bores[0].point
    across = between - (between @ bores[0].axis) * bores[0].axis
    assert np.linalg.norm(across) == pytest.approx(size[link], rel=1e-9)  # no float32 within a part


def test_pins_of_the_fourbar_are_where_the_drawing_has_them():
    size = EXAMPLES["fourbar"].dimensions
    a, d = np.zeros(3), np.array([size["ground"], 0, 0])
    b = size["crank"] * direction(size["angle"])
    diagonal = np.linalg.norm(d - b)
    at_b = np.arccos((size["coupler"] ** 2 + diagonal**2 - size["rocker"] ** 2) / (2 * size["coupler"] * diagonal))
    c = b + size["coupler"] * direction(np.arctan2(*(d - b)[1::-1]) + at_b)  # the open branch: left of b to d
    assert np.linalg.norm(c - d) == pytest.approx(size["rocker"])
    for centre, radius, pin, hole in (
        (a, "ground pin radius", "ground", "crank"),
        (b, "pin radius", "crank", "coupler"),
        (c, "pin radius", "rocker", "coupler"),
        (d, "ground pin radius", "ground", "rocker"),
    ):
        assert sides("fourbar", pin, centre, [0, 0, 1], size[radius]) == [1]
        assert sides("fourbar", hole, centre, [0, 0, 1], size[radius]) == [-1]


def test_the_slider_is_where_the_drawing_has_it():
    size = EXAMPLES["slider_crank"].dimensions
    b = size["crank"] * direction(size["angle"])
    x = b[0] + np.sqrt(size["rod"] ** 2 - (b[1] - size["offset"]) ** 2)
    for centre, radius, pin, hole in (
        (np.zeros(3), "ground pin radius", "ground", "crank"),
        (b, "pin radius", "crank", "rod"),
        (np.array([x, size["offset"], 0]), "pin radius", "slider", "rod"),
    ):
        assert sides("slider_crank", pin, centre, [0, 0, 1], size[radius]) == [1]
        assert sides("slider_crank", hole, centre, [0, 0, 1], size[radius]) == [-1]
    # rail, floor, rail: the slider has faces in the same three planes, facing the other way
    half = size["slider width"] / 2
    for point, normal in (
        ([x, size["offset"] - half, 0], [0, 1, 0]),
        ([x, size["offset"], 0], [0, 0, 1]),
        ([x, size["offset"] + half, 0], [0, -1, 0]),
    ):
        assert planes("slider_crank", "ground", point, normal) == 1
        assert planes("slider_crank", "slider", point, [-n for n in normal]) == 1


def test_the_cam_is_that_of_the_paper():
    size = EXAMPLES["cam"].dimensions
    centre = size["eccentricity"] * direction(size["angle"])
    assert [part.name for part in read("cam")[0]] == ["cam", "follower", "frame"]  # p1, p2, p3 of Table 4
    assert sides("cam", "cam", centre, [0, 0, 1], size["cam radius"]) == [1]
    foot = [0, centre[1] + size["cam radius"], 0]
    assert planes("cam", "follower", foot, [0, -1, 0]) == 1  # j1 (b)
    assert (planes("cam", "cam", [0, 0, 0], [0, 0, -1]), planes("cam", "frame", [0, 0, 0], [0, 0, 1])) == (1, 1)  # j2
    assert planes("cam", "follower", [0, 0, 0], [0, 0, -1]) == 1  # j4 (a)
    for part, side in (("cam", 1), ("frame", -1)):
        assert sides("cam", part, np.zeros(3), [0, 0, 1], size["shaft radius"]) == [side]  # j3 (e)
    for part, side in (("follower", 1), ("frame", -1)):
        assert sides("cam", part, np.array([0, 0, size["stem height"]]), [0, 1, 0], size["stem radius"]) == [side]


@cache
def read(name):
    return read_step(path(name))


def direction(angle):
    return np.array([np.cos(angle), np.sin(angle), 0.0])


def cylinders(name, part_name):
    (part,) = (part for part in read(name)[0] if part.name == part_name)
    return [face.surface for face in part.faces if isinstance(face.surface, Cylinder)]


def sides(name, part_name, point, axis, radius):
    """Sides of the cylinders of a part that have this axis, in the coordinates of the drawing, and this radius."""
    line = apply(EXAMPLES[name].placement, np.array([point, np.add(point, np.multiply(50.0, axis))], float))
    return [
        found.side
        for found in cylinders(name, part_name)
        if found.radius == pytest.approx(radius, rel=1e-9)
        and np.abs(found.distance(line) + found.side * found.radius).max() < NOISE
    ]


def planes(name, part_name, point, normal):
    """How many plane faces of a part go through this point of the drawing, with this outward normal."""
    placement = EXAMPLES[name].placement
    (part,) = (part for part in read(name)[0] if part.name == part_name)
    found = [face.surface for face in part.faces if isinstance(face.surface, Plane)]
    return sum(
        plane.normal @ placement[:3, :3] @ np.array(normal, float) > 1 - 1e-12
        and abs(plane.distance(apply(placement, np.array(point, float)))) < NOISE
        for plane in found
    )
