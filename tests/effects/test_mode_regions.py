"""Modes that a path connects without a singular pose: against the surface of all poses of a 3-RPR robot.

With one leg fixed, every pose of that robot is given by two angles, that of the leg and that of the platform, and the
lengths of the two other legs are functions of these (Zein, Wenger and Chablat, 2008). The torus of the angles is cut
by the curves where the Jacobian of the two lengths vanishes and by the ends of their ranges; modes are connected where
they are in one piece. Where the ranges are wide, two pieces are left, as Husty (2009) proved of all general robots of
this kind, three of the six modes in each.
"""

from dataclasses import replace

import numpy as np
import pytest
from scipy.ndimage import label
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

import jaxkin as jk
from reference import planar
from reference.mechanisms import Z, planar_fourbar
from reference.planar_robots import BASE, LEGS, PLATFORM, connected, elbows, five_bar, three_rpr, tip

ANGLES = 900
"""Values of each angle: the narrowest passage of the ranges below is some thirty of them wide."""


def legs(alpha, theta):
    """Lengths of the second and the third leg, for the angles of the first leg and of the platform."""
    corner = BASE[0] + LEGS[0] * np.stack([np.cos(alpha), np.sin(alpha)], -1)
    cos, sin = np.cos(theta), np.sin(theta)
    ends = [corner + np.stack([cos * x - sin * y, sin * x + cos * y], -1) for x, y in PLATFORM[1:]]
    return [np.linalg.norm(end - base, axis=-1) for end, base in zip(ends, BASE[1:], strict=True)]


def pieces(ranges) -> list[set[float]]:
    """The angles of the platform, degrees, in the modes that are in one piece of the torus."""
    values = np.linspace(-np.pi, np.pi, ANGLES, endpoint=False)
    alpha, theta = np.meshgrid(values, values, indexing="ij")
    step = 1e-5
    by_alpha = [(a - b) / step for a, b in zip(legs(alpha + step, theta), legs(alpha, theta), strict=True)]
    by_theta = [(a - b) / step for a, b in zip(legs(alpha, theta + step), legs(alpha, theta), strict=True)]
    determinant = by_alpha[0] * by_theta[1] - by_alpha[1] * by_theta[0]
    lengths = zip(legs(alpha, theta), ranges, strict=True)
    inside = np.all([(own >= low) & (own <= high) for own, (low, high) in lengths], axis=0)
    found: dict[tuple[int, int], set[float]] = {}
    for sign in (1, -1):
        labels, count = label(inside & (sign * determinant > 0))  # pyright: ignore[reportGeneralTypeIssues]
        # pieces go on across the ends of both angles
        joined = np.concatenate([np.stack([labels[0], labels[-1]], 1), np.stack([labels[:, 0], labels[:, -1]], 1)])
        joined = joined[np.all(joined > 0, axis=1)]
        graph = coo_array((np.ones(len(joined)), joined.T), shape=(count + 1, count + 1))
        piece = connected_components(graph, directed=False)[1]
        for x, y, turn in planar.platform_poses(BASE, PLATFORM, LEGS):
            cell = [round(np.mod(each + np.pi, 2 * np.pi) / (2 * np.pi) * ANGLES) for each in (np.arctan2(y, x), turn)]
            if number := labels[cell[0] % ANGLES, cell[1] % ANGLES]:
                found.setdefault((sign, int(piece[number])), set()).add(degrees(turn))
    return list(found.values())


def degrees(turn: float) -> float:
    """An angle between -180 and 180 degrees, to a thousandth, which tells the modes apart."""
    return round(float(np.rad2deg(np.angle(np.exp(1j * turn)))), 3)


@pytest.fixture(scope="module")
def modes() -> jk.AssemblyModes:
    robot = three_rpr(planar.platform_poses(BASE, PLATFORM, LEGS)[0])
    return jk.assembly_modes(robot, {"leg 0": 0.0, "leg 1": 0.0, "leg 2": 0.0}, tries=256)


@pytest.mark.long
@pytest.mark.study
@pytest.mark.parametrize(
    ("ranges", "count"), [(((5.0, 30.0), (5.0, 30.0)), 4), (((2.0, 40.0), (2.0, 40.0)), 2)], ids=["narrow", "wide"]
)
def test_regions_of_a_3_rpr_robot(modes, ranges, count, tmp_path):
    """One leg of three is fixed; nodes are one unit apart."""
    grid = [np.arange(low, high + 0.5) - leg for (low, high), leg in zip(ranges, LEGS[1:], strict=True)]
    found = jk.mode_regions(modes, {"leg 1": grid[0], "leg 2": grid[1]})
    matrices = np.asarray(modes.motion.transforms["platform"])
    start = planar.platform_poses(BASE, PLATFORM, LEGS)[0][2]
    turns = np.arctan2(matrices[:, 1, 0], matrices[:, 0, 0]) + start
    regions = [sorted(degrees(turns[k]) for k in region) for region in found.regions]
    assert sorted(regions) == sorted(map(sorted, pieces(ranges))) and len(regions) == count
    assert f"6 assembly modes in {count} regions" in str(found)
    # every node has as many poses as the closed form, of those that the modes lead to: all in the wide range
    assert found.poses.sum(axis=0).max() == 6
    assert found.plot(tmp_path / "regions.png").read_bytes().startswith(b"\x89PNG")
    assert len(found.save(tmp_path / "regions.csv").read_text().splitlines()) == 1 + found.poses[0].size
    # a sweep along the path leads from one mode to the other, on its branch and past no singular pose
    one, other = next(region for region in found.regions if len(region) > 1)[:2]
    assert found.connected(one, other) and found.connected(other, one)
    path = found.path(one, other)
    along = np.linspace(0.0, 1.0, 40 * len(path["leg 1.z"]))
    knots = np.linspace(0.0, 1.0, len(path["leg 1.z"]))
    drive = {name: np.interp(along, knots, row) - row[0] for name, row in path.items()}
    motion = modes[one].mechanism().sweep(drive).check()
    assert float(np.min(motion.sigma_min)) > 1e-3
    moved = np.asarray(motion.transforms["platform"])[-1] @ matrices[one]
    np.testing.assert_allclose(moved, matrices[other], atol=1e-9)  # rounding over a small singular value
    apart = found.regions[0][0], found.regions[1][0]
    assert not found.connected(*apart)
    with pytest.raises(ValueError, match="no path over this grid connects mode"):
        found.path(*apart)


