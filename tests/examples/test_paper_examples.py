"""The paper's Fig. 3 and 5 and Fig. 7 from solids to motion: contacts, loops, mobility, and plane geometry as oracle.

From STEP, places are held to 5e-7 of the size (placements pass through float32 in the reader) and closure to 1e-12.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples import EXAMPLES, path
from jaxkin.examples.paper import AIR_CYLINDER, EIGHTEEN_BARS
from reference import planar

NOISE = 5e-7 * 300.0  # mm: of the size of either assembly
POSES = 21


@cache
def assembly(name):
    return jk.load(path(name))


@cache
def mechanism(name, fixed, combine=True):
    return assembly(name).mechanism(fixed=fixed, combine=combine)


@pytest.mark.parametrize(("combine", "loops", "redundant"), [(True, 1, 1), (False, 3, 5)])
def test_figure_6_has_one_freedom(combine, loops, redundant):
    """Whatever counting gives: -4 with a joint a contact, as in Table 5, 0 with those of a pair combined."""
    found = mechanism("cam", ("frame",), combine)
    assert len(found.structure.loops) == loops
    mobility = found.mobility()
    assert (mobility.freedoms, mobility.useful, mobility.redundant) == (1, 1, redundant)
    assert mobility.counted == 1 - redundant


def by_parts(pairs):
    return sorted(tuple(sorted(pair[:2], key=lambda part: int(part[1:]))) + tuple(pair[2:]) for pair in pairs)


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("eighteen_bars", [(*pair, "e") for pair in EIGHTEEN_BARS.values()]),
        ("air_cylinder", list(AIR_CYLINDER.values())),
    ],
)
def test_contacts_are_those_of_the_tables(name, expected):
    contacts = assembly(name).contacts()
    assert by_parts((*contact.parts, contact.state) for contact in contacts) == by_parts(expected)
    assert not contacts.near_misses and not contacts.notes


@pytest.mark.long
@pytest.mark.parametrize(
    ("fixed", "loops", "freedoms"),
    [
        # three loops: 1 in the plane, 7 parts float along their pins; the fourth: 1 and 3; six free pins: 2 each
        (("p1", "p9"), [3, 1], 8 + 4 + 12),
        (("p1",), [1, 1, 1], 3 * 4 + 2 * 8),
    ],
)
def test_loops_and_freedoms_of_figure_3(fixed, loops, freedoms):
    found = mechanism("eighteen_bars", fixed)
    assert [len(element.loops) for element in found.structure.elements if element.loops] == loops
    assert found.mobility().freedoms == freedoms
    in_loops = {found.structure.joints[joint] for block in found.structure.loop_groups for joint in block.joints}
    assert set(found.mobility().idle) == {f"{name}.z" for name in in_loops}  # bars float along their pins


@pytest.mark.parametrize(("combine", "loops"), [pytest.param(True, 5, marks=pytest.mark.long), (False, 7)])
def test_figure_7_has_nine_freedoms_of_which_one_is_of_use(combine, loops):
    """Four links and the platform float along the pins, rod and sleeve spin, the sleeve slides: eight idle ones."""
    found = mechanism("air_cylinder", ("p4",), combine)
    assert len(found.structure.loops) == loops  # 16 - 10 + 1 with a joint a contact, as in Table 7
    assert (found.mobility().freedoms, found.mobility().idle_freedoms) == (9, 8)
    useful = {"p1-p5", "p1-p6", "p1-p7", "p1-p8", "p1-p9", "p4-p5", "p4-p6", "p4-p7", "p4-p8", "p4-p10"}
    coordinates = {f"{name}.phi" for name in found.joints if name.partition(":")[0] in useful} | {"p2-p10.z"}
    assert not coordinates & set(found.mobility().idle)


def test_directions_of_figure_7_are_those_of_table_7():
    found = mechanism("air_cylinder", ("p4",), False).structure
    cycles = found.cycles
    assert not ((cycles > 0).any(axis=0) & (cycles < 0).any(axis=0)).any()
    assert np.linalg.matrix_rank(cycles) == len(cycles) == 7
    assert [element.kind for element in found.elements] == ["multiple loop"]


def drawing_axis(example, axis):
    return EXAMPLES[example].placement[:3, :3] @ np.asarray(axis, float)


def sign(found, joint, direction):
    """+1 where the joint's axis points along a direction of the drawing, -1 against it: files have it either way."""
    return np.sign(float(np.asarray(found.joints[joint].frames_1)[0][:3, 2] @ direction))


