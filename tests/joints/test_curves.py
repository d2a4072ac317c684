"""Points on curves and curves on curves, and what all joints along curves have: files, frames, derivatives."""

import jax
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.io.study_writer import write_study
from jaxkin.view.sticks import stick_parts
from reference import higher_pairs
from reference.oval_cam import TURN, flat_on_oval, roller, swings

Z = (0.0, 0.0, 1.0)
LINE = np.stack([np.linspace(-60, 90, 7), np.zeros(7)], axis=1)


def quick_return(pin):
    return jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("crank", "ground", "wheel", point=(120, 0, 0), axis=Z),
            pin,
            jk.revolute("D", "ground", "arm", point=(0, 0, 0), axis=Z),
        ],
        unit="mm",
    )


def on_line(**more):
    return jk.point_on_curve("pin", "arm", "wheel", profile=LINE, point=(150, 0, 0), point2=(170, 0, 0), axis=Z, **more)


@pytest.mark.long
def test_a_pin_on_a_straight_curve_is_a_pin_in_a_slot():
    slot = jk.pin_in_slot("pin", "arm", "wheel", point=(170, 0, 0), axis=Z, direction=(1, 0, 0))
    one, other = (quick_return(pin).sweep({"crank": TURN}) for pin in (on_line(), slot))
    assert one.closed.all() and other.closed.all()  # beyond the ends of the line, too
    for name in ("D", "pin"):  # s is z and phi is phi; rounding of lengths of 150
        np.testing.assert_allclose(one.coordinates[name], other.coordinates[name], atol=1e-11)


@pytest.mark.long
def test_a_pin_on_a_circle_is_a_pin_in_a_circular_slot():
    arc = np.linspace(-1.2, 0.7, 200)
    profile = 60 * np.stack([np.cos(arc), np.sin(arc)], axis=1)
    start = np.array([60 * np.cos(-0.3), 60 * np.sin(-0.3), 0])

    def mechanism(pin):
        return jk.Mechanism.build(
            fixed=["ground"],
            joints=[
                jk.revolute("A", "ground", "crank", point=(0, 0, 0), axis=Z),
                jk.revolute("B", "crank", "coupler", point=(15, 5, 0), axis=Z),
                pin,
            ],
        )

    one = mechanism(jk.point_on_curve("pin", "ground", "coupler", profile=profile, point2=start))
    other = mechanism(jk.pin_in_slot("pin", "ground", "coupler", point=start, axis=Z, centre=(0, 0, 0)))
    angles = np.linspace(0, 0.6, 13)
    motions = [each.sweep({"A": angles}, throw=True) for each in (one, other)]
    s, turned = (np.asarray(motion.coordinates["pin"]) for motion in motions)
    # the chords of 199 pieces are shorter than the arc by h^2 / 24 = 4e-6 of it; the spline is off by 1e-9 of 60
    np.testing.assert_allclose(s[:, 0], 60 * turned[:, 0], rtol=4e-6, atol=1e-9)
    np.testing.assert_allclose(s[:, 1], turned[:, 1], atol=1e-7)
    np.testing.assert_allclose(motions[0].coordinates["B"], motions[1].coordinates["B"], atol=1e-7)


def discs(gap=0.0):
    """Two discs: the eccentric one on a shaft, and a round follower that slides along y beside it."""
    height = float(higher_pairs.cam_roller_follower(np.zeros(())))
    return jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("shaft", "ground", "cam", point=(0, 0, 0), axis=Z),
            jk.curve_on_curve(
                "contact",
                "cam",
                "follower",
                profile=higher_pairs.disc_profile(360),
                profile2=higher_pairs.disc_profile(180, radius=6.0, eccentricity=0.0),
                point2=(3, height + gap, 0),
            ),
            jk.prismatic("guide", "ground", "follower", axis=(0, 1, 0)),
        ],
        unit="mm",
    )


