"""Mechanisms whose numbers were rounded: they move as the exact ones do, or say by how much their joints disagree."""

import re
from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.joints.pairs import prismatic, revolute
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.motion import Motion
from jaxkin.mobility.alignment import MISALIGNMENT_LEVELS, SIX_DIGITS
from jaxkin.solve.status import Status, default_tolerance
from reference import mechanisms, overconstrained
from reference.rounding import EVERY, placed, rounded, schmidt_coupling, spherical_wrist, tilted
from reference.rounding import tilted_fourbar as fourbar

TURN = np.linspace(0.0, 2 * np.pi, 50)


def moved_by(mechanism: Mechanism, joints) -> float:
    """The largest change of a frame, lengths over the extent."""
    extent = np.ptp(np.concatenate([joint.frames_1[:, :3, 3] for joint in joints])) or 1.0
    changes = [new.frames_1 - old.frames_1 for new, old in zip(mechanism.all_joints, joints, strict=True)]
    return max(float(np.abs(change / [1.0, 1.0, 1.0, extent]).max()) for change in changes)


def numbers(mechanism: Mechanism) -> tuple[int, ...]:
    found = mechanism.mobility()
    return found.freedoms, found.idle_freedoms, found.redundant, len(found.drivable)


@pytest.mark.long
@pytest.mark.parametrize("tilt", [0.0, *10.0 ** -np.arange(6.0, 16.0)])
def test_a_tilt_within_the_noise_changes_nothing(tilt):
    mechanism, exact = fourbar(tilt), fourbar(0.0)
    motion = mechanism.sweep({"A": TURN})
    assert np.all(motion.closed) and numbers(mechanism) == numbers(exact)
    # the axes are parallel now, each a part of the tilt from where it was
    difference = np.asarray(motion.coordinates["D"]) - np.asarray(exact.sweep({"A": TURN}).coordinates["D"])
    assert np.abs(difference).max() <= 1e-12 + 10 * tilt
    # below 1e-13 the loops close to rounding as they are, and nothing is moved
    assert len(mechanism.notes) == (tilt > 1e-13)
    if mechanism.notes:
        said = re.fullmatch(r".* aligned by at most (\S+) rad", mechanism.notes[0])
        assert said and 0 < float(said[1]) <= tilt
    coarse = mechanism.sweep({"A": TURN}, tolerance=1e-6)
    assert np.all(coarse.closed)


@pytest.mark.long
def test_a_coarse_tolerance_finds_no_other_branch():
    """With a tolerance above the tilt poses were called JUMPED that are on the branch."""
    for tilt in (1e-8, 1e-4):
        assert np.all(fourbar(tilt, align=0).sweep({"A": TURN}, tolerance=1e-3).closed)


@pytest.mark.long
@pytest.mark.parametrize("digits, tilted_by", [(9, 0.0), (6, 0.0), (0, 1e-9), (0, 1e-6)])
def test_a_five_bar_in_a_tilted_plane_keeps_its_two_freedoms(digits, tilted_by):
    exact = EVERY["five_bar"]()
    rng = np.random.default_rng(4)
    joints = placed(exact.all_joints, rng)
    joints = rounded(joints, digits) if digits else tilted(joints, tilted_by, rng)
    mechanism = Mechanism.build(fixed=["ground"], joints=joints)
    motion = mechanism.sweep({"A": 0.4 * np.sin(TURN), "E": 0.3 * np.sin(2 * TURN)})
    assert mechanism.mobility().freedoms == 2 and np.all(motion.closed)


@pytest.mark.long
def test_a_spherical_wrist_of_two_interlocking_loops_keeps_its_three_freedoms():
    rng = np.random.default_rng(0)
    joints = []
    for joint in spherical_wrist().all_joints:
        frames = joint.frames_1.copy()
        frames[0, :3, 3] += rng.uniform(-9e-8, 9e-8, 3)
        joints.append(replace(joint, frames_1=frames, frames_2=frames))
    assert numbers(Mechanism.build(fixed=["ground"], joints=joints)) == numbers(spherical_wrist())


@pytest.mark.long
def test_a_schmidt_coupling_of_seven_digits_moves():
    joints = rounded(placed(schmidt_coupling().all_joints, np.random.default_rng(1)), 7)
    mechanism = Mechanism.build(fixed=["ground"], joints=joints)
    assert numbers(mechanism) == numbers(schmidt_coupling())
    motion = mechanism.sweep({"in": np.linspace(-0.3, 0.3, 7)})
    assert np.all(motion.closed)
    # the third disc turns as the first; the pins are known to 1e-7 of the coupling, whose discs are a third of it
    np.testing.assert_allclose(np.abs(motion.coordinates["out"]), np.abs(motion.coordinates["in"]), atol=1e-6)


