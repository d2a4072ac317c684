"""What solids imply beside exact contacts: each kind of evidence alone, with its sizes, and what it must not do."""

from dataclasses import replace

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.geometry.part import moved
from jaxkin.joints.evidence import EvidenceKind
from reference.round_parts import assembly, block, part, pin, ring

BASE = block((-60, -60, -30), (60, 60, -20))
"""A base that touches nothing of what is tested."""


def joint_of(mechanism: jk.Mechanism, one: str, other: str) -> jk.Joint:
    (name,) = mechanism.joints_between(one, other)
    return mechanism.joints[name]


def hinge_with(radius: float, *more) -> jk.Assembly:
    """A lever with a bore of 5 mm on a post of the base, of some radius."""
    base = part("base", BASE, pin(radius, -20, 10))
    lever = part("lever", ring(5.0, 12.0, -6, 6), block((11, -3, -6), (40, 3, 6)))
    return assembly(base, lever, *more)


@pytest.mark.parametrize(("radius", "clearance"), [(4.5, 0.5), (4.0, 1.0), (5.3, -0.3)])
def test_a_pin_with_play_or_interference_is_a_pin(radius, clearance):
    mechanism = hinge_with(radius).mechanism(fixed=["base"])
    joint = joint_of(mechanism, "base", "lever")
    assert joint.kind == "cylindrical" and joint.evidence.kind == EvidenceKind.CLEARANCE
    assert dict(joint.evidence.sizes)["clearance"] == pytest.approx(clearance)
    np.testing.assert_allclose(joint.frames_1[0, :3, 2], [0, 0, 1], atol=1e-12)
    fit = f"has {'a clearance' if clearance > 0 else 'an interference'} of {abs(clearance):.2g};"
    assert any(fit in note and "base-lever" in note for note in mechanism.notes)
    assert np.all(mechanism.sweep({f"{joint.name}.phi": np.linspace(0, 1, 5), f"{joint.name}.z": np.zeros(5)}).closed)


@pytest.mark.parametrize("offset", [0.0, 2e-14, 0.1])
def test_an_offset_that_is_rounding_is_not_told_as_a_size(offset):
    base = part("base", BASE, pin(4.5, -20, 10))
    lever = part("lever", ring(5.0, 12.0, -6, 6), block((11, -3, -6), (40, 3, 6)))
    shift = np.eye(4)
    shift[0, 3] = offset
    mechanism = assembly(base, moved(lever, shift)).mechanism(fixed=["base"])
    assert joint_of(mechanism, "base", "lever").evidence.text.count(" off") == (offset > 1e-6)


def test_the_largest_clearance_can_be_said():
    """In the unit of the file: 0.5 of a radius of 5 is within the default, and more is asked for."""
    assert joint_of(hinge_with(4.5).mechanism(fixed=["base"], clearance=0.6), "base", "lever").freedoms
    assert not hinge_with(4.5).mechanism(fixed=["base"], clearance=0.4).joints_between("base", "lever")
    assert joint_of(hinge_with(3.0).mechanism(fixed=["base"], clearance=2.1), "base", "lever").freedoms
    with pytest.raises(ValueError, match=r"clearance must be a radial length .* got -1"):
        hinge_with(4.5).mechanism(fixed=["base"], clearance=-1)


@pytest.mark.parametrize("radius", [2.0, 6.5])
def test_a_post_that_is_far_too_thin_or_thick_is_no_pin(radius):
    mechanism = hinge_with(radius).mechanism(fixed=["base"])
    assert not any(joint.freedoms for joint in mechanism.all_joints)
    assert any("'lever' is tied to nothing" in note for note in mechanism.notes)


def test_a_pin_that_fits_is_an_exact_contact_and_stays_one():
    mechanism = hinge_with(5.0).mechanism(fixed=["base"])
    assert joint_of(mechanism, "base", "lever").evidence.kind == EvidenceKind.CONTACT


@pytest.mark.parametrize("radius", [4.5, 5.0, 5.3])
def test_an_axis_points_forwards_however_its_faces_are_written(radius):
    """By half a turn the axes of all faces point backwards; a joint of exact contacts does not, nor does another."""
    drawn = hinge_with(radius)
    upside_down = replace(drawn, parts=tuple(moved(each, np.diag([1.0, -1.0, -1.0, 1.0])) for each in drawn.parts))
    for some in (drawn, upside_down):
        joint = joint_of(some.mechanism(fixed=["base"]), "base", "lever")
        np.testing.assert_allclose(joint.frames_1[0, :3, 2], [0, 0, 1], atol=1e-12)


