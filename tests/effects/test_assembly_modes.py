"""All closed poses for given inputs: against closed forms, counts of the literature, and mirror images."""

import jax
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.effects.coupled_turns import coupled_turns
from reference import parallel, planar, spatial
from reference.catalogue import hexapod, hexapod_between, stephenson
from reference.mechanisms import flat, planar_fourbar, rssr_linkage, spherical_linkage
from reference.planar_robots import BASE, LEGS, PLATFORM, corners, three_rpr

Z = (0.0, 0.0, 1.0)


def turned(modes: jk.AssemblyModes, part: str) -> np.ndarray:
    """Angle by which a part is turned in each mode from its assembled pose."""
    matrices = np.asarray(modes.motion.transforms[part])
    return np.arctan2(matrices[:, 1, 0], matrices[:, 0, 0])


def same_angles(found, wanted):
    """Sets of angles that are equal to 1e-10, up to full turns."""
    apart = np.abs(np.angle(np.exp(1j * (np.asarray(found)[:, None] - np.asarray(wanted)))))
    assert apart.shape[0] == apart.shape[1]
    assert apart.min(axis=0).max() < 1e-10 and apart.min(axis=1).max() < 1e-10


@pytest.mark.long
@pytest.mark.parametrize("pins", [1, 2, 4])
def test_pins_that_slide_idly_hide_no_mode(pins):
    """The slides are no columns of loops that are solved in their plane, but idle freedoms all the same."""
    points, ends = [(0, 0, 0), (1, 0.3, 0), (3, 2, 0), (4, 0, 0)], ["ga", "ab", "bc", "cg"]
    made = [jk.revolute] * (4 - pins) + [jk.cylindrical] * pins
    joints = [
        make(name, *pair, point=point, axis=(0, 0, 1))
        for make, name, pair, point in zip(made, "ABCD", ends, points, strict=True)
    ]
    mechanism = jk.Mechanism.build(joints=joints, fixed=["g"])
    modes = jk.assembly_modes(mechanism, {"A.phi": 0.3})
    assert modes.complete and len(modes.motion) == 2


def test_a_fourbar_has_two_modes_and_each_can_be_driven():
    theta = np.linspace(0.0, 2 * np.pi, 13)
    mechanism = planar_fourbar(1.0)
    modes = jk.assembly_modes(mechanism, {"A": 0.7})
    assert len(modes) == 2 and modes.complete and modes.assembled and not modes.found
    assert sorted(modes.signs) == ["+", "-"] and modes.chance_of_more == 0.0
    pin = mechanism.joints["C"].frames_1[0][:3, 3]
    for mode, side in zip(modes, (1, -1), strict=True):
        wanted = flat(planar.fourbar(np.array([1.7]), side=side).rocker_pin)
        np.testing.assert_allclose(modes.motion.points("rocker", pin)[mode.index], wanted, atol=1e-11)  # of 100
        assert mode.residual < 1e-14 and mode.coordinates["A"][0] == 0.7
        motion = mode.mechanism().sweep({"A": theta})
        assert np.all(motion.closed)
        path = planar.fourbar(1.7 + theta, side=side).rocker_pin
        np.testing.assert_allclose(motion.points("rocker", wanted)[:, :2], path, atol=1e-10)


@pytest.mark.long
def test_a_triad_has_six_modes(tmp_path):
    """Of a 3-RPR robot; the third class of Assur has no formula here."""
    poses = planar.platform_poses(BASE, PLATFORM, LEGS)
    assert len(poses) == 6
    drive = {f"leg {i}": 0.0 for i in range(3)}
    modes = jk.assembly_modes(three_rpr(poses[2]), drive, tries=128)
    assert len(modes) == 6 and not modes.complete and modes.starts == 128 and sum(modes.found) <= 128
    same_angles(turned(modes, "platform"), poses[:, 2] - poses[2, 2])
    np.testing.assert_allclose(modes.motion.displacements[1][0], 0.0, atol=1e-12)  # "mode 1" is as assembled
    assert modes.motion.status.tolist() == [jk.Status.CLOSED.value] + [jk.Status.JUMPED.value] * 5
    text = str(modes)
    assert "6 assembly modes for leg 0.z = 0" in text and "from 128 starts" in text and "mode 6" in text
    picture = modes.plot(tmp_path / "modes.png").read_bytes()
    assert picture.startswith(b"\x89PNG") and len(picture) > 10_000
    assert len(modes.save(tmp_path / "modes.csv").read_text().splitlines()) == 7

    few = jk.assembly_modes(three_rpr(poses[2]), drive, tries=1)
    assert 1 <= len(few) <= 2 and few.chance_of_more == 1.0 and few.found[0] in (0, 1)
    again = jk.assembly_modes(three_rpr(poses[2]), drive, tries=128)
    assert again.found == modes.found