QUICK = ("planar_fourbar", "kite", "bennett_linkage", "bricard_linkage", "sarrus")
"""In the default run; the others take one to ten seconds each."""
SLOWEST = ("parallel links, cylindrical", "spherical_wrist", "schmidt_coupling", "peaucellier", "wrist", "three cranks")
SLOWEST += ("Fig. 3", "Fig. 7", "delta", "andrews", "jansen", "stephenson", "quick_return", "scotch_yoke", "sarrus")


@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.long] * (name not in QUICK)) for name in EVERY])
def test_rounded_mechanisms_have_the_mobility_of_exact_ones(name):
    exact, rng = EVERY[name](), np.random.default_rng(len(name))
    joints = rounded(tilted(placed(exact.all_joints, rng), 1e-6, rng), 6)
    mechanism = Mechanism.build(fixed=list(exact.fixed), joints=joints)
    assert not mechanism.linkage.ideal and numbers(mechanism) == numbers(exact)
    assert moved_by(mechanism, joints) <= SIX_DIGITS


@pytest.mark.long
@pytest.mark.parametrize("trials", [range(4), pytest.param(range(4, 28), marks=pytest.mark.study)], ids=["some", "all"])
@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.study] * (name in SLOWEST)) for name in EVERY])
def test_rounded_mechanisms_move_as_exact_ones(name, trials):
    """28 placements of each, more than a thousand in all: of 6, 9 and 12 digits, or tilted by as much."""
    exact, rng = EVERY[name](), np.random.default_rng((len(name), trials[0]))
    drivable = exact.mobility().drivable
    if name == "wrist":
        drivable = ("A.phi", "B.phi", "C.phi")  # beside its pose they are independent
    for trial in trials:
        error = 10.0 ** -(6 + 3 * (trial % 3))
        truth = exact.with_linkage(exact.linkage.with_joints(placed(exact.all_joints, rng)))
        joints = truth.all_joints
        joints = rounded(joints, 6 + 3 * (trial % 3)) if trial % 2 else tilted(joints, error, rng)
        mechanism = Mechanism.build(fixed=list(exact.fixed), joints=joints)
        assert numbers(mechanism) == numbers(exact), (trial, mechanism.notes)
        size = np.ptp(np.concatenate([joint.frames_1[:, :3, 3] for joint in joints])) or 1.0
        drive = {
            each: np.sin((1 + 0.1 * number) * np.linspace(-1, 1, 13)) * (0.02 * size if each[-1] in "xyz" else 0.4)
            for number, each in enumerate(drivable)
        }
        motion, expected = mechanism.sweep(drive), truth.sweep(drive)
        np.testing.assert_array_equal(motion.status, expected.status, err_msg=str(trial))
        closed = np.asarray(expected.closed)
        off = distance(motion, expected, size) * np.minimum(np.asarray(expected.sigma_min), 1.0)
        # Errors of up to sixteen frames add up; 3 errors were met. Below: what rounding allows, as for hard cases.
        assert np.all(off[closed] <= 10 * error + 1e-12), (trial, off.max() / error)


def distance(one: Motion, other: Motion, size: float) -> np.ndarray:
    """How far joints and the centres of balls are apart (poses,), but for what is idle; lengths over the size."""
    idle, worst = set(other.mechanism.mobility().idle), np.zeros(len(other))
    for joint in other.mechanism.all_joints:
        for column, coordinate in enumerate(joint.coordinates):
            if f"{joint.name}.{coordinate}" in idle or joint.kind == "spherical":
                continue
            gap = np.asarray(one.coordinates[joint.name] - other.coordinates[joint.name])[:, column]
            worst = np.maximum(worst, np.abs(gap) / (size if coordinate[0] in "xyz" else 1.0))
        if joint.kind == "spherical":
            centre = joint.frames_1[0, :3, 3]
            for part in joint.parts:
                gap = np.asarray(one.points(part, centre) - other.points(part, centre))
                worst = np.maximum(worst, np.linalg.norm(gap, axis=1) / size)
    return worst