@pytest.mark.long
def test_the_two_modes_of_a_five_bar_are_never_connected():
    """Where the rods are stretched the mechanism is singular, and both modes meet there only; the map of each is known.

    The rods reach both sides of the line of the elbows for the same inputs.
    """
    grid = np.linspace(-3.1, 3.1, 13)
    modes = jk.assembly_modes(five_bar(72.0), {"A": 0.0, "E": 0.0})
    found = jk.mode_regions(modes, {"A": grid, "E": grid})
    assert found.regions == ((0,), (1,)) and "not connected with another mode" in str(found)
    for poses in found.poses:
        np.testing.assert_array_equal(poses, connected(grid, 72.0))


@pytest.mark.long
def test_no_region_goes_beyond_the_limits_of_a_joint():
    """An elbow of the five-bar has limits: the nodes to which lines of the grid lead from node to node within these.

    Its angle is known by the closed form. That of the other mode is beyond: a region of its own, of one pose.
    """
    grid, low, high = np.linspace(-3.1, 3.1, 13), -1.0, 0.8
    robot = five_bar(86.0)
    joints = [replace(joint, limits=((low, high),)) if joint.name == "B" else joint for joint in robot.all_joints]
    modes = jk.assembly_modes(jk.Mechanism.build(fixed=["ground"], joints=joints), {"A": 0.0, "E": 0.0})
    found = jk.mode_regions(modes, {"A": grid, "E": grid})
    left, right = (each.ravel() for each in np.meshgrid(grid, grid, indexing="ij"))
    rod = tip(left, right, 86.0) - elbows(left, right)[0]
    elbow = np.arctan2(rod[:, 1], rod[:, 0]) - left
    elbow = np.angle(np.exp(1j * (elbow - elbow[len(elbow) // 2]))).reshape(13, 13)  # from the assembled pose
    inside = (elbow >= low) & (elbow <= high)  # nan, where there is no pose, is neither
    wanted = connected(grid, 86.0, inside)
    assert 0 < wanted.sum() < connected(grid, 86.0).sum()
    assert found.regions == ((0,), (1,)) and "mode 2: beyond the limits of joints; 1 pose" in str(found)
    np.testing.assert_array_equal(found.poses[0], wanted)
    assert found.poses[1].sum() == 1


@pytest.mark.long
def test_what_has_no_regions_is_refused():
    rods = jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("A", "ground", "crank", point=(0, 0, 0), axis=Z),
            jk.spherical("B", "crank", "rod", point=(30, 0, 0)),
            jk.spherical("C", "rod", "slider", point=(100, 20, 10)),
            jk.prismatic("S", "ground", "slider", point=(100, 20, 10), axis=(1, 0, 0)),
            jk.prismatic("T", "slider", "tool", point=(100, 20, 10), axis=Z),
        ],
    )
    grid = np.linspace(-0.5, 0.5, 3)
    arm = jk.assembly_modes(five_bar(86.0), {"A": 0.0, "E": 0.0})
    for given, ranges, message in (
        (five_bar(86.0), {"A": grid, "E": grid}, "regions are those of modes, .* got Mechanism"),
        (arm, {"A": grid}, "mapped over two inputs, got 1"),
        (arm, {"A": grid, "B": grid}, "'B' is no input of the modes"),
        (arm, {"A": grid, "E": grid[::-1]}, "'E' must be two finite numbers or more, rising"),
        (arm, {"A": grid, "E": grid + 3}, r"values of 'E', 2.5 to 3.5, must hold that of the modes, 0"),
        (jk.assembly_modes(planar_fourbar(), {"A": 0.0}), {"A": grid, "B": grid}, "'B' is no input"),
        (jk.assembly_modes(rods, {"A": 0.0, "T": 0.0}), {"A": grid, "T": grid}, "1 idle freedom, such as the spin"),
    ):
        with pytest.raises(ValueError, match=message):
            jk.mode_regions(given, ranges)  # pyright: ignore[reportArgumentType]
