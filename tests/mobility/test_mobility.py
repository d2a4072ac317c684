"""Mobility from the rank, where counting is wrong too; drives that no freedom is left for."""

from dataclasses import replace
from random import Random

import jax
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from jaxkin.joints.joint import Joint
from jaxkin.joints.pairs import cylindrical, fixed, revolute
from jaxkin.linkage.coordinates import coordinate
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mobility.infeasible_drive import infeasible_drive
from reference import catalogue, planar
from reference.mechanisms import (
    Z,
    ball_in_bore,
    bennett_linkage,
    cam,
    cardan_shafts,
    planar_fourbar,
    rssr_linkage,
    slider_crank,
    spherical_linkage,
)

SEEDS = st.integers(0, 2**32)
PARALLELOGRAM = {"ground": 120.0, "crank": 50.0, "coupler": 120.0, "rocker": 50.0}
CATALOGUE = {
    # mechanism, freedoms, idle ones of these, counted in the subgroups of its loops
    "four-bar": (planar_fourbar(), 1, 0, 1),
    "parallelogram": (planar_fourbar(1.0, **PARALLELOGRAM), 1, 0, 1),
    "parallelogram lying flat": (planar_fourbar(0.0, **PARALLELOGRAM), 1, 0, 1),  # a singular pose
    "parallelogram, five bars": (catalogue.parallelogram(3), 1, 0, 0),
    "parallelogram, seven bars": (catalogue.parallelogram(5), 1, 0, -2),
    "antiparallelogram": (catalogue.antiparallelogram(), 1, 0, 1),
    "Chebyshev's lambda": (planar_fourbar(1.2, ground=2.0, crank=1.0, coupler=2.5, rocker=2.5), 1, 0, 1),
    "slider-crank": (slider_crank(), 1, 0, 1),
    "slider-crank, dead centre": (slider_crank(0.0, offset=0.0), 1, 0, 1),
    "scotch yoke": (catalogue.scotch_yoke(), 1, 0, 1),
    "quick return": (catalogue.quick_return(), 1, 0, 1),
    "Watt": (catalogue.watt(), 1, 0, 1),
    "Stephenson": (catalogue.stephenson(), 1, 0, 1),
    "Jansen": (catalogue.jansen(), 1, 0, 1),
    "Peaucellier": (catalogue.peaucellier(), 1, 0, 1),
    "Andrews": (catalogue.andrews(), 1, 0, 1),
    "Oldham": (catalogue.oldham(), 1, 0, 1),
    "four-bar of cylinders": (planar_fourbar(pin=cylindrical), 4, 3, 4),
    "Cardan": (cardan_shafts(), 1, 0, 1),
    "spherical four-bar": (spherical_linkage(), 1, 0, 1),
    "RSSR": (rssr_linkage(), 2, 1, 2),
    "Bennett": (bennett_linkage(), 1, 0, -2),
    "Sarrus": (catalogue.sarrus(), 1, 0, 0),
    "hexapod": (catalogue.hexapod(), 12, 6, 12),
    "Delta": (catalogue.delta(), 9, 6, 9),
    "cam": (cam(), 1, 0, 0),
    "cam with roller": (catalogue.cam_roller(), 1, 0, 1),
    "swash plate": (catalogue.swash_plate(), 1, 0, 1),
    "ball in bore": (ball_in_bore(), 1, 0, 0),
}


@pytest.mark.parametrize("name", CATALOGUE)
def test_freedoms_and_what_counting_gives(name):
    """Six equations a loop: freedoms - redundant = coordinates - 6 loops, whatever the pose."""
    mechanism, freedoms, idle, counted = CATALOGUE[name]
    found = mechanism.mobility()
    assert (found.freedoms, found.idle_freedoms, found.counted_in_subgroups) == (freedoms, idle, counted)
    assert found.freedoms - found.redundant == found.counted
    assert len(found.drivable) == freedoms - idle
    assert not set(found.drivable) & set(found.idle)
    assert found.counted == sum(joint.freedoms for joint in mechanism.all_joints) - 6 * len(mechanism.structure.loops)


def test_idle_freedoms_are_named():
    assert rssr_linkage().mobility().idle == ("B.theta", "B.phi", "B.psi", "C.theta", "C.phi", "C.psi")
    assert planar_fourbar().mobility().idle == ()
    assert set(planar_fourbar(pin=cylindrical).mobility().idle) == {"A.z", "B.z", "C.z", "D.z"}