@pytest.mark.long
def test_a_round_curve_on_a_disc_is_a_roller():
    motion = discs().sweep({"shaft": TURN}, throw=True)
    height = higher_pairs.cam_roller_follower(TURN)
    np.testing.assert_allclose(motion.coordinates["guide"][:, 0], height - height[0], atol=3e-8)  # both splines
    assert jk.curve_contacts(motion).holds
    found = discs().mobility()
    assert (found.freedoms, found.idle_freedoms) == (1, 0)


@pytest.mark.long
def test_curves_that_do_not_touch_are_open_and_closed_by_close():
    mechanism = discs(gap=0.5)
    assert "Not closed in this pose" in str(mechanism)
    closed = mechanism.close()
    assert closed.closed and closed.moves["follower"].length > 0.3
    height = higher_pairs.cam_roller_follower(TURN)
    motion = mechanism.sweep({"shaft": TURN}, throw=True)
    np.testing.assert_allclose(motion.coordinates["guide"][:, 0], height - height[0] - 0.5, atol=3e-8)


@pytest.fixture(scope="module")
def oval():
    return roller()


@pytest.fixture(scope="module")
def swung(oval):
    return swings(oval)


@pytest.mark.long
def test_neither_unit_nor_place_nor_names_nor_order_matter(swung):
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    place = np.eye(4)
    place[:3, :3], place[:3, 3] = turn * np.linalg.det(turn), (300.0, -20.0, 70.0)
    for other in (
        roller(unit=1e-3),
        roller(unit=1e4),
        roller(place=place),
        roller(names=("frame", "z", "a")),
        roller(backwards=True),
    ):
        # rounding of coordinates that are ten times as large as the mechanism
        np.testing.assert_allclose(swings(other), swung, atol=1e-11)


@pytest.mark.long
def test_all_that_can_be_written_is_read_back(oval, swung, tmp_path):
    study = tmp_path / "cam.toml"
    write_study(oval, study, drive={"shaft": "0:360:13"})
    saved = jk.load(oval.save(tmp_path / "cam.json")).mechanism()
    assert np.array_equal(swings(saved), swung)
    # the contact is found anew from numbers in full precision
    np.testing.assert_allclose(swings(jk.load_study(study).mechanism), swung, atol=1e-12)


@pytest.mark.parametrize(
    "made",
    [
        lambda: quick_return(on_line(limits={"s": (-30, 60)})),
        discs,
        lambda: flat_on_oval(),  # noqa: PLW0108, it is defined below
        lambda: quick_return(on_line(direction=(0.6, 0.8, 0))).close().mechanism,
    ],
    ids=["point", "curves", "flat", "tilted"],
)
def test_a_study_says_every_joint_along_a_curve(made, tmp_path):
    mechanism, study = made(), tmp_path / "study.toml"
    write_study(mechanism, study)
    again = jk.load_study(study).mechanism
    for name, joint in mechanism.joints.items():
        other = again.joints[name]
        assert (other.kind, other.movements) == (joint.kind, joint.movements)
        np.testing.assert_allclose(other.limits, joint.limits, atol=1e-9)
        # the contact is found anew: lengths of 200, divided by the angle of a contact that is not sharp
        for side in ("frames_1", "frames_2"):
            np.testing.assert_allclose(getattr(other, side), getattr(joint, side), atol=1e-9)
        for curve, like in zip(other.curves, joint.curves, strict=True):
            if curve is not None and like is not None:
                np.testing.assert_array_equal(curve.points, like.points)
                np.testing.assert_allclose(curve.place, like.place, atol=1e-9)
                assert curve.closed == like.closed


@pytest.mark.long
def test_assembled_in_another_pose_it_moves_on_from_there(oval, swung):
    motion = oval.sweep({"shaft": TURN})
    there = oval.at(motion, 5)
    again = there.sweep({"shaft": TURN[:8]}, throw=True)
    for name, q in motion.coordinates.items():
        np.testing.assert_allclose(again.coordinates[name], q[5:13] - q[5], atol=1e-11)  # rounding