def test_faces_that_stop_the_slide_make_it_a_hinge():
    """A collar 1 mm below the lever and one 2 mm above it: 3 mm of play."""
    collar = part("base", BASE, pin(4.5, -20, 10), ring(4.5, 9.0, -10, -5), ring(4.5, 9.0, 6, 9))
    lever = part("lever", ring(5.0, 12.0, -4, 4), block((11, -3, -4), (40, 3, 4)))
    joint = joint_of(assembly(collar, lever).mechanism(fixed=["base"]), "base", "lever")
    assert joint.kind == "revolute" and dict(joint.evidence.sizes)["play"] == pytest.approx(3.0)


@pytest.mark.parametrize(
    ("gap", "kind"), [(0.0, "revolute"), (12.0, "cylindrical"), (40.0, "cylindrical"), (130.0, None)]
)
def test_equal_bores_without_a_pin_are_a_hinge_where_faces_touch(gap, kind):
    """One stop is enough here: with a virtual pin, nothing is said about what holds the other side."""
    base = part("base", BASE, ring(5.0, 12.0, -8, 0))
    lever = part("lever", ring(5.0, 12.0, gap, gap + 8), block((11, -3, gap), (40, 3, gap + 8)))
    mechanism = assembly(base, lever).mechanism(fixed=["base"])
    if kind is None:
        assert not any(joint.freedoms for joint in mechanism.all_joints)
        return
    joint = joint_of(mechanism, "base", "lever")
    assert joint.evidence.kind == EvidenceKind.VIRTUAL_PIN
    assert joint.kind == kind


def test_two_parallel_axes_hold_two_parts_together():
    """Two plates with two equal bores each, and nothing in them."""
    lower = part("lower", BASE, ring(5.0, 12.0, -8, 0), ring(5.0, 12.0, -8, 0, (40, 0)))
    upper = part("upper", ring(5.0, 12.0, 0, 8), ring(5.0, 12.0, 0, 8, (40, 0)), block((11, -3, 0), (29, 3, 8)))
    mechanism = assembly(lower, upper).mechanism(fixed=["lower"])
    assert mechanism.bodies == {"lower": ("lower", "upper")}
    assert any("2 parallel common axes" in note for note in mechanism.notes)


def test_a_pin_in_a_lug_without_a_hole_belongs_to_the_lug():
    """The base has no bore for the pin that stands in it, and the lever turns about that pin."""
    stud = part("stud", pin(5.0, -25, 10))
    lever = part("lever", ring(5.0, 12.0, -6, 6), block((11, -3, -6), (40, 3, 6)))
    mechanism = assembly(part("base", BASE), stud, lever).mechanism(fixed=["base"])
    assert mechanism.bodies["base"] == ("base", "stud")
    assert joint_of(mechanism, "stud", "lever").freedoms == 2


def test_parts_far_from_all_others_stay_where_they_are_and_near_ones_go_along():
    far, near = part("far", block((400, 0, 0), (410, 10, 10))), part("near", block((41, -3, -4), (50, 3, 4)))
    mechanism = hinge_with(4.5, far, near).mechanism(fixed=["base"])
    assert "far" in mechanism.fixed and mechanism.bodies["lever"] == ("lever", "near")
    assert any("'far' is tied to nothing: left at rest" in note for note in mechanism.notes)
    assert any("'near' is tied to nothing, and 1 from 'lever'" in note for note in mechanism.notes)


def test_exact_contacts_only_on_demand():
    with pytest.raises(ValueError, match="'lever' touches no other part"):
        hinge_with(4.5).mechanism(fixed=["base"], infer=False)


def test_what_the_user_says_comes_first():
    """A joint by hand between two parts, parts held together, and contacts ignored: nothing is inferred there."""
    drawn = hinge_with(4.5)
    by_hand = jk.revolute("motor", "base", "lever", point=(0, 0, 0), axis=(0, 0, 1))
    assert drawn.mechanism(fixed=["base"], joints=[by_hand]).joints_between("base", "lever") == ("motor",)
    assert drawn.mechanism(fixed=["base"], rigid=[["base", "lever"]]).bodies == {"base": ("base", "lever")}
    exact = hinge_with(5.0).mechanism(fixed=["base"], ignore=[["base", "lever"]])
    assert not any(joint.freedoms for joint in exact.all_joints)