@pytest.mark.long
@pytest.mark.parametrize("combine", [True, False])
def test_figure_7_moves_as_the_triangle_of_its_pivots_says(combine):
    """|CD|^2 = (50 cos a - 110)^2 + (50 sin a)^2: the rod drives, the links turn, the platform stays level."""
    found = mechanism("air_cylinder", ("p4",), combine)
    size = EXAMPLES["air_cylinder"].dimensions
    reach = size["trunnion"] - size["base"] / 2
    angles = np.linspace(np.radians(50), np.radians(85), POSES)

    def stretch(a):
        return np.hypot(size["link"] * np.cos(a) - reach, size["link"] * np.sin(a))

    assert stretch(size["angle"]) == pytest.approx(95.39, abs=5e-3)
    start = size["angle"]
    towards = np.array([size["trunnion"], 0, 0]) - [
        size["link"] * np.cos(start) + size["base"] / 2,
        size["link"] * np.sin(start),
        0,
    ]
    out = sign(found, "p2-p10", drawing_axis("air_cylinder", towards))  # the cylinder, part 2, leaves the rod along it
    motion = found.sweep({"p2-p10.z": out * (stretch(angles) - stretch(start))})
    assert np.all(motion.closed)
    assert np.max(motion.residual) < 1e-12
    q = size["link"] * np.stack([np.cos(angles) - np.cos(start), np.sin(angles) - np.sin(start), 0 * angles], axis=1)
    moved = q @ EXAMPLES["air_cylinder"].placement[:3, :3].T
    platform = np.asarray(motion.transforms["p1"])
    np.testing.assert_allclose(platform[:, :3, :3], np.broadcast_to(np.eye(3), (POSES, 3, 3)), atol=5e-7)
    np.testing.assert_allclose(platform[:, :3, 3], moved, atol=NOISE)
    z = drawing_axis("air_cylinder", [0, 0, 1])
    for joint in ("p4-p5", "p4-p6", "p4-p7", "p4-p8"):
        turned = sign(found, joint, z) * np.asarray(motion.coordinates[joint])
        np.testing.assert_allclose(turned[:, 1], angles - start, atol=5e-7)
        np.testing.assert_allclose(turned[:, 0], 0.0, atol=NOISE)  # least-norm motion leaves the floats at rest


def flat(position, turn):
    """Displacements of the plane of the drawing that turn about the origin and then shift, as world displacements."""
    placement = EXAMPLES["eighteen_bars"].placement
    moved = np.tile(np.eye(4), (len(turn), 1, 1))
    moved[:, 0, 0] = moved[:, 1, 1] = np.cos(turn)
    moved[:, 1, 0], moved[:, 0, 1] = np.sin(turn), -np.sin(turn)
    moved[:, :2, 3] = position
    return placement @ moved @ np.linalg.inv(placement)


def bar(before, after):
    """The displacement of a bar from two of its points before (2,) and after (poses, 2)."""
    (a, b), (a_now, b_now) = before, after
    turn = np.arctan2(*np.moveaxis(b_now - a_now, -1, 0)[::-1]) - np.arctan2(*(b - a)[::-1])
    cos, sin = np.cos(turn), np.sin(turn)
    return np.stack([a_now[:, 0] - cos * a[0] + sin * a[1], a_now[:, 1] - sin * a[0] - cos * a[1]], axis=1), turn


def carried(displacement, point):
    shift, turn = displacement
    cos, sin = np.cos(turn), np.sin(turn)
    return shift + np.stack([cos * point[0] - sin * point[1], sin * point[0] + cos * point[1]], axis=1)


def turned_about(displacement, point, angle):
    """A bar hinged at a point of one that moves so, and turned against it by an angle."""
    _, turn = displacement
    now, total = carried(displacement, point), turn + angle
    cos, sin = np.cos(total), np.sin(total)
    return now - np.stack([cos * point[0] - sin * point[1], sin * point[0] + cos * point[1]], axis=1), total


