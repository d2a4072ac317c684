"""What a calibration says that measurements do not tell: in noise, in single precision, and in any unit."""

import jax
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples.paths import fourbar
from jaxkin.geometry.pose import rotation

GIVEN = (100.0, 40.0, 120.0, 80.0)
BARS = (("ground", "A", "D"), ("crank", "A", "B"), ("coupler", "B", "C"), ("rocker", "C", "D"))
AXES = np.eye(3)
ANGLES = np.linspace(0, 2 * np.pi, 12, endpoint=False)


@pytest.mark.long
@pytest.mark.parametrize("kind", [jk.revolute, jk.prismatic])
def test_noise_of_poses_does_not_tell_where_a_joint_is_along_its_axis(kind):
    """A hinge is the same anywhere along its axis, and of a slide nothing depends on the place."""
    arm = jk.Mechanism.build(
        fixed=["base"],
        joints=[
            jk.revolute("shoulder", "base", "upper", point=(0, 0, 0), axis=(1, 0, 0)),
            kind("elbow", "upper", "fore", point=(0, 300, 50), axis=(0, 0, 1)),
        ],
    )
    drive = {"shoulder": 0.9 * np.sin(ANGLES), "elbow": 0.9 * np.cos(ANGLES)}
    random = np.random.default_rng(0)
    poses = np.array(arm.sweep(drive).transforms["fore"])
    turns = [rotation(AXES[k % 3], angle) for k, angle in enumerate(random.normal(0, 1e-3, 12))]
    poses[:, :3] = turns @ poses[:, :3]
    poses[:, :3, 3] += random.normal(0, 0.1, (12, 3))
    target = jk.pose("fore")
    found = jk.calibrate(
        arm, drive, {target: poses}, frames={"shoulder": ("y",), "elbow": ("x", "y", "z")}, sigma={target: (0.1, 1e-3)}
    )
    untold = "z" if kind is jk.revolute else "xyz"
    assert sorted(map(list, found.undetermined)) == [[f"{axis} of elbow"] for axis in untold]


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:jaxkin computes in float32")  # said once a process
def test_single_precision_tells_no_more():
    """Angles do not tell the scale: derivatives that are rounded to 1e-7 told it, with bars of minus many metres."""
    with jax.enable_x64(False):
        measured = np.array(fourbar(100.0, 40.2, 120.0, 80.0).sweep({"A": ANGLES}).coordinates["D"][:, 0], float)
        measured += np.random.default_rng(0).normal(0, 1e-3, 12)
        found = jk.calibrate(fourbar(*GIVEN), {"A": ANGLES}, {"D": measured}, lengths=BARS)
    (direction,) = found.undetermined
    now = np.array([found.mechanism.lengths[bar] for bar in BARS])
    # shares of noise in a direction are told apart to a thousandth
    np.testing.assert_allclose(list(direction.values()), now / now.max(), atol=1e-3)
    assert found.converged and np.isnan(found.values).all()


@pytest.mark.long
@pytest.mark.parametrize("scale", [1.0, 1e5])
def test_an_angle_is_named_beside_lengths_in_any_unit(scale):
    """A crank that turns about its pin with its zero is the same crank: y by minus its length, for one radian."""
    measured = np.asarray(fourbar(100.0, 40.2, 120.0, 80.0).sweep({"A": ANGLES}).coordinates["D"][:, 0])
    mechanism = fourbar(*(scale * each for each in GIVEN))
    found = jk.calibrate(mechanism, {"A": ANGLES}, {"D": measured}, frames=[("crank", "A")])
    (direction,) = found.undetermined
    length = found.mechanism.lengths["crank", "A", "B"]
    np.testing.assert_allclose(-direction["y of crank A"] / direction["rz of crank A"], length, rtol=1e-6)