@pytest.mark.long
def test_the_ends_of_an_open_curve_are_limits():
    joint = on_line()
    np.testing.assert_allclose(joint.limits[0], (-80.0, 70.0), atol=1e-12)
    assert on_line(limits={"s": (-5, 5)}).limits[0] == (-5, 5)
    # it is passed where the pin of the wheel, of 50, is 170 - 80 - 50 = 40 beside its lowest place
    motion = quick_return(joint).sweep({"crank": TURN})
    found = jk.curve_contacts(motion).contacts[0]
    arm = np.hypot(120 + 50 * np.cos(TURN), 50 * np.sin(TURN))
    np.testing.assert_allclose(found.beyond, np.maximum(90 - arm, 0.0), atol=1e-9)
    assert np.all(motion.closed)
    np.testing.assert_array_equal(np.asarray(motion.status) == jk.Status.LIMITED, arm < 90)
    assert "leaves the end of its curve" in str(motion) and "20 mm" in str(motion)


@pytest.mark.long
def test_lengths_beside_a_curve(oval, swung):
    """The arm is as long from its pivot to the middle of the roller, and may be made longer."""
    assert oval.lengths["arm", "contact", "pivot"] == pytest.approx(np.hypot(45, 7), rel=1e-12)
    longer = oval.with_lengths({("arm", "contact", "pivot"): 50.0})
    motion = longer.sweep({"shaft": TURN}, throw=True)
    tip = motion.points("arm", np.asarray(longer.joints["contact"].frames_2)[-1, :3, 3])
    # the roller's middle is as far from the pivot as it was made, and a radius from the profile
    np.testing.assert_allclose(np.linalg.norm(np.asarray(tip) - [45, 20, 0], axis=1), 50.0, rtol=1e-12)
    assert jk.curve_contacts(motion).holds


def test_a_curve_is_drawn_on_its_part(oval):
    found = {part.name: part.triangles.reshape(-1, 3) for part in stick_parts(oval)}
    turn = np.linspace(0, 2 * np.pi, 9)
    for angle in turn:
        place = np.array([28 * np.cos(angle), 20 * np.sin(angle) - 2 * np.sin(3 * angle)])
        assert np.linalg.norm(found["cam"][:, :2] - place, axis=1).min() < 2.0
    beside = np.linalg.norm(found["arm"][:, :2] - [0, 27], axis=1)
    assert np.any(np.abs(beside - 5.0) < 1e-6)  # the roller's rim


@pytest.mark.long
def test_what_has_no_curve_has_no_curve_in_its_program():
    """Joints without curves have the leaves that they had, and their sweeps compute no spline."""
    pins = [
        jk.revolute(name, *parts, point=point, axis=Z)
        for name, parts, point in (
            ("A", ("ground", "crank"), (0, 0, 0)),
            ("B", ("crank", "coupler"), (1, 0, 0)),
            ("C", ("coupler", "rocker"), (3.2, 2.9, 0)),
            ("D", ("ground", "rocker"), (4, 0, 0)),
        )
    ]
    fourbar = jk.Mechanism.build(fixed=["ground"], joints=pins)
    assert len(jax.tree.leaves(fourbar)) == 3 * 4  # frames on both parts, and the pitch
    screwed = jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.screw("A", "ground", "nut", point=(0, 0, 0), axis=Z, pitch=2.0),
            jk.revolute("B", "nut", "slider", point=(0, 0, 0), axis=Z),
            jk.prismatic("C", "ground", "slider", axis=Z),
        ],
    )
    for mechanism in (fourbar, screwed):
        text = str(jax.make_jaxpr(lambda u, m=mechanism: m.sweep({"A": u}).displacements)(TURN))
        assert "tridiagonal" not in text
    assert "tridiagonal" in str(jax.make_jaxpr(lambda u: roller().sweep({"shaft": u}).displacements)(TURN))


@pytest.mark.parametrize(
    "write, name", [(jk.write_mjcf, "cam.xml"), (jk.write_urdf, "cam.urdf"), (jk.write_asmt, "cam.asmt")]
)
def test_formats_without_curves_refuse_them(write, name, oval, tmp_path):
    with pytest.raises(ValueError, match="no joints along curves and over surfaces, as 'contact'"):
        write(oval, tmp_path / name)
    assert not list(tmp_path.iterdir())
