"""Wide open poses of every kind of joint, rounded ones, ones with solids, and what hangs beside them."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import jaxkin as jk
from jaxkin.examples import path
from jaxkin.geometry.pose import apply, inverse
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.pairs import revolute
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism import reassembly
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mobility.open_loops import opening
from reference import catalogue
from reference.mechanisms import (
    ball_in_bore,
    bennett_linkage,
    cam,
    cardan_shafts,
    planar_fourbar,
    rssr_linkage,
    spherical_linkage,
)
from reference.open_poses import assert_same_lengths, pushed, rounded, zeroed_elsewhere

EVERY = {
    "Watt": catalogue.watt,
    "Andrews": catalogue.andrews,
    "Oldham": catalogue.oldham,
    "spherical four-bar": spherical_linkage,
    "Cardan": cardan_shafts,
    "Bennett": bennett_linkage,
    "Sarrus": catalogue.sarrus,
    "RSSR": rssr_linkage,
    "hexapod": catalogue.hexapod,
    "delta": catalogue.delta,
    "cam": cam,
    "cam with roller": catalogue.cam_roller,
    "swash plate": catalogue.swash_plate,
    "ball in bore": ball_in_bore,
}


@pytest.mark.parametrize("name", EVERY)
@pytest.mark.parametrize("angle", [pytest.param(0.1, marks=pytest.mark.long), 1.0])
def test_joints_that_count_from_elsewhere_are_closed(name, angle, monkeypatch):
    """Every kind of joint, up to a radian and a third of the size off; the lengths and the mobility stay."""
    monkeypatch.setattr(reassembly, "other_modes", lambda *_: [])  # they are another test's
    exact = EVERY[name]()
    mechanism = zeroed_elsewhere(exact, angle)
    found = mechanism.close()
    assert found.closed and found.residual < 1e-11 and found.residual_before > 0.01
    assert_same_lengths(found.mechanism, mechanism)
    one, other = found.mechanism.mobility(), exact.mobility()
    assert (one.freedoms, one.idle_freedoms, one.redundant) == (other.freedoms, other.idle_freedoms, other.redundant)


@pytest.mark.parametrize("angle", [pytest.param(angle, marks=pytest.mark.long) for angle in (3.0, np.pi)])
def test_loops_open_by_half_a_turn_close(angle):
    """A rod in two halves, one of them drawn the other way round: the twist of the loop vanishes at half a turn."""
    for axis in np.eye(3):
        halves = [
            replace(joint, parts=(joint.parts[0], "half") if joint.name == "B" else joint.parts)
            for joint in rssr_linkage().all_joints
        ]
        weld = np.eye(4)[None]
        weld[0, :3, 3] = halves[1].frames_1[0, :3, 3]
        turned = weld.copy()
        turned[0, :3, :3] = Rotation.from_rotvec(angle * axis).as_matrix()
        halves.append(Joint("weld", ("half", "rod"), JointKind.FIXED, ("I",), weld, turned, np.array(0.0)))
        mechanism = Mechanism.build(fixed=["ground"], joints=halves)
        found = mechanism.close()
        assert found.closed and found.residual_before > 2.5
        told = opening(mechanism.linkage)
        assert told is not None and told.angle == pytest.approx(angle) and told.joint == "weld"
        assert_same_lengths(found.mechanism, mechanism)


@pytest.mark.long
@pytest.mark.parametrize("digits", [6, 9])
def test_numbers_that_were_rounded_close_to_their_rounding(digits):
    """A planar four-bar in space, by numbers of some digits: its loop never closes to rounding of the arithmetic."""
    mechanism = rounded(pushed(planar_fourbar(), ("rocker", "C"), (3.0, -2.5, 0.0)), digits)
    found = mechanism.close()
    assert found.closed and 0 < found.residual < 10.0**-digits
    assert any("stay open by" in note for note in found.mechanism.notes) == (found.residual > 1e-11)
    assert np.all(found.mechanism.sweep({"A": np.linspace(0.0, 1.0, 5)}).closed)


def test_frames_that_coincide_are_closed_whatever_their_digits():
    """Contact frames may be rigid to six digits only: what they leave is no gap."""
    joints = [
        replace(joint, frames_1=joint.frames_1 + rough, frames_2=joint.frames_1 + rough)
        for joint in planar_fourbar().all_joints
        for rough in [1e-7 * np.sin(np.arange(16.0)).reshape(1, 4, 4) * [[1], [1], [1], [0]]]
    ]
    mechanism = Mechanism(Linkage.of(joints, planar_fourbar().structure))
    assert opening(mechanism.linkage) is None and mechanism.close().mechanism is mechanism


@pytest.mark.long
def test_solids_go_along():
    """A joint that counts from elsewhere, of solids: each solid keeps its place at the frames on its part."""
    given = jk.load(path("fourbar")).mechanism(fixed=["ground"])
    mechanism = zeroed_elsewhere(given, 0.4)
    found = mechanism.close()
    assert found.closed and max(move.angle for move in found.moves.values()) > 0.01
    solids, drawn = ({part.name: part for part in each.solids} for each in (found.mechanism, mechanism))
    for new, old in zip(found.mechanism.all_joints, mechanism.all_joints, strict=True):
        name = old.parts[0]
        there, here = (
            apply(inverse(frames[0]), part.triangles)
            for frames, part in ((new.frames_1, solids[name]), (old.frames_1, drawn[name]))
        )
        # about the axis of the joint: heights and distances
        np.testing.assert_allclose(there[..., 2], here[..., 2], atol=1e-9)
        np.testing.assert_allclose(np.linalg.norm(there, axis=-1), np.linalg.norm(here, axis=-1), atol=1e-9)
        for contact in found.mechanism.contacts[new.name]:
            for surface in contact.surfaces:
                if surface.kind == "cylinder":  # both are about the axis of the hinge still
                    off = np.cross(new.frames_1[0, :3, 3] - surface.point, surface.axis)
                    assert np.linalg.norm(off) < 1e-4
    assert not found.mechanism.sweep({found.mechanism.all_joints[0].name: [0.0, 0.1]}).lost_contacts


@pytest.mark.long
def test_a_drive_beside_open_loops_closes_them():
    """What is driven hangs on the ground alone; the loops, whose length was changed, are closed all the same."""
    joints = [*planar_fourbar().all_joints, revolute("arm", "ground", "lever", point=(0, -50, 0), axis=(0, 0, 1))]
    mechanism = Mechanism.build(fixed=["ground"], joints=joints).with_lengths({("coupler", "B", "C"): 125.0})
    motion = mechanism.sweep({"arm": np.linspace(0.0, 1.0, 3)})
    assert np.all(motion.closed)
    found = mechanism.close()
    assert abs(float(motion.coordinates["D"][0, 0])) == pytest.approx(found.moves["rocker"].angle, abs=1e-3)