@pytest.mark.long
def test_what_has_no_modes_is_refused():
    mechanism = planar_fourbar(1.0, crank=90.0, coupler=60.0, rocker=60.0)
    nowhere = jk.assembly_modes(mechanism, {"A": 2.0})
    assert len(nowhere) == 0 and "0 assembly modes for A.phi = 2" in str(nowhere)
    assert "cannot close" in str(nowhere)
    five = planar_five_bar()
    with pytest.raises(ValueError, match=r"leaves freedoms, so that there are infinitely many .* give .*too"):
        jk.assembly_modes(five, {"A": 0.0})
    with pytest.raises(ValueError, match="one finite number, as in"):
        jk.assembly_modes(mechanism, {"A": [0.0, 1.0]})  # pyright: ignore[reportArgumentType]
    with pytest.raises(ValueError, match="there is no joint 'AA'"):
        jk.assembly_modes(mechanism, {"AA": 0.0})
    with pytest.raises(ValueError, match="tries must be a whole number, 1 or more, got 0"):
        jk.assembly_modes(mechanism, {"A": 0.0}, tries=0)
    with pytest.raises(ValueError, match="outside of jit"):
        jax.jit(lambda x: jk.assembly_modes(mechanism, {"A": x}).motion.residual)(0.1)
    with pytest.raises(IndexError, match="there are 0 modes, numbered from 0, got 1"):
        nowhere[1]


def planar_five_bar() -> jk.Mechanism:
    points = {"A": (0, 0), "B": (-30, 60), "C": (40, 110), "D": (110, 60), "E": (80, 0)}
    links = ["ground", "left", "left rod", "right rod", "right", "ground"]
    return jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute(name, links[i], links[i + 1], point=flat(point), axis=Z)
            for i, (name, point) in enumerate(points.items())
        ],
    )


@pytest.mark.long
def test_several_inputs_and_several_elements():
    """A five-bar has one dyad for two inputs; two mechanisms on one ground multiply their modes."""
    assert len(jk.assembly_modes(planar_five_bar(), {"A": 0.1, "E": -0.2})) == 2
    other = [
        jk.Joint(
            name=f"second {joint.name}",
            parts=tuple(part if part == "ground" else f"second {part}" for part in joint.parts),  # pyright: ignore
            **{
                field: getattr(joint, field)
                for field in joint.__dataclass_fields__
                if field not in ("name", "parts") and joint.__dataclass_fields__[field].init
            },
        )
        for joint in planar_fourbar().all_joints
    ]
    both = jk.Mechanism.build(fixed=["ground"], joints=[*planar_fourbar().all_joints, *other])
    modes = jk.assembly_modes(both, {"A": 0.3, "second A": 1.0})
    assert len(modes) == 4 and modes.complete and sorted(modes.signs) == ["++", "+-", "-+", "--"]
    assert np.asarray(modes.motion.residual).max() < 1e-14


@pytest.mark.long
def test_sixbars():
    """Stephenson's: two dyads one after the other, 4 modes; from the crank of a triad six (Hunt, 1983)."""
    modes = jk.assembly_modes(stephenson(), {"A": 0.1})
    assert len(modes) == 4 and modes.complete
    pose = planar.platform_poses(BASE, PLATFORM, LEGS)[3]
    pivot = BASE[2] + [-4.0, 3.0]
    joints = [jk.revolute("crank", "ground", "crank", point=flat(pivot), axis=Z)]
    for i, (base, corner) in enumerate(zip(BASE, corners(pose), strict=True)):
        carrier = "crank" if i == 2 else "ground"
        joints.append(jk.revolute(f"base {i}", carrier, f"link {i}", point=flat(base), axis=Z))
        joints.append(jk.revolute(f"top {i}", f"link {i}", "coupler", point=flat(corner), axis=Z))
    sixbar = jk.Mechanism.build(fixed=["ground"], joints=joints)
    six = jk.assembly_modes(sixbar, {"crank": 0.0})
    assert len(six) == 6 and min(six.found) > 1
    same_angles(turned(six, "coupler"), planar.platform_poses(BASE, PLATFORM, LEGS)[:, 2] - pose[2])


