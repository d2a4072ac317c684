"""Products of displacements along loops."""

from functools import reduce

import numpy as np
import pytest

from jaxkin.geometry.rigid import inverse, product
from jaxkin.linkage.joint_motion import joint_motion, loop_motion
from reference.mechanisms import cam, planar_fourbar, rssr_linkage, slider_crank


@pytest.mark.long
@pytest.mark.parametrize("make", [planar_fourbar, slider_crank, rssr_linkage, cam])
def test_a_loop_is_the_product_of_its_joints(make):
    """Whether it closes or not: for any displacements, of slides, balls and curves, too, and either way through."""
    mechanism, random = make(), np.random.default_rng(0)
    joints = mechanism.all_joints
    displaced = [random.uniform(-0.3, 0.3, (4, len(joint.coordinates))) for joint in joints]
    for group in mechanism.structure.loop_groups:
        for loop in group.loops:
            for way in (loop, [(joint, -sign) for joint, sign in reversed(loop)]):
                each = [joint_motion(joints[joint], displaced[joint]) for joint, _ in way]
                each = [moved if sign > 0 else inverse(moved) for moved, (_, sign) in zip(each, way, strict=True)]
                # rounding of a dozen products
                size = max(1.0, float(np.abs(each[0][:, 3]).max()))
                np.testing.assert_allclose(
                    loop_motion(joints, displaced, way), reduce(product, each), atol=1e-13 * size
                )
