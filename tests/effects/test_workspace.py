"""Maps over two inputs: a five-bar against its closed form, a serial arm, and a hexapod against its legs."""

from dataclasses import replace

import jax
import numpy as np
import pytest
from scipy import ndimage

import jaxkin as jk
from jaxkin import Status
from jaxkin.effects import workspace_plot
from reference import planar
from reference.catalogue import hexapod
from reference.mechanisms import flat, planar_fourbar
from reference.planar_robots import connected, elbows, five_bar, tip

Z = (0.0, 0.0, 1.0)


@pytest.mark.long
@pytest.mark.parametrize(("rod", "nodes"), [(72.0, 37), (86.0, 37)])
def test_a_five_bar(rod, nodes, tmp_path):
    """All nodes, their places, and their derivatives; the shorter rods leave islands to which no motion leads."""
    grid = np.linspace(-3.1, 3.1, nodes)  # no node where the elbows meet, around which the rods turn freely
    found = jk.workspace(five_bar(rod), {"A": grid, "E": grid}, "left rod", flat(tip([0.0], [0.0], rod)))
    left, right = np.meshgrid(grid, grid, indexing="ij")
    wanted = tip(left.ravel(), right.ravel(), rod).reshape(nodes, nodes, 2)
    exists = np.isfinite(wanted[..., 0])
    np.testing.assert_array_equal(found.status == Status.UNREACHABLE.value, ~exists)
    np.testing.assert_array_equal(found.reached, connected(grid, rod))
    assert np.isnan(found.points[~exists]).all() and np.isnan(found.condition[~exists]).all()
    at = found.reached
    # beside a limit an error of a pose is that of the residual over a small singular value
    np.testing.assert_allclose(found.points[at][:, :2], wanted[at], rtol=0, atol=1e-9)
    well = at & (found.sigma_min > 0.1)
    step = 1e-6
    for number, (one, other) in enumerate(((step, 0.0), (0.0, step))):
        ends = [tip((left + side * one).ravel(), (right + side * other).ravel(), rod) for side in (1, -1)]
        rates = ((ends[0] - ends[1]) / (2 * step)).reshape(nodes, nodes, 2)
        np.testing.assert_allclose(found.rates[well][..., :2, number], rates[well], rtol=0, atol=1e-5)
    values = np.linalg.svd(found.rates[well], compute_uv=False)
    np.testing.assert_allclose(found.condition[well], values[:, 1] / values[:, 0], rtol=1e-12)
    if rod == 72.0:
        text = str(found)
        assert np.sum(found.status == Status.JUMPED.value) > 3
        assert f"Workspace of left rod over {nodes} x {nodes} poses" in text and f"{at.sum()} CLOSED" in text
        assert found.plot(tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")
        assert len(found.save(tmp_path / "map.csv").read_text().splitlines()) == 1 + nodes**2
        check_singularities(found, rod, tmp_path)


def check_singularities(found: jk.Workspace, rod: float, folder) -> None:
    """The workspace ends where the two rods are stretched: one pose on each edge of the grid that leads out."""
    ends = jk.singularities(found)
    one, other = elbows(*ends.values.T)
    np.testing.assert_allclose(np.linalg.norm(other - one, axis=1), 2 * rod, rtol=0, atol=1e-10)  # of 144
    np.testing.assert_allclose(ends.points[:, :2], (one + other) / 2, rtol=0, atol=1e-10)
    edges = np.sum(found.reached[:-1] != found.reached[1:]) + np.sum(found.reached[:, :-1] != found.reached[:, 1:])
    assert len(ends.values) == edges > 10 and ends.passed == 0
    assert set(ends.reasons) == {"the axes of B, C and D lie in one plane"}
    assert f"{edges} points of singularity curves over A.phi and E.phi" in str(ends)
    assert ends.plot(folder / "singular.png").read_bytes().startswith(b"\x89PNG")
    table = ends.save(folder / "singular.csv").read_text().splitlines()
    assert len(table) == 1 + edges and table[0].startswith('pose,"A.phi [rad]","E.phi [rad]","x')


def test_a_serial_arm_reaches_all():
    """Nothing is to be closed: a point of two links, singular where they are stretched and folded."""
    arm = jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("shoulder", "ground", "upper", point=(0, 0, 0), axis=Z),
            jk.revolute("elbow", "upper", "lower", point=(2, 0, 0), axis=Z),
        ],
    )
    first, second = np.linspace(0.5, 1.5, 5), np.linspace(0.0, np.pi, 7)
    found = jk.workspace(arm, {"shoulder": first, "elbow": second}, "lower", (3.0, 0, 0))
    assert found.reached.all() and found.status.shape == (5, 7)
    with pytest.raises(ValueError, match=r"the two inputs move no loop together"):
        jk.singularities(found)
    one, other = np.meshgrid(first, second, indexing="ij")
    np.testing.assert_allclose(
        found.points[..., :2], planar.polar(2.0, one) + planar.polar(1.0, one + other), rtol=0, atol=1e-14
    )
    assert found.condition[:, [0, -1]].max() < 1e-12 < 0.1 < found.condition[:, 2:-2].min()