@pytest.mark.parametrize(
    "build",
    [
        lambda: overconstrained.missing_axes(0.4, 1e-7),
        lambda: mechanisms.bennett_linkage(0.9, 1e-7, 1.7e-7),
        lambda: mechanisms.rssr_linkage(0.3),
    ],
    ids=["axes that miss", "axes nearly parallel", "nothing special"],
)
def test_loops_that_move_are_left_as_they_are(build):
    """Small numbers that are design: RCCC, Bennett's linkage."""
    mechanism = build()
    assert not mechanism.notes and not mechanism.linkage.ideal
    tried = Mechanism.build(fixed=list(mechanism.fixed), joints=mechanism.all_joints, align=MISALIGNMENT_LEVELS[-1])
    assert all(one is other for one, other in zip(tried.all_joints, mechanism.all_joints, strict=True))


@pytest.mark.long
@pytest.mark.parametrize("tilt", [1e-4, 1e-5, 1e-3])
def test_joints_that_disagree_by_more_give_poses_of_least_residual(tilt):
    mechanism = fourbar(tilt)
    motion = mechanism.sweep({"A": TURN})
    status, residual = np.asarray(motion.status), np.asarray(motion.residual)
    assert moved_by(mechanism, fourbar(tilt, align=0).all_joints) == 0.0
    assert set(status) == {Status.CLOSED, Status.MISFIT}
    assert np.all(residual[status == Status.CLOSED] <= default_tolerance(residual.dtype))
    assert np.all(residual[status == Status.MISFIT] > default_tolerance(residual.dtype))
    # the axis of C is out of the plane by no more than the tilt, whatever it turns: of Eq. 12 the root of 2 at most
    assert residual.max() <= 2 * tilt
    expected = np.asarray(fourbar(0.0).sweep({"A": TURN}).coordinates["D"])
    assert np.abs(np.asarray(motion.coordinates["D"]) - expected).max() <= 10 * tilt
    assert f"{np.sum(status == Status.MISFIT)}  MISFIT" in str(motion)
    assert f"{residual.max():.1e}" in str(motion)


@pytest.mark.long
@pytest.mark.parametrize("tilt", [1e-3, 1e-5])
def test_no_pose_beside_has_a_smaller_residual(tilt):
    """The status of the pose is earned: every free coordinate to either side makes the residual larger."""
    mechanism = fourbar(tilt)
    motion = mechanism.sweep({"A": TURN[10:13]})
    for pose in range(3):
        found = np.array([float(motion.coordinates[name][pose, 0]) for name in "ABCD"])
        least = closure(mechanism, found)
        assert least == pytest.approx(float(motion.residual[pose]) ** 2, rel=1e-6)
        for column in range(1, 4):
            for step in (-0.1 * tilt, 0.1 * tilt):
                assert closure(mechanism, found + step * (np.arange(4) == column)) > least


def closure(mechanism: Mechanism, angles: np.ndarray) -> float:
    """Eq. 12 of the four-bar from products of matrices: A B C D^-1 should be the identity; lengths over the size."""
    product, origins = np.eye(4), np.concatenate([joint.frames_1[:, :3, 3] for joint in mechanism.all_joints])
    centre = origins.mean(axis=0)
    size = np.sqrt(((origins - centre) ** 2).sum(axis=1).mean())
    for joint, angle, sign in zip(mechanism.all_joints, angles, (1, 1, 1, -1), strict=True):
        frame, turn = joint.frames_1[0].copy(), np.eye(4)
        frame[:3, 3] = (frame[:3, 3] - centre) / size
        c, s = np.cos(sign * angle), np.sin(sign * angle)
        turn[:2, :2] = [[c, -s], [s, c]]
        product = product @ frame @ turn @ np.linalg.inv(frame)
    return float(((product - np.eye(4)) ** 2).sum())


@pytest.mark.long
def test_the_note_names_the_joint_and_what_it_advises_works():
    mechanism = fourbar(1e-4)
    (note,) = mechanism.notes
    assert "'C'" in note and "'A'" not in note and "MISFIT" in note
    advised = re.search(r"align=(\S+)", note)
    assert advised
    aligned = fourbar(1e-4, align=float(advised[1]))
    assert not aligned.linkage.ideal and np.all(aligned.sweep({"A": TURN}).closed)
    assert "by at most" in str(aligned) and "MISFIT" in str(mechanism)