def test_a_shaft_in_two_fixed_bearings_is_not_idle():
    bearings = [revolute(f"B{i}", f"block {i}", "shaft", point=(0, 0, 50.0 * i), axis=Z) for i in range(2)]
    mechanism = Mechanism.build(fixed=["block 0", "block 1"], joints=bearings)
    assert (mechanism.mobility().freedoms, mechanism.mobility().idle) == (1, ())
    assert mechanism.mobility().drivable == ("B0.phi",)


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_mobility_does_not_depend_on_the_unit_nor_on_where_it_stands(scale):
    turn = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    pose = np.eye(4)
    pose[:3, :3] = turn * np.sign(np.linalg.det(turn))
    pose[:3, 3] = 300.0, -200.0, 500.0
    for name in ("Bennett", "Jansen", "Delta"):
        mechanism, *_ = CATALOGUE[name]
        frames = [np.array(pose @ joint.frames_1) for joint in mechanism.all_joints]
        for frame in frames:
            frame[:, :3, 3] *= scale
        joints = [replace(j, frames_1=f, frames_2=f) for j, f in zip(mechanism.all_joints, frames, strict=True)]
        assert mechanism.with_linkage(mechanism.linkage.with_joints(joints)).mobility() == mechanism.mobility()


def test_mobility_of_a_mechanism_in_single_precision():
    """Frames rounded to 6e-8: what is parallel but for that still is."""
    mechanism = jax.tree.map(lambda leaf: np.asarray(leaf, np.float32), CATALOGUE["Jansen"][0])
    assert mechanism.mobility() == CATALOGUE["Jansen"][0].mobility()


def alike(mechanism: Mechanism) -> bool:
    """Whether all joints look the same from either part, so that exchanging the parts turns them round."""
    return {joint.kind for joint in mechanism.all_joints} <= {"revolute", "prismatic", "cylindrical", "spherical"}


def reordered(mechanism: Mechanism, seed: int) -> tuple[Mechanism, dict[str, str], dict[str, bool]]:
    """The same mechanism with other names of parts and joints, in another order, some joints the other way round."""
    random = Random(seed)
    parts = dict(
        zip(mechanism.parts, random.sample([f"part {i}" for i in range(99)], len(mechanism.parts)), strict=True)
    )
    turned = {joint.name: random.random() < 0.5 for joint in mechanism.all_joints}
    joints = []
    for joint in mechanism.all_joints:
        ends = tuple(parts[part] for part in joint.parts)
        new = Joint(f"new {joint.name}", ends, joint.kind, joint.movements, joint.frames_1, joint.frames_2, joint.pitch)
        joints.append(replace(new, parts=ends[::-1]) if turned[joint.name] else new)
    random.shuffle(joints)
    return Mechanism.build(fixed=[parts[part] for part in mechanism.fixed], joints=joints), parts, turned


@pytest.mark.long
@settings(max_examples=40, deadline=None)
@given(st.sampled_from([name for name, (mechanism, *_) in CATALOGUE.items() if alike(mechanism)]), SEEDS)
def test_other_names_order_and_direction_give_the_same_mobility(name, seed):
    mechanism, *_ = CATALOGUE[name]
    other, _, _ = reordered(mechanism, seed)
    before, after = mechanism.mobility(), other.mobility()
    assert (after.freedoms, after.redundant, after.idle_freedoms) == (
        before.freedoms,
        before.redundant,
        before.idle_freedoms,
    )
    assert set(after.idle) == {f"new {name}" for name in before.idle}


@pytest.mark.long
@pytest.mark.parametrize(
    ("mechanism", "drive", "seed"),
    [
        (catalogue.watt(), "A", 3),
        (planar_fourbar(pin=cylindrical), "A.phi", 2),  # with freedoms that are left at rest
    ],
    ids=["Watt", "cylinders"],
)
def test_other_names_order_and_direction_give_the_same_motion(mechanism, drive, seed):
    other, parts, turned = reordered(mechanism, seed)
    assert any(turned.values()) and not all(turned.values())
    angles = np.linspace(0.0, 2.0, 9)
    motion = mechanism.sweep({drive: angles})
    again = other.sweep({f"new {drive}": -angles if turned[drive.partition(".")[0]] else angles})
    for part, transforms in motion.transforms.items():
        np.testing.assert_allclose(again.transforms[parts[part]], transforms, atol=1e-11)  # mm; both closed to 1e-14
    for name, values in motion.coordinates.items():
        sign = -1 if turned[name] else 1
        np.testing.assert_allclose(again.coordinates[f"new {name}"], sign * values, atol=1e-12)


def locked() -> Mechanism:
    """A triangle of bars on the ground: nothing can move; the crank beside it can."""
    points = {"A": (0, 0), "B": (30, 0), "C": (10, 20)}
    joints = catalogue.pinned(points, {"ground": "AB", "left": "AC", "right": "BC"}).all_joints
    return Mechanism.build(
        fixed=["ground"], joints=[*joints, revolute("D", "ground", "crank", point=(0, 0, 0), axis=Z)]
    )