def closed(pins, crank, rocker, joint, pivot_crank, pivot_rocker):
    """The pin of a dyad between two moving points, on the side on which it was assembled."""
    p, q, c = pins[pivot_crank], pins[pivot_rocker], pins[joint]
    side = int(np.sign(np.linalg.det([q - p, c - p])))
    return planar.meet(crank, np.linalg.norm(c - p), rocker, np.linalg.norm(c - q), side)


@pytest.mark.long
@pytest.mark.parametrize("fixed", [("p1", "p9"), ("p1",)])
def test_figure_5_moves_as_a_chain_of_circles(fixed):
    """j1, j3, j14 and j17 driven as in Section 6; every other pin is where two circles meet."""
    found = mechanism("eighteen_bars", fixed)
    size = EXAMPLES["eighteen_bars"].dimensions
    pins = {f"j{i}": np.array([size[f"j{i} x"], size[f"j{i} y"]]) for i in range(1, 21)}
    s = np.linspace(0.0, 1.0, POSES)
    drive = {"p1-p2": 2 * np.pi * s, "p3-p11": 0.6 * s, "p10-p13": 0.5 * s, "p15-p16": -0.6 * s}
    z = drawing_axis("eighteen_bars", [0, 0, 1])
    motion = found.sweep({f"{joint}.phi": sign(found, joint, z) * angle for joint, angle in drive.items()})
    assert np.all(motion.closed)
    assert np.max(motion.residual) < 1e-12

    still = np.zeros((POSES, 2)), np.zeros(POSES)
    at = {name: np.broadcast_to(pins[name], (POSES, 2)) for name in ("j1", "j5")}
    place = {"p1": still, "p2": turned_about(still, pins["j1"], drive["p1-p2"])}
    at["j2"] = carried(place["p2"], pins["j2"])
    at["j4"] = closed(pins, at["j2"], at["j5"], "j4", "j2", "j5")
    place["p3"] = bar((pins["j2"], pins["j4"]), (at["j2"], at["j4"]))
    place["p4"] = bar((pins["j5"], pins["j4"]), (at["j5"], at["j4"]))
    if "p9" in fixed:
        at |= {name: np.broadcast_to(pins[name], (POSES, 2)) for name in ("j11", "j12")}
        at["j6"] = carried(place["p4"], pins["j6"])
        at["j8"] = closed(pins, at["j6"], at["j12"], "j8", "j6", "j12")
        place["p5"] = bar((pins["j6"], pins["j8"]), (at["j6"], at["j8"]))
        place["p6"] = bar((pins["j12"], pins["j8"]), (at["j12"], at["j8"]))
        at["j9"] = carried(place["p6"], pins["j9"])
        at["j10"] = closed(pins, at["j9"], at["j11"], "j10", "j9", "j11")
        place["p7"] = bar((pins["j9"], pins["j10"]), (at["j9"], at["j10"]))
        place["p8"] = bar((pins["j11"], pins["j10"]), (at["j11"], at["j10"]))
        place["p9"] = still
    else:  # nothing drives j6 and what hangs on it: carried along
        place |= dict.fromkeys(("p5", "p6", "p7", "p8", "p9"), place["p4"])
    place["p11"] = place["p12"] = turned_about(place["p3"], pins["j3"], drive["p3-p11"])
    place["p10"] = place["p15"] = place["p5"]
    place["p13"] = place["p14"] = turned_about(place["p10"], pins["j14"], drive["p10-p13"])
    place["p16"] = turned_about(place["p15"], pins["j17"], drive["p15-p16"])
    at["j18"], at["j20"] = carried(place["p16"], pins["j18"]), carried(place["p15"], pins["j20"])
    at["j19"] = closed(pins, at["j18"], at["j20"], "j19", "j18", "j20")
    place["p17"] = bar((pins["j18"], pins["j19"]), (at["j18"], at["j19"]))
    place["p18"] = bar((pins["j20"], pins["j19"]), (at["j20"], at["j19"]))

    centre = EXAMPLES["eighteen_bars"].placement @ [100.0, 100.0, 10.0, 1.0]
    for part, transforms in motion.transforms.items():
        expected = flat(*place[part])
        np.testing.assert_allclose(transforms[:, :3, :3], expected[:, :3, :3], atol=1e-6, err_msg=part)
        np.testing.assert_allclose(transforms @ centre, expected @ centre, atol=NOISE, err_msg=part)