@pytest.mark.long
def test_a_misfit_works_in_jit_and_grad_and_streams():
    mechanism = fourbar(1e-4)
    inside = jax.jit(lambda mechanism, angles: mechanism.sweep({"A": angles}))(mechanism, jnp.asarray(TURN))
    outside = mechanism.sweep({"A": TURN})
    np.testing.assert_array_equal(inside.status, outside.status)
    np.testing.assert_allclose(inside.coordinates["D"], outside.coordinates["D"], atol=1e-12)
    slope = jax.jacfwd(lambda angle: mechanism.sweep({"A": angle[None]}).coordinates["D"][0, 0])(jnp.asarray(1.0))
    step = 1e-3
    ends = mechanism.sweep({"A": np.array([1 - step, 1 + step])}).coordinates["D"][:, 0]
    # the derivative is that of the nearest mechanism that moves: right to the tilt
    assert float(slope) == pytest.approx(float(ends[1] - ends[0]) / (2 * step), abs=1e-3)
    chunks = list(mechanism.stream({"A": TURN}, chunk=20))
    np.testing.assert_array_equal(np.concatenate([chunk.status for chunk in chunks]), outside.status)


@pytest.mark.long
def test_a_misfit_with_slides_along_the_axes():
    """Planar loops of cylindrical pairs leave their slides to the plane; those of least residual need them."""
    exact = mechanisms.planar_fourbar(1.0, pin=overconstrained.cylindrical)
    joints = tilted(exact.all_joints, 1e-4, np.random.default_rng(0))
    mechanism = Mechanism.build(fixed=["ground"], joints=joints)
    motion = mechanism.sweep({"A.phi": TURN})
    assert mechanism.linkage.ideal and set(np.asarray(motion.status)) <= {Status.CLOSED, Status.MISFIT}
    off = np.asarray(motion.coordinates["D"] - exact.sweep({"A.phi": TURN}).coordinates["D"])
    assert np.abs(off)[:, 1].max() <= 1e-2  # a hundred tilts: the loops cannot say where slides stay


@pytest.mark.long
def test_frames_placed_anew_are_aligned_too():
    mechanism, tilted_axis = fourbar(0.0), fourbar(1e-7, align=0).joints["C"].frames_1[0]
    assert np.all(mechanism.with_frames({"C": tilted_axis}).sweep({"A": TURN}).closed)
    assert mechanism.with_frames({"C": tilted_axis}, align=0).linkage.ideal
    one_side = mechanism.with_frames({("rocker", "C"): tilted_axis})
    assert np.all(one_side.sweep({"A": TURN}).closed) and len(one_side.notes) == 1


@pytest.mark.long
def test_traced_frames_are_taken_as_they_are():
    def rocker(tilt):
        frame = jnp.asarray(mechanism.joints["C"].frames_1[0]).at[0, 2].add(tilt)
        return mechanism.with_frames({"C": frame}).sweep({"A": jnp.array([0.5])}).coordinates["D"][0, 0]

    mechanism = fourbar(0.0)
    assert np.isfinite(jax.grad(rocker)(0.0))


def test_lengths_of_a_mechanism_that_was_aligned_can_be_changed():
    assert np.all(fourbar(1e-7).with_lengths({("coupler", "B", "C"): 3.9}).sweep({"A": 0.2 * TURN}).closed)


@pytest.mark.parametrize("align", [-1e-6, 0.1, float("nan")])
def test_a_wrong_option_is_refused(align):
    with pytest.raises(ValueError, match=r"align must be a number from 0 \(move nothing\) to 0.001.*got"):
        fourbar(0.0, align=align)


def test_a_structure_stays_one():
    """A braced frame has no freedom within any noise: nothing is moved, and no pose is promised."""
    corners = [(0, 0), (0, 3), (4, 3), (4, 0)]
    bars = [("ground", "left"), ("left", "top"), ("top", "right"), ("ground", "right")]
    joints = [revolute("ABCD"[k], *bars[k], point=(*corners[k], 1e-7 * k), axis=(1e-7 * k, 0, 1)) for k in range(4)]
    brace = [
        revolute("E", "ground", "brace", point=(1, 0, 0), axis=(0, 0, 1)),
        revolute("F", "brace", "top", point=(2, 3, 0), axis=(0, 0, 1)),
        prismatic("G", "left", "brace", axis=(0, 1, 0)),
    ]
    mechanism = Mechanism.build(fixed=["ground"], joints=[*joints, *brace])
    assert not mechanism.notes and mechanism.mobility().freedoms == 0
