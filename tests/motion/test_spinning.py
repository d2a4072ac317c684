"""Screws, pins and washers are told from parts that have work to do, and rest; `tests/io/data/fasteners.step`."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh

import jaxkin as jk
from jaxkin.examples import path
from jaxkin.geometry.part import Part
from jaxkin.motion.needless import spinning
from reference.mechanisms import rssr_linkage

FASTENERS = ("washer", "screw", "long screw", "loose washer")


@pytest.fixture(scope="module")
def assembly():
    return jk.load(Path(__file__).parents[1] / "io" / "data" / "fasteners.step")


@pytest.fixture(scope="module")
def mechanism(assembly):
    return assembly.mechanism(fixed=["base"])


def test_fasteners_are_named_and_the_arm_is_not(mechanism):
    """One turn each of the washer and the screws; the loose washer slides on its face as well."""
    mobility = mechanism.mobility()
    assert mobility.spinning == FASTENERS
    assert (mobility.freedoms, mobility.spins, mobility.useful) == (7, 6, 1)
    assert mobility.idle == ()
    assert "only spin: washer, screw, long screw, loose washer" in str(mobility)


def test_they_close_no_loops_and_rest(mechanism):
    """The washer lies between the arm, which turns, and the base: it stays on the base."""
    assert len(mechanism.structure.loops) == 0
    motion = mechanism.sweep({"base-arm": [0.0, 1.0, 2.0]})
    for part in FASTENERS:
        still = np.broadcast_to(np.eye(4), (3, 4, 4))
        np.testing.assert_allclose(motion.transforms[part], still, atol=1e-13)  # mm, rounding of the frames
    assert any("'washer' only spins" in note and "'arm'" in note for note in mechanism.notes)


def test_they_can_still_be_driven(mechanism):
    turn = np.linspace(0.0, 1.0, 3)
    motion = mechanism.sweep({"base-washer": turn})
    np.testing.assert_allclose(np.trace(motion.transforms["washer"][:, :3, :3].T), 1 + 2 * np.cos(turn), atol=1e-15)


def test_rigid_fixes_them_for_good(assembly):
    fixed = assembly.mechanism(fixed=["base"], rigid=[["base", *FASTENERS]])
    assert fixed.fixed == ("base", *FASTENERS)
    assert [joint.name for joint in fixed.all_joints] == ["base-arm"]
    assert (fixed.mobility().freedoms, fixed.mobility().spinning) == (1, ())


def test_one_joint_a_contact_keeps_every_contact(assembly):
    """The paper's way: nothing is left out, and the same parts are named."""
    apart = assembly.mechanism(fixed=["base"], combine=False)
    assert len(apart.all_joints) == len(assembly.contacts())
    mobility = apart.mobility()
    assert (mobility.spinning, mobility.useful) == (FASTENERS, 1)


@pytest.mark.parametrize("name, fixed", [("fourbar", "ground"), ("slider_crank", "ground"), ("cam", "frame")])
def test_parts_with_work_to_do_are_not_taken_for_fasteners(name, fixed):
    """The disc of the cam is round, but not about its shaft; cranks and rods hold each other."""
    assert spinning(jk.load(path(name)).mechanism(fixed=[fixed])) == {}


def solid(name, radius, length, square=False):
    """A round or square bar along z."""
    sections = 4 if square else 24
    return Part(name, (), trimesh.creation.cylinder(radius, length, sections=sections).triangles)


def hinge(*, second: bool):
    """A link on a pin of its own, held by it alone, or by a second pin through both as well."""

    def pin(name, one, other):
        return jk.cylindrical(name, one, other, point=(0, 0, 0), axis=(0, 0, 1))

    joints = [pin("A", "base", "pin"), pin("B", "pin", "link"), jk.planar("C", "base", "link", normal=(0, 0, 1))]
    made = jk.Mechanism.build(fixed=["base"], joints=[*joints, *([pin("D", "base", "link")] if second else [])])
    return replace(made, solids=(solid("base", 9, 1, True), solid("pin", 1, 6), solid("link", 5, 2, True)))


def test_the_only_pin_of_a_hinge_is_needed_and_a_second_one_is_not():
    needed, idle = (hinge(second=second).mobility() for second in (False, True))
    assert needed.spinning == () and needed.freedoms == 3  # the hinge; the pin turns and slides
    assert idle.spinning == ("pin",) and (idle.spins, idle.useful) == (2, 1)


def test_nothing_is_guessed_without_solids():
    assert rssr_linkage().mobility().spinning == ()
    assert replace(hinge(second=True), solids=()).mobility().spinning == ()