@pytest.mark.long
def test_spherical_and_rssr_linkages_have_two():
    theta = np.array([0.4 + 0.6])
    modes = jk.assembly_modes(spherical_linkage(0.4), {"A": 0.6})
    assert len(modes) == 2 and modes.complete
    home = spatial.spherical_fourbar(np.array([0.4])).output
    found = np.array([mode.coordinates["D"][0] for mode in modes])
    same_angles(found, [(spatial.spherical_fourbar(theta, branch=side).output - home)[0] for side in (1, -1)])

    theta = np.array([0.3 + 0.5])
    modes = jk.assembly_modes(rssr_linkage(0.3), {"A": 0.5})
    assert len(modes) == 2 and modes.complete
    home = spatial.rssr(np.array([0.3])).output
    found = np.array([mode.coordinates["D"][0] for mode in modes])
    same_angles(found, [(spatial.rssr(theta, branch=side).output - home)[0] for side in (1, -1)])


def test_full_turns_of_an_angle_that_moves_a_rack():
    """The rocker closes with every full turn, and its rack is elsewhere each time: what is found is not all."""
    x, turns = (1.0, 0.0, 0.0), "full turns of D.phi, which couplings tie"
    rack = jk.prismatic("rack", "ground", "bar", axis=x)
    wheel = jk.revolute("wheel", "ground", "wheel", point=(9.0, 0.0, 0.0), axis=Z)
    fourbar = planar_fourbar()
    for added, tie, drive, told in (
        (rack, jk.rack("D", "rack", 1.3), "A", True),
        (wheel, jk.gear("D", "wheel", 0.7), "A", True),
        (wheel, jk.gear("D", "wheel", 0.7), "wheel", False),
        (wheel, jk.gear("A", "wheel", 0.7), "A", False),
    ):
        tied = jk.Mechanism.build(fixed=["ground"], joints=[*fourbar.all_joints, added], couplings=[tie])
        assert ("D.phi" in coupled_turns(tied.linkage, [f"{drive}.phi"])) is told
    tied = jk.Mechanism.build(
        fixed=["ground"], joints=[*fourbar.all_joints, rack], couplings=[jk.rack("D", "rack", 1.3)]
    )
    modes = jk.assembly_modes(tied, {"A": 0.0}, tries=8)
    assert not modes.complete and turns in str(modes)


@pytest.mark.long
def test_modes_that_are_many_turns_of_a_screw_away():
    """A ram at the height y over a rod of length 5 from a car that a screw moves: the car is at x or at -x."""
    x, y, pitch, home = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), 0.5, (3.0, 0.0, 0.0)
    joints = [
        jk.screw("screw", "ground", "nut", point=(0.0, 0.0, 0.0), axis=x, pitch=pitch),
        jk.prismatic("way", "ground", "car", axis=x),
        jk.revolute("nut", "nut", "car", point=home, axis=x),
        jk.revolute("foot", "car", "rod", point=home, axis=Z),
        jk.revolute("top", "rod", "ram", point=(0.0, 4.0, 0.0), axis=Z),
        jk.prismatic("ram", "ground", "ram", axis=y, point=(0.0, 4.0, 0.0)),
    ]
    press = jk.Mechanism.build(fixed=["ground"], joints=joints)
    modes = jk.assembly_modes(press, {"ram": 0.5}, tries=32)
    away = np.sqrt(25.0 - 4.5**2)
    turns = sorted(mode.coordinates["screw"][0] / (2 * np.pi) for mode in modes)
    np.testing.assert_allclose(turns, [(-away - 3.0) / pitch, (away - 3.0) / pitch], atol=1e-10)