@pytest.mark.parametrize(
    ("mechanism", "drive", "message"),
    [
        (
            planar_fourbar(),
            {"A": [0.0], "C": [0.0]},
            r"driven A\.phi, C\.phi, but the mechanism of crank, coupler, rocker has 1 freedom: "
            r"drive only A\.phi, or one of B\.phi, C\.phi, D\.phi",
        ),
        (
            Mechanism.build(
                fixed=["left", "right"], joints=[revolute("A", "left", "right", point=(0, 0, 0), axis=(0, 0, 1))]
            ),
            {"A": [0.0]},
            r"^A\.phi cannot be driven: what it joins is fixed on both sides$",
        ),
        (locked(), {"A": [0.0]}, r"A\.phi cannot be driven: the mechanism of left, right has no freedom"),
        (
            planar_fourbar(pin=cylindrical),
            {f"{name}.z": [0.0] for name in "ABCD"},
            r"driven A\.z, B\.z, C\.z, D\.z, .* has 4 freedoms, 3 of them for these: drive only A\.z, B\.z, C\.z",
        ),
    ],
)
def test_drives_that_the_loops_cannot_follow_are_refused(mechanism, drive, message):
    with pytest.raises(ValueError, match=message):
        mechanism.sweep(drive)


def test_a_joint_that_nothing_can_move_is_named():
    """A slide across parallel hinges: the loop turns, but the slide is stuck."""
    stuck = Mechanism.build(
        fixed=["ground"],
        joints=[
            *planar_fourbar().all_joints[:3],
            cylindrical("D", "ground", "rocker", point=(100.0, 0, 0), axis=Z),
        ],
    )
    with pytest.raises(
        ValueError, match=r"D\.z has no freedom left to it by the loops; what can be driven is A\.phi, B"
    ):
        stuck.sweep({"D.z": [0.0]})


def test_a_drive_at_its_dead_centre_is_not_refused():
    """The slide of a stretched slider-crank has no rate there, but it can move."""
    mechanism = slider_crank(0.0, offset=0.0)
    assert infeasible_drive(mechanism.linkage, [coordinate(mechanism.linkage, "S")]) is None


@pytest.mark.long
def test_freedoms_without_a_drive_are_told():
    five = Mechanism.build(
        fixed=["ground"],
        joints=catalogue.pinned(
            {"A": (0, 0), "B": (10, 40), "C": (50, 70), "D": (90, 40), "E": (100, 0)},
            {"ground": "AE", "a": "AB", "b": "BC", "c": "CD", "d": "DE"},
        ).all_joints,
    )
    assert five.mobility().drivable == ("A.phi", "E.phi")
    motion = five.sweep({"A": [0.0, 0.1]})
    assert "freedoms without a drive move as little as they can; it could be E.phi" in str(motion)
    assert "without a drive" not in str(five.sweep({"A": [0.0, 0.1], "E": [0.0, 0.1]}))


def test_a_welded_joint_counts_no_freedom():
    """A loop closed by a fixed joint: the parts on it are one."""
    bars = planar_fourbar()
    pieces = [*bars.all_joints[:2], revolute("C", "coupler", "upper rocker", point=flat_pin(), axis=Z)]
    pieces += [fixed("weld", "upper rocker", "rocker"), bars.all_joints[3]]
    found = Mechanism.build(fixed=["ground"], joints=pieces).mobility()
    assert (found.freedoms, found.redundant) == (1, 3)


def flat_pin():
    x, y = planar.fourbar(np.array([1.0])).rocker_pin[0]
    return float(x), float(y), 0.0


def test_a_loop_of_welds_alone_has_no_freedom_and_closes():
    """Parts held to each other all round, as by bolts in a ring, with a hinge beside them."""
    welds = [fixed(f"{one}{other}", one, other) for one, other in ("ab", "bc", "ca")]
    hinge = revolute("hinge", "c", "d", point=(0, 0, 0), axis=(0, 0, 1))
    mechanism = Mechanism.build(fixed=["a"], joints=[*welds, hinge])
    assert (mechanism.mobility().freedoms, mechanism.mobility().redundant) == (1, 6)
    assert np.all(mechanism.sweep({"hinge": [0.0, 1.0]}).closed)
    assert Mechanism.build(fixed=["a"], joints=welds).mobility().freedoms == 0


def test_parts_in_a_row_that_pairs_of_pins_lock_are_one_bar():
    """A four-bar whose crank is three plates: their joints allow no twist, about a point or otherwise."""
    joints = [
        revolute("A", "ground", "a", point=(0, 0, 0), axis=Z),
        *(revolute(f"B{y}", "a", "b", point=(1, y, 0), axis=Z) for y in range(2)),
        *(revolute(f"C{y}", "b", "c", point=(2, y, 0), axis=Z) for y in range(2)),
        revolute("D", "c", "rod", point=(3, 2, 0), axis=Z),
        revolute("E", "rod", "rocker", point=(5, 3, 0), axis=Z),
        revolute("F", "rocker", "ground", point=(6, 0, 0), axis=Z),
    ]
    mobility = Mechanism.build(fixed=["ground"], joints=joints).mobility()
    assert (mobility.freedoms, mobility.idle_motions, mobility.drivable) == (1, (), ("A.phi",))