@pytest.mark.long
@pytest.mark.parametrize("size", [1.0, 1e-6])
def test_a_map_far_from_the_assembled_pose_does_not_depend_on_the_unit(size):
    """Two links between slides that go apart until the links are nearly stretched: in metres as in micrometres."""
    places = {"A": (0.0, 0.0, 0.0), "C": (1.5 * size, 2.0 * size, 0.0), "B": (3.0 * size, 0.0, 0.0)}
    pairs = {"A": ("left", "one"), "C": ("one", "other"), "B": ("other", "right")}
    joints = [jk.revolute(name, *pairs[name], point=place, axis=Z) for name, place in places.items()]
    joints += [jk.prismatic(part[0].upper(), "ground", part, axis=(0, 1, 0)) for part in ("left", "right")]
    mechanism = jk.Mechanism.build(fixed=["ground"], joints=joints)
    up = size * np.linspace(1.97, 1.99, 5)
    assert jk.workspace(mechanism, {"L": up, "R": -up[::-1]}, "one", places["C"]).reached.all()


def test_poses_beyond_the_limits_of_joints_are_told_apart(tmp_path):
    """An arm whose elbow bends from -0.5 to 1: beyond, points are known, but not reached."""
    joints = [
        jk.revolute("shoulder", "ground", "upper", point=(0, 0, 0), axis=Z),
        jk.revolute("elbow", "upper", "lower", point=(2, 0, 0), axis=Z, limits=(-0.5, 1.0)),
    ]
    arm = jk.Mechanism.build(fixed=["ground"], joints=joints)
    first, second = np.linspace(-1, 1, 5), np.linspace(-2, 2, 9)
    found = jk.workspace(arm, {"shoulder": first, "elbow": second}, "lower", (3.0, 0, 0))
    within = np.broadcast_to((second >= -0.5) & (second <= 1.0), (5, 9))
    np.testing.assert_array_equal(found.reached, within)
    assert set(found.status[~within]) == {Status.LIMITED.value}
    assert np.isfinite(found.points).all() and np.isfinite(found.rates).all()
    assert "20 CLOSED, 25 LIMITED" in str(found)
    assert found.plot(tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")


def test_a_pose_that_is_assembled_beyond_a_limit_is_told():
    """No node is within the limits of what is held beyond them."""
    joints = [
        jk.revolute(name, *parts, point=(x, 0, 0), axis=Z, limits=limits)
        for name, parts, x, limits in (
            ("base", ("ground", "lower"), 0, None),
            ("elbow", ("lower", "upper"), 2, None),
            ("wrist", ("upper", "hand"), 3, (0.1, 0.5)),
        )
    ]
    mechanism, grid = jk.Mechanism.build(fixed=["ground"], joints=joints), np.linspace(-0.2, 0.2, 3)
    found = jk.workspace(mechanism, {"base": grid, "elbow": grid}, "hand", (4.0, 0, 0), hold=["wrist"])
    assert not found.reached.any()
    assert "the assembled pose itself is beyond its limits: wrist.phi, 0.1 to 0.5; assemble" in str(found)
    within = mechanism.at(mechanism.sweep({"wrist": [0.3]}), 0)
    found = jk.workspace(within, {"base": grid, "elbow": grid}, "hand", (4.0, 0, 0), hold=["wrist"])
    assert found.reached.all() and "beyond" not in str(found)


@pytest.mark.long
def test_a_map_begins_at_whichever_node_beside_the_assembled_pose_it_can_get_to():
    """A five-bar that is stretched but for 4e-4: the node nearest to 0 is beyond that, and the three around it are not.

    The rods close where the elbows are less than both of them apart; of these nodes none is cut off.
    """
    places = {"left": (0, 0, 0), "left elbow": (0, 1, 0), "tip": (1, 1.02, 0), "right elbow": (2, 1, 0)}
    parts = [("ground", "one"), ("one", "two"), ("two", "three"), ("three", "four"), ("four", "ground")]
    joints = [
        jk.revolute(name, *pair, point=point, axis=Z)
        for (name, point), pair in zip({**places, "right": (2, 0, 0)}.items(), parts, strict=True)
    ]
    first, second = np.array([-0.9, -0.6, -0.3, 0.1, 0.4, 0.7]), np.array([-0.7, -0.4, -0.1, 0.3, 0.6, 0.9])
    mechanism = jk.Mechanism.build(fixed=["ground"], joints=joints)
    # the right crank is part 1 of its joint: it turns against the displacement
    found = jk.workspace(mechanism, {"left": first, "right": -second[::-1]}, "two", (1, 1.02, 0))
    u, v = np.meshgrid(first, second[::-1], indexing="ij")
    apart = np.hypot(2 - np.sin(v) + np.sin(u), np.cos(u) - np.cos(v))
    np.testing.assert_array_equal(found.reached, apart < 2 * np.hypot(1, 0.02))
    assert not found.reached[3, 3] and found.reached.sum() == 21
    assert "leads to no node" not in str(found)
    away = jk.workspace(mechanism, {"left": first[3:], "right": -second[2::-1]}, "two", (1, 1.02, 0))
    assert not away.reached.any() and "the assembled pose leads to no node beside it" in str(away)


@pytest.mark.long
def test_what_limits_part_from_the_assembled_pose_is_not_reached():
    """The limits of an elbow that is not driven: of the nodes within them, only those that a path within leads to."""
    rod, grid = 86.0, np.linspace(-3.1, 3.1, 37)
    free = jk.workspace(five_bar(rod), {"A": grid, "E": grid}, "left rod", flat(tip([0.0], [0.0], rod)))
    bend = np.asarray(free.motion.coordinates["B"])[:, 0].reshape(free.status.shape)
    joints = [replace(each, limits=((-0.2, 0.9),)) if each.name == "B" else each for each in five_bar(rod).all_joints]
    limited = jk.Mechanism.build(fixed=["ground"], joints=joints)
    found = jk.workspace(limited, {"A": grid, "E": grid}, "left rod", flat(tip([0.0], [0.0], rod)))
    within = (bend >= -0.2) & (bend <= 0.9)
    np.testing.assert_array_equal(found.status == Status.LIMITED.value, free.reached & ~within)
    islands = ndimage.label(free.reached & within)[0]
    home = islands[18, 18]
    assert home and islands.max() > 1
    np.testing.assert_array_equal(found.reached, islands == home)
    np.testing.assert_array_equal(found.status[(islands > 0) & (islands != home)], Status.JUMPED.value)
    # where a joint ends nothing is singular: only edges that lead out of the free map are searched
    out = free.status == Status.UNREACHABLE.value
    edges = sum(
        np.sum(a & b)
        for one, other in ((found.reached, out), (out, found.reached))
        for a, b in ((one[:-1], other[1:]), (one[:, :-1], other[:, 1:]))
    )
    ends = jk.singularities(found)
    assert len(ends.values) + ends.passed == edges


def test_what_is_no_map_is_refused():
    mechanism, grid = five_bar(86.0), np.linspace(-1.0, 1.0, 3)
    for ranges, message in (
        ({"A": grid}, "a workspace has two inputs, as in .*, got 1"),
        ({"A": grid, "E": grid[::-1]}, "the values of 'E' must be two finite numbers or more, rising"),
        ({"A": grid, "E": "x"}, "the values of 'E' must be numbers"),
        ({"A": grid, "F": grid}, "there is no joint 'F'"),
    ):
        with pytest.raises(ValueError, match=message):
            jk.workspace(mechanism, ranges, "left", (0, 0, 0))
    with pytest.raises(ValueError, match="there is no part 'lef'; did you mean 'left'"):
        jk.workspace(mechanism, {"A": grid, "E": grid}, "lef", (0, 0, 0))
    with pytest.raises(ValueError, match="a point must be three finite numbers"):
        jk.workspace(mechanism, {"A": grid, "E": grid}, "left", (0, 0))
    with pytest.raises(ValueError, match=r"a point must be three finite numbers \(x, y, z\), got \(40, nan, 0\)"):
        jk.workspace(mechanism, {"A": grid, "E": grid}, "left", (40, np.nan, 0))
    with pytest.raises(ValueError, match=r"1 freedom"):
        jk.workspace(planar_fourbar(), {"A": grid, "B": grid}, "coupler", (0, 0, 0))
    with pytest.raises(ValueError, match=r"leave freedoms.*: hold .* too, as in hold="):
        jk.workspace(hexapod(), {"leg 0": grid, "leg 1": grid}, "platform", (0, 0, 0))
    with pytest.raises(ValueError, match="outside of jit"):
        jax.jit(lambda x: jk.workspace(mechanism, {"A": grid, "E": grid}, "left", x).points)(np.zeros(3))


@pytest.mark.long
@pytest.mark.study
def test_two_legs_of_a_hexapod():
    """The legs of all poses are as long as they were told; the others rest."""
    mechanism, grid = hexapod(), np.linspace(-30.0, 30.0, 13)
    hold = [f"leg {i}" for i in range(2, 6)]
    found = jk.workspace(mechanism, {"leg 0": grid, "leg 1": grid}, "platform", (0, 0, 220.0), hold=hold)
    assert 0.5 < found.reached.mean() < 1.0
    ends = jk.singularities(found)
    assert len(ends.values) > 10 and ends.passed == 0
    # at a lock the loops can move while all legs rest: sigma_min, about the root of the rounding of the pose, vanishes
    for values in ends.values[::15]:
        pose = jk.limits(mechanism.at(mechanism.sweep(_drive(values, hold)), 1), "leg 0", hold=["leg 1", *hold])
        assert min(np.abs(pose.range)) < 1e-6 * 30
    at = found.reached.ravel()
    for i in range(6):
        base, top = (np.asarray(mechanism.joints[f"{end} {i}"].frames_1[0][:3, 3]) for end in ("base", "top"))
        legs = np.linalg.norm(np.asarray(found.motion.points("platform", top)) - base, axis=1) - np.linalg.norm(
            top - base
        )
        wanted = [np.repeat(grid, 13), np.tile(grid, 13)][i][at] if i < 2 else 0.0
        np.testing.assert_allclose(legs[at], wanted, rtol=0, atol=1e-9)


def _drive(values, hold):
    """Two poses on the line from the assembled pose to singular inputs, the second one just before these."""
    ways = np.array([0.5, 1.0 - 1e-8])
    return {"leg 0": ways * values[0], "leg 1": ways * values[1], **{name: 0.0 * ways for name in hold}}


def test_axes_of_the_map_have_units_and_no_legend_covers_it(tmp_path, monkeypatch):
    figures = []
    monkeypatch.setattr(workspace_plot, "save_figure", lambda figure, path: figures.append(figure) or path)
    joints = [
        jk.prismatic("lift", "base", "mast", axis=Z),
        jk.revolute("turn", "mast", "arm", point=(0, 0, 0), axis=Z, limits=(-1, 0.5)),
    ]
    crane = jk.Mechanism.build(fixed=["base"], joints=joints, unit="cm")
    found = jk.workspace(crane, {"lift": np.linspace(-1, 1, 3), "turn": np.linspace(-1, 1, 5)}, "arm", (2, 0, 0))
    found.plot(tmp_path / "map.png")
    plane, space = figures[0].axes[0], next(axes for axes in figures[0].axes if axes.name == "3d")
    assert (plane.get_xlabel(), plane.get_ylabel()) == ("lift.z (cm)", "turn.phi (rad)")
    assert [space.get_xlabel(), space.get_ylabel(), space.get_zlabel()] == ["x (cm)", "y (cm)", "z (cm)"]
    assert plane.get_legend() is None and len(figures[0].legends) == 1