@pytest.mark.long
@pytest.mark.parametrize("radius", [0.08, 40.0])
def test_a_pinion_that_follows_hides_no_mode(radius):
    """Behind the same car as above a pinion turns, or a rack behind a large one: two modes, with it and without it."""
    x, y, home, small = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (3.0, 0.0, 0.0), radius < 1
    joints = [
        jk.prismatic("way", "ground", "car", axis=x),
        jk.revolute("foot", "car", "rod", point=home, axis=Z),
        jk.revolute("top", "rod", "ram", point=(0.0, 4.0, 0.0), axis=Z),
        jk.prismatic("ram", "ground", "ram", axis=y, point=(0.0, 4.0, 0.0)),
        jk.revolute("pinion", "ground", "pinion", point=(0.0, -1.0, 0.0), axis=Z)
        if small
        else jk.prismatic("rack", "ground", "rack", axis=x, point=(0.0, -1.0, 0.0)),
    ]
    tie = jk.rack("pinion", "way", radius) if small else jk.relation({"rack": 1.0, "way": radius})
    modes = jk.assembly_modes(jk.Mechanism.build(fixed=["ground"], joints=joints, couplings=[tie]), {"ram": 0.5})
    away = np.sqrt(25.0 - 4.5**2)
    found = sorted(mode.coordinates["way"][0] for mode in modes)
    np.testing.assert_allclose(found, [-away - 3.0, away - 3.0], atol=1e-10)


@pytest.mark.parametrize(("ratio", "told"), [(1.0, ()), (-2.0, ()), (0.5, ()), (-1.5, ("A.phi", "E.phi"))])
def test_wheels_whose_full_turns_are_none(ratio, told):
    """Two cranks of a five-bar: with a whole ratio a turn of one is whole turns of both, and the pose the same."""
    points = [(0.0, 0.0), (-0.5, 1.5), (1.5, 2.0), (4.2, 1.5), (4.0, 0.0)]
    parts = ["ground", "left arm", "left rod", "right rod", "right arm", "ground"]
    joints = [
        jk.revolute(name, one, other, point=(*point, 0.0), axis=Z)
        for name, one, other, point in zip("ABCDE", parts, parts[1:], points, strict=False)
    ]
    geared = jk.Mechanism.build(fixed=["ground"], joints=joints, couplings=[jk.gear("A", "E", ratio)])
    assert coupled_turns(geared.linkage, ["C.phi"]) == told


@pytest.mark.long
def test_modes_of_a_flat_hexapod_are_mirror_images():
    """The balls of base and platform lie in planes: each pose has its image below the base. Rods may spin."""
    mechanism = hexapod()
    modes = jk.assembly_modes(mechanism, {f"leg {i}": 0.0 for i in range(6)})
    assert len(modes) == 16 and min(modes.found) > 1
    balls = [np.asarray(mechanism.joints[f"top {i}"].frames_1[0][:3, 3]) for i in range(6)]
    points = np.stack([np.asarray(modes.motion.points("platform", ball)) for ball in balls], axis=1)
    apart = np.abs(points[:, None] - points * [1, 1, -1]).max(axis=(2, 3))
    assert apart.min(axis=1).max() < 1e-8  # of 200, through a Jacobian of condition 1e3


@pytest.mark.long
def test_forty_modes_of_dietmaiers_hexapod():
    robot = parallel.Dietmaier()
    mechanism = hexapod_between(robot.base, robot.a_pose())
    modes = jk.assembly_modes(mechanism, {f"leg {i}": 0.0 for i in range(6)})
    assert len(modes) == 40 and min(modes.found) > 1 and modes.assembled
    balls = [np.asarray(mechanism.joints[f"top {i}"].frames_1[0][:3, 3]) for i in range(6)]
    points = np.stack([np.asarray(modes.motion.points("platform", ball)) for ball in balls], axis=1)
    np.testing.assert_allclose(np.linalg.norm(points - robot.base, axis=-1), robot.legs[None].repeat(40, 0), atol=1e-12)
    apart = np.abs(points[:, None] - points).max(axis=(2, 3)) + np.eye(40)
    assert apart.min() > 1e-3
    other = modes[17].mechanism().sweep({f"leg {i}": np.array([0.0, 1e-3 * (-1) ** i]) for i in range(6)})
    assert np.all(other.closed)