def test_an_inference_of_two_parts_without_contact_is_taken_back_by_their_names():
    """A screw of 4 mm in a hole of 3.4 is held there, and touches the plate nowhere."""
    plate = part("plate", BASE, ring(3.4, 20.0, -20, 0))
    drawn = assembly(plate, part("screw", pin(4.0, -15, 12)), part("lever", ring(4.4, 12.0, 2, 10)))
    assert drawn.mechanism(fixed=["plate"]).bodies["plate"] == ("plate", "screw")
    told = " ".join(drawn.mechanism(fixed=["plate"]).notes)
    assert "ignore=[['plate', 'screw']]" in told
    mechanism = drawn.mechanism(fixed=["plate"], ignore=[["screw", "plate"]])
    assert not any("fastener" in note and "'plate', 'screw' are one body" in note for note in mechanism.notes)
    assert "nothing is inferred between 'screw' and 'plate', as was asked for" in mechanism.notes
    for pair in (["plate", "lever"], ["plate", "scrw"]):
        with pytest.raises(ValueError, match=f"no contact between 'plate' and '{pair[1]}' to ignore, and nothing is"):
            drawn.mechanism(fixed=["plate"], ignore=[pair])


def test_parts_are_left_out_and_named_by_patterns():
    extra = [part(f"bolt <{k}>", block((100 + 20 * k, 0, 0), (110 + 20 * k, 10, 10))) for k in range(3)]
    drawn = hinge_with(4.5, *extra)
    mechanism = drawn.mechanism(fixed=["b?se"], exclude=["bolt*"])
    assert mechanism.parts == ("base", "lever") and mechanism.fixed == ("base",)
    assert drawn.mechanism(fixed=["base"], rigid=[["lever", "bolt*"]]).bodies["lever"] == ("lever", *drawn.names[2:])
    with pytest.raises(ValueError, match=r"exclude names 'nut\*', which no part matches; there is 'base'"):
        drawn.mechanism(fixed=["base"], exclude=["nut*"])
    with pytest.raises(ValueError, match=r"exclude names the unknown part 'bolt <9>'; did you mean 'bolt <"):
        drawn.mechanism(fixed=["base"], exclude=["bolt <9>"])


ELSEWHERE = np.array([[0.0, 0.6, 0.8, 30.0], [0.0, 0.8, -0.6, -20.0], [-1.0, 0.0, 0.0, 7.0], [0.0, 0.0, 0.0, 1.0]])


@pytest.mark.parametrize("order", [(0, 1, 2), (2, 1, 0), (1, 2, 0)])
@pytest.mark.parametrize("names", [("base", "stud", "lever"), ("z", "m", "a")])
@pytest.mark.parametrize("pose", [np.eye(4), ELSEWHERE], ids=["here", "elsewhere"])
def test_neither_order_nor_names_nor_place_matter(order, names, pose):
    lever = ring(5.0, 12.0, -6, 6), block((11, -3, -6), (40, 3, 6))
    pieces = [BASE], [pin(4.5, -25, 10)], lever
    parts = [moved(part(name, *own), pose) for name, own in zip(names, pieces, strict=True)]
    mechanism = assembly(*(parts[k] for k in order)).mechanism(fixed=[names[0]])
    assert {frozenset(body) for body in mechanism.bodies.values()} == {frozenset(names[:2]), frozenset(names[2:])}
    assert mechanism.mobility().freedoms == 2
    joint = joint_of(mechanism, names[1], names[2])
    assert joint.kind == "cylindrical" and joint.evidence.kind == EvidenceKind.CLEARANCE
    way = np.sign(pose[2, 2] or pose[1, 2])  # forwards, wherever it is
    np.testing.assert_allclose(joint.frames_1[0, :3, 2], way * pose[:3, 2], atol=1e-9)
    offset = np.cross(joint.frames_1[0, :3, 3] - pose[:3, 3], pose[:3, 2])
    np.testing.assert_allclose(offset, 0.0, atol=1e-9)


def test_parts_are_named_by_the_subassemblies_that_they_are_in():
    drawn = hinge_with(4.5, part("bolt", block((100, 0, 0), (110, 10, 10))))
    drawn = replace(drawn, parts=tuple(replace(each, path=("Arm <1>",)) for each in drawn.parts))
    mechanism = drawn.mechanism(fixed=["Arm*/b?se"], exclude=["Arm*/bo*"])
    assert mechanism.parts == ("base", "lever") and mechanism.fixed == ("base",)
    with pytest.raises(ValueError, match=r"rigid names 'Leg/\*', which no part matches"):
        drawn.mechanism(fixed=["base"], rigid=[["base", "Leg/*"]])
